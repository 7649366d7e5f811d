"""The least value: its bounds hold what the wall and the discs have, and are as near to it as they say."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import least
from hypcheck.truth.least import NOTHING, to_border

INF = math.inf


def drawn(count, seed, *, scale=1.0):
    """Pairs of all shapes beside walls that end, half of them solid, at any length of the unit."""
    draw = random.Random(seed)  # noqa: S311
    for number in range(count):
        sizes = [scale * math.exp(draw.gauss(0, 1.2)) for _ in range(4)]
        center = [draw.gauss(0, 1) * 2 * max(sizes[0], *sizes[2:]) for _ in range(3)]
        ends = sorted(center[2] + draw.gauss(0, 1) * 3 * sizes[3] for _ in range(2))
        axis = (0, 0, 1) if number % 4 == 0 else [draw.gauss(0, 1) for _ in range(3)]
        low, high = (ends[0], INF) if number % 5 == 0 else (-INF, ends[1]) if number % 5 == 1 else ends
        yield Pair.from_row((*sizes, *center, *axis, low, high, number % 2))


def n_of(pair, X):
    """n at points (3, n), by the matrix of the spheroid."""
    v = np.array(pair.axis) / np.linalg.norm(pair.axis)
    M = np.eye(3) / pair.b**2 + (1 / pair.d**2 - 1 / pair.b**2) * np.outer(v, v)
    D = X - np.array([[pair.x], [pair.y], [pair.z]])
    return np.sqrt(np.einsum("in,ij,jn->n", D, M, D))


def wall(pair, w, t):
    r = pair.alpha * np.hypot(1, w / pair.gamma)
    return np.stack([r * np.cos(t), r * np.sin(t), w])


def border(pair, point):
    """Many points of the wall and the discs, (3, n), most of them about a point."""
    draw = np.random.default_rng(1)
    w, t = draw.normal(size=4000), draw.uniform(-math.pi, math.pi, 4000)
    level, width = point[2], max(pair.b, pair.d)
    far = np.concatenate([level + 2 * width * w, level + width * w * np.geomspace(1e-9, 1, 4000)])
    turn = math.atan2(point[1], point[0])
    near = np.concatenate([t, turn + t * np.geomspace(1e-9, 1, 4000)])
    parts = [wall(pair, np.clip(far, pair.z_min, pair.z_max), near)]
    for end in (pair.z_min, pair.z_max) if pair.solid else ():
        if math.isfinite(end):
            edge = wall(pair, np.full(4000, end), t)
            share = np.sqrt(draw.uniform(0, 1, 4000))
            parts.append(edge * np.stack([share, share, np.ones(4000)]))
    return np.concatenate(parts, axis=1)


@pytest.mark.parametrize("scale", [1.0, 2.0**-150, 2.0**150])
def test_bounds_of_the_least_value_hold_that_of_every_point_and_are_as_near_as_told(scale):
    for pair in drawn(24, seed=int(math.log2(scale)), scale=scale):
        found = to_border(pair)
        assert found.lower <= found.upper <= found.lower * (1 + 2.0**-39) + 1e-9
        on_border = np.array(found.point)[:, None]
        assert n_of(pair, on_border)[0] == pytest.approx(found.upper, rel=1e-9, abs=1e-9)
        radius = math.hypot(*found.point[:2])
        rim = pair.alpha * math.hypot(1, found.point[2] / pair.gamma)
        assert pair.z_min <= found.point[2] <= pair.z_max
        ends = [end for end in (pair.z_min, pair.z_max) if pair.solid]
        assert radius == pytest.approx(rim, rel=1e-12) or (found.point[2] in ends and radius < rim)
        assert n_of(pair, border(pair, found.point)).min() >= found.lower * (1 - 1e-13) - 1e-12


def test_a_search_for_the_side_alone_ends_when_it_is_known():
    for pair in drawn(40, seed=3):
        side, whole = to_border(pair, side_alone=True), to_border(pair)
        assert side.meets is whole.meets
        assert side.lower <= whole.upper
        assert whole.lower <= side.upper
        assert not side.lower <= 1 <= side.upper


def test_the_bound_of_a_cell_is_below_all_that_the_cell_has():
    """The step of the proof: Taylor's formula with the largest second derivatives, in cells of any size."""
    draw = np.random.default_rng(5)
    for pair in drawn(60, seed=4):
        count, size = 300, max(pair.b, pair.d, pair.alpha)
        w = np.clip(pair.z + size * draw.normal(size=count), pair.z_min, pair.z_max)
        h, k = size * 10 ** draw.uniform(-7, 0.5, count), 10 ** draw.uniform(-7, 0, count)
        t = draw.uniform(-math.pi, math.pi, count)
        at_most, bound, _, _, curvatures, X = least._bounds(pair, np.stack([w, t, h, k]), least._SLACK)
        assert (curvatures > 0).all()
        assert (n_of(pair, X) ** 2 <= at_most * (1 + 1e-12)).all()
        assert ((X[2] >= pair.z_min) & (X[2] <= pair.z_max) & (abs(X[2] - w) <= h * (1 + 1e-9) + 1e-12 * size)).all()
        for across, around in draw.uniform(-1, 1, (40, 2)):
            for one, other in ((across, around), (np.sign(across), around), (across, 0), (0, around)):
                q = n_of(pair, wall(pair, w + one * h, t + other * k)) ** 2
                assert (bound <= q * (1 + 1e-12)).all()


def test_the_bound_of_a_small_cell_is_near_its_value():
    for pair in drawn(30, seed=6):
        w, t = np.full(8, min(max(pair.z, pair.z_min), pair.z_max)), np.linspace(-3, 3, 8)
        small = np.full(8, 1e-6)
        at_most, bound, *_ = least._bounds(pair, np.stack([w, t, small * pair.gamma, small]), least._SLACK)
        assert (at_most - bound <= 1e-3 * (1 + at_most) * max(1, pair.alpha / min(pair.b, pair.d)) ** 2).all()


def test_roundings_of_a_value_are_within_their_bound_far_from_the_axis():
    draw = np.random.default_rng(7)
    for far in (1.0, 1e4, 1e8):
        for large in drawn(6, seed=8, scale=far):
            pair = replace(large, b=large.b / far, d=large.d / far)
            w, t = pair.z + pair.gamma * draw.normal(size=20), draw.uniform(-3, 3, 20)
            q, _, _, error, _, _ = least._values(pair, w, t, least._SLACK)
            with mp.workprec(200):
                axis = [mpf(part) for part in pair.axis]
                for k in range(20):
                    r = pair.alpha * mp.sqrt(1 + (mpf(w[k]) / pair.gamma) ** 2)
                    point = (r * mp.cos(mpf(t[k])), r * mp.sin(mpf(t[k])), mpf(w[k]))
                    way = [p - c for p, c in zip(point, pair.row[4:7], strict=True)]
                    along = sum(x * y for x, y in zip(way, axis, strict=True)) ** 2 / sum(x * x for x in axis)
                    exact = (sum(x * x for x in way) - along) / mpf(pair.b) ** 2 + along / mpf(pair.d) ** 2
                    assert abs(exact - mpf(q[k])) <= error[k]


TREE = (3.0, 4.0)
"""α and γ whose circle at height 3 has the radius 15/4."""


@pytest.mark.parametrize(
    ("row", "ends", "solid", "value"),
    [
        ((*TREE, 1, 1, 0, 0, 5), (-1, 3), 1, 2.0),  # above the disc
        ((*TREE, 1, 0.5, 1, 0, 5), (-1, 3), 1, 4.0),
        ((*TREE, 1, 2, 1, 0, 5, 1, 0, 0), (-1, 3), 1, 2.0),
        ((*TREE, 1, 1, 0, 0, -4), (-1, 3), 1, 3.0),  # below it
        ((*TREE, 1, 1, 0, 0, 5), (-1, 3), 0, math.hypot(3.75, 2)),  # the rim of an open wall
        ((*TREE, 1, 1, 4.75, 0, 4), (-1, 3), 1, math.hypot(1, 1)),  # beside the disc: the rim
        ((*TREE, 1, 1, 0, 0, 0), (-1, 3), 1, 1.0),  # the disc below is as far as a radius
        ((*TREE, 1, 1, 4, 0, 0), (0, 3), 0, 1.0),
        ((*TREE, 1, 1, 0, 0, 0), (0, 3), 0, 3.0),
        ((10, 1, 1, 1, 13, 0, -2.25), (0.7, 3), 0, math.sqrt(37) / 2),  # above its end a flat wall is nearer
        ((*TREE, 2, 2, 0, 0, 1), (1, 1.0000001), 0, math.hypot(3, 0.75) / 2),
    ],
)
def test_least_values_are_those_found_by_hand(row, ends, solid, value):
    axis = row[7:] or (0, 0, 1)
    found = to_border(Pair.from_row((*row[:7], *axis, *ends, solid)))
    assert found.lower <= value <= found.upper <= found.lower * (1 + 1e-6)  # a whole ring is nearest: many cells


def test_bounds_tell_nothing_of_lengths_beyond_their_range_or_over_an_edge_of_a_disc():
    assert to_border(Pair.from_row((1, 1, 1, 1e-70, 3, 0, 0, 0, 0, 1, -1, 1, 0))) is NOTHING
    assert to_border(Pair.from_row((1e70, 1, 1, 1, 3, 0, 0, 0, 0, 1, -1, 1, 0))) is NOTHING
    over_the_rim = to_border(Pair.from_row((*TREE, 1, 1, 3.75, 0, 4.5, 0, 0, 1, -1, 3, 1)))
    assert (over_the_rim.lower, over_the_rim.meets) == (0.0, None)
    assert over_the_rim.upper == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("row", "position"),
    [
        ((1, 1, 1, 1, 2, 0, 0, 0, 0, 1, -1, 1, 0), None),  # it touches
        ((1, 1, 0.25, 0.25, 0.5, 0, 0, 0, 0, 1, -1, 1, 0), Position.INTERIOR),
        ((1, 1, 0.25, 0.25, 0.5, 0, 2, 0, 0, 1, -1, 1, 0), Position.EXTERIOR),
        ((1, 1, 0.25, 0.25, 0.5, 0, -2, 0, 0, 1, -1, 1, 0), Position.EXTERIOR),
        ((1, 1, 0.25, 0.25, 0.0, 0.5, 0, 0, 0, 1, -1, 1, 1), Position.INTERIOR),
        ((1, 1, 0.25, 0.25, 0.0, 1.5, 0, 0, 0, 1, -1, 1, 1), Position.EXTERIOR),
        ((1, 1, 0.6, 0.25, 0.0, 1.5, 0, 0, 0, 1, -1, 1, 1), Position.CONTACT),
        ((1, 1, 2.0**-60, 2.0**-60, 1 + 2.0**-50, 0, 0, 0, 0, 1, -1, 1, 0), None),  # a side that rounds
    ],
)
def test_positions_by_the_least_value_are_those_found_by_hand(row, position):
    assert least.position(Pair.from_row(row)) is position
