"""Steps of hypcheck.clearance in the numpy kernel: what is rounded, scaled and halved on the way to an interval."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.geometry.pair import Pair
from hypcheck.kernel import choice, clearance
from hypcheck.kernel import clearance_points as points
from hypcheck.truth import nearest
from hypcheck.truth.nearest_exact import nearest as nearest_of
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES

UPRIGHT = ("uniform", "tangent", "ring", "near-axis", "extreme-subnormal", "extreme-magnitude", "on-surface", "waist")


@pytest.fixture
def numpy_kernel(monkeypatch):
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.choice.cache_clear()
    yield
    choice.choice.cache_clear()


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([FAMILIES[name].rows(3, 10) for name in UPRIGHT])


def test_clearance_in_the_numpy_kernel_encloses_the_exact_clearances_touches_and_distances(rows, numpy_kernel):
    found, true = hypcheck.clearance(rows), nearest.clearances(rows)
    assert (found.position == true.position).all()
    assert ((found.lower <= true.clearance) & (true.clearance <= found.upper)).all()
    assert (found.upper - found.lower <= 2.0**-29 * np.maximum(1, 1 + found.lower)).all()
    assert (found.lower >= -1).all()
    assert (found.lower[found.position != 0] >= 0).all()
    assert (found.upper[found.position == 0] <= 0).all()
    assert (found.distance_lower <= found.distance_upper).all()
    assert (found.distance_upper[found.position == 0] == 0).all()
    for k, row in enumerate(rows.tolist()):
        exact = nearest_of(Pair.from_row(row))
        if np.isfinite(found.touch_error[k]) and not exact.circle:
            off = min(np.linalg.norm(np.array(point) - found.touch[k]) for point in exact.points)
            assert off <= found.touch_error[k]


def test_clearance_in_the_numpy_kernel_gives_narrow_distance_intervals_for_ordinary_rows(numpy_kernel):
    rows = FAMILIES["uniform"].rows(4, 60)
    found = hypcheck.clearance(rows)
    clear = found.position != 0
    width = found.distance_upper - found.distance_lower
    assert clear.sum() > 20
    assert (width[clear] <= 1e-8 * (found.distance_upper[clear] + rows[clear, 2:4].max(axis=1))).all()


@pytest.mark.parametrize("exponent", [990, -960, 700, -700])
@pytest.mark.parametrize("tilted", [False, True])
def test_rows_in_another_unit_have_the_same_clearance_and_scaled_distances(exponent, tilted, numpy_kernel):
    rows = (TILTED_FAMILIES["tilted-uniform"] if tilted else FAMILIES["uniform"]).rows(5, 6)
    scaled = rows.copy()
    scaled[:, :7] = np.ldexp(rows[:, :7], exponent)
    here, there = hypcheck.clearance(rows), hypcheck.clearance(scaled)
    assert (here.position == there.position).all()
    assert (np.maximum(here.lower, there.lower) <= np.minimum(here.upper, there.upper)).all()
    lower, upper = (np.ldexp(each, -exponent) for each in (there.distance_lower, there.distance_upper))
    assert (np.maximum(here.distance_lower, lower) <= np.minimum(here.distance_upper, upper)).all()
    assert (upper - lower <= 2 * (here.distance_upper - here.distance_lower) + 1e-8 * rows[:, 2:4].max(axis=1)).all()
    assert np.ldexp(there.touch, -exponent) == pytest.approx(here.touch, rel=1e-9)


def test_subtracting_1_from_a_factor_is_exact_from_half_to_2_and_else_rounded_as_asked():
    factors = np.array([0.0, 1e-30, 0.3, 0.5, 0.75, 1.0, 1 + 2.0**-52, 1.9, 2.0, 2.1, 1e9, 1e30])
    for towards, side in ((-np.inf, -1), (np.inf, 1)):
        found = clearance._less_one(factors, towards)
        for factor, less in zip(factors.tolist(), found.tolist(), strict=True):
            off = (Fraction(less) - (Fraction(factor) - 1)) * side
            assert 0 <= off <= 2 * Fraction(math.ulp(less))
            assert not off or not 0.5 <= factor <= 2


def test_enlarged_sizes_are_rounded_in_the_given_direction_and_unchanged_by_the_factor_1():
    rows = np.array([[1.0, 2.0, 0.3, 0.7, 3.0, 0.1, 0.2]] * 3)
    factors = np.array([1.0, 1.1, 0.37])
    for towards, side in ((np.inf, 1), (0.0, -1)):
        grown = clearance._enlarged(rows, factors, towards)
        assert (grown[:, [0, 1, 4, 5, 6]] == rows[:, [0, 1, 4, 5, 6]]).all()
        assert (grown[0] == rows[0]).all()
        for k in (1, 2):
            for column in (2, 3):
                off = Fraction(grown[k, column]) - Fraction(rows[k, column]) * Fraction(factors[k])
                assert 0 < off * side < 2 * math.ulp(grown[k, column])


def test_clearance_scales_only_extreme_rows_and_only_by_exact_powers_of_two():
    row = np.array([1.0, 2.0, 0.3, 0.7, 3.0, -0.1, 0.2])
    rows = np.array([row, np.ldexp(row, 990), np.ldexp(row, -1000), row, row])
    rows[3, 2] = 1e-310
    rows[4, 0], rows[4, 2] = 1e300, 1e-310
    scaled, shift = clearance._scaled(rows)
    assert (np.ldexp(scaled, -shift[:, None]) == rows).all()
    assert shift[0] == 0
    assert (scaled[1] == scaled[2]).all()
    assert np.abs(scaled[1]).max() < 8
    assert scaled[3, 2] > 1e-300
    assert shift[4] == 0


def test_clearance_scales_lengths_back_with_rounding_in_the_given_direction():
    lengths, shift = np.array([3.0, 3.0, 0.0, 5e-324 * 3]), np.array([0, 2, 5, 1])
    assert clearance._lowered(lengths, shift, 0.0).tolist() == [3.0, math.nextafter(0.75, 0), 0.0, 5e-324]
    assert clearance._lowered(lengths, shift, np.inf).tolist() == [3.0, math.nextafter(0.75, 1), 0.0, 5e-324 * 3]


def test_the_measured_length_of_a_gap_has_the_unit_of_its_row():
    """Every term of its bound is a length, so that with all lengths times 2ᵏ it is 2ᵏ times as long."""
    rows = np.array([[1.0, 2.0, 0.001, 4.0, 3.0, 1.0, 2.0, 1.0, 0.0, 1.0]])
    there, here = np.array([[1.5, 0.5, 0.25]]), np.array([[2.5, 1.0, 0.5]])
    one = points.Gaps(np.ones(1), np.ones(1), there, here)
    measured = clearance._measured(rows, one)
    assert measured > np.linalg.norm(there - here)
    for unit in (2.0**-30, 2.0**30):
        scaled = rows.copy()
        scaled[:, :7] *= unit
        other = points.Gaps(np.ones(1), np.ones(1), there * unit, here * unit)
        assert clearance._measured(scaled, other) == measured * unit


def halved(low, high, border, sizes=1.0):
    """What _halve makes of a bracket where a spheroid is clear below the border and in contact from it on."""
    rows, low, high = np.full((1, 7), sizes), np.array([low]), np.array([high])
    clearance._halve(rows, low, high, lambda _, factor: factor < border, lambda _, factor: factor >= border)
    return low[0], high[0]


@pytest.mark.parametrize("border", [1e-300, *(k * clearance.WIDTH for k in (0.6, 1.4, 1.9, 3.0)), 0.5, 1.0])
def test_halving_ends_within_the_promised_width_below_1(border):
    low, high = halved(0.0, 1.0, border)
    assert low < border <= high
    assert high - low <= clearance.WIDTH


def test_halving_never_lowers_a_factor_that_is_proved():
    """Beyond 2¹⁰⁰⁰ no middle is tried."""
    assert halved(2.0**1001, np.inf, np.inf) == (2.0**1001, np.inf)
    low, high = halved(1.0, np.inf, 1e200)
    assert low < 1e200 <= high
    assert high - low <= clearance.WIDTH * low
