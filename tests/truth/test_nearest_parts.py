"""Steps of the nearest-point oracle that no row shows alone: how an enclosure is rounded, and where Newton starts."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import mpmath
import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.truth import nearest_exact
from hypcheck.truth.nearest_exact import Enclosure, SquaredLengths, dual, ratio

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


APART = (4.0, 4.0, 1e-310, 1.0, 4.0, 0.1, 1e10)
"""The spheroid is a needle: A is 1e621, B is 16, and the centre is a little outside the evolute."""


def rows(count, decades, dice):
    return [tuple(10 ** dice.uniform(-decades, decades) for _ in range(7)) for _ in range(count)]


def test_newton_start_lies_next_to_the_maximum_by_exact_evaluation():
    """Where the slope of the dual changes its sign, within a relative 2⁻⁴⁸ of the pole's distance on both sides."""
    dice = random.Random(6)  # noqa: S311
    for row in (APART, *rows(60, 1, dice), *rows(30, 100, dice)):
        squares = SquaredLengths.of(Pair.from_row(row))
        at_A, mantissa, exponent = nearest_exact.start(squares)
        pole = Fraction(mantissa) * Fraction(2) ** exponent
        slopes = []
        for factor in (1 - Fraction(1, 2**48), 1 + Fraction(1, 2**48)):
            length = pole * factor
            at = length - Fraction(squares.alpha, squares.b) if at_A else Fraction(squares.gamma, squares.d) - length
            slopes.append(dual(squares, at.numerator, at.denominator).slope)
        assert slopes[0] > 0 > slopes[1] if at_A else slopes[0] < 0 < slopes[1], row


@pytest.mark.parametrize("sizes", [(3, 5, 2, 7), (1, 1, 1, 1), (9, 2, 4, 5), (2, 10, 3, 1)])
@pytest.mark.parametrize("K", [1, 3, 10])
def test_a_multiplier_is_moved_to_the_nearest_one_strictly_between_the_poles(sizes, K):
    """Against a plain search among the multiples of 1/K."""
    alpha, gamma, b, d = sizes
    squares = nearest_exact.SquaredLengths(alpha=alpha, b=b, R=1, gamma=gamma, d=d, z=1)
    inside = [L for L in range(-200, 200) if -Fraction(alpha, b) < Fraction(L, K) < Fraction(gamma, d)]
    for L in range(-150, 150):
        assert nearest_exact._within(squares, L, K) == min(inside, key=lambda each: abs(each - L))


def test_first_tau_of_newton_is_never_below_the_root():
    """τ √(1 + (q/σ)²) ≥ p at it, for p, q and W far apart, equal and nearly equal."""
    dice = random.Random(7)  # noqa: S311
    with mpmath.workprec(1500):
        for _ in range(600):
            W, spread = mpmath.mpf(1), dice.choice([0.5, 3, 100])
            p = 1 + dice.choice([-1, 1]) * 10 ** mpmath.mpf(dice.uniform(-spread, 0)) * dice.choice([0, 1, 1])
            p = p if p > 0 and dice.random() < 0.6 else 10 ** mpmath.mpf(dice.uniform(-spread, spread))
            q = 10 ** mpmath.mpf(dice.uniform(-2 * spread, spread))
            tau, sigma = nearest_exact._above(p, q, W, p - W)
            assert 0 < tau <= W * (1 + mpmath.mpf(2) ** -60)
            assert sigma > 0
            assert tau * mpmath.sqrt(1 + (q / sigma) ** 2) >= p * (1 - mpmath.mpf(2) ** -100), (p, q)
            assert math.isfinite(tau)
