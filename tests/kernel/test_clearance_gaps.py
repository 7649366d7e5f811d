"""hypcheck.clearance beside a groove: long, flat and tilted spheroids, whose distance exact decisions bound badly."""

from __future__ import annotations

import json

import numpy as np
import pytest

import hypcheck
from hypcheck.cli.main import main

IN_GROOVE = [1.017268845361678, 0.3926105344639404, 0.7658765291164381, 0.15775131243075338, 3.5202444439959484, 0, 0]


def spheroids(tilted, count):
    """Flat and long ones, some of them as thin as needles, inside and outside of wide and narrow walls."""
    rng = np.random.default_rng(11)
    sizes = 10 ** rng.uniform(-1, 1, (count, 4))
    sizes[:, 3] = sizes[:, 2] * 10 ** (rng.choice([-1, 1], count) * rng.uniform(0.3, 3, count))
    centres = 10 ** rng.uniform(-1, 1, (count, 3)) * rng.choice([-1, 0, 1], (count, 3))
    return np.hstack([sizes, centres, rng.normal(size=(count, 3))] if tilted else [sizes, centres])


@pytest.mark.parametrize("tilted", [False, True])
def test_distance_bounds_are_as_narrow_as_promised_and_agree_with_the_nearest_point(tilted):
    rows = spheroids(tilted, 1000)
    rows = rows[hypcheck.classify(rows) != 0]
    found = hypcheck.clearance(rows)
    assert {-1, 1} == set(found.position.tolist())
    longer, width = rows[:, 2:4].max(axis=1), found.distance_upper - found.distance_lower
    assert ((width >= 0) & (width <= 2.0**-29 * (found.distance_lower + longer))).all()
    radius = rows[:, 0] * np.hypot(1, found.nearest[:, 2] / rows[:, 1])
    assert np.allclose(np.hypot(*found.nearest.T[:2]), radius, rtol=1e-13)
    offset = found.nearest + found.distance_upper[:, None] * found.normal - rows[:, 4:7]
    axis = rows[:, 7:] / np.linalg.norm(rows[:, 7:], axis=1, keepdims=True) if tilted else np.array([[0.0, 0.0, 1.0]])
    along = (offset * axis).sum(axis=1)
    across = np.linalg.norm(offset - along[:, None] * axis, axis=1)
    off = (np.hypot(across / rows[:, 2], along / rows[:, 3]) - 1) * rows[:, 2:4].min(axis=1)
    assert (np.abs(off) <= 1e-6 * longer).all()


def test_the_distance_of_a_spheroid_in_a_groove_is_the_least_between_sampled_points_of_both_surfaces():
    alpha, gamma, b, d, x, *_ = IN_GROOVE
    near = hypcheck.clearance([IN_GROOVE])
    height, angle = np.meshgrid(np.linspace(-2, 2, 2001), np.linspace(0, 2 * np.pi, 2001))
    gaps = np.hypot(alpha * np.hypot(1, height / gamma) - x - b * np.cos(angle), height - d * np.sin(angle))
    assert near.distance_lower[0] <= gaps.min() <= near.distance_upper[0] + 1e-5
    assert abs(near.nearest[0, 2]) == pytest.approx(0.877, abs=1e-3)
    assert near.tie[0]


def test_classify_prints_the_distance_of_a_spheroid_in_a_groove_in_ten_digits(capsys):
    near = hypcheck.clearance(*IN_GROOVE[:4], IN_GROOVE[4:])
    alpha, gamma, b, d, *centre = map(str, IN_GROOVE)
    words = ["classify", "--json", "--alpha", alpha, "--gamma", gamma, "--b", b, "--d", d, "--center", *centre]
    assert main(words) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["distance_lower"] <= near.distance_upper
    assert near.distance_lower <= said["distance_upper"] <= said["distance_lower"] + 1e-9


def test_distance_bounds_of_a_huge_wall_or_in_extreme_units_are_ordered_and_raise_no_float_error():
    rows = np.array([[*IN_GROOVE, 0.3, 0.2, 1.0]] * 5)
    rows[1, :7] *= 1e150
    rows[2, :7] *= 1e-150
    rows[3, :7] *= 2.0**-1066
    rows[4, 0] = 1e150
    with np.errstate(all="raise"):
        found = hypcheck.clearance(rows)
    assert (found.distance_lower <= found.distance_upper).all()
    assert found.distance_upper[:3] * (1, 1e-150, 1e150) == pytest.approx([found.distance_upper[0]] * 3, rel=1e-9)


LONG_AND_TILTED = [1.2723, 2.2682, 0.167, 5.0219, 6.9888, -8.2508, 6.6449, 0.16757, 1.00563, -0.01132]
"""A rod of which another point of the wall is nearest than the first that is tried: its gap has to be measured."""


@pytest.mark.parametrize(("unit", "axis"), [(2.0**20, 1.0), (2.0**-20, 1.0), (1.0, 2.0**30), (1.0, 2.0**-30)])
def test_distance_bounds_are_narrow_in_any_unit_of_lengths_and_for_an_axis_of_any_length(unit, axis):
    row = np.array([LONG_AND_TILTED])
    row[:, :7] *= unit
    row[:, 7:] *= axis
    found = hypcheck.clearance(row)
    low, high = found.distance_lower.item(), found.distance_upper.item()
    assert 0 < high - low <= 2.0**-29 * (low + 5.0219 * unit)
