"""Judging: which answers are wrong, by how much, and which mistake they are."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Mistake, Status
from tests.support import inside
from tests.support.inside import flip_exponents
from tests.support.judging import ends_of, wrong_cases
from tests.support.pairs import ordinary_pairs

CLEAR = (2.0, 5.0, 1.0, 1.0, 4.0, 0.0, 0.0)  # r − a = 2
TOUCH = (2.0, 5.0, 1.0, 1.0, 3.0, 0.0, 0.0)  # r − a = 1
CROSS = (2.0, 5.0, 1.0, 1.0, 2.5, 0.0, 0.0)
INSIDE = (4.0, 5.0, 1.0, 1.0, 0.0, 0.0, 0.0)


def judged(row, answer, criterion=Criterion()):  # noqa: B008  frozen
    rows = np.array([row])
    return wrong_cases(rows, inside.positions(rows), np.array([answer], dtype=np.int8), criterion)


@pytest.mark.parametrize(
    ("row", "answer", "question", "mistake"),
    [
        (CLEAR, 0, "position", Mistake.FALSE_CONTACT),
        (CLEAR, -1, "position", Mistake.WRONG_SIDE),
        (CROSS, 1, "position", Mistake.FALSE_CLEAR),
        (INSIDE, 1, "position", Mistake.WRONG_SIDE),
        (CLEAR, 0, "exterior", Mistake.FALSE_CONTACT),
        (CROSS, 1, "exterior", Mistake.FALSE_CLEAR),
        (INSIDE, 1, "exterior", Mistake.WRONG_SIDE),
        (CROSS, 1, "interior", Mistake.FALSE_CLEAR),
        (INSIDE, 0, "interior", Mistake.FALSE_CONTACT),
        (CROSS, 0, "contact", Mistake.FALSE_CLEAR),
        (CLEAR, 1, "contact", Mistake.FALSE_CONTACT),
    ],
)
def test_judge_names_each_mistake_by_its_consequence(row, answer, question, mistake):
    (case,) = judged(row, answer, Criterion(question))
    assert case.mistake is mistake
    assert case.status is Status.WRONG


@pytest.mark.parametrize(
    ("row", "answer", "question"),
    [
        (CLEAR, 1, "position"),
        (CLEAR, 0, "interior"),
        (CROSS, 0, "exterior"),
        (TOUCH, 1, "contact"),
        (CROSS, 2, "position"),
    ],
)
def test_judge_does_not_call_right_answers_and_abstentions_wrong(row, answer, question):
    assert judged(row, answer, Criterion(question)) == []


def test_wrong_answer_at_a_tangency_is_tolerated_unless_the_tolerance_is_0():
    assert judged(TOUCH, 1)[0].status is Status.TOLERATED
    assert judged(TOUCH, 1, Criterion(tolerance=Fraction(0)))[0].status is Status.WRONG


@pytest.mark.parametrize(
    ("units", "status"), [(Fraction(799, 100), Status.WRONG), (Fraction(801, 100), Status.TOLERATED)]
)
def test_tolerance_is_applied_exactly_at_its_limit(units, status):
    """x = 3 (1 + δ) with δ = 8 u · (6/3): contact is right after a change of 8 u, since 3(1+δ)(1−ε) = 3(1+ε)."""
    row = (2.0, 5.0, 1.0, 1.0, 3.0 + 48 * 2.0**-53, 0.0, 0.0)
    assert judged(row, 0, Criterion(tolerance=units))[0].status is status


def test_backward_errors_are_given_in_units_of_the_declared_precision():
    row = (2.0, 5.0, 1.0, 1.0, 3.0 + 48 * 2.0**-53, 0.0, 0.0)
    (case,) = judged(row, 0)
    error = judge.measured(case, "position")
    assert judge.in_units(error, Criterion(precision="float64").unit) == pytest.approx(8, rel=1e-3)
    assert judge.in_units(error, Criterion(precision="float32").unit) == pytest.approx(8 * 2.0**-29, rel=1e-3)
    assert judge.in_units(error, Criterion(precision="exact").unit) == math.inf
    assert judged(row, 0, Criterion(precision="exact"))[0].status is Status.WRONG


@pytest.mark.parametrize("units", [256, 1000])
def test_tolerance_of_1_tolerates_all_errors_except_infinite_ones(units):
    """256 u of bfloat16 are a relative change of 1."""
    criterion = Criterion(precision="bfloat16", tolerance=Fraction(units))
    assert judged((2.0, 5.0, 1.0, 1.0, 90.0, 0.0, 0.0), -1, criterion)[0].status is Status.TOLERATED
    assert judged((4.0, 5.0, 1.0, 1.0, 0.0, 0.0, 9.0), 1, criterion)[0].status is Status.WRONG


def test_exterior_answer_on_the_axis_has_an_infinite_backward_error():
    (case,) = judged((4.0, 5.0, 1.0, 1.0, 0.0, 0.0, 9.0), 1)
    assert case.exponent == math.inf
    assert judge.measured(case, "position") == math.inf


@pytest.mark.parametrize("bad", [{"question": "where"}, {"precision": "float8"}, {"tolerance": Fraction(-1)}])
def test_judge_refuses_an_invalid_criterion(bad):
    with pytest.raises(InputError, match=r"must be"):
        Criterion(**bad)


@pytest.mark.thorough
@given(st.lists(ordinary_pairs, min_size=1, max_size=10), st.integers(0, 2**32))
def test_measured_error_of_a_wrong_case_lies_in_the_octave_of_its_exponent(some, seed):
    rows = np.array([pair.row for pair in some])
    answers = np.random.default_rng(seed).integers(-1, 2, len(rows)).astype(np.int8)
    for case in wrong_cases(rows, inside.positions(rows), answers, Criterion()):
        error = judge.measured(case, "position")
        assert case.truth != case.answer
        if math.isfinite(case.exponent):
            assert 2.0**case.exponent <= error <= 2.0 ** (case.exponent + 1)


def test_flip_exponents_are_those_of_the_distance_to_the_nearest_other_position():
    """CROSS: exterior after 1/11 (see test_backward_error), interior only later; TOUCH: 0."""
    assert flip_exponents(np.array([CROSS, TOUCH])).tolist() == [-4.0, -math.inf]
    assert Position.CONTACT not in judge.right_positions(Position.CONTACT, 0, "contact")


@pytest.mark.parametrize(
    ("answer", "question", "words"),
    [
        (1, "position", "exterior"),
        (0, "position", "contact"),
        (-1, "position", "interior"),
        (1, "contact", "contact: yes"),
        (0, "exterior", "exterior: no"),
        (7, "position", "7"),
        (-1, "interior", "-1"),
    ],
)
def test_in_words_names_answers_and_keeps_other_numbers(answer, question, words):
    assert judge.in_words(answer, question) == words


def test_the_distance_of_a_tilted_spheroid_to_the_other_answer_is_estimated_near_the_proved_one():
    leaning = (2.0, 3.0, 0.5, 0.25, 2.54, 0.0, 0.5, 0.0, 1.0, 1.0)
    proved = ends_of(leaning, 0)[1]
    assert 0 < proved < 0.01
    assert judge.about_error_of(leaning, 0, "position") == pytest.approx(proved, rel=0.05)
    assert flip_exponents(np.array([leaning])).tolist() == [math.floor(math.log2(proved))]


def test_the_distance_of_an_upright_spheroid_is_the_same_with_and_without_its_axis():
    upright = (2.0, 3.0, 0.5, 0.25, 3.0, 0.0, 0.5)
    assert judge.about_error_of((*upright, 0.0, 0.0, 1.0), 0, "position") == judge.about_error_of(
        upright, 0, "position"
    )
    with_axis = flip_exponents(np.array([(*upright, 0.0, 0.0, 1.0)]))
    assert with_axis.tolist() == flip_exponents(np.array([upright])).tolist()


def test_every_wrong_answer_about_tilted_rows_is_judged_even_if_float64_proves_only_some_wrong():
    row = [1.0, 4.0, 0.125, 0.25, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0]  # a needle across the x axis, at the waist
    near = [*row[:4], 1.125 + 1e-12, *row[5:]]
    rows = np.array([row, near, row, [*row[:7], 0.0, 0.0, 1.0]])
    truth = np.array([1, 1, 1, 1], dtype=np.int8)
    found = wrong_cases(rows, truth, np.zeros(4, dtype=np.int8), Criterion(tolerance=Fraction(10**4)))
    assert [case.index for case in found] == [0, 1, 2, 3]
    assert [case.status for case in found] == [Status.WRONG, Status.TOLERATED, Status.WRONG, Status.WRONG]
    assert [case.mistake for case in found] == [Mistake.FALSE_CONTACT] * 4
    assert found[0].least == found[2].least > 1e-3
    assert not found[1].least


def test_exponent_of_a_wrong_answer_about_a_tilted_spheroid_is_minus_infinity_only_at_a_tangency():
    needle = [1.0, 4.0, 0.125, 0.25, 1.125, 0.0, 0.0, 0.0, 1.0, 0.0]  # across the x axis, it touches the throat
    rows = np.array([needle, [*needle[:4], 1.25, *needle[5:]]])
    truth, answers = np.array([0, 1], dtype=np.int8), np.array([1, 0], dtype=np.int8)
    touching, clear = wrong_cases(rows, truth, answers, Criterion(tolerance=Fraction(0)))
    assert touching.exponent == -math.inf
    assert math.floor(clear.exponent) == math.floor(math.log2(1 / 19))  # contact where x (1 − ε) = (α + b)(1 + ε)


@pytest.mark.parametrize("units", [256, 300])
def test_a_tolerance_of_1_tolerates_an_error_that_rounds_up_to_1(units):
    """α = 1e-9 and x = 1: the spheroid has to shrink and the hyperboloid to move by nearly all of themselves."""
    criterion = Criterion(precision="bfloat16", tolerance=Fraction(units))
    assert judged((1e-9, 1.0, 1e-12, 1e-12, 1.0, 0.0, 0.0), -1, criterion)[0].status is Status.TOLERATED
