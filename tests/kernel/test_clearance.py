"""hypcheck.clearance: intervals that contain what the nearest-point oracle says, whatever the guess is."""

from __future__ import annotations

import dataclasses
import sys

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from hypcheck.kernel import clearance_bounds, clearance_points
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from tests.support.inside import clearances, nearest
from tests.support.inside import kernel_choice as choice
from tests.support.nearest_points import is_circle, nearest_points

UPRIGHT = ("uniform", "tangent", "ring", "near-axis", "extreme-subnormal", "extreme-magnitude", "on-surface", "waist")
TILTED = ("tilted-uniform", "tilted-tangent", "tilted-ring", "tilted-sphere")


@pytest.fixture(scope="module")
def rows():
    return np.concatenate([FAMILIES[name].rows(1, 40) for name in UPRIGHT])


@pytest.fixture(scope="module")
def found(rows):
    return hypcheck.clearance(rows)


def test_clearance_intervals_contain_the_exact_clearance_on_each_family(rows, found):
    true = clearances(rows)
    assert (found.position == true.position).all()
    assert ((found.lower <= true.clearance) & (true.clearance <= found.upper)).all()
    assert (found.upper - found.lower <= 2.0**-29 * np.maximum(1, 1 + found.lower)).all()
    assert (found.lower[found.position != 0] >= 0).all()
    assert (found.upper[found.position == 0] <= 0).all()


def test_clearance_intervals_contain_the_clearance_even_if_the_guessed_factor_of_the_touch_is_wrong(
    rows, found, monkeypatch
):
    honest = clearance_points.upright_touches

    def touches(some):
        said = honest(some)
        return dataclasses.replace(said, factor=said.factor * np.where(np.arange(len(some)) % 2, 1.5, 0.7))

    monkeypatch.setattr(clearance_points, "upright_touches", touches)
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.choice.cache_clear()
    other = hypcheck.clearance(rows[::8])
    choice.choice.cache_clear()
    true = clearances(rows[::8]).clearance
    assert ((other.lower <= true) & (true <= other.upper)).all()
    assert (other.upper - other.lower <= (2.0**-30 + 2.0**-50) * np.maximum(1, 1 + other.lower)).all()


def test_clearance_intervals_stay_right_if_the_gap_is_measured_at_another_point(rows, monkeypatch):
    monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
    choice.choice.cache_clear()
    some = FAMILIES["uniform"].rows(2, 60)
    true, honest = hypcheck.clearance(some), clearance_points.upright_gaps

    def gaps(them, position, touch):
        moved = touch.copy()
        moved[:, 2] = 1.5 * touch[:, 2] + 0.5 * them[:, 1]
        radius = them[:, 0] * np.sqrt(1 + (moved[:, 2] / them[:, 1]) ** 2)
        moved[:, :2] *= (radius / np.hypot(touch[:, 0], touch[:, 1]))[:, None]
        said = honest(them, position, touch)
        length = np.sqrt(((moved - said.here) ** 2).sum(axis=1))
        return dataclasses.replace(said, there=moved, length=length)

    monkeypatch.setattr(clearance_points, "upright_gaps", gaps)
    found, unmeasured = hypcheck.clearance(some), clearance_bounds.clearances_without_ends(some)
    choice.choice.cache_clear()
    for each in (found, unmeasured):
        assert (each.distance_lower <= true.distance_upper).all()
        assert (each.distance_upper >= true.distance_lower).all()
    assert (unmeasured.distance_upper > 1.01 * true.distance_upper).any()
    assert np.allclose(found.distance_upper, true.distance_upper, rtol=0, atol=1e-8)


def test_clearance_of_the_numpy_kernel_agrees_with_each_instruction_set(rows, monkeypatch):
    module = pytest.importorskip("hypcheck.kernel._compiled")
    some = rows[::2]
    with monkeypatch.context() as environment:
        environment.setenv("HYPCHECK_KERNEL", "numpy")
        environment.setitem(sys.modules, choice.EXTENSION, None)
        choice.choice.cache_clear()
        found = hypcheck.clearance(some)
    choice.choice.cache_clear()
    best = module.level()
    for level in ("plain", "sse2", "avx2"):
        if module.use_level(level):
            other = hypcheck.clearance(some)
            assert (other.position == found.position).all()
            assert np.maximum(other.lower, found.lower).max() < np.inf
            assert (np.maximum(other.lower, found.lower) <= np.minimum(other.upper, found.upper)).all()
            assert (other.distance_lower <= found.distance_upper).all()
            assert (found.distance_lower <= other.distance_upper).all()
            assert (other.upper - other.lower <= 2.0**-29 * np.maximum(1, 1 + other.lower)).all()
    assert module.use_level(best)


def test_the_distance_of_touch_from_the_exact_nearest_point_is_at_most_touch_error(rows, found):
    known = np.flatnonzero(np.isfinite(found.touch_error))
    assert len(known) > len(rows) / 2
    for k in known[::4].tolist():
        pair = Pair.from_row(rows[k].tolist())
        if is_circle(pair):  # one point of it, in the half plane of the other
            continue
        off = min(np.linalg.norm(np.array(point) - found.touch[k]) for point in nearest_points(pair))
        assert off <= found.touch_error[k]
    assert np.median(found.touch_error[known] / np.abs(found.touch[known]).sum(axis=1)) < 1e-12


def test_clearance_intervals_contain_the_exact_clearance_on_tilted_families():
    rows = np.concatenate([TILTED_FAMILIES[name].rows(1, 8) for name in TILTED])
    found = hypcheck.clearance(rows)
    for k, row in enumerate(rows.tolist()):
        true = nearest(Pair.from_row(row)).clearance
        assert found.lower[k] <= true <= found.upper[k]
    assert (found.distance_lower <= found.distance_upper).all()


@pytest.mark.parametrize(
    ("row", "distance"),
    [
        ((2, 17.8, 0.25, 0.15, 0, 0, 0), 1.75),  # on the axis, at the waist: α − b
        ((2, 17.8, 0.25, 0.15, 3, 4, 0), 2.75),  # outside, at the waist: r − α − b
        ((3, 4, 1, 1, 0, 0, 20), np.sqrt(9 + 9 * 400 / 25) - 1),  # a sphere on the axis: √(α² + α²z²/(α² + γ²)) − b
        ((1, 1, 1, 1, 1.5, 0, 0), 0.0),
    ],
)
def test_distance_intervals_contain_distances_worked_out_by_hand(row, distance):
    found = hypcheck.clearance([row])
    assert found.distance_lower[0] <= distance <= found.distance_upper[0]
    assert found.distance_upper[0] - found.distance_lower[0] <= 1e-8


def test_sampled_points_of_both_bodies_are_no_nearer_than_distance_lower():
    rng = np.random.default_rng(7)
    rows = np.concatenate([np.exp(rng.normal(0, 1, (60, 4))), rng.normal(0, 5, (60, 3))], axis=1)
    rows = rows[hypcheck.classify(rows) != 0]
    found = hypcheck.clearance(rows)
    height, angle = np.sinh(np.linspace(-4, 4, 401)), np.linspace(0, 2 * np.pi, 1001)
    for k, (alpha, gamma, b, d, x, y, z) in enumerate(rows.tolist()):
        r, zeta = np.hypot(x, y), np.concatenate([z + d * height, [found.nearest[k, 2]]])
        rho = alpha * np.sqrt(1 + (zeta / gamma) ** 2)
        gaps = np.hypot(rho[:, None] - r - b * np.cos(angle), zeta[:, None] - z - d * np.sin(angle))
        assert found.distance_lower[k] <= gaps.min()
        assert gaps[-1].min() <= found.distance_upper[k] + 0.01 * max(b, d)  # the sampled points are that far apart
        assert np.isclose(np.hypot(*found.nearest[k, :2]), rho[-1], rtol=1e-14)


def test_clearance_refuses_invalid_rows_or_marks_them_with_127():
    rows = [[2, 17.8, 0.25, 0.15, 0, 0, 0], [2, 17.8, -1, 0.15, 0, 0, 0]]
    with pytest.raises(InputError, match=r"row 1: b is -1\.0; a semi-axis must be"):
        hypcheck.clearance(rows)
    found = hypcheck.clearance(rows, on_invalid="flag")
    assert found.position.tolist() == [-1, 127]
    assert np.isnan([found.lower[1], found.distance_upper[1], *found.touch[1]]).all()
    assert found.lower[0] <= 7 <= found.upper[0]


@pytest.mark.parametrize("more", [{"z_max": 1.0}, {"z_max": 1.0, "solid": True}, {"z_max": 1.0, "axis": (1, 1, 0)}])
def test_a_clearance_beyond_float64_beside_a_wall_that_ends_has_the_upper_bound_inf(more):
    near = hypcheck.clearance((1, 1, 1e-200, 1e-200), (1e150, 0, 0), **more)
    assert near.position == 1
    assert (near.lower, near.upper) == (sys.float_info.max, np.inf)
    assert near.distance_lower <= 1e150 * 0.5**0.5 <= near.distance_upper * (1 + 2.0**-50)
    assert near.distance_upper < 1e150
    assert hypcheck.classify((1, 1, 1e-200, 1e-200), (1e150, 0, 0), margin=1.0, **more) == 1
