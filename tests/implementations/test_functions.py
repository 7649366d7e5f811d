"""Python functions: each fault ends as its own status and sentence, and costs only its own row."""

from __future__ import annotations

import re
import sys
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits, Outcome, StartError, TimingError
from hypcheck.implementations.worker import Leftovers, mode_in_use
from tests.tools.miniatures import (
    HERE,
    LIMITS,
    NOT_ISOLATED,
    QUICK,
    UNLUCKY,
    command,
    function,
    only_unlucky,
    restarts_of,
    rows,
    stderr_of,
    truth,
)

GOES_ON = {
    13: (Outcome.ERROR, r"raised ZeroDivisionError: float division \\x1b\[0m by zero \(goes_wrong.py, line 17\)"),
    14: (Outcome.ERROR, r"raised SystemExit: 3 \(goes_wrong.py, line 19\)"),
    15: (Outcome.PROTOCOL, "left the rounding mode changed: upward; a call must leave it as it was"),
    16: (Outcome.PROTOCOL, "answered 256; it must be one of -1, 0, 1 or 2"),
}
ENDS = {
    13: (Outcome.CRASH, "ended by itself with exit status 3"),
    14: (Outcome.CRASH, "ended by SIGSEGV.*; stderr: .*ends.py"),
    15: (Outcome.TIMEOUT, "no answer within 0.7 s"),
}
EATS = {16: (Outcome.CRASH, r"memory: its processes grew to 0\.\d+ GiB")}


@pytest.mark.parametrize(
    ("name", "faults", "limits"),
    [
        ("goes_wrong", GOES_ON, LIMITS),
        ("goes_wrong", GOES_ON, NOT_ISOLATED),
        ("ends", ENDS, QUICK),
        ("ends", EATS, LIMITS),
    ],
)
def test_a_fault_of_a_function_fails_only_its_own_row_with_the_reason_and_costs_a_restart_if_it_ends(
    name, faults, limits
):
    some = rows(lucky=True)
    places = dict(zip(faults, (2, 17, 18, 33), strict=False))
    for gamma, place in places.items():
        some[place, 1] = gamma
    with open_implementation(function(name), limits) as it:
        answered = it.classify(some)
        assert it.classify(rows(lucky=True)).answered.all()
        assert restarts_of(it) == (len(faults) if name == "ends" else 0)
    assert np.flatnonzero(~answered.answered).tolist() == [*places.values()]
    assert answered.answers[answered.answered].tolist() == truth(some)[answered.answered].tolist()
    for gamma, (outcome, sentence) in faults.items():
        reason = answered.reasons[places[gamma]]
        assert answered.status[places[gamma]] == outcome
        assert reason.isprintable()
        assert re.search(sentence, reason), reason


def test_a_function_that_does_not_return_one_integer_per_row_breaks_the_protocol():
    sentences = (
        "it returned an array of float64; it must be integers, such as int8",
        r"it returned an array of shape \(2,\) for 1 rows; it must be \(1,\)",
        r"it returned a NoneType of shape \(\) for 1 rows; it must be \(1,\)",
        "it returned a masked array with masked answers; it must answer every row",
        "it returned a list that is not an array of one integer a row",
    )
    some = rows()
    with open_implementation(function("no_integers"), LIMITS) as it:
        for some[:, 1], sentence in enumerate(sentences, 1):
            answered = it.classify(some)
            assert answered.count(Outcome.PROTOCOL) == 40
            assert all(re.search(sentence, answered.reasons[index]) for index in range(40))
        assert restarts_of(it) == 0


def test_a_function_that_does_not_return_integers_breaks_the_protocol_without_isolation_too():
    with open_implementation(function("floats"), NOT_ISOLATED) as it:
        answered = it.classify(rows(3, lucky=True))
    assert answered.status.tolist() == [Outcome.PROTOCOL] * 3
    assert answered.reasons[0] == "it returned an array of float64; it must be integers, such as int8"


def test_a_function_that_cannot_be_loaded_again_is_given_up_with_the_reason(tmp_path):
    """Its file is gone when its process has ended."""
    (tmp_path / "once.py").write_text("import os\nos.remove(__file__)\ndef f(rows):\n    os._exit(3)\n")
    with open_implementation(f"python:{tmp_path / 'once.py'}:f", NOT_ISOLATED) as it:
        answered = it.classify(rows(3, lucky=True), batch=1)
        with pytest.raises(TimingError, match="could not be timed: not asked: it could not be started again"):
            it.time(rows(3, lucky=True), 1)
    assert answered.status.tolist() == [Outcome.CRASH, Outcome.NOT_RUN, Outcome.NOT_RUN]
    assert re.search("not asked: it could not be started again: .*there is no file", answered.reasons[1])


def test_a_function_that_has_never_answered_is_given_up_after_1024_rows():
    with open_implementation(function("floats"), LIMITS) as it:
        answered = it.classify(rows(1100), batch=150)
    assert answered.status.tolist() == [Outcome.PROTOCOL] * 1024 + [Outcome.NOT_RUN] * 76
    assert answered.reasons[1023].startswith("it returned")
    given_up = "not asked: 1,024 rows before were at fault and none was answered; the last: it returned"
    assert answered.reasons[1099].startswith(given_up)


@pytest.mark.parametrize(("spec", "restarts"), [(command("leaves"), 3), (function("raises"), 0)])
def test_the_outcome_of_faults_does_not_depend_on_the_batch_size(spec, restarts):
    """Batches grow with what a machine answers in time: neither restarts nor what is not asked may depend on them."""
    some = rows(300, lucky=True)
    some[[7, 50, 130, 200, 203, 280]] = rows()[UNLUCKY]
    found = []
    for batch in (16, 300):
        with open_implementation(spec, replace(LIMITS, restarts=3)) as it:
            it.allowance = replace(it.allowance, faults=4, hangs=None)
            answered = it.classify(some, batch=batch)
            found.append((answered.status.tolist(), answered.answers.tolist(), restarts_of(it)))
    assert found[0] == found[1]
    assert np.flatnonzero(answered.status != Outcome.ANSWERED).tolist() == [7, 50, 130, *range(200, 300)]
    assert restarts_of(it) == restarts


def test_a_function_may_return_a_list_of_integers():
    some = rows(500)
    with open_implementation(function("list_of_integers"), LIMITS) as it:
        assert it.classify(some).answers.tolist() == truth(some).tolist()


def test_a_function_whose_file_imports_hypcheck_does_not_get_a_description_from_it():
    with open_implementation(function("imports_us"), NOT_ISOLATED) as it:
        assert it.classify(rows()).answers.tolist() == truth(rows()).tolist()


def intruder(name):
    return function("writes_into_our_pipe").replace(":classify", f":{name}")


@pytest.mark.parametrize(("name", "seen"), [("garbage", r"'�\\x1b\[31m"), ("error", "'erro")])
def test_a_function_that_writes_into_the_pipe_of_its_worker_fails_its_row(name, seen):
    some = rows()
    with open_implementation(intruder(name), LIMITS) as it:
        for _ in range(2):
            reason = only_unlucky(it.classify(some), Outcome.PROTOCOL, truth(some))
            assert re.search(f"it wrote into the worker's pipe: {seen}", reason), reason


def test_times_that_a_function_writes_into_the_pipe_of_its_worker_are_refused():
    with (
        open_implementation(intruder("times"), LIMITS) as it,
        pytest.raises(TimingError, match="it wrote into the worker's pipe"),
    ):
        it.time(rows(), 1)


def test_a_function_may_print_and_its_output_is_kept_as_its_standard_error():
    some = rows()
    with open_implementation(function("prints"), LIMITS) as it:
        assert it.classify(some).answers.tolist() == truth(some).tolist()
        assert stderr_of(it)[-2:] == ("computing", r"�\x00 from C")


def test_a_module_in_a_python_spec_is_found_from_the_working_directory(tmp_path, monkeypatch):
    """There a struct.py of the user's is no stand-in for Python's while our own modules are loaded."""
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / "module.py").write_text("def near(rows):\n    return [0] * len(rows)\n")
    (tmp_path / "struct.py").write_text("raise SystemExit('this is not the struct that we want')\n")
    monkeypatch.chdir(tmp_path)
    with open_implementation("python:package.module:near", LIMITS) as it:
        assert it.classify(rows()).answers.tolist() == [0] * 40
        assert (it.description.name, it.description.language) == ("package.module:near", "python")


def test_the_description_of_a_function_is_read_and_can_be_overridden():
    with open_implementation(function("right"), LIMITS, precision="float32", domain=Domain(ratio=(1.0, 2.0))) as it:
        assert (it.declared.name, it.declared.version, it.declared.precision) == ("right", "2.1", "float64")
        assert it.declared.domain == Domain(regimes=("a>=1",), ratio=(0.1, 10.0))
        assert (it.description.precision, it.description.domain) == ("float32", Domain(ratio=(1.0, 2.0)))
    with open_implementation(function("float16"), LIMITS) as it:
        assert (it.description.precision, it.description.question) == ("float16", "exterior")
        assert it.classify(rows()).answers.tolist() == [1] * 40


def test_an_invalid_override_of_a_description_is_refused_and_leaves_no_process():
    with pytest.raises(InputError, match="the precision is 'double'; it must be one of float16"):
        open_implementation(function("right"), LIMITS, precision="double")


def test_an_answer_that_the_question_does_not_allow_breaks_the_protocol():
    some = rows()
    with open_implementation(function("right"), LIMITS, question="exterior") as it:
        answered = it.classify(some)
    assert (answered.status == Outcome.PROTOCOL).tolist() == (truth(some) == -1).tolist()
    assert "it must be one of 0, 1 or 2" in answered.reasons[int(np.flatnonzero(truth(some) == -1)[0])]


def test_answer_127_is_allowed_for_invalid_rows_if_the_description_says_refuses():
    some = rows()
    some[3, 0], some[4, 6] = -1.0, np.nan
    with open_implementation(function("refuses_all"), LIMITS) as it:
        answered = it.classify(some)
        assert np.flatnonzero(answered.answered).tolist() == [3, 4]
        assert answered.answers[3:5].tolist() == [127, 127]
        assert "answered 127, which refuses the row, but the row is valid" in answered.reasons[0]


def test_the_worker_varies_row_addresses_so_that_answers_that_depend_on_them_differ():
    some = rows()
    with open_implementation(function("minds_alignment"), LIMITS) as it:
        answers = {bytes(it.classify(some).answers) for _ in range(8)}
        it.close()
        afresh = it.classify(some).answers
    assert len(answers) == 2
    assert bytes(afresh) in answers


def test_the_state_of_a_function_is_lost_with_a_fresh_process():
    some = rows()
    with open_implementation(function("stateful"), LIMITS) as it:
        seen = [it.classify(some).answers.tolist() for _ in range(5)]
        it.close()
        assert it.classify(some).answers.tolist() == truth(some).tolist()
    assert seen == [truth(some).tolist()] * 3 + [(-truth(some)).tolist()] * 2


def test_a_slow_function_gets_smaller_batches_and_no_timeout():
    """All 260 rows at once would take 1.3 s."""
    with open_implementation(function("slow"), QUICK) as it:
        assert it.classify(rows(260)).answered.all()
        assert restarts_of(it) == 0


@pytest.mark.parametrize(
    ("spec", "sentence"),
    [
        (
            function("fails_to_import"),
            r"raised ModuleNotFoundError: .*\(fails_to_import.py, line 3\)",
        ),
        (function("misspelt"), "the description has the key 'presicion', which is not known; did you mean precision"),
        (
            function("ends_when_loaded"),
            "while it was loaded it ended by itself with .* 4; stderr: licence expired",
        ),
        (function("no_such_file"), r"there is no file '.*no_such_file.py'$"),
        (
            f"python:{HERE / 'functions' / 'right.py'}:clasify",
            "has no function 'clasify'; it has nothing with that name",
        ),
        (f"python:{HERE / 'functions' / 'right.py'}:hypcheck", "has no function 'hypcheck'; it has a dict"),
        (
            function("seven_numbers"),
            (
                r"has classify\(alpha, gamma, b, d, x, y, z\), which cannot be called with one argument; it must be "
                r"classify\(rows\) for all rows at once"
            ),
        ),
        ("python:no.such.module:f", r"raised ModuleNotFoundError: No module named 'no'( \(.*\.py, line \d+\))?$"),
    ],
)
def test_a_python_spec_that_cannot_be_loaded_is_refused(spec, sentence):
    with pytest.raises(StartError, match=sentence) as caught:
        open_implementation(spec, LIMITS)
    assert str(caught.value).startswith(spec[:30])


def test_a_python_spec_that_loads_too_slowly_is_refused(tmp_path):
    (tmp_path / "slow.py").write_text("import time\ntime.sleep(60)\n")
    with pytest.raises(StartError, match=r"it was not loaded within 0\.5 s"):
        open_implementation(f"python:{tmp_path / 'slow.py'}:f", Limits(startup_timeout=0.5))


def test_a_function_is_timed_and_a_fault_while_timing_is_reported():
    some = rows(200, lucky=True)
    with open_implementation(function("right"), LIMITS) as it:
        # the least of five, for whatever else the machine does may fall on any one of them
        assert 0 < min(it.time(some, 1) for _ in range(5)) < it.time(some, 30)
        assert it.time(some, 1, row_by_row=True) > 0
        with pytest.raises(InputError, match="0 rows cannot be timed 1 time;"):
            it.time(some[:0], 1)
        with pytest.raises(InputError, match="has no function for scenes"):
            it.time(some, 1, by_scene=True)
    with open_implementation(function("raises"), LIMITS) as it:
        with pytest.raises(TimingError, match="could not be timed: it raised ZeroDivisionError"):
            it.time(rows(), 1)
        assert it.time(some, 1) > 0


def test_a_function_answers_half_a_million_rows_in_their_order(tmp_path):
    (tmp_path / "sign.py").write_text(
        "import numpy as np\n\n\ndef f(rows):\n    return (rows[:, 4] > 0).astype(np.int8) - (rows[:, 4] < 0)\n"
    )
    some = rows(1 << 19)
    with open_implementation(f"python:{tmp_path / 'sign.py'}:f") as it:
        assert it.classify(some).answers.tolist() == np.sign(some[:, 4]).tolist()
        assert it.proven_batch == it._supervisor.max_batch


def test_a_change_of_the_rounding_mode_by_a_call_is_found_and_undone():
    import ctypes

    guard, libm = Leftovers(whole=False), ctypes.CDLL(None)
    for mode, name in ((0x400, "downward"), (0x800, "upward"), (0xC00, "towards zero")):
        if libm.fesetround(mode):
            pytest.skip("this machine numbers its rounding modes in another way than x86")
        found = mode_in_use()
        with pytest.raises(Exception, match="left the rounding mode changed") as caught:
            guard.restore()
        assert found == name
        assert name in str(caught.value)
        assert mode_in_use() == "to nearest"
        guard.restore()


def test_an_error_inside_a_package_is_reported_with_the_users_calling_line(tmp_path):
    (tmp_path / "helper.py").write_text("import numpy as np\n\ndef f():\n    np.broadcast_arrays([1, 2], [1, 2, 3])\n")
    calls = {
        "np.broadcast_arrays([1, 2], [1, 2, 3])": ("calls.py", 7),
        "json.loads('{')": ("calls.py", 9),
        "helper.f()": ("helper.py", 4),
    }
    text = "import json\n\nimport helper\nimport numpy as np\ndef f(rows):\n"
    text += "".join(f"    if rows[0, 0] == {place + 1}:\n        {call}\n" for place, call in enumerate(calls))
    (tmp_path / "calls.py").write_text(text, encoding="utf-8")
    some = rows()[: len(calls)]
    some[:, 0] = range(1, len(calls) + 1)
    with open_implementation(f"python:{tmp_path / 'calls.py'}:f", LIMITS) as it:
        answered = it.classify(some)
    for place, (file, line) in enumerate(calls.values()):
        assert answered.reasons[place].endswith(f" ({file}, line {line})"), answered.reasons[place]


def test_a_file_in_a_python_spec_imports_what_is_beside_it_and_finds_neither_sympy_nor_mpmath_nor_fcl_loaded(tmp_path):
    (tmp_path / "neighbour.py").write_text("ANSWER = 1\n")
    names = "{'sympy', 'mpmath', 'fcl', 'click', 'hypcheck.implementations.builtin'}"
    (tmp_path / "seen.py").write_text(
        "import sys\n\nfrom neighbour import ANSWER\n\n"
        f"hypcheck = {{'name': 'x', 'version': str({names} & set(sys.modules))}}\n\n\n"
        "def f(rows):\n    return [ANSWER] * len(rows)\n"
    )
    before = {"sympy", "mpmath", "fcl"} & set(sys.modules)
    with open_implementation(f"python:{tmp_path / 'seen.py'}:f", LIMITS) as it:
        assert it.declared.version == "set()"
        assert it.classify(rows()).answers.tolist() == [1] * 40
    assert {"sympy", "mpmath", "fcl"} & set(sys.modules) == before


def test_the_row_on_which_the_sample_functions_fail_is_among_the_rows():
    assert (rows()[:, 1] == 13.0).nonzero()[0].tolist() == [UNLUCKY]
