"""Steps of the nearest-point oracle that no row shows alone: how an enclosure is rounded, and where Newton starts."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import mpmath
import pytest

from hypcheck.geometry.pair import Lengths, Pair, to_integers
from hypcheck.truth.nearest import Dual
from tests.support.inside import Enclosure, ratio
from tests.support.inside import truth_nearest as nearest

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
def test_an_enclosure_is_rounded_to_a_float_only_if_both_ends_round_to_it_and_0_is_not_inside(low, high, bits, rounded):
    assert Enclosure(low, high, bits).rounded == rounded


@pytest.mark.parametrize(("odd", "even"), [(2**53 + 1, 2**53), (2**53 + 3, 2**53 + 4)])
def test_very_narrow_enclosure_around_a_rounding_tie_is_rounded_to_the_even_neighbour(odd, even):
    unit, bits = 1 << 400, 400
    assert Enclosure(odd * unit - 1, odd * unit + 1, bits).rounded == even
    assert Enclosure((odd << 190) - 1, (odd << 190) + 1, 190).rounded is None


def test_a_quotient_beyond_float64_is_infinite():
    assert ratio(3, 4) == 0.75
    assert ratio(10**400, 3) == math.inf
    assert ratio(-(10**400), 3) == -math.inf


APART = (4.0, 4.0, 1e-310, 1.0, 4.0, 0.1, 1e10)
"""The spheroid is a needle: A is 1e621, B is 16, and the centre is a little outside the evolute."""


def rows(count, decades, dice, numbers=7):
    return [tuple(10 ** dice.uniform(-decades, decades) for _ in range(numbers)) for _ in range(count)]


def duals():
    dice = random.Random(6)  # noqa: S311
    some = (APART, *rows(60, 1, dice), *rows(30, 100, dice), *rows(60, 1, dice, 10), *rows(10, 100, dice, 10))
    return [(row, Dual.of(Pair.from_row(row).lengths)) for row in some]


def test_the_start_value_has_the_right_ratio_of_distances_to_0_and_to_the_end_within_a_factor_of_two():
    """That ratio, share/(1 − share), is at most the one of the optimum, and twice it is at least that of the optimum.

    The signs of the slope, which are exact, show on which side of a place the optimum lies.
    """
    for row, dual in duals():
        side = dual.direction(0, 0)
        L, shift, at_end = nearest._start(dual, side, 96)
        assert not at_end, row
        end = side * dual.end(side, shift)
        share = Fraction(L, end)
        twice = 2 * share / (1 + share)  # twice/(1 − twice) is twice share/(1 − share)
        assert dual.direction(L, shift) == side, row
        assert dual.direction(round(end * (twice + Fraction(1, 2**12) * (1 - twice))), shift) == -side, row


def test_end_of_a_dual_is_the_last_multiple_of_the_step_within_the_interval_on_either_side():
    for row, dual in duals():
        for shift in (0, 7, 300):
            for side in (1, -1):
                end = dual.end(side, shift)
                assert dual.inside(side * end, shift), row
                assert not dual.inside(side * (end + 1), shift), row


def test_the_general_dual_of_an_upright_pair_has_the_values_and_slopes_of_the_upright_dual():
    """Value and slope at some places, from two formulas; the unit of the general one is another."""
    dice = random.Random(9)  # noqa: S311
    for row in rows(40, 1, dice):
        alpha, gamma, b, d, x, y, z = to_integers(row)
        one = Dual.of(Lengths.of(row))
        other = nearest._general(Lengths(alpha, b, x, y, gamma, d, z))
        for part in (-0.5, -1e-3, 1e-6, 0.75):
            at = Fraction(part) * Fraction(min(row[0] / row[2], row[1] / row[3])) ** 2
            for slopes in (False, True):
                found = [value_of(dual, at / dual.unit, slopes) / (dual.unit if slopes else 1) for dual in (one, other)]
                assert found[0] == found[1]


def value_of(dual, at, slope):
    def sums(f):
        return sum((part * at**power for power, part in enumerate(reversed(f))), Fraction(0))

    return sums(dual.slope) / sums(dual.under) ** 2 if slope else sums(dual.value) / sums(dual.under)


def test_clearance_is_that_of_the_maximum_of_the_dual_in_high_precision():
    """Against a maximum found by bisection on the sum λ Cᵀ D (M + λD)⁻¹ M C − λ, formed from the definitions."""
    for row, _ in duals()[91:97]:
        if max(row) < 100:
            assert math.isclose(nearest.nearest(Pair.from_row(row)).clearance, by_definition(row), rel_tol=1e-15), row


def by_definition(row):
    with mpmath.workprec(200):
        alpha, gamma, b, d, x, y, z, *axis = map(mpmath.mpf, row)
        v, C, D = mpmath.matrix(axis), mpmath.matrix([x, y, z]), mpmath.diag([alpha**-2, alpha**-2, -(gamma**-2)])
        M = mpmath.eye(3) / b**2 + (d**-2 - b**-2) * (v * v.T) / (v.T * v)[0]
        root = mpmath.cholesky(M)
        poles = mpmath.eigsy(root**-1 * D * root.T**-1, eigvals_only=True)
        low, high = -1 / max(poles), -1 / min(poles)

        def dual(at):
            return at * (C.T * D * mpmath.lu_solve(M + at * D, M * C))[0] - at

        for _ in range(110):
            middle, step = (low + high) / 2, (high - low) * mpmath.mpf(2) ** -60
            low, high = (middle, high) if dual(middle + step) > dual(middle) else (low, middle)
        return float(mpmath.sqrt(dual(low)) - 1)
