"""The nearest hyperboloid of a scene to the mover: proved bounds of the distances of all pairs, and the least one.

A pair's distance is that of clearance() for the rounded offset from the hyperboloid's centre to the mover's; each
coordinate of the offset is rounded by u of its size at most, which _ROUNDED of their sum holds. If one of two bodies is
moved, their distance changes by no more than that. Whether a pair is in contact is decided from the exact offset, as
Scene.position decides it: the upper bound is 0 in contact, and only there.

The distance to a whole hyperboloid is a lower bound of that to the wall between its ends; it is the same where the
nearest point lies between them. Else a point P at the near end gives an upper bound: with f the factor by which the
spheroid reaches P, its point on the way to P is (1 − 1/f) |P − C| away. An end disc is no nearer than its plane. For
pairs that may be the nearest by these bounds, scene_gaps.py then finds the distance to the real surface between the
ends, and so it does where clearance_bounds.py leaves bounds that are apart, as for a long mover in a groove.

**A tilted hyperboloid** is asked in a frame of its own, whose rows are a unit vector along its axis and two across.
So the offset is off by TURNING of its size, and the spheroid, by its axis, by TURNING of its longer semi-axis: both are
less than _ROUNDED of the coordinates, b and d. γ is not in that sum, for no length here is as long as γ where the
others are not: a point of the waist is |C| + α from the spheroid's centre C at most, so that neither the nearest point
nor an end plane that is nearer than the wall is farther away.

Pairs are left out by a cylinder around the hyperboloid: the mover is no nearer to the hyperboloid than to the cylinder.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, UPRIGHT, Position
from hypcheck.geometry.rows import PAIRS, Floats, Indices, Mask, Rows
from hypcheck.kernel.clearance_bounds import clearances_without_ends
from hypcheck.kernel.clearance_points import normals
from hypcheck.kernel.scene_gaps import at_height, gaps
from hypcheck.kernel.scene_index import OUTWARD, Bodies, frames_of, turned, turned_axes
from hypcheck.kernel.scene_pairs import along_and_across, positions
from hypcheck.scene.model import Mover

PAIRS_AT_A_TIME = 1 << 18
"""So many pairs are measured together."""

_ROUNDED = 2.0**-44
"""More than the error of a rounded offset, in units of the coordinates and sizes (above)."""
_APART = 2.0**-27
"""How far bounds may be apart, in units of the distance and the mover's size, before the gap is measured."""

_LEAST = 2.0**-1060
"""More than the roundings of subnormal numbers. It also keeps the upper bound of a mover that is clear above 0."""


@dataclass(frozen=True, slots=True)
class Nearest:
    """The result of Scene.nearest for n centres.

    `index` (n,): the number of the nearest hyperboloid in the scene's order, from 0. `tied` (n,): another one may be as
    near, as their distances are equal, both are in contact, or the bounds do not separate them. `contact` (n,):
    whether there is contact.
    `distance_lower` ≤ distance ≤ `distance_upper` (n,): the Euclidean distance from the mover to the nearest of all.
    `point` (n, 3): a point of that hyperboloid whose distance is `distance_upper` at most, except for its rounding; NaN
    where the centres are so far apart that their difference overflows, of which only contact is known. `normal`
    (n, 3): the unit vector from there to the mover, which is the gradient of the distance with respect to the centre;
    NaN in contact; its error has no proved bound. One centre has numbers, and vectors (3,).
    """

    index: Indices
    tied: Mask
    distance_lower: Floats
    distance_upper: Floats
    point: Floats
    normal: Floats

    @property
    def contact(self) -> Mask:
        """Whether the mover is in contact."""
        touching: Mask = self.distance_upper == 0  # of one centre True or False
        return touching


def first_of(result: Nearest) -> Nearest:
    """Return the result for the first centre, with numbers instead of arrays (n,)."""
    first = [getattr(result, part.name)[0] for part in fields(Nearest)]
    return Nearest(*(value if np.ndim(value) else value.item() for value in first))


def nearest(bodies: Bodies, mover: Mover, centres: Floats, axes: Floats | None) -> Nearest:
    """Return the nearest of all hyperboloids to a mover at centres (n, 3), with axes (n, 3); None: it is upright."""
    count, some = len(centres), max(1, PAIRS_AT_A_TIME // len(bodies.tall))
    result = Nearest(
        np.zeros(count, np.intp), np.zeros(count, np.bool_), np.full(count, np.inf), np.full(count, np.inf),
        np.full((count, 3), np.nan), np.full((count, 3), np.nan),
    )  # fmt: skip
    for start in range(0, count, some):
        _fill(result, bodies, mover, (centres, axes), np.arange(start, min(start + some, count)))
    result.normal[:] = _normals(result, mover, centres, axes)
    return result


def _normals(result: Nearest, mover: Mover, centres: Floats, axes: Floats | None) -> Floats:
    """Return the unit vectors from the points to movers at these centres, in the scene's coordinates."""
    rows = np.zeros((len(centres), len(TILTED_COLUMNS)))
    rows[:, 2:4], rows[:, 7:] = (mover.b, mover.d), UPRIGHT if axes is None else axes
    with np.errstate(over="ignore", invalid="ignore"):
        off = result.point - centres
    return normals(rows, off, np.where(result.contact | np.isnan(off).any(axis=1), 0, 1).astype(np.int8))


Movers = tuple[Floats, Floats | None]
"""Centres (n, 3) and axes (n, 3), None where the mover is upright."""


def _fill(result: Nearest, bodies: Bodies, mover: Mover, movers: Movers, places: Indices) -> None:
    """Fill in the result for some centres: from the one that seems nearest, then from all that may be nearer."""
    least = cylinder_bounds(bodies, slice(None), mover, [column[:, None] for column in movers[0][places].T])
    first = np.argmin(least, axis=1)
    _ask(result, bodies, mover, movers, places, first)
    query, body = np.nonzero(least <= result.distance_upper[places, None])
    others = body != first[query]
    _ask(result, bodies, mover, movers, places[query[others]], body[others])


def _ask(result: Nearest, bodies: Bodies, mover: Mover, movers: Movers, query: Indices, body: Indices) -> None:
    """Measure these pairs, and update the result: the nearest of each centre, its bounds, whether others may tie."""
    centres, axes = movers
    pairs = _pairs_of(bodies, mover, centres[query], None if axes is None else axes[query], body)
    low, high, point = _distances(pairs, query, result.distance_upper)
    _decide_contact(pairs, low, high)
    point = pairs.in_scene(point)
    order = np.argsort(high, kind="stable")
    best, first = np.unique(query[order], return_index=True)
    nearer = high[order][first] < result.distance_upper[best]
    known = np.isfinite(result.distance_upper)
    before = result.distance_lower.copy()
    chosen = order[first[nearer]]
    changed = query[chosen]
    result.index[changed], result.distance_upper[changed], result.point[changed] = (
        body[chosen],
        high[chosen],
        point[chosen],
    )
    np.minimum.at(result.distance_lower, query, low)
    reaching = np.zeros(len(centres), np.intp)
    np.add.at(reaching, query[low <= result.distance_upper[query]], 1)
    reaching[known & (before <= result.distance_upper)] += 1
    queries = np.unique(query)
    result.tied[queries] = reaching[queries] > 1


def distances(
    bodies: Bodies, mover: Mover, centres: Floats, axes: Floats | None, pairs: tuple[Indices, Indices], most: Floats
) -> tuple[Floats, Floats, Floats]:
    """Return bounds of the distances of movers from hyperboloids, and points of these for the upper bounds.

    `pairs` are the numbers of a group and of a hyperboloid, (n,) each, for the centres (n, 3). Only the least distance
    of each group is needed; `most` are upper bounds of it, by group, and bounds above that may be loose. Contact is not
    decided.
    """
    group, body = pairs
    made = _pairs_of(bodies, mover, centres, axes, body)
    low, high, point = _distances(made, group, most)
    return low, high, made.in_scene(point)


def _distances(pairs: _Pairs, group: Indices, most: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the same of prepared pairs, with the points in the hyperboloids' frames."""
    low, high, point, unsure = _to_wholes(pairs)
    most = most.copy()
    np.minimum.at(most, group, high)
    _to_what_stands(pairs, (low, high, point), np.flatnonzero(unsure & (low <= most[group]) & np.isfinite(high)))
    return low, high, point


def cylinder_bounds(
    bodies: Bodies, body: Indices | slice, mover: Mover, centre: Floats | Sequence[Floats], most: Floats | None = None
) -> Floats:
    """Return a lower bound of each distance, by a cylinder around the hyperboloid between its ends.

    `centre` are the mover's x, y, z in the scene: columns for the hyperboloids `body` (m,) of these, or (n, 1) for all
    pairs (n, m) of a place and one of them. With `most`, lengths for the pairs, the cylinder is no wider than the
    hyperboloid within them of the mover: where a bound is above one of these, the distance is above it too, but may be
    less than the bound. The height has an error, which counts α/γ times in the width there.
    """
    origins, (alpha, gamma), longest = bodies.origins[body], bodies.shapes[body].T, max(mover.b, mover.d)
    with np.errstate(all="ignore"):
        x, y, along = (part - here for part, here in zip(centre, origins.T, strict=True))
        across, error = np.hypot(x, y), np.zeros(along.shape)
        tilted = np.flatnonzero(bodies.tilted[body])
        if len(tilted):
            places = [np.broadcast_to(part, along.shape)[..., tilted] for part in centre]
            along[..., tilted], across[..., tilted], error[..., tilted] = along_and_across(
                places, origins[tilted].T, bodies.axes[body][tilted].T
            )
        low, high = bodies.spans[body].T
        beyond = np.maximum(np.maximum(along - high, low - along), 0)
        level, steep = bodies.tall[body], 0.0
        if most is not None:
            level, steep = np.minimum(level, np.abs(along) + longest + most), alpha / gamma
        wide = alpha * np.sqrt(1 + (level / gamma) ** 2) * OUTWARD
        size = sum(map(np.abs, centre)) + np.abs(origins).sum(axis=1)
        lost = _LEAST + (error + _ROUNDED * size) * (2 + steep) + _ROUNDED * wide
        least = np.hypot(np.maximum(across - wide, 0), beyond) * (1 - 2.0**-40) - longest - lost
        return np.asarray(np.where(np.isfinite(least), np.maximum(least, 0), 0))


@dataclass(frozen=True)
class _Pairs:
    """Movers beside hyperboloids, `body` (n,) of `bodies`: in the scene, and in frames of the hyperboloids.

    `rows` are those of clearance, in these frames; `rounded` (n,) bounds how far they are off. `beyond` (n,) are those
    whose difference of centres overflows: for them only contact is known.
    """

    bodies: Bodies
    body: Indices
    mover: Mover
    centres: Floats
    axes: Floats
    rows: Floats
    frames: Floats | None
    rounded: Floats
    beyond: Mask

    @property
    def spans(self) -> Floats:
        """The heights at which the hyperboloids end, (n, 2)."""
        return self.bodies.spans[self.body]

    @property
    def own_axes(self) -> Floats | None:
        """The movers' axes in the frames; None where all are upright there."""
        return self.rows[:, len(COLUMNS) :] if PAIRS.has_axis(self.rows) else None

    def in_scene(self, point: Floats) -> Floats:
        """Return points of the frames (n, 3) in the scene; NaN for those beyond."""
        turned_back = point if self.frames is None else turned(self.frames.transpose(0, 2, 1), point)
        return np.where(self.beyond[:, None], np.nan, turned_back + self.bodies.origins[self.body])


def _pairs_of(bodies: Bodies, mover: Mover, centres: Floats, axes: Floats | None, body: Indices) -> _Pairs:
    """Return movers at these centres beside hyperboloids, one each, in the hyperboloids' frames."""
    origins = bodies.origins[body]
    with np.errstate(over="ignore"):
        offset = centres - origins
    beyond = ~np.isfinite(offset).all(axis=1)
    offset[beyond] = 0.0
    frames = frames_of(bodies.axes[body]) if bodies.tilted.any() else None
    own_axes = axes
    if frames is not None:
        offset, own_axes = turned(frames, offset), turned_axes(frames, axes)
    sizes = np.concatenate([bodies.shapes[body], np.tile((mover.b, mover.d), (len(body), 1))], axis=1)
    rows = np.concatenate([sizes, offset] if own_axes is None else [sizes, offset, own_axes], axis=1)
    with np.errstate(all="ignore"):
        lengths = np.abs(centres).sum(axis=1) + np.abs(origins).sum(axis=1) + bodies.shapes[body, 0] + mover.b + mover.d
        rounded = _LEAST + _ROUNDED * lengths
    axes = np.broadcast_to(UPRIGHT, centres.shape) if axes is None else axes
    return _Pairs(bodies, body, mover, centres, axes, rows, frames, rounded, np.asarray(beyond))


def _to_wholes(pairs: _Pairs) -> tuple[Floats, Floats, Floats, Mask]:
    """Return bounds of the distances by those to whole hyperboloids, points for the upper ones, a mask of the rest."""
    rows, rounded, (bottom, top) = pairs.rows, pairs.rounded, pairs.spans.T
    wholes = clearances_without_ends(rows)
    with np.errstate(all="ignore"):
        low, high = np.maximum(wholes.distance_lower - rounded, 0), wholes.distance_upper + rounded
        point = wholes.nearest.copy()
        level, ended = point[:, 2], np.isfinite(pairs.spans).any(axis=1)
        solid = pairs.bodies.solid[pairs.body] & ended
        to_planes = np.nanmin(np.abs(rows[:, 6:7] - pairs.spans), axis=1) - rows[:, 2:4].max(axis=1) - rounded
        cut = ended & ~((level - rounded >= bottom) & (level + rounded <= top))
        cut |= solid & (to_planes < high)  # else its discs are farther than its wall
        low[solid] = np.minimum(low, np.maximum(to_planes, 0))[solid]
        some = np.flatnonzero(cut)
        at = at_height(rows[some], point[some], np.clip(level[some], bottom[some], top[some]))
        axes = pairs.own_axes
        point[some] = at
        high[some] = _reached(pairs.mover, None if axes is None else axes[some], at - rows[some, 4:7])
        steep = 1 + rows[some, 0] / rows[some, 1]
        high[some] += rounded[some] * steep + _ROUNDED * np.abs(at).sum(axis=1)
        apart = high - low > _APART * (high + rows[:, 2:4].max(axis=1)) + 4 * rounded
    low[pairs.beyond], high[pairs.beyond | np.isnan(high)] = 0.0, np.inf
    return low, high, point, cut | apart


def _to_what_stands(pairs: _Pairs, bounds: tuple[Floats, Floats, Floats], some: Indices) -> None:
    """Replace the bounds and points of some pairs by those of walls between their ends, and of end discs."""
    if not len(some):
        return
    low, high, point = bounds
    axes = pairs.own_axes
    measured = gaps(
        pairs.rows[some, :4], pairs.rows[some, 4:7], None if axes is None else axes[some],
        pairs.spans[some], pairs.bodies.solid[pairs.body[some]], high[some],
    )  # fmt: skip
    low[some] = np.fmax(low[some], measured.lower - pairs.rounded[some])
    upper = measured.upper + pairs.rounded[some] + _ROUNDED * np.abs(measured.point).sum(axis=1)
    better = upper < high[some]
    high[some[better]] = upper[better]
    point[some[better]] = measured.point[better]


def _decide_contact(pairs: _Pairs, low: Floats, high: Floats) -> None:
    """Decide contact exactly for pairs that bounds leave undecided: the upper bound is 0 only in contact."""
    some = np.flatnonzero((low == 0) | pairs.beyond)
    bodies, body, mover = pairs.bodies, pairs.body[some], pairs.mover
    found = positions(bodies, body, (mover.b, mover.d), pairs.centres[some], pairs.axes[some])
    high[some[found == Position.CONTACT]] = 0.0


def _reached(mover: Mover, axes: Floats | None, offset: Rows) -> Floats:
    """Return upper bounds of distances of movers with axes (n, 3) from points `offset` (n, 3) from their centres."""
    length = _length(offset)
    if axes is None:
        across, along = np.hypot(offset[:, 0], offset[:, 1]), offset[:, 2]
    else:
        unit = axes / np.abs(axes).max(axis=1, keepdims=True)
        unit /= _length(unit)[:, None]
        along, across = (unit * offset).sum(axis=1), _length(np.cross(unit, offset))
    reached: Floats = np.maximum(length * (1 - 1 / np.hypot(across / mover.b, along / mover.d)), 0)
    return reached


def _length(vectors: Rows) -> Floats:
    """Return the lengths of vectors (n, 3), whose squares may overflow."""
    length: Floats = np.hypot(np.hypot(vectors[:, 0], vectors[:, 1]), vectors[:, 2])
    return length
