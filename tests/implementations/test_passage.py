"""Implementations of the question passage: rows of ways, and times of first contact, in every way of asking."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import SWEEPS, with_axis
from hypcheck.implementations.description import Description, described
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Outcome, StartError
from tests.support.inside import passage
from tests.tools.miniatures import LIMITS, NOT_ISOLATED, command, compiled, function, rows

SHARED = ("-shared", "-fPIC")


def ways(n: int = 24):
    """Ways of everyday, of spheroids that are smaller than the waist."""
    there = np.random.default_rng(5).uniform(-6.0, 6.0, (n, 3))
    return np.column_stack([rows(n, lucky=True), there])


def truth(some):
    """Hits and times of first contact."""
    found = [passage(row[:4], row[4:7], row[7:10]) for row in some.tolist()]
    return [int(each.hit) for each in found], [each.first_lower for each in found]


def crossing(some):
    """What the miniature in C answers."""
    start, end = some[:, 4] + (some[:, 10] if some.shape[1] == 13 else 0.0), some[:, 7]
    hits = (start * end <= 0).astype(int)
    return hits.tolist(), np.where(hits, start / (start - end), np.nan)


@pytest.mark.parametrize(
    "words",
    [
        pytest.param((), marks=pytest.mark.thorough),
        ("binary",),
        ("times",),
        pytest.param(("times", "binary"), marks=pytest.mark.thorough),
        ("times", "leaning", "binary"),
    ],
)
def test_a_command_answers_sweeps_in_text_and_binary_with_and_without_times(words):
    some = ways()
    hits, times = truth(some)
    assert 0 < sum(hits) < len(hits)
    with open_implementation(command("passage", *words), NOT_ISOLATED) as it:
        for answered in (it.classify(some), it.classify(some, batch=7)):
            assert answered.answers.tolist() == hits
            assert (answered.times is None) == ("times" not in words)
            if answered.times is not None:
                np.testing.assert_array_equal(answered.times, times)


def test_a_command_is_timed_on_sweeps():
    some = ways(8)
    with open_implementation(command("passage", "times", "binary"), NOT_ISOLATED) as it:
        assert it.time(some, 3) == 3000


def test_a_python_function_returns_hits_and_times_and_refuses_an_invalid_sweep():
    some = ways()
    hits, times = truth(some)
    bad = some.copy()
    bad[3, 8] = math.nan
    with open_implementation(function("passage"), NOT_ISOLATED) as it:
        answered = it.classify(some)
        refused = it.classify(bad)
        assert it.time(some[:3], 2) > 0
        assert it.time(some[:3], 1, row_by_row=True) > 0
    assert answered.answers.tolist() == hits
    np.testing.assert_array_equal(answered.times, times)
    assert np.flatnonzero(refused.answers == 127).tolist() == [3]


@pytest.mark.parametrize("flags", [(), pytest.param(("-DTIMES",), marks=pytest.mark.thorough), ("-DTIMES", "-DTILT")])
def test_a_library_for_sweeps_is_called_by_its_function_for_passage(flags, tmp_path):
    library = compiled("passage", tmp_path / "passage.so", *SHARED, *flags)
    some = ways(700)
    if "-DTILT" in flags:
        some = with_axis(some, SWEEPS)
        some[:, 10] = np.random.default_rng(3).uniform(-5.0, 5.0, len(some))
    hits, times = crossing(some)
    with open_implementation(f"library:{library}", LIMITS) as it:
        assert not it.scene
        answered = it.classify(some)
        assert it.time(some, 3) > 0
        assert it.time(some[:9], 2, row_by_row=True) > 0
    assert answered.answers.tolist() == hits
    if flags:
        np.testing.assert_array_equal(answered.times, times)
    else:
        assert answered.times is None


@pytest.mark.slow
def test_a_library_that_writes_one_time_too_many_breaks_the_protocol(tmp_path):
    library = compiled("passage", tmp_path / "beyond.so", *SHARED, "-DTIMES", "-DBEYOND")
    with open_implementation(f"library:{library}", LIMITS) as it:
        answered = it.classify(ways(2))
    assert answered.outcomes <= {Outcome.PROTOCOL, Outcome.CRASH}
    seen = "it wrote outside the 1 time that it was given", "by SIGSEGV; stderr: it reached behind the times"
    assert all(reason.endswith(seen) for reason in answered.reasons.values()), answered.reasons


def test_a_library_for_sweeps_without_the_function_for_passage_is_refused(tmp_path):
    library = compiled("passage", tmp_path / "lacks.so", *SHARED, "-DLACKS", "-DTILT")
    with pytest.raises(StartError) as caught:
        open_implementation(f"library:{library}", LIMITS)
    assert str(caught.value) == (
        f"library:{library} could not be started: '{library}' has no symbol hypcheck_passage_tilted; it must export "
        "void hypcheck_passage_tilted(size_t n, const double *rows13, int8_t *hits, double *times), in C++ as extern "
        '"C", since it describes itself with "question": "passage" and "tilt": true'
    )


@pytest.mark.parametrize("words", [("nan", "times"), ("nan", "times", "binary")])
def test_a_hit_without_a_time_from_0_to_1_breaks_the_protocol(words):
    some = ways()
    hits, _ = truth(some)
    with open_implementation(command("passage", *words), NOT_ISOLATED) as it:
        answered = it.classify(some)
    assert (~answered.answered).astype(int).tolist() == hits
    assert answered.reasons[hits.index(1)] == "it answered 1 with the time nan; it must be a number from 0 to 1"


def test_the_example_conversation_about_sweeps_on_the_protocol_page_is_right():
    text = (Path(__file__).parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")
    (said,) = re.findall(r"((?:^    [→←] .*\n)*)", text[text.index("    → classify 1 2 passage-text") :], re.MULTILINE)[
        :1
    ]
    lines = [line[6:] for line in said.splitlines()]
    ways = np.array([line.split() for line in lines[1:3]], dtype=np.float64)
    hits, times = truth(ways)
    assert lines[3:6] == ["1 2", f"1 {times[0]!r}", "0"]
    assert hits == [1, 0]
    bits = [np.uint64(int(word, 16)).view(np.float64) for word in re.findall("[0-9a-f]{16}", lines[7] + lines[9])]
    assert bits == [*ways[0], times[0]]


def test_an_implementation_for_sweeps_refuses_rows_of_another_width():
    with open_implementation(command("passage"), NOT_ISOLATED) as it:
        with pytest.raises(InputError, match=r"shape \(24, 7\); it must be \(n, 10\): alpha, .*, z1$"):
            it.classify(ways()[:, :7])
        with pytest.raises(InputError, match=r"shape \(24, 13\)"):
            it.classify(with_axis(ways(), SWEEPS))


def test_the_question_of_a_description_cannot_be_overridden_by_passage():
    with pytest.raises(InputError) as caught:
        open_implementation(command("right"), LIMITS, question="passage")
    assert str(caught.value) == (
        "the question is 'passage', but right.py describes itself as answering 'position', about other rows; its "
        'description must say "question": "passage"'
    )


def test_a_description_with_times_is_refused_unless_its_question_is_passage():
    assert described({"question": "passage", "times": True}, Description(name="x")).times
    with pytest.raises(
        InputError, match=r"times is true, but its question is 'contact'; times belong to the question passage$"
    ):
        described({"question": "contact", "times": True}, Description(name="x"))
