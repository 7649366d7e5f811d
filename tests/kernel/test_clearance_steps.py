"""Steps of hypcheck.clearance in the numpy kernel: what is rounded, scaled and halved on the way to an interval."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.geometry.pair import Pair
from hypcheck.kernel import clearance_bounds
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from tests.support.inside import clearances
from tests.support.inside import kernel_choice as choice
from tests.support.nearest_points import is_circle, nearest_points

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
    found, true = hypcheck.clearance(rows), clearances(rows)
    assert (found.position == true.position).all()
    assert ((found.lower <= true.clearance) & (true.clearance <= found.upper)).all()
    assert (found.upper - found.lower <= 2.0**-29 * np.maximum(1, 1 + found.lower)).all()
    assert (found.lower >= -1).all()
    assert (found.lower[found.position != 0] >= 0).all()
    assert (found.upper[found.position == 0] <= 0).all()
    assert (found.distance_lower <= found.distance_upper).all()
    assert (found.distance_upper[found.position == 0] == 0).all()
    for k, row in enumerate(rows.tolist()):
        pair = Pair.from_row(row)
        if np.isfinite(found.touch_error[k]) and not is_circle(pair):
            off = min(np.linalg.norm(np.array(point) - found.touch[k]) for point in nearest_points(pair))
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


def test_clearance_scales_only_extreme_rows_and_only_by_exact_powers_of_two():
    """A step of the proof: the bounds of roundings hold for lengths in 2^±300, which frozen rows seldom leave."""
    row = np.array([1.0, 2.0, 0.3, 0.7, 3.0, -0.1, 0.2])
    rows = np.array([row, np.ldexp(row, 990), np.ldexp(row, -1000), row, row])
    rows[3, 2] = 1e-310
    rows[4, 0], rows[4, 2] = 1e300, 1e-310
    scaled, shift = clearance_bounds.scaled(rows)
    assert (np.ldexp(scaled, -shift[:, None]) == rows).all()
    assert shift[0] == 0
    assert (scaled[1] == scaled[2]).all()
    assert np.abs(scaled[1]).max() < 8
    assert scaled[3, 2] > 1e-300
    assert shift[4] == 0


@pytest.mark.parametrize("solid", [False, True])
def test_distances_of_subnormal_numbers_from_a_wall_that_ends_are_rounded_outward(solid):
    unit = 2.0**-1074
    points = np.array([(3000 + 7 * k, 2000 - 11 * k, 0) for k in range(40)]) * unit
    sizes = (1001 * unit, 50_000 * unit, 137 * unit, 137 * unit)
    found = hypcheck.clearance(sizes, points, z_min=-900 * unit, z_max=2000 * unit, solid=solid)
    for point, low, high in zip(points, found.distance_lower, found.distance_upper, strict=True):
        squared = sum(Fraction(number) ** 2 for number in point.tolist())
        shorter, longer = (Fraction(length) + Fraction(1138 * unit) for length in (low.item(), high.item()))
        assert shorter**2 <= squared <= longer**2
        assert high - low <= 4 * unit


def test_the_bounds_of_the_clearance_of_an_interior_tilted_spheroid_are_narrow():
    near = hypcheck.clearance(2.0, 3.0, 0.25, 0.5, (0.5, 0.25, 1.0), axis=(0.5, 0.25, 1.0))
    assert near.position == -1
    assert 0 < near.lower <= near.upper < near.lower * (1 + 1e-8)
