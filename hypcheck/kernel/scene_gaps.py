"""Distances from spheroids to hyperboloids that end, in the hyperboloids' frames, by branch and bound.

With f(X) the distance from the spheroid to a point X outside of it, and n the unit vector along which that is, the
spheroid lies in a half space: f(Y) ≥ n·(Y − C) − h(n) for every Y, with h(n) = √(b² + (d² − b²)(n·v)²) and v its axis.
So the least n·Y in a cell of the wall is a lower bound for the cell, whatever n is, and its place a point to try.
It is known in closed form:

- beside a tilted spheroid cells are pieces of the rulings Y = (α (cos φ − w/γ sin φ), α (sin φ + w/γ cos φ), w),
  linear in w and a cosine in φ, so that the least is at an end of w, and in φ at an end or where the cosine is −1;
- beside an upright one Y = (ρ(w), w) in the meridian half plane of C, ρ = α √(1 + w²/γ²), has all that is needed:
  n_r ρ + n_z w is least where its slope is 0, or at an end.

Cells above what some point reaches are dropped, the others halved. The distance to an end disc is that to its rim, a
border of the wall, or where the spheroid's point nearest to the disc's plane is above the disc, that to the plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.kernel.clearance_points import unit_vectors

_LOOSE = 2.0**-48
"""More than the roundings of a bound, in units of all lengths in it."""

_NARROW = 4 * _LOOSE
"""How far apart the bounds are at most where cells could be halved enough, in the same units."""

_ROUNDS, _MOST_CELLS, _FIRST = 96, 4096, 16
"""The most rounds of halving; a pair with more than _MOST_CELLS cells keeps its bounds as they are; how many heights
and angles the first cells divide."""

_TURNS, _SETTLED = 24, 2.0**-24
"""The most steps of Newton's method, and the relative step at which it ends. Bounds hold for any normal; near the right
one they change by the square of its error only."""


@dataclass(frozen=True)
class Gaps:
    """Bounds of distances (n,), and points (n, 3) that are not farther than the upper ones, except for roundings."""

    lower: Floats
    upper: Floats
    point: Floats


@dataclass(frozen=True)
class _Pairs:
    """Spheroids beside hyperboloids: α, γ, b, d (n,), centres and unit axes (n, 3) of the spheroids.

    `upright` (n,): the axes of both are parallel, or the spheroid is a ball.
    """

    alpha: Floats
    gamma: Floats
    b: Floats
    d: Floats
    centre: Floats
    axis: Floats
    upright: Mask

    def some(self, index: Indices) -> _Pairs:
        """Return the pairs with these indices."""
        return _Pairs(*(column[index] for column in vars(self).values()))


def gaps(sizes: Rows, centres: Rows, axes: Rows | None, spans: Rows, solid: Mask, farthest: Floats) -> Gaps:
    """Return the distances of spheroids from walls between two heights, spans (n, 2), with end discs if solid.

    `sizes` are α, γ, b, d (n, 4); `axes` (n, 3), None where all are upright; `farthest` (n,) are upper bounds.
    """
    unit = np.tile((0.0, 0.0, 1.0), (len(sizes), 1)) if axes is None else unit_vectors(axes)
    upright = (unit[:, :2] == 0).all(axis=1) | (sizes[:, 2] == sizes[:, 3])
    with np.errstate(all="ignore"):
        unit_of = _unit_of(sizes, centres)
        sizes, centres, spans = (np.ldexp(column, unit_of[:, None]) for column in (sizes, centres, spans))
        alpha, gamma, b, d = np.ascontiguousarray(sizes.T)
        pairs = _Pairs(alpha, gamma, b, d, centres, unit, upright)
        result = _to_walls(pairs, spans, np.ldexp(farthest, unit_of))
        for end in (0, 1):
            _to_discs(result, pairs, spans[:, end], solid)
        lower, upper = (
            _in_unit(length, unit_of, toward) for length, toward in ((result.lower, 0), (result.upper, np.inf))
        )
        return Gaps(lower, upper, np.ldexp(result.point, -unit_of[:, None]))


def gaps_at(sizes: Rows, centres: Rows, axes: Rows, points: Rows) -> tuple[Floats, Rows]:
    """Return the distances (n,) of spheroids from the points (n, 3) of walls at the height of some points.

    Also return those points of walls. The distances are upper bounds of the distances from the walls.
    """
    with np.errstate(all="ignore"):
        unit_of = _unit_of(sizes, centres)
        sizes, centres, points = (np.ldexp(column, unit_of[:, None]) for column in (sizes, centres, points))
        points = at_height(sizes, points, points[:, 2])
        distance, _ = from_spheroids(sizes[:, 2], sizes[:, 3], unit_vectors(axes), points - centres)
        return _in_unit(distance, unit_of, np.inf), np.ldexp(points, -unit_of[:, None])


def at_height(rows: Rows, point: Rows, height: Floats) -> Rows:
    """Return the points of the hyperboloids at these heights, in the half planes of some points."""
    share = rows[:, 0] * np.hypot(1, height / rows[:, 1]) / np.hypot(point[:, 0], point[:, 1])
    return np.stack([point[:, 0] * share, point[:, 1] * share, height], axis=1)


def _unit_of(sizes: Rows, centres: Rows) -> Indices:
    """Return exponents by which lengths become about 1 at most, as squares overflow."""
    return np.asarray(-np.frexp(np.maximum(np.abs(centres).max(axis=1), sizes[:, 2:].max(axis=1)))[1])


def _in_unit(length: Floats, unit_of: Indices, towards: float) -> Floats:
    """Return the lengths times 2^−unit_of, rounded towards a side where they are subnormal."""
    result = np.ldexp(length, -unit_of)
    back = np.ldexp(result, unit_of)
    return np.where((back > length) if towards == 0 else (back < length), np.nextafter(result, towards), result)


def _to_walls(pairs: _Pairs, spans: Rows, farthest: Floats) -> Gaps:
    """Return bounds of the distances from the walls, by branch and bound."""
    count = len(pairs.alpha)
    result = Gaps(np.zeros(count), np.full(count, np.inf), np.full((count, 3), np.nan))
    if not count:
        return result
    owner, cells = _first_cells(pairs, spans, farthest)
    most = np.zeros(count)
    np.maximum.at(most, owner, np.abs(cells[:, :2]).max(axis=1))
    size = _size(pairs, most)
    for _ in range(_ROUNDS):
        of = pairs.some(owner)
        normal = _try(result, of, owner, _middles(of, cells))
        bound, place = _least(of, cells, normal)
        _try(result, of, owner, place)
        floor = np.full(count, np.inf)
        np.minimum.at(floor, owner, bound)
        enough = result.upper - _NARROW * size  # what was dropped before is not nearer
        owners = np.unique(owner)
        result.lower[owners] = np.maximum(result.lower, np.minimum(floor, enough))[owners]
        few = np.bincount(owner, minlength=count) <= _MOST_CELLS
        keep = np.flatnonzero((bound < enough[owner]) & few[owner])
        if not len(keep):
            break
        owner, cells = _halved(of.some(keep), owner[keep], cells[keep])
    return result


def _first_cells(pairs: _Pairs, spans: Rows, farthest: Floats) -> tuple[Indices, Floats]:
    """Return the owner of each cell, and its ranges of w and φ, (m, 4).

    The cells cover every possible nearest point.
    """
    level, far = pairs.centre[:, 2], (farthest + np.maximum(pairs.b, pairs.d)) * (1 + _LOOSE)
    nearest = np.clip(level, *spans.T)
    low, high = np.maximum(spans[:, 0], level - far), np.minimum(spans[:, 1], level + far)
    low, high = np.minimum(low, nearest), np.maximum(high, nearest)
    edges = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, _FIRST + 1)
    edges[:, -1] = high
    turns = np.linspace(0, 2 * np.pi, _FIRST + 1)
    owners, cells = [], []
    for upright, around in ((True, np.zeros((1, 2))), (False, np.stack([turns[:-1], turns[1:]], axis=1))):
        of = np.flatnonzero(pairs.upright == upright)
        shape = (_FIRST, len(around), len(of))
        ends = (edges[of, :-1].T[:, None], edges[of, 1:].T[:, None], *around.T[:, None, :, None])
        cells.append(np.stack([np.broadcast_to(end, shape).ravel() for end in ends], axis=1))
        owners.append(np.tile(of, shape[0] * shape[1]))
    return np.concatenate(owners), np.concatenate(cells)


def _halved(of: _Pairs, owner: Indices, cells: Floats) -> tuple[Indices, Floats]:
    """Return two cells for each, cut across its longer side."""
    tall = (cells[:, 1] - cells[:, 0]) * np.hypot(1, of.alpha / of.gamma)
    wide = (cells[:, 3] - cells[:, 2]) * of.alpha * np.hypot(1, np.abs(cells[:, :2]).max(axis=1) / of.gamma)
    side = np.where(tall >= wide, 0, 2)
    row = np.arange(len(cells))
    middle = (cells[row, side] + cells[row, side + 1]) / 2
    first, second = cells.copy(), cells.copy()
    first[row, side + 1] = second[row, side] = middle
    return np.concatenate([owner, owner]), np.concatenate([first, second])


def _on_wall(of: _Pairs, w: Floats, turn: Floats) -> Floats:
    """Return the points (…, m, 3) at these heights: in the centre's meridian half plane, or on a ruling."""
    share = w / of.gamma
    if not of.upright.all():
        across, along = np.cos(turn) - share * np.sin(turn), np.sin(turn) + share * np.cos(turn)
    if of.upright.any():
        x, y = of.centre[:, 0], of.centre[:, 1]
        length, radius = np.hypot(x, y), np.hypot(1, share)
        cosine, sine = np.where(length > 0, x / length, 1.0), np.where(length > 0, y / length, 0.0)
        level, steep = radius * cosine, radius * sine
        if of.upright.all():
            across, along = level, steep
        else:
            across, along = np.where(of.upright, level, across), np.where(of.upright, steep, along)
    return np.stack(np.broadcast_arrays(of.alpha * across, of.alpha * along, w), axis=-1)


def _middles(of: _Pairs, cells: Floats) -> Floats:
    """Return the middle points of cells."""
    return _on_wall(of, (cells[:, 0] + cells[:, 1]) / 2, (cells[:, 2] + cells[:, 3]) / 2)


def _try(result: Gaps, of: _Pairs, owner: Indices, place: Floats) -> Floats:
    """Keep points that are nearer than the best so far; return the unit vectors from the spheroids to all points."""
    upper, normal = from_spheroids(of.b, of.d, of.axis, place - of.centre)
    best = np.full(len(result.upper), np.inf)
    np.minimum.at(best, owner, upper)
    better = best < result.upper
    winners = np.flatnonzero((upper == best[owner]) & better[owner])
    result.point[owner[winners]] = place[winners]
    result.upper[better] = best[better]
    return normal


def from_spheroids(b: Floats, d: Floats, axes: Rows, offset: Rows) -> tuple[Floats, Rows]:
    """Return distances of points, `offset` (n, 3) from the centres, from spheroids with unit axes (n, 3).

    Also return unit normals.
    """
    along = (axes * offset).sum(axis=1)
    across = offset - along[:, None] * axes
    off = np.sqrt((across * across).sum(axis=1))
    b2, d2, wide, tall = b * b, d * d, b * off, d * np.abs(along)
    beyond = np.maximum(np.maximum(wide - b2, tall - d2), 0)
    for _ in range(_TURNS):  # (b off/(b² + t))² + (d along/(d² + t))² = 1, from below
        p, q = b2 + beyond, d2 + beyond
        first, second = (wide / p) ** 2, (tall / q) ** 2
        step = np.fmax((first + second - 1) / (2 * (first / p + second / q)), 0)  # not NaN at a centre
        beyond = beyond + step
        if not (step > _SETTLED * beyond).any():
            break
    p, q = b2 + beyond, d2 + beyond
    share = np.maximum(np.hypot(wide / p, tall / q), 1)
    rest = across * (1 - b2 / p / share)[:, None] + axes * (along * (1 - d2 / q / share))[:, None]
    inside = np.hypot(off / b, along / d) <= 1
    normal = across / p[:, None] + axes * (along / q)[:, None]
    distance = np.where(inside, 0, np.sqrt((rest * rest).sum(axis=1)))
    return distance, np.asarray(normal / np.sqrt((normal * normal).sum(axis=1, keepdims=True)))


def _least(of: _Pairs, cells: Floats, normal: Floats) -> tuple[Floats, Floats]:
    """Return a lower bound of the distance in each cell (m,), and the point (m, 3) that has it along the normal."""
    heights = _heights(of, cells, normal)
    points = _on_wall(of, heights[:, None], _turns(of, cells, normal, heights))
    values = (normal * (points - of.centre)).sum(axis=-1).reshape(-1, len(cells))
    chosen = np.where(np.isnan(values), np.inf, values).argmin(axis=0), np.arange(len(cells))
    best, place = values[chosen], points.reshape(-1, len(cells), 3)[chosen]
    steep = (normal * of.axis).sum(axis=1)
    across = normal - steep[:, None] * of.axis  # 1 − steep² would lose what counts beside a flat spheroid
    flat = np.sqrt((across * across).sum(axis=1))
    bound = best - np.hypot(of.b * flat, of.d * steep) - _LOOSE * _size(of, np.abs(cells[:, :2]).max(axis=1))
    return np.where(np.isfinite(bound), bound, -np.inf), place


def _size(of: _Pairs, height: Floats) -> Floats:
    """Return the lengths in a bound: of the pair, and of points of the wall up to a height."""
    wall = height + of.alpha * np.hypot(1, height / of.gamma)
    return np.asarray(np.abs(of.centre).sum(axis=1) + of.b + of.d + wall)


def _heights(of: _Pairs, cells: Floats, normal: Floats) -> Floats:
    """Return heights (3, m) at one of which the normal's component is least in the cells."""
    x, y, (n_x, n_y, n_z) = of.centre[:, 0], of.centre[:, 1], normal.T
    length = np.hypot(x, y)
    outward = np.where(length > 0, (n_x * x + n_y * y) / length, n_x)
    slope = -n_z * of.gamma / (outward * of.alpha)
    flat = of.gamma * slope / np.sqrt(np.maximum(1 - slope * slope, 0))
    flat = np.where(of.upright & np.isfinite(flat), flat, cells[:, 0])
    return np.stack([cells[:, 0], cells[:, 1], np.clip(flat, cells[:, 0], cells[:, 1])])


def _turns(of: _Pairs, cells: Floats, normal: Floats, heights: Floats) -> Floats:
    """Return angles (3, 3, m), three at each height; beside an upright spheroid only one, which has no effect."""
    if of.upright.all():
        return cells[None, None, :, 2]
    (n_x, n_y, _), share = normal.T, heights / of.gamma
    lowest = np.arctan2(n_y - share * n_x, n_x + share * n_y) + np.pi
    lowest += 2 * np.pi * np.ceil((cells[:, 2] - lowest) / (2 * np.pi))
    ends = (np.broadcast_to(cells[:, column], lowest.shape) for column in (2, 3))
    return np.stack([*ends, np.clip(lowest, cells[:, 2], cells[:, 3])], axis=1)


def _to_discs(result: Gaps, pairs: _Pairs, end: Floats, solid: Mask) -> None:
    """Take end discs of those that are solid into account, except for their rims."""
    v, rise = pairs.axis, end - pairs.centre[:, 2]
    level = v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1]
    half = np.sqrt(pairs.b**2 * level + pairs.d**2 * v[:, 2] ** 2)
    offset = ((pairs.d**2 - pairs.b**2) * v[:, 2] / half)[:, None] * v[:, :2]
    across = pairs.centre[:, :2] + np.clip(rise / half, -1, 1)[:, None] * offset
    radius, off = pairs.alpha * np.hypot(1, end / pairs.gamma), np.hypot(*across.T)
    distance = np.maximum(np.abs(rise) - half, 0)
    loose = _LOOSE * (radius + off + np.abs(end) + np.abs(pairs.centre).sum(axis=1) + pairs.b + pairs.d)
    ends = solid & np.isfinite(end)
    above = ends & (off <= radius + loose)
    result.lower[above] = np.minimum(result.lower, np.maximum(distance - loose, 0))[above]
    better = ends & (off <= radius - loose) & (distance < result.upper)
    result.upper[better] = distance[better]
    result.point[better] = np.concatenate([across, end[:, None]], axis=1)[better]
