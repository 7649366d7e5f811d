"""The least value: its bounds hold what the wall and the discs have, and are as near to it as they say."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf

from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import exact, least, position
from tests.tools import ended_agreement

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
def test_bounds_of_the_least_value_hold_for_sampled_points_and_are_as_narrow_as_requested(scale):
    for pair in drawn(10, seed=int(math.log2(scale)), scale=scale):
        found = least.to_border(pair)
        assert found.lower <= found.upper <= found.lower * (1 + 2.0**-39) + 1e-9
        on_border = np.array(found.point)[:, None]
        assert n_of(pair, on_border)[0] == pytest.approx(found.upper, rel=1e-9, abs=1e-9)
        radius = math.hypot(*found.point[:2])
        rim = pair.alpha * math.hypot(1, found.point[2] / pair.gamma)
        assert pair.z_min <= found.point[2] <= pair.z_max
        ends = [end for end in (pair.z_min, pair.z_max) if pair.solid]
        assert radius == pytest.approx(rim, rel=1e-12) or (found.point[2] in ends and radius < rim)
        assert n_of(pair, border(pair, found.point)).min() >= found.lower * (1 - 1e-13) - 1e-12


def test_a_search_that_is_asked_only_for_the_side_ends_as_soon_as_the_side_is_certain():
    for pair in drawn(16, seed=3):
        side, whole = least.to_border(pair, side_alone=True), least.to_border(pair)
        assert side.meets is whole.meets
        assert side.lower <= whole.upper
        assert whole.lower <= side.upper
        assert not side.below <= 0 <= side.above


STAGES = {"float64": least._at, "double-double": least._at_finely}


def cells(pair, draw, count):
    """Cells of any size about the heights of the spheroid, some reaching over an end."""
    size = max(pair.b, pair.d, pair.alpha)
    w = np.clip(pair.z + size * draw.normal(size=count), pair.z_min, pair.z_max)
    h, k = size * 10 ** draw.uniform(-7, 0.5, count), 10 ** draw.uniform(-7, 0, count)
    return np.stack([w, draw.uniform(-math.pi, math.pi, count), h, k])


def in_cells(pair, some, draw):
    """n² at points of each cell (m, n): 160 drawn, and its corners, none of them beyond the ends."""
    w, t, h, k = some
    corners = [(one, other) for one in (-1, 1) for other in (-1, 1)]
    for across, around in draw.uniform(-1, 1, (40, 2)):
        corners += [(across, around), (np.sign(across), around), (across, 0), (0, around)]
    heights = [np.clip(w + one * h, pair.z_min, pair.z_max) for one, _ in corners]
    places = [wall(pair, height, t + other * k) for height, (_, other) in zip(heights, corners, strict=True)]
    return np.stack([n_of(pair, place) ** 2 for place in places])


@pytest.mark.parametrize("stage", STAGES)
def test_the_lower_bound_of_a_cell_is_below_every_value_in_the_cell(stage):
    """The step of the proof: Taylor's formula with the largest second derivatives, in cells of any size."""
    draw = np.random.default_rng(5)
    for pair in drawn(20, seed=4):
        some = cells(pair, draw, 300)
        found = least._bounds(pair, some, STAGES[stage])
        w, _, h, _ = some
        size = max(pair.b, pair.d, pair.alpha)
        assert (found.shares >= 0).all()
        assert (n_of(pair, found.X) ** 2 <= (1 + found.above) * (1 + 1e-12) + 1e-12).all()
        assert ((found.X[2] >= pair.z_min) & (found.X[2] <= pair.z_max)).all()
        assert (abs(found.X[2] - w) <= h * (1 + 1e-9) + 1e-12 * size).all()
        assert (1 + found.below <= in_cells(pair, some, draw) * (1 + 1e-12) + 1e-12).all()


@pytest.mark.parametrize("stage", STAGES)
def test_the_lower_bound_of_a_cell_at_a_rim_takes_no_account_of_heights_beyond_the_rim(stage):
    """A bound is below the corners of its cell by no more than the terms of second order of both, and roundings."""
    draw = np.random.default_rng(6)
    for pair in drawn(20, seed=14):
        some = cells(pair, draw, 100)
        ends = [end for end in (pair.z_min, pair.z_max) if math.isfinite(end)]
        some[0] = draw.choice(ends, 100) + some[2] * draw.uniform(-1, 1, 100)
        some[0] = np.clip(some[0], pair.z_min, pair.z_max)
        found = least._bounds(pair, some, STAGES[stage])
        lowest = in_cells(pair, some, draw).min(axis=0) - 1
        assert (lowest - found.below <= 2 * (found.loose + found.error) * (1 + 1e-6) + 1e-12 * (1 + lowest)).all()


def test_parts_of_a_cut_cell_cover_the_cell_in_spite_of_the_rounding_of_their_middles():
    draw = np.random.default_rng(8)
    for pair in drawn(20, seed=9):
        some = cells(pair, draw, 50)
        shares = draw.uniform(-1, 1, (2, 40, 50))
        shares[:, :20] = np.sign(shares[:, :20] + draw.choice([-0.5, 0, 0.5], (2, 20, 50)))
        shares[:, :10] *= draw.choice([0, 1], (2, 10, 50))
        rooms = [(abs(some[0]) + some[2]) * 2.0**-50, np.full(50, 2.0**-49)]
        places = [some[row] + shares[row] * (some[2 + row] - rooms[row]) for row in (0, 1)]
        for terms in draw.uniform(0, 10, (3, 2, 50)):
            parts = least._cut(some, terms)
            assert 100 <= parts.shape[1] <= 200
            rooms = [(abs(parts[0]) + parts[2]) * 2.0**-51, 2.0**-50]
            within = [abs(places[row][..., None] - parts[row]) <= parts[2 + row] - rooms[row] for row in (0, 1)]
            assert (within[0] & within[1]).any(axis=-1).all()


@pytest.mark.parametrize("stage", STAGES)
def test_errors_of_a_value_and_of_its_slopes_are_within_their_bounds_far_from_the_axis(stage):
    draw = np.random.default_rng(7)
    for far in (1.0, 1e4, 1e8):
        for large in drawn(3, seed=8, scale=far):
            pair = replace(large, b=large.b / far, d=large.d / far)
            w, t = pair.z + pair.gamma * draw.normal(size=10), draw.uniform(-3, 3, 10)
            found = STAGES[stage](pair, w, t)
            turns = np.stack([np.cos(t), np.sin(t)])
            with mp.workprec(400):
                for k in range(10):
                    turn = (mp.cos(t[k]), mp.sin(t[k]))
                    if stage != "float64":
                        turn = tuple(mpf(part) / mp.hypot(*turns[:, k]) for part in turns[:, k])
                    exact, up, around, lengths = exactly(pair, mpf(w[k]), turn)
                    assert abs(exact - 1 - mpf(found.excess[k])) <= found.error[k]
                    slack = (2.0**-45 * lengths[0] if stage == "float64" else found.blur[k]) / min(pair.b, pair.d)
                    slack /= min(pair.b, pair.d) if stage == "float64" else 1
                    assert abs(up - mpf(found.qw[k])) <= slack * lengths[1]
                    assert abs(around - mpf(found.qt[k])) <= slack * lengths[2]
                    n = float(mp.sqrt(exact))
                    touching = replace(pair, b=pair.b * n, d=pair.d * n)
                    here = STAGES[stage](touching, w[k : k + 1], t[k : k + 1])
                    excess = exactly(touching, mpf(w[k]), turn)[0] - 1
                    assert abs(excess - mpf(here.excess[0])) <= here.error[0]


def exactly(pair, w, turn):
    """q at a point of the wall, its slopes, and the lengths |X| + |C|, |X_w| and |X_θ|."""
    u = [mpf(part) / mp.sqrt(sum(mpf(part) ** 2 for part in pair.axis)) for part in pair.axis]
    r = pair.alpha * mp.sqrt(1 + (w / pair.gamma) ** 2)
    slope = mpf(pair.alpha) ** 2 / mpf(pair.gamma) ** 2 * w / r
    X = (r * turn[0], r * turn[1], w)
    D = [p - c for p, c in zip(X, pair.row[4:7], strict=True)]
    along = sum(x * y for x, y in zip(D, u, strict=True))
    M = [(p - along * y) / mpf(pair.b) ** 2 + along * y / mpf(pair.d) ** 2 for p, y in zip(D, u, strict=True)]
    q = sum(x * y for x, y in zip(D, M, strict=True))
    up = 2 * (M[0] * slope * turn[0] + M[1] * slope * turn[1] + M[2])
    lengths = mp.norm(X) + mp.norm(pair.row[4:7]), mp.sqrt(1 + slope**2), r
    return q, up, 2 * r * (M[1] * turn[0] - M[0] * turn[1]), lengths


@pytest.mark.parametrize("tilted", [False, True])
def test_rows_very_near_a_rim_a_disc_or_the_wall_have_the_exact_position_by_the_least_value(tilted):
    rows = ended_agreement.hairs(np.random.default_rng(11), 40, tilted=tilted)
    for row in rows.tolist():
        pair = Pair.from_row(row)
        assert least.position(pair) is exact.position(pair.lengths)


@pytest.mark.parametrize(("beyond", "position"), [("1e-20", Position.EXTERIOR), ("-1e-20", Position.CONTACT)])
def test_the_least_value_decides_a_centre_a_relative_1e_minus_20_beside_contact_with_a_rim(beyond, position):
    """The centre is 15/4 + 1 + `beyond` from the axis: y is chosen so that √(x² + y²) is that."""
    x = 4.75 - 2.0**-50
    with mp.workprec(200):
        y = float(mp.sqrt((mpf(4.75) + mpf(beyond)) ** 2 - mpf(x) ** 2))
        assert abs(mp.hypot(x, y) - 4.75 - mpf(beyond)) < 1e-25
    assert least.position(Pair.from_row((*TREE, 1, 1, x, y, 3, 0, 0, 1, -1, 3, 0))) is position


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
        ((*TREE, 1, 1, 3.75, 0, 4.5), (-1, 3), 1, 1.5),  # over its edge
        ((*TREE, 1, 1, 0, 0, 0), (-1, 3), 1, 1.0),  # the disc below is as far as a radius
        ((*TREE, 1, 1, 4, 0, 0), (0, 3), 0, 1.0),
        ((*TREE, 1, 1, 0, 0, 0), (0, 3), 0, 3.0),
        ((10, 1, 1, 1, 13, 0, -2.25), (0.7, 3), 0, math.sqrt(37) / 2),  # above its end a flat wall is nearer
        ((*TREE, 2, 2, 0, 0, 1), (1, 1.0000001), 0, math.hypot(3, 0.75) / 2),
    ],
)
def test_least_values_are_those_found_by_hand(row, ends, solid, value):
    axis = row[7:] or (0, 0, 1)
    found = least.to_border(Pair.from_row((*row[:7], *axis, *ends, solid)))
    assert found.lower <= value <= found.upper <= found.lower * (1 + 1e-6)  # a whole ring is nearest: many cells


def test_the_search_for_the_least_value_gives_no_bounds_for_lengths_beyond_its_range():
    assert least.to_border(Pair.from_row((1, 1, 1, 1e-70, 3, 0, 0, 0, 0, 1, -1, 1, 0))) is least.NOTHING
    assert least.to_border(Pair.from_row((1e70, 1, 1, 1, 3, 0, 0, 0, 0, 1, -1, 1, 0))) is least.NOTHING


@pytest.mark.parametrize(
    "row",
    [
        (3.4e-14, 1.5e-31, 2.4e19, 7.3e-53, 0.0, 3.9e-32, -9.4e12, -0.3, 1.3, -1.2, -INF, 7.6e-53, 1),
        (5e16, 2.0**-60, 2.0**-60, 9e9, 0, 0, 0, 0, 0, 1, 1, INF, 0),
    ],
)
def test_a_bound_that_overflows_decides_nothing(row):
    pair = Pair.from_row(row)
    assert least.position(pair) in (None, position(pair.lengths))


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ((1, 1, 1, 1, 2, 0, 0, 0, 0, 1, -1, 1, 0), None),  # it touches
        ((1, 1, 0.25, 0.25, 0.5, 0, 0, 0, 0, 1, -1, 1, 0), Position.INTERIOR),
        ((1, 1, 0.25, 0.25, 0.5, 0, 2, 0, 0, 1, -1, 1, 0), Position.EXTERIOR),
        ((1, 1, 0.25, 0.25, 0.5, 0, -2, 0, 0, 1, -1, 1, 0), Position.EXTERIOR),
        ((1, 1, 0.25, 0.25, 0.0, 0.5, 0, 0, 0, 1, -1, 1, 1), Position.INTERIOR),
        ((2, 4, 0.25, 0.25, 0.0, 1, 0, 0, 0, 1, -1, 1, 0), Position.INTERIOR),
        ((2, 4, 0.25, 0.25, 1, 0.0, 0, 0, 0, 1, -1, 1, 0), Position.INTERIOR),
        ((1, 4, 0.125, 0.125, 1.5, 0, 3, 0, 0, 1, -4, 4, 0), Position.EXTERIOR),
        ((4, 0.25, 0.125, 0.125, 6, 0, 0.5, 0, 0, 1, -4, 4, 0), Position.INTERIOR),
        ((1, 1, 0.25, 0.25, 0.0, 1.5, 0, 0, 0, 1, -1, 1, 1), Position.EXTERIOR),
        ((1, 1, 0.6, 0.25, 0.0, 1.5, 0, 0, 0, 1, -1, 1, 1), Position.CONTACT),
        ((1, 1, 2.0**-60, 2.0**-60, 1 + 2.0**-50, 0, 0, 0, 0, 1, -1, 1, 0), None),  # much smaller than roundings of X
        ((*TREE, 1, 1, 4.75, 0, 3, 0, 0, 1, -1, 3, 0), None),  # touches of a rim and a disc
        ((*TREE, 1, 1, 1, 0, 4, 0, 0, 1, -1, 3, 1), None),
    ],
)
def test_positions_by_the_least_value_are_those_found_by_hand(row, expected):
    assert least.position(Pair.from_row(row)) is expected


def test_the_lower_bound_of_a_cell_at_a_narrow_waist_covers_the_curvature_of_the_wall():
    """Far from the axis, beside a waist whose radius of curvature is a thousandth of that distance."""
    draw = np.random.default_rng(3)
    pair = Pair.from_row((0.125, 0.0125, 4, 4, 5, 0, 0, 0, 0, 1, -1, 1, 0))
    w, t = draw.uniform(-0.02, 0.02, 200), draw.uniform(-1, 1, 200)
    some = np.stack([w, t, 10 ** draw.uniform(-3, -1, 200), 10 ** draw.uniform(-6, -3, 200)])
    found = least._bounds(pair, some, least._at)
    assert (1 + found.below <= in_cells(pair, some, draw) * (1 + 1e-12) + 1e-12).all()


def test_a_spheroid_much_smaller_than_the_roundings_of_the_wall_is_left_undecided():
    assert least.position(Pair.from_row((1, 1, 2.0**-60, 2.0**-60, 1 + 2.0**-50, 0, 0, 0, 0, 1, -1, 1, 0))) is None


def test_the_error_of_a_squared_length_covers_every_allowed_error_of_its_coordinates():
    """The step of the proof: n is off by e = s (|X| + |C|)/m at most, and so n² by e (2n + e)."""
    draw = np.random.default_rng(9)
    pair = Pair(1.0, 2.0, 2.0**-40, 2.0**-38, 3.0, 4.0, 12.0)
    X, n = draw.normal(size=(3, 64)) * 10 ** draw.uniform(-3, 3, 64), 10 ** draw.uniform(-6, 6, 64)
    lengths = np.linalg.norm(abs(X) + np.array([[3.0], [4.0], [12.0]]), axis=0)
    for slack in (2.0**-45, 2.0**-30, 2.0**-10):
        errors = least._error(pair, X, n * n, slack) * (1 + 2.0**-40)
        for value, off, error in zip(n, slack * lengths / 2.0**-40, errors, strict=True):
            assert (Fraction(value) + Fraction(off)) ** 2 - Fraction(value) ** 2 <= Fraction(error)
