"""Lines for bodies of one size prove nothing wrong, above all next to the border, and prove most positions."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair
from tests.support.inside import filtered, float_filter, lines_for_sizes, position, positions

TOWER = (2.0, 17.8, 0.25, 0.15)
ULPS = np.arange(-40, 41)
sizes = st.tuples(*[st.floats(2.0**-12, 2.0**12)] * 4)


def rows_of(some, x, z):
    x, z = np.broadcast_arrays(x, z)
    rows = np.zeros((x.size, 7))
    rows[:, :4], rows[:, 4], rows[:, 6] = some, x.ravel(), z.ravel()
    return rows


def beside_lines(some, height):
    """Centres within 40 ulps of where each line crosses a height; each is on the line at about the middle."""
    found = lines_for_sizes(*some, math.frexp(height / some[1])[1])
    crossings = [constant + slope * height * height for constant, slope in (*found.exterior, *found.interior)]
    x = [math.sqrt(crossing) + ULPS * math.ulp(math.sqrt(crossing)) for crossing in crossings]
    return rows_of(some, np.concatenate([*x, [some[0]]]), height)


def assert_right(rows):
    proved = filtered(rows)
    expected = np.array([position(Pair.from_row(row).lengths) for row in rows.tolist()])
    decided = proved != float_filter.UNDECIDED
    assert (proved[decided] == expected[decided]).all()
    return decided


@pytest.mark.slow
@given(sizes, st.floats(0, 4))
def test_lines_prove_no_wrong_position_for_centres_beside_a_line(some, share):
    assert_right(beside_lines(some, share * some[1]))


@given(sizes, st.integers(-60, -1), st.floats(0, 2))
def test_lines_prove_no_wrong_position_for_centres_near_the_waist(some, exponent, share):
    """r = α ± b, moved by a little: tangencies wherever the throat and the groove are wide enough."""
    alpha, gamma, b, _ = some
    x = np.array([alpha + b, abs(alpha - b)])[:, None] * (1 + np.array([-1, 0, 1]) * 2.0**exponent)
    assert_right(rows_of(some, x, np.array([0.0, share * gamma * 2.0**exponent])[:, None, None]))


@given(sizes, st.integers(-2, 5))
def test_constants_of_a_line_are_rounded_to_its_safe_side(some, reach):
    """By more than the rounding of both sides of a comparison can come to, which is 12 of these units."""
    alpha, gamma, b, d = map(Fraction, some)
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    found = lines_for_sizes(*some, reach)
    for sign, kept in ((1, found.exterior), (-1, found.interior)):
        for constant, slope in kept:
            # M tells λ: (A ± λ)/(B ∓ λ) = M d²/b², and the exact line of that λ has the K that is compared.
            ratio = Fraction(slope) * d**2 / b**2
            multiplier = sign * (ratio * B - A) / (1 + ratio)
            moved = 1 + sign * Fraction(12, 2**53)
            assert sign * Fraction(constant) >= sign * moved * b**2 * (A + sign * multiplier) * (1 + sign / multiplier)


@pytest.mark.slow
@given(sizes, st.floats(-4, 4), st.sampled_from([-1, 1]))
def test_lines_prove_no_wrong_position_beside_the_rim_of_the_level_disc(some, share, side):
    """Centres b off the surface, level, by some ulps more or less."""
    alpha, gamma, b, _ = some
    z = share * gamma
    x = abs(math.hypot(alpha, alpha / gamma * z) + side * b)
    assert_right(rows_of(some, x + ULPS * math.ulp(x), z))


def test_lines_decide_most_positions_in_a_tower():
    rng = np.random.default_rng(3)
    rows = np.column_stack([np.tile(TOWER, (4000, 1)), rng.uniform(-4, 4, (4000, 2)), rng.uniform(-17.8, 17.8, 4000)])
    proved = float_filter._by_lines(np.ascontiguousarray(rows.T))
    truth = positions(rows)
    assert (proved == truth).mean() > 0.99


@given(st.tuples(*[st.floats(2.0**-100, 2.0**100)] * 4), st.integers(-2, 20))
def test_constants_of_lines_lie_between_2_to_the_minus_600_and_2_to_the_600(some, reach):
    found = lines_for_sizes(*some, reach)
    numbers = [number for line in (*found.exterior, *found.interior) for number in line]
    assert all(2.0**-600 < number < 2.0**600 for number in numbers)
