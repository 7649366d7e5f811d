"""Which hyperboloid of a scene is nearest to the mover: distances of pairs between proved numbers, and the least.

A pair's distance is that of clearance.py for the rounded offset from the hyperboloid's centre to the mover's; each
coordinate of the offset is rounded by u of its size at most, which _ROUNDED of their sum holds.

A hyperboloid with a modelled height ends there. The distance to the endless one is a lower bound of that to the part
which stands; it is the same where the nearest point is on that part. Else a point P at the near end gives the upper
bound: with f the factor by which the spheroid reaches P, its point on the way to P is (1 − 1/f) |P − C| away.

Pairs are left out by the cylinder about the standing part: the mover is no nearer to the part than to the cylinder.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.pair import SIZES
from hypcheck.geometry.rows import Floats, Indices, Mask
from hypcheck.kernel.clearance import clearance
from hypcheck.kernel.scene_index import OUTWARD, Bodies
from hypcheck.scene.model import Mover, leans

PAIRS_AT_A_TIME = 1 << 18
_ROUNDED = 2.0**-44


@dataclass(frozen=True, slots=True)
class Nearest:
    """What Scene.nearest says of n centres.

    `index` (n,): the number of the nearest hyperboloid in the scene's order, from 0. `tied` (n,): another one may be as
    near, as their distances are equal, both are in contact, or the bounds do not tell them apart.
    `distance_lower` ≤ distance ≤ `distance_upper` (n,): the Euclidean distance from the mover to the nearest of all.
    `point` (n, 3): a point of that hyperboloid whose distance is `distance_upper` at most, but for its rounding.
    """

    index: Indices
    tied: Mask
    distance_lower: Floats
    distance_upper: Floats
    point: Floats


def nearest(bodies: Bodies, mover: Mover, centres: Floats) -> Nearest:
    """The nearest of upright hyperboloids to a mover whose axis is fixed, at centres (n, 3)."""
    count, some = len(centres), max(1, PAIRS_AT_A_TIME // len(bodies.tall))
    found = Nearest(
        np.zeros(count, np.intp), np.zeros(count, np.bool_), np.full(count, np.inf), np.full(count, np.inf),
        np.full((count, 3), np.nan),
    )  # fmt: skip
    for start in range(0, count, some):
        _fill(found, bodies, mover, centres, np.arange(start, min(start + some, count)))
    return found


def _fill(found: Nearest, bodies: Bodies, mover: Mover, centres: Floats, places: Indices) -> None:
    least = _cylinders(bodies, mover, centres[places])
    first = np.argmin(least, axis=1)
    _ask(found, bodies, mover, centres, places, first)
    query, body = np.nonzero(least <= found.distance_upper[places, None])
    others = body != first[query]
    _ask(found, bodies, mover, centres, places[query[others]], body[others])


def _ask(found: Nearest, bodies: Bodies, mover: Mover, centres: Floats, query: Indices, body: Indices) -> None:
    """Take these pairs into account: each centre's with the least upper bound, and whether others may be as near."""
    low, high, point = _distances(bodies, mover, centres[query], body)
    order = np.argsort(high, kind="stable")
    best, first = np.unique(query[order], return_index=True)
    nearer = high[order][first] < found.distance_upper[best]
    known = np.isfinite(found.distance_upper)
    before = found.distance_lower.copy()
    chosen = order[first[nearer]]
    changed = query[chosen]
    found.index[changed], found.distance_upper[changed], found.point[changed] = (
        body[chosen],
        high[chosen],
        point[chosen],
    )
    np.minimum.at(found.distance_lower, query, low)
    reaching = np.zeros(len(centres), np.intp)
    np.add.at(reaching, query[low <= found.distance_upper[query]], 1)
    reaching[known & (before <= found.distance_upper)] += 1
    asked = np.unique(query)
    found.tied[asked] = reaching[asked] > 1


def _cylinders(bodies: Bodies, mover: Mover, centres: Floats) -> Floats:
    """A lower bound of each distance, (n, m), by the cylinder about the standing part; inf where nothing stands."""
    with np.errstate(all="ignore"):
        across = np.hypot(*(centres[:, k, None] - bodies.origins[:, k] for k in (0, 1)))
        wide = bodies.shapes[:, 0] * np.sqrt(1 + (bodies.tall / bodies.shapes[:, 1]) ** 2) * OUTWARD
        beside = np.maximum(across - wide * OUTWARD, 0)
        low, high = bodies.heights.T
        beyond = np.maximum(np.maximum(centres[:, 2, None] - high, low - centres[:, 2, None]), 0)
        least = np.hypot(beside, beyond) * (1 - 2.0**-40) - max(mover.b, mover.d) - _ROUNDED * (across + wide)
        least = np.where(np.isfinite(least), np.maximum(least, 0), 0)
        return np.asarray(np.where(low <= high, least, np.inf))


def _distances(bodies: Bodies, mover: Mover, centres: Floats, body: Indices) -> tuple[Floats, Floats, Floats]:
    """Lower and upper bounds of the distances of pairs, and a point that proves each upper one."""
    origins = bodies.origins[body]
    offset = centres - origins
    lean = leans(mover.axis)
    rows = np.empty((len(body), 10 if lean else 7))
    rows[:, : len(SIZES)] = np.concatenate([bodies.shapes[body], np.tile((mover.b, mover.d), (len(body), 1))], axis=1)
    rows[:, 4:7] = offset
    if lean:
        rows[:, 7:] = mover.axis
    said = clearance(rows)
    with np.errstate(all="ignore"):
        rounded = _ROUNDED * (np.abs(centres).sum(axis=1) + np.abs(origins).sum(axis=1) + rows[:, :4].sum(axis=1))
        low = np.maximum(said.distance_lower - rounded, 0)
        low = np.where(said.position == 0, 0, low)
        high = said.distance_upper + np.where(said.position == 0, 0, rounded)
        point, bottom, top = said.nearest.copy(), *bodies.heights[body].T
        level = point[:, 2] + origins[:, 2]
        cut = np.flatnonzero(~((level - rounded >= bottom) & (level + rounded <= top)) & np.isfinite(bodies.tall[body]))
        standing = np.clip(level[cut], bottom[cut], top[cut]) - origins[cut, 2]
        radius = rows[cut, 0] * np.sqrt(1 + (standing / rows[cut, 1]) ** 2) / np.hypot(point[cut, 0], point[cut, 1])
        point[cut] = np.stack([point[cut, 0] * radius, point[cut, 1] * radius, standing], axis=1)
        way = point[cut] - offset[cut]
        length = np.sqrt((way * way).sum(axis=1))
        reached = length - min(mover.b, mover.d)
        if not lean:
            share = np.hypot(np.hypot(way[:, 0], way[:, 1]) / mover.b, way[:, 2] / mover.d)
            reached = length * (1 - 1 / share)
        high[cut] = np.maximum(reached, 0) + rounded[cut]
    empty = bottom > top
    return np.where(empty, np.inf, low), np.where(empty, np.inf, high), point + origins
