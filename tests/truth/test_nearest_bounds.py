"""The nearest-point oracle's bounds: they hold, they are needed, and no answer rests on an iteration."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import Pair
from hypcheck.truth import double_double, nearest_rows
from tests.support.inside import NearestStage, clearances, nearest
from tests.support.inside import truth_nearest as oracle
from tests.truth.nearest_reference import mismatches, mixed_rows, reference


def exactly(number):
    """The exact values of a double-double array, or of a float64 array."""
    parts = number if isinstance(number, tuple) else (number,)
    return np.array([sum(map(Fraction, values)) for values in zip(*(part.tolist() for part in parts), strict=True)])


def doubles(rng, count):
    """Double-doubles of many orders, with low parts from full to 0."""
    high = rng.choice((-1, 1), count) * 2.0 ** rng.uniform(-200, 200, count)
    low = np.abs(high) * 2.0**-53 * rng.uniform(-1, 1, count) * rng.choice((0.0, 2.0**-30, 1.0), count)
    return two_sum(high, low)


@pytest.mark.parametrize("seed", range(4))
def test_each_double_double_operation_is_within_its_bound(seed):
    rng = np.random.default_rng(seed)
    first, second = doubles(rng, 1000), doubles(rng, 1000)
    cancelling = two_sum(-first[0] * (1 + 2.0 ** -rng.integers(1, 52, 1000)), first[1] * rng.uniform(-1, 1, 1000))
    X, Y, N = exactly(first), exactly(second), exactly(cancelling)
    x, y, n = exactly(first[0]), exactly(second[0]), exactly(cancelling[0])
    for found, true, scale in (
        (double_double.add(first, second), X + Y, abs(X) + abs(Y)),
        (double_double.add(first, cancelling), X + N, abs(X) + abs(N)),
        (double_double.subtract(first, second), X - Y, abs(X) + abs(Y)),
        (double_double.add_float(first, second[0]), X + y, abs(X) + abs(y)),
        (double_double.add_float(first, cancelling[0]), X + n, abs(X) + abs(n)),
        (double_double.multiply(first, second), X * Y, abs(X * Y)),
        (double_double.square(first), X * X, X * X),
        (double_double.divide(first, second), X / Y, abs(X / Y)),
        (double_double.quotient_of_floats(first[0], second[0]), x / y, abs(x / y)),
    ):
        assert (abs(exactly(found) - true) <= Fraction(double_double.ERROR) * scale).all()
    root = exactly(double_double.square_root(double_double.where(first[0] > 0, first, (-first[0], -first[1]))))
    assert (
        abs(root * root - abs(X)) <= 2 * Fraction(double_double.ERROR) * abs(X)
    ).all()  # a root's error counts twice
    assert (exactly(two_sum(first[0], second[0])) == x + y).all()
    assert (exactly(double_double.two_product(first[0], second[0])) == x * y).all()
    assert (exactly(double_double.two_square(first[0])) == x * x).all()


@pytest.mark.parametrize("factor", [1.0, 1 - 1e-6, 1 + 1e-3, 0.5, 2.0, 1e-3])
def test_the_bound_of_the_float_stage_covers_its_error(factor):
    """At the λ that the solver finds, and at others, whose distance to the nearer pole is off by a factor."""
    rows = mixed_rows(800, seed=8, span=20)
    scaled = nearest_rows._scale(rows)
    with np.errstate(all="ignore"):
        tau, sigma = nearest_rows._solve(scaled)
        tau, sigma = np.where(tau < sigma, tau * factor, tau), np.where(tau < sigma, sigma, sigma * factor)
        dual = nearest_rows._evaluate(scaled, tau, sigma)
        squared = double_double.add_float(dual.value, dual.gap)
        clearance, error = nearest_rows._clearance(squared, dual.error + dual.gap_error)
    known = np.flatnonzero(scaled.inside & np.isfinite(error))
    assert len(known) > (30 if abs(factor - 1) > 0.1 else 500)
    truths = [reference(row)[0] for row in rows[known].tolist()]
    columns = (clearance[0][known].tolist(), clearance[1][known].tolist(), error[known].tolist(), truths)
    with mp.workprec(400):
        used = [abs(mpf(high) + low - truth) / bound for high, low, bound, truth in zip(*columns, strict=True)]
    assert max(used) <= 1
    assert max(used) > 1e-4  # nor is the bound so wide that it says nothing


@pytest.mark.parametrize("factor", [1.0, 0.5, 2.0**-20])
def test_the_bound_of_the_dual_is_at_least_what_its_derivation_says(factor):
    """64η(|λ|(u + C)(near + far) + |λ|T + (u + C)|F|), in rationals from the row and the u that was chosen."""
    rows = mixed_rows(300, seed=21, span=20)
    scaled = nearest_rows._scale(rows)
    with np.errstate(all="ignore"):
        tau, sigma = nearest_rows._solve(scaled)
        tau, sigma = np.where(tau <= sigma, tau * factor, tau), np.where(tau <= sigma, sigma, sigma * factor)
        error = nearest_rows._evaluate(scaled, tau, sigma).error
    eta, seen = Fraction(double_double.ERROR), 0
    for row, near_A, near_B, bound in zip(rows.tolist(), tau.tolist(), sigma.tolist(), error.tolist(), strict=True):
        alpha, gamma, b, d, x, y, z = map(Fraction, row)
        A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2
        u = Fraction(min(near_A, near_B))
        if not 0 < u < (A + B) / 4 or not math.isfinite(bound):
            continue
        seen += 1
        C = A if near_A <= near_B else B
        at = u - A if near_A <= near_B else B - u
        down, up = P / (A + at) ** 2, Q / (B - at) ** 2
        F, T = A * down - B * up - 1, A * down + B * up + 1
        inexact = 100 * eta  # λ, F and their terms are themselves known so well
        size, slope = max(abs(at) - inexact * (u + C), 0), max(abs(F) - inexact * T, 0)
        derived = 64 * eta * (size * (u + C) * (down + up) + size * T + (u + C) * slope)
        assert Fraction(bound) >= derived * (1 - Fraction(1, 2**40))
    assert seen > 200


def test_float_stage_is_not_certain_of_a_position_if_the_multiplier_is_beyond_the_poles():
    """The dual is no bound there; a solver that strays must not be believed."""
    scaled = nearest_rows._scale(mixed_rows(300, seed=13))
    with np.errstate(all="ignore"):
        tau, sigma = nearest_rows._solve(scaled)
        for strayed in ((-tau, sigma), (tau, -sigma), (np.full_like(tau, np.nan), sigma)):
            decided = nearest_rows._judge(scaled.inside, nearest_rows._evaluate(scaled, *strayed))
            assert not (decided.position_certain & (tau > 0) & (sigma > 0)).any()


def test_float_stage_takes_the_interval_end_as_the_maximum_only_where_that_is_certain():
    """In the waist plane, at and about a r = A + B, where float64 cannot tell on which side of it a centre is."""
    rng = np.random.default_rng(10)
    a, c = 2.0 ** rng.uniform(-3, 3, (2, 500))
    r = (a + c * c / a) * (1 + rng.integers(-4, 5, 500) * 2.0**-53)
    rows = np.stack((a, c, *np.ones((2, 500)), r, *np.zeros((2, 500))), axis=1)
    exact = [[Fraction(value) for value in row] for row in rows.tolist()]
    beyond = np.array([row[0] * row[4] >= row[0] ** 2 + row[1] ** 2 for row in exact])
    scaled = nearest_rows._scale(rows)
    with np.errstate(all="ignore"):
        tau, sigma = nearest_rows._solve(scaled)
        sure = nearest_rows._evaluate(scaled, tau, sigma).gap_error == 0
    ended = sigma == 0
    assert (ended & ~beyond).any()
    assert not (ended & ~beyond & sure).any()
    assert (ended & beyond & sure).any()
    assert mismatches(clearances(rows), rows) == 0


def test_clearances_are_right_even_if_newton_starts_badly_and_takes_short_steps(monkeypatch):
    """Short steps leave an error far above what the last of them suggests: the signs of D′ have to notice."""
    rows = mixed_rows(30, seed=12)
    full = [nearest(Pair.from_row(row)) for row in rows.tolist()]
    newton, start = oracle._newton, oracle._start

    def poor_start(*asked):
        L, shift, at_end = start(*asked)
        return L * 7 // 8, shift, at_end

    def short(dual, L, shift, bits):
        reached, _ = newton(dual, L, shift, bits)
        return reached - (reached - L) // 4**8, 4  # as eight steps do that are three quarters of what they should be

    monkeypatch.setattr(oracle, "_newton", short)
    monkeypatch.setattr(oracle, "_start", poor_start)
    for row, expected in zip(rows.tolist(), full, strict=True):
        found = nearest(Pair.from_row(row))
        assert found.clearance == expected.clearance
        assert found.position is expected.position


@pytest.mark.parametrize("column", [0, 1, 4, 5, 6])
@pytest.mark.parametrize("order", [-61, 61])
def test_rows_beyond_the_limits_of_the_float_bounds_are_computed_with_exact_enclosures(column, order):
    row = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0]
    row[4 if column == 6 else column] = 1.0
    row[column] = 2.0**order
    found = clearances(np.array([row]))
    assert found.stage[0] != NearestStage.DOUBLE_DOUBLE
    assert mismatches(found, np.array([row])) == 0


def test_reference_clearance_of_the_tests_is_accurate_beyond_float64():
    """Against a derivative it does not use: for a = 1, c = 2, r = 5/2 the clearance falls by Q/5 as Q = z² leaves 0."""
    with mp.workprec(400):
        clearance, rho, zeta = reference((1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 2.0**-100))
        assert abs(rho**2 - zeta**2 / 4 - 1) < mpf(10) ** -100
        assert abs((clearance - 0.5) * 2**200 + mpf(1) / 5) < mpf(10) ** -50


def test_the_gap_of_the_dual_is_within_its_error_bound_where_only_roundings_matter():
    """With the poles far away the gap is F²/(2|F′|), which float64 rounds."""
    rng = np.random.default_rng(22)
    slope, curvature = 2.0 ** rng.uniform(-60, 5, (2, 500))
    found, error = nearest_rows._gap(slope, np.zeros(500), curvature, np.full(500, 2.0**300))
    exact = [Fraction(each) ** 2 / (2 * Fraction(bend)) for each, bend in zip(slope, curvature, strict=True)]
    assert (np.abs(exactly(found) - exact) <= exactly(error)).all()
    assert (exactly(found) != exact).any()
    assert (error <= 2.0**-40 * found).all()


@pytest.mark.parametrize("order", [-40, -3, 3, 60])
def test_the_clearance_computed_from_an_exact_squared_distance_is_within_its_error_bound(order):
    rng = np.random.default_rng(23)
    high = 2.0**order * rng.uniform(1, 4, 300)
    squared = two_sum(high, high * 2.0**-53 * rng.uniform(-1, 1, 300))
    (first, second), error = nearest_rows._clearance(squared, np.zeros(300))
    with mp.workprec(400):
        for s, low, one, two, bound in zip(*squared, first, second, error, strict=True):
            assert abs(mpf(one) + mpf(two) - (mp.sqrt(mpf(s) + mpf(low)) - 1)) <= bound
    assert (error < 2.0**-95 * (1 + np.sqrt(high))).all()
