"""Judging of answers about ways: wrong implementations are rejected for what they do, right ones pass."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.implementations.session import Answered
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Mistake, Status
from hypcheck.runs.score import score
from hypcheck.truth.passage_error import hits, radii_off, sweep_in_radii
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.support.inside import passage_of
from tests.tools.mutants import passages
from tests.tools.mutants.collection import public_functions
from tests.tools.mutants.expectation import expectation_of

CRITERION = Criterion("passage")
ALL = list(public_functions(passages).values())
RIGHT, WRONG = ([each for each in ALL if expectation_of(each).right is right] for right in (True, False))
BEYOND_TOLERANCE_0 = [each for each in WRONG if expectation_of(each).asked]
"""Wrong only where the surface is touched for an instant, which a spheroid that is a little smaller does not."""

BODY = (1.0, 2.0, 1.0, 1.0)
"""A ball that touches the waist from outside where its centre is 2 from the axis; its ring has the radius 2.5."""

BY_HAND = {
    "touches at the start alone": ((2.0, 0.0, 0.0), (5.0, 0.0, 0.0), 0.0),
    "touches at the end alone": ((5.0, 0.0, 0.0), (2.0, 0.0, 0.0), 1.0),
    "grazes in the middle": ((2.0, -3.0, 0.0), (2.0, 3.0, 0.0), 0.5),
    "passes just outside": ((2.0 + 2.0**-40, -3.0, 0.0), (2.0 + 2.0**-40, 3.0, 0.0), None),
    "crosses the ring": ((4.0, 0.0, 0.0), (2.25, 0.0, 0.0), None),
    "stays in contact": ((1.5, 0.0, 0.0), (1.5, 0.0, 0.0), 0.0),
    "stays clear": ((3.0, 0.0, 0.0), (3.0, 0.0, 0.0), None),
    "runs into the waist": ((4.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.5),
    "goes through and out again": ((6.0, 0.0, 0.0), (-10.0, 0.0, 0.0), 0.25),
}
"""Ways of BODY: start, end, and the first contact, worked out by hand."""


def by_hand():
    return np.array([[*BODY, *start, *end] for start, end, _ in BY_HAND.values()])


@pytest.fixture(scope="module")
def rows():
    """Ways by hand and of the families, and ways within a hyperboloid."""
    made = [family.rows(1, 4) for family in SWEEP_FAMILIES.values() if "axis" not in family.groups]
    made += [SWEEP_FAMILIES[name].rows(1, 24) for name in ("way-anywhere", "way-tunnelling")]
    inside = [[2.0, 17.8, 0.25, 0.15, *ends] for ends in ((0.0, 0.0, -9.0, 0.0, 0.0, 9.0), (0.5, 0, 1, 0.5, 1, 1))]
    return np.concatenate([by_hand(), inside, *made])


def judged(rows, answer, criterion=CRITERION):
    given, times = answer(rows)
    scored = score(rows, hits(rows), Answered.of(np.asarray(given, dtype=np.int8), times), criterion)
    return list(scored.judged())


@pytest.mark.parametrize("name", BY_HAND)
def test_first_contact_of_sweeps_worked_out_by_hand_is_known(name):
    start, end, first = BY_HAND[name]
    found = passage_of((*BODY, *start, *end))
    assert found.hit == (first is not None)
    if first is not None:
        assert found.first_lower <= first <= found.first_upper <= found.first_lower + 2.0**-52


@pytest.mark.parametrize(
    "answer", [*WRONG[:6], *(pytest.param(each, marks=pytest.mark.thorough) for each in WRONG[6:])]
)
def test_wrong_implementation_of_sweeps_is_rejected(answer, rows):
    tolerance = Fraction(0 if answer in BEYOND_TOLERANCE_0 else 8)
    cases = judged(rows, answer, Criterion("passage", tolerance=tolerance))
    assert any(case.status is Status.WRONG for case in cases)


@pytest.mark.parametrize("answer", BEYOND_TOLERANCE_0, ids=lambda each: each.__name__)
def test_answer_clear_for_a_sweep_that_only_touches_the_surface_is_tolerated(answer, rows):
    cases = judged(rows, answer)
    assert cases
    assert {case.status for case in cases} == {Status.TOLERATED}


@pytest.mark.parametrize("answer", RIGHT, ids=lambda each: each.__name__)
def test_right_implementation_of_sweeps_passes_without_any_tolerance(answer, rows):
    assert judged(rows, answer, Criterion("passage", tolerance=Fraction(0))) == []


def test_there_are_at_least_20_wrong_and_3_right_test_implementations_of_sweeps():
    assert len(WRONG) >= 20
    assert len(RIGHT) == 3


@pytest.mark.parametrize(
    ("name", "hit", "time", "mistake", "status"),
    [
        ("runs into the waist", 0, math.nan, Mistake.FALSE_CLEAR, Status.WRONG),
        ("grazes in the middle", 0, math.nan, Mistake.FALSE_CLEAR, Status.TOLERATED),
        ("passes just outside", 1, 0.5, Mistake.FALSE_CONTACT, Status.WRONG),
        ("stays clear", 1, 0.0, Mistake.FALSE_CONTACT, Status.WRONG),
        ("runs into the waist", 1, 0.501, Mistake.LATE, Status.WRONG),
        ("runs into the waist", 1, 0.499, Mistake.EARLY, Status.WRONG),
    ],
)
def test_answers_about_sweeps_get_the_expected_mistake_and_status(name, hit, time, mistake, status):
    start, end, _ = BY_HAND[name]
    (case,) = judged(np.array([[*BODY, *start, *end]]), lambda _: ([hit], np.array([time])))
    assert (case.mistake, case.status) == (mistake, status)


def test_judge_accepts_any_time_of_a_graze_at_which_a_spheroid_larger_by_the_tolerance_touches():
    start, end, _ = BY_HAND["grazes in the middle"]
    rows = np.array([[*BODY, *start, *end]])
    near, far = 0.5 + 2.0**-27, 0.5 + 1e-3
    assert judged(rows, lambda _: ([1], np.array([0.5 - 2.0**-27]))) == []
    assert judged(rows, lambda _: ([1], np.array([near]))) == []
    (case,) = judged(rows, lambda _: ([1], np.array([0.5 - 1e-3])))
    assert case.mistake is Mistake.EARLY
    assert judged(rows, lambda _: ([1], np.array([far]))) == []  # shrunk, it never touches: no time is too late
    exact = Criterion("passage", tolerance=Fraction(0))
    assert [case.mistake for case in judged(rows, lambda _: ([1], np.array([near])), exact)] == [Mistake.LATE]


def test_size_error_of_a_wrong_answer_is_measured_and_a_wrong_time_in_radii_of_the_sweep():
    start, end, _ = BY_HAND["stays clear"]
    (case,) = judged(np.array([[*BODY, *start, *end]]), lambda _: ([1], np.array([0.0])))
    assert judge.measured(case, "passage") == math.inf  # from 3 to 1 it must be twice as large
    start, end, _ = BY_HAND["passes just outside"]
    (case,) = judged(np.array([[*BODY, *start, *end]]), lambda _: ([1], np.array([0.5])))
    assert judge.measured(case, "passage") == pytest.approx(2.0**-40, rel=0.02)
    assert case.exponent == pytest.approx(-40, abs=0.5)
    row = (*BODY, *BY_HAND["runs into the waist"][0], *BY_HAND["runs into the waist"][1])
    assert radii_off(row, 0.75) == pytest.approx(1.0)  # a quarter of a way of 4 radii
    assert radii_off(row, 0.25) == pytest.approx(1.0)


def test_sweep_of_a_tilted_spheroid_is_measured_along_its_own_axis():
    sizes, start, end = (1.0, 2.0, 0.5, 0.25), (0.0, 0.0, 0.0), (3.0, 0.0, 0.0)
    assert sweep_in_radii((*sizes, *start, *end)) == 6.0
    assert sweep_in_radii((*sizes, *start, *end, 0.0, 0.0, 1e300)) == 6.0
    assert sweep_in_radii((*sizes, *start, *end, -1e-300, 0.0, 0.0)) == 12.0
    assert sweep_in_radii((*sizes, *start, *end, 1.0, 1.0, 0.0)) == pytest.approx(3 * math.hypot(4, 2) / 2**0.5)


def test_answer_cannot_say_about_a_sweep_is_not_wrong(rows):
    assert judged(rows, lambda some: (np.full(len(some), 2), np.full(len(some), np.nan))) == []


@pytest.mark.parametrize(
    ("start", "end", "time", "mistake", "exponent"),
    [
        ((4.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.25 - 2.0**-20, Mistake.EARLY, 0),  # a quarter of four radii
        ((4.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.75 - 2.0**-20, Mistake.LATE, -1),
        ((4.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.5 - 2.0**-12 - 2.0**-20, Mistake.EARLY, -10),
        ((2.0, -1e308, 0.0), (2.0, 0.0, 0.0), 0.25, Mistake.EARLY, 1022),
        ((1.5, 0.0, 0.0), (1.5, 5e-324, 0.0), 0.25, Mistake.LATE, -math.inf),
        ((2.0, -1e308, 0.0), (2.0, 1e308, 0.0), 0.25, Mistake.EARLY, math.inf),
    ],
)
def test_exponent_of_a_wrong_time_is_that_of_its_error_in_spheroid_radii(start, end, time, mistake, exponent):
    row, exactly = np.array([[*BODY, *start, *end]]), Criterion("passage", tolerance=Fraction(0))
    (case,) = judge.judged(row, np.array([1], np.int8), np.array([0]), exactly, np.array([time]))
    assert (case.mistake, case.exponent, case.time) == (mistake, exponent, time)
