"""Newton's start for the nearest point: on the right side of the root, and a few steps from it whatever the lengths."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.truth import nearest, nearest_exact
from hypcheck.truth.nearest_exact import SquaredLengths, dual

APART = (4.0, 4.0, 1e-310, 1.0, 4.0, 0.1, 1e10)
"""The spheroid is a needle: A is 1e621, B is 16, and the centre is a little outside the evolute."""


def rows(count, decades, dice):
    return [tuple(10 ** dice.uniform(-decades, decades) for _ in range(7)) for _ in range(count)]


def steps(squares, monkeypatch):
    """How many steps the iteration takes: each takes one square root, and two are taken before."""
    taken = []
    iterate = nearest_exact._iterate

    def counting(squares, ratio, sqrt):
        return iterate(squares, ratio, lambda value: (taken.append(value), sqrt(value))[1])

    with monkeypatch.context() as patch:
        patch.setattr(nearest_exact, "_iterate", counting)
        nearest_exact.start(squares)
    return len(taken) - 2


def test_newton_reaches_the_root_in_few_steps_for_any_ratio_of_lengths(monkeypatch):
    dice = random.Random(5)  # noqa: S311 - dice, not secrets
    asked = [APART, *rows(200, 1, dice), *rows(100, 6, dice), *rows(100, 100, dice), *rows(60, 300, dice)]
    assert steps(SquaredLengths.of(Pair.from_row(APART)), monkeypatch) <= 2
    assert max(steps(SquaredLengths.of(Pair.from_row(row)), monkeypatch) for row in asked) <= 8


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


@pytest.mark.slow
def test_the_first_tau_of_arrays_is_at_or_above_the_root_and_within_a_modest_factor():
    draw, count = np.random.default_rng(8), 150
    W = np.exp(draw.uniform(-3, 3, count))
    p = W * np.where(draw.random(count) < 0.5, np.exp(draw.uniform(-4, 4, count)), 1 + draw.normal(0, 1e-3, count))
    q = W * np.exp(draw.uniform(-12, 4, count))
    with np.errstate(all="ignore"):
        tau, sigma = nearest._start(p, q, W)
    for k in range(count):
        low, high = mpmath.mpf(0), mpmath.mpf(W[k])
        with mpmath.workprec(110):
            for _ in range(100):
                middle = (low + high) / 2
                too_low = middle * mpmath.sqrt(1 + (q[k] / (W[k] - middle)) ** 2) < p[k]
                low, high = (middle, high) if too_low else (low, middle)
        assert low * (1 - 1e-12) <= tau[k] <= 2 * high * (1 + 1e-12)
        assert sigma[k] > 0
        assert 1 / 8 < sigma[k] / (W[k] - high) < 1 + 1e-6 or tau[k] < W[k] / 2
