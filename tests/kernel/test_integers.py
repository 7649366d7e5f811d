"""The stages in integers against the exact decision of the truth, which shares no code with them."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.kernel import integers, numpy_kernel, tilted_integers
from hypcheck.truth import exact
from hypcheck.truth.tilted import exact as tilted_exact
from hypcheck.truth.tilted.pair import TiltedLengths, TiltedPair
from tests.kernel.test_tilted_integers import small_rows
from tests.truth.tilted.cases import SYMMETRIC, TOUCHING_AND_CROSSING, WITNESSES, in_floats


def test_integers_decide_upright_pairs_of_small_integers_exactly():
    """Tangencies of every kind, rings and double roots are among them."""
    kinds = set()
    for row in itertools.product(*[range(1, 5)] * 4, range(7), (0,), range(5)):
        lengths = Pair.from_row(tuple(map(float, row))).lengths
        decision = exact.decide(lengths)
        kinds.add(decision.kind)
        assert integers.position(lengths) is decision.position, row
    assert len(kinds) > 10


def test_integers_decide_upright_pairs_with_random_centres_exactly():
    draw = random.Random(3)  # noqa: S311
    for _ in range(1500):
        row = [draw.uniform(0.2, 5) for _ in range(4)] + [draw.uniform(-6, 6) for _ in range(3)]
        lengths = Pair.from_row(row).lengths
        assert integers.position(lengths) is exact.position(lengths), row


@pytest.mark.parametrize("part", [0, 1])
def test_tilted_integers_decide_leaning_pairs_of_small_integers_exactly(part):
    for row in small_rows(17 + part, 500):
        assert tilted_integers.position(row) is tilted_exact.position(TiltedLengths.of(row)), row


def test_tilted_integers_decide_symmetric_and_tangent_leaning_pairs_exactly():
    rows = [list(map(float, row)) for row, *_ in (*SYMMETRIC, *WITNESSES)]
    rows += [found for row in TOUCHING_AND_CROSSING if (found := in_floats(row)) is not None]
    for row in rows:
        if any(row[7:9]):
            assert tilted_integers.position(row) is tilted_exact.position(TiltedPair.from_row(row).lengths), row


def test_tilted_integers_decide_upright_rows_and_balls_as_upright_pairs():
    draw = random.Random(5)  # noqa: S311
    for _ in range(300):
        row = [float(draw.randint(1, 6)) for _ in range(4)] + [float(draw.randint(-9, 9)) for _ in range(3)]
        expected = exact.position(Pair.from_row(row).lengths)
        ball = [*row[:3], row[2], *row[4:]]
        assert tilted_integers.position([*row, 0.0, 0.0, -2.0]) is expected
        assert tilted_integers.position([*ball, 1.0, 0.0, 1.0]) is exact.position(Pair.from_row(ball).lengths)


def turned(vector):
    """A vector turned by a rational rotation about two axes."""
    x, y, z = map(Fraction, vector)
    x, y = (3 * x - 4 * y) / 5, (4 * x + 3 * y) / 5
    y, z = (5 * y - 12 * z) / 13, (12 * y + 5 * z) / 13
    return x, y, z


def test_tilted_integers_decide_two_leaning_bodies_as_the_pair_turned_upright():
    for row in small_rows(23, 250):
        expected = tilted_exact.position(TiltedLengths.of(row))
        centre, axis, other = turned(row[4:7]), turned(row[7:]), turned((0, 0, 3))
        whole = [[float(each * 65) for each in vector] for vector in (axis, other)]
        found = tilted_integers.squares_between_axes(row[:4], centre, *whole)
        assert not found.upright
        assert tilted_integers.position_of_squares(found) is expected, row


def test_squares_of_a_tilted_row_are_upright_for_parallel_axes_and_balls():
    row = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    for d, axis, upright in ((4.0, (0, 0, 2), True), (4.0, (1, 0, 2), False), (3.0, (1, 0, 2), True)):
        assert tilted_integers.squares([*row[:3], d, *row[4:], *map(float, axis)]).upright is upright


def test_leaning_is_true_for_rows_whose_axis_leans_except_balls():
    row = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    rows = [[*row, *axis] for axis in ((0, 0, 1), (1, 0, 0), (0, -1, 5), (1, 1, 1), (1, 0, 1))]
    rows.append([*row[:3], 3.0, *row[4:], 1.0, 0.0, 0.0])
    assert numpy_kernel.leaning(np.array(rows)).tolist() == [False, True, True, True, True, False]
