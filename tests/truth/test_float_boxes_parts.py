"""Parts of the float64 boxes: intervals, boxes and hints, each against the same numbers from fractions."""

from __future__ import annotations

import operator
import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth import float_boxes
from hypcheck.truth.box_proofs import Goal
from hypcheck.truth.float_boxes import Enclosures
from tests.support.inside import goal_of, position
from tests.truth.tilted_cases import random_rows

ROWS = [
    *random_rows(15, seed=3),
    [1, 2, 1.5, 0.5, 3, 1, 2, 0, 0, 1],  # upright
    [1, 2, 0.5, 1.5, 0.1, 0.2, 0.3, 0, 0, -2],
    [1, 2, 0.5, 1.5, 3, 1, 0, 1, 2, 0],  # level
    [1, 1, 0.9, 0.8, 0.2, 0.1, 0, 1, 0, 1],  # it leans as the asymptote does
    [3, 1, 0.5, 0.5, 4, 0, 1, 1, 1, 1],  # a ball
]


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul, operator.truediv])
def test_an_operation_on_enclosures_contains_the_exact_results_for_their_ends(operation):
    draw = random.Random(1)  # noqa: S311
    for _ in range(200):
        ends = [sorted(draw.choice((draw.uniform(-2, 2), draw.gauss(0, 1e-160), 0.0)) for _ in "ab") for _ in "ab"]
        with np.errstate(all="ignore"):
            found = operation(*(Enclosures(np.array([low]), np.array([high])) for low, high in ends))
        for one in map(Fraction, ends[0]):
            for other in map(Fraction, ends[1]):
                if operation is operator.truediv and ends[1][0] <= 0 <= ends[1][1]:
                    assert (found.low[0], found.high[0]) == (-np.inf, np.inf) or np.isnan(found.low[0])
                else:
                    assert Fraction(found.low[0]) <= operation(one, other) <= Fraction(found.high[0])


def test_enclosures_hold_squares_and_roots():
    with np.errstate(all="ignore"):
        around = Enclosures(np.array([-0.1]), np.array([0.3]))
        square = around**2
        root = (around + 1).root()
    assert square.low[0] == 0
    assert Fraction(square.high[0]) >= Fraction(0.3) ** 2
    assert Fraction(root.low[0]) ** 2 <= 1 + Fraction(-0.1)
    assert Fraction(root.high[0]) ** 2 >= 1 + Fraction(0.3)


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul, operator.truediv])
def test_an_enclosure_is_no_wider_than_its_exact_ends_and_a_few_roundings(operation):
    draw = random.Random(2)  # noqa: S311
    for _ in range(200):
        ends = [sorted(draw.uniform(0.5, 2) for _ in "ab") for _ in "ab"]
        ends = [[-high, -low] if draw.random() < 0.5 else [low, high] for low, high in ends]
        found = operation(*(Enclosures(np.array([low]), np.array([high])) for low, high in ends))
        exact_ends = [operation(Fraction(one), Fraction(other)) for one in ends[0] for other in ends[1]]
        room = 2.0**-50 * 4
        assert Fraction(found.low[0]) >= min(exact_ends) - Fraction(room)
        assert Fraction(found.high[0]) <= max(exact_ends) + Fraction(room)


def test_squares_and_roots_are_no_wider_than_their_exact_ends_and_a_few_roundings():
    for low, high in ((0.5, 2.0), (-2.0, -0.5), (-0.5, 2.0), (-2.0, 0.5)):
        square = Enclosures(np.array([low]), np.array([high])) ** 2
        least = 0.25 if low * high > 0 else 0.0
        assert (square.low[0], square.high[0]) == (pytest.approx(least, abs=1e-15), pytest.approx(4.0))
    root = Enclosures(np.array([0.25]), np.array([4.0])).root()
    assert (root.low[0], root.high[0]) == (pytest.approx(0.5), pytest.approx(2.0))


def test_enclosure_refuses_every_power_but_the_square():
    with pytest.raises(ValueError, match="only squares are needed"):
        Enclosures(np.array([1.0]), np.array([1.0])) ** 3


def enough_by_sizes(row, goal, truth):
    """A change of the sizes alone, at their best corner, that reaches the goal: by bisection of exact decisions."""
    low, high = Fraction(0), Fraction(1)
    for _ in range(30):
        middle = (low + high) / 2
        moved = [Fraction(a) * (1 + way * middle) for a, way in zip(row[:4], goal.sizes, strict=True)]
        there = position(Lengths.of([*moved, *map(Fraction, row[4:])]))
        reached = (there is not truth) if goal.leave else (there is goal.side)
        low, high = (low, middle) if reached else (middle, high)
    return high


@pytest.mark.parametrize("row", ROWS)
def test_lower_ends_are_between_a_fifth_of_a_sufficient_change_of_the_sizes_and_that_change(row):
    truth = position(Lengths.of(row))
    answers = [Position.CONTACT] if truth is not Position.CONTACT else [Position.EXTERIOR, Position.INTERIOR]
    for answer in answers:
        goal = goal_of(truth, answer)
        (low,) = float_boxes.lower_ends(np.array([row]), [goal])
        enough = enough_by_sizes(row, goal, truth)
        assert low <= enough
        if enough < Fraction(1, 5):  # farther away one certificate is not sharp, and more than sizes can change
            assert low > 0.2 * enough


def test_rows_that_float64_cannot_scale_exactly_have_no_lower_end():
    row = np.array([[1e300, 1e300, 1e-320, 2e-320, 2e300, 0.0, 0.0, 1.0, 0.0, 1.0]])
    assert float_boxes.lower_ends(row, [goal_of(Position.EXTERIOR, Position.CONTACT)]).tolist() == [0.0]


def test_the_two_halves_of_a_box_cover_the_box_and_share_its_middle():
    row = np.array([[1.0, 1.0, 0.5, 0.25, -1.1, 0.0, 1.7, 0.3, -0.6, 0.0]])
    whole = float_boxes._boxes(row, [Goal(Position.EXTERIOR, True)], np.array([0.125]))
    pull = np.array([[1.0], [100.0], [-3.0], [0.0], [0.0], [0.0]])  # z costs most: y has no width
    one, other = (float_boxes._halves(whole, pull)[np.array([k])] for k in (0, 1))
    assert one.high[2] == other.low[2] == whole.middle[2]
    assert (one.low.tolist(), other.high.tolist()) == (whole.low.tolist(), whole.high.tolist())
    rest = [0, 1, 3, 4, 5]
    assert (one.high[rest].tolist(), other.low[rest].tolist()) == (whole.high[rest].tolist(), whole.low[rest].tolist())


def test_no_change_within_a_lower_end_of_the_least_size_makes_the_answer_right():
    goal = Goal(Position.EXTERIOR, leave=False)
    rows = np.array([[1, 4, 0.125, 0.25, 1.125 - k * 2.0**-52, 0, 0, 0, 1, 0] for k in range(140, 240, 5)])
    ends = float_boxes.lower_ends(rows, [goal] * len(rows))
    found = ends > 0
    assert ends[found].min() == 2.0**float_boxes.LEAST
    assert float_boxes.excluded(rows[found], [goal] * int(found.sum()), ends[found]).all()
