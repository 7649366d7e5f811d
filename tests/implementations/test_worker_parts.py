"""What a worker says of a function and of what a library leaves behind, and a reply that breaks the protocol."""

from __future__ import annotations

import re
import signal
import sys

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.implementations import worker
from hypcheck.implementations.description import Description, described_by_json
from hypcheck.implementations.foreign import ContractError, LoadError, PythonFunction, error_text
from hypcheck.implementations.frames import CALLS
from hypcheck.implementations.protocol import TextReply, TimeReply
from hypcheck.implementations.session import FaultError

ROWS = np.zeros((3, 10))
POSITION, *_, TIMED = CALLS


@pytest.fixture
def loaded(tmp_path, monkeypatch):
    """A function of a file with this text; what loading it changes is undone."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    before = {*sys.modules}

    def load(text, name="under_test.py"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return PythonFunction(str(tmp_path / name), "f")

    yield load
    for each in {*sys.modules} - before:
        del sys.modules[each]


def test_the_worker_refuses_a_description_that_json_cannot_express(loaded):
    with pytest.raises(LoadError, match="its description holds a value that JSON cannot express"):
        loaded("def f(rows): ...\nhypcheck = {'name': {1, 2}}")
    assert loaded("def f(rows): ...\nhypcheck = {'name': 'mine'}", "other.py").description == '{"name": "mine"}'


def test_the_worker_does_not_replace_a_loaded_module_by_a_users_file_of_its_name(loaded):
    import json

    function = loaded("def f(rows):\n    return [1] * len(rows)", "json.py")
    assert function.classify(ROWS, POSITION).integers.tolist() == [1, 1, 1]
    assert sys.modules["json"] is json


def test_the_worker_refuses_a_file_that_is_not_a_python_file(loaded):
    with pytest.raises(LoadError, match="it is not a Python file"):
        loaded("def f(rows): ...", "under_test.txt")


def test_the_worker_reports_a_syntax_error_with_its_file_and_line(loaded):
    with pytest.raises(LoadError, match=r"raised SyntaxError: .* \(under_test\.py, line 2\)"):
        loaded("x = 1\ndef f(rows) return")
    assert re.search(
        r"raised ValueError: no \(test_worker_parts\.py, line \d+\)", error_text(_raised(ValueError("no")))
    )


def _raised(error):
    try:
        raise error
    except ValueError as found:
        return found


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("def g(rows): ...", "has no function 'f'; it has nothing with that name"),
        ("f = 3", "has no function 'f'; it has a int"),
        ("def f(x, y): ...", r"has f\(x, y\), which cannot be called with one argument; it must be f\(rows\)"),
        (
            "import sys\nsys.path.append('/no/such/folder')\nimport no_such_module",
            "ModuleNotFoundError: .*; sys.path has '/no/such/folder', which is not there",
        ),
    ],
)
def test_the_worker_refuses_a_file_without_a_function_of_rows(loaded, text, reason):
    with pytest.raises(LoadError, match=reason):
        loaded(text)


def test_the_worker_names_no_missing_folder_of_the_path_if_the_path_has_a_file(loaded, tmp_path):
    (tmp_path / "archive.zip").write_bytes(b"")
    with pytest.raises(LoadError) as caught:
        loaded(f"import sys\nsys.path.append({str(tmp_path / 'archive.zip')!r})\nimport no_such_module")
    assert "sys.path has" not in str(caught.value)


def test_the_worker_takes_a_callable_whose_parameters_cannot_be_known(loaded):
    """Python knows no parameters of `type`, which called with rows gives their class."""
    with pytest.raises(ContractError, match="it returned a type"):
        loaded("f = type").classify(ROWS, POSITION)


@pytest.mark.parametrize(
    ("returned", "reason"),
    [
        ("[0.5, 1, 0]", "it returned a list of float64; it must be integers, such as int8"),
        ("[1, 0]", r"it returned a list of shape \(2,\) for 3 rows; it must be \(3,\)$"),
        ("[[1], [1, 0], 1]", "it returned a list that is not an array of one integer a row"),
        ("np.ma.masked_array([1, 0, 1], mask=[0, 0, 1])", "it returned a masked array with masked answers"),
    ],
)
def test_a_function_that_does_not_return_an_integer_for_each_row_raises_an_error(loaded, returned, reason):
    with pytest.raises(ContractError, match=reason):
        loaded(f"import numpy as np\ndef f(rows):\n    return {returned}").classify(ROWS, POSITION)


@pytest.mark.parametrize(
    ("returned", "reason"),
    [
        ("[1, 0, 1]", "with times it must return two arrays, hits and times"),
        ("([1, 0, 1], [0.5, 0.5])", r"as times .* of shape \(2,\) and of float64 for 3 rows; it must be \(3,\)"),
        ("([1, 0, 1], [[0.5], [0.5, 0.25], 1])", r"as times .*; it must be \(3,\) of float64"),
        ("([1, 0, 1], ['a', 'b', 'c'])", r"as times .* of <U1 for 3 rows"),
    ],
)
def test_a_function_for_sweeps_that_does_not_return_hits_and_times_raises_an_error(loaded, returned, reason):
    with pytest.raises(ContractError, match=reason):
        loaded(f"def f(rows):\n    return {returned}").classify(ROWS, TIMED)


def test_a_function_that_returns_unrequested_times_is_told_to_declare_them_in_its_description(loaded):
    with pytest.raises(ContractError, match=r"it must be \(3,\); to return times .* must say \"times\": True"):
        loaded("def f(rows):\n    return [1, 0, 1], [0.5, 0.5, 0.5]").classify(ROWS, POSITION)


def test_a_function_may_return_times_of_any_type_and_too_large_answers_stay_invalid(loaded):
    function = loaded("import numpy as np\ndef f(rows):\n    return np.array([1, 0, 2**64 - 1], np.uint64), [0, 1, 0]")
    given = function.classify(ROWS, TIMED)
    assert given.times.tolist() == [0.0, 1.0, 0.0]
    assert given.integers.tolist() == [1, 0, 2**63 - 1]


HANDLERS = bytes(8 * 65)


def test_every_change_that_a_library_leaves_in_the_process_is_named():
    before = worker._State("/before", "C", HANDLERS, 3, ((1, 1), (1, 2)))
    changed = bytearray(HANDLERS)
    changed[8 * signal.SIGSEGV] = changed[8 * 64] = 1
    now = worker._State("/now", "de", bytes(changed), 4, ((1, 1), (1, 3)))
    assert list(worker._changes(before, now)) == [
        "the working directory, which is '/now' now",
        "the locale, which is 'de' now",
        "the handler of SIGSEGV, SIGRTMAX",
        "the open descriptors",
        "the files behind the standard descriptors",
    ]
    assert list(worker._changes(before, before)) == []


def test_a_changed_handler_of_an_unnamed_signal_is_reported_by_its_number():
    assert (worker._name(int(signal.SIGINT)), worker._name(63)) == ("SIGINT", "signal 63")


@pytest.mark.parametrize(
    ("before", "now", "said"),
    [
        ((0x1F80, 0x37F), (0x9FC0, 0x37F), "flushing results to zero (FTZ), denormals are zero (DAZ)"),
        ((0x1F80, 0x37F), (0x1F00, 0x27F), "the mask of floating point exceptions, the precision of the x87 unit"),
        ((0x1F80, 0x37F), (0x1F81, 0x37F), "the control word of floating point"),
    ],
)
def test_a_changed_floating_point_control_word_is_reported_by_its_bits(before, now, said):
    assert worker._control_change(before, now) == said


def test_a_reply_with_a_missing_time_or_checksum_breaks_the_protocol():
    with pytest.raises(FaultError) as raised:
        TextReply(1, 2, times=True).answers(b"1 2\n0\n1\n")
    assert raised.value.reason == "answer 2 of 2 is '1'; it must be 1 and the time, one blank between"
    with pytest.raises(FaultError) as raised:
        TimeReply(7).length(bytearray(b"7 100\n"))
    assert raised.value.reason == "it wrote '7 100' where '7 NANOSECONDS CHECKSUM' had to come"


def test_a_description_longer_than_65536_bytes_is_refused_without_parsing():
    with pytest.raises(InputError, match=r"longer than 65536 bytes$"):
        described_by_json(" " * 65537, Description(name="x"))
    assert described_by_json(" " * 65534 + "{}", Description(name="x")).name == "x"
