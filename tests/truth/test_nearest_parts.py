"""Parts of the nearest-point oracle: the float64 of an enclosure, and roots in units of a power of two."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from hypcheck.truth import nearest_exact
from hypcheck.truth.nearest_exact import Enclosure, ratio

LEAST = math.ulp(0.0)


@pytest.mark.parametrize(
    ("low", "high", "bits", "rounded"),
    [
        (0, 0, 10, None),
        (0, 1, 2000, None),
        (-1, 0, 2000, None),
        (-1, 1, 2000, None),
        (1, 2, 3000, LEAST),
        (-2, -1, 3000, -LEAST),
        (3 << 98, (3 << 98) + 1, 100, 0.75),
        (-(3 << 98), -(3 << 98) + 1, 100, -0.75),
        (1 << 100, (1 << 100) + (1 << 60), 100, None),
        (1 << 1100, (1 << 1100) + 1, 10, math.inf),
        (-(1 << 1100), 1 - (1 << 1100), 10, -math.inf),
    ],
)
def test_an_enclosure_has_a_float_where_both_ends_round_to_it_and_0_is_not_inside(low, high, bits, rounded):
    assert Enclosure(low, high, bits).rounded == rounded


@pytest.mark.parametrize(("odd", "even"), [(2**53 + 1, 2**53), (2**53 + 3, 2**53 + 4)])
def test_very_narrow_enclosure_of_a_rounding_tie_is_rounded_as_the_tie(odd, even):
    unit, bits = 1 << 400, 400
    assert Enclosure(odd * unit - 1, odd * unit + 1, bits).rounded == even
    assert Enclosure((odd << 190) - 1, (odd << 190) + 1, 190).rounded is None


def test_a_quotient_beyond_float64_is_infinite():
    assert ratio(3, 4) == 0.75
    assert ratio(10**400, 3) == math.inf
    assert ratio(-(10**400), 3) == -math.inf


@pytest.mark.parametrize(("numerator", "denominator"), [(2, 1), (9, 4), (1, 10**40), (10**40, 3), (7, 7 * 10**9)])
def test_clearance_of_a_known_squared_distance_is_its_rounded_root_minus_1(numerator, denominator):
    found = nearest_exact._clearance_of_square(numerator, denominator)
    exact = Fraction(numerator, denominator)
    for share, larger in ((Fraction(1, 2**53), True), (-Fraction(1, 2**53), False)):
        beside = Fraction(found) * (1 + share * (1 if found > 0 else -1)) + 1
        assert (beside**2 >= exact) if larger else (beside < 0 or beside**2 <= exact)
    assert nearest_exact._clearance_of_square(5, 5) == 0


@pytest.mark.parametrize("sizes", [(3, 5, 2, 7), (1, 1, 1, 1), (9, 2, 4, 5), (2, 10, 3, 1)])
@pytest.mark.parametrize("K", [1, 3, 10])
def test_a_multiplier_is_moved_to_the_nearest_one_strictly_between_the_poles(sizes, K):
    """Against a plain search among the multiples of 1/K."""
    alpha, gamma, b, d = sizes
    squares = nearest_exact.SquaredLengths(alpha=alpha, b=b, R=1, gamma=gamma, d=d, z=1)
    inside = [L for L in range(-200, 200) if -Fraction(alpha, b) < Fraction(L, K) < Fraction(gamma, d)]
    for L in range(-150, 150):
        assert nearest_exact._within(squares, L, K) == min(inside, key=lambda each: abs(each - L))
