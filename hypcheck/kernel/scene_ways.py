"""Straight ways of a mover beside hyperboloids of a scene: which are near, and exactly whether contact is on the way.

**Which are near.** A way is cut into pieces no longer than a cell of the grid (scene_index.py), and the hyperboloids of
all cells that the box of a piece overlaps are candidates. Those whose axis the way passes beyond their reach are left
out. Floats carry both: a piece's end is off by three roundings of both ends' coordinates; the distance from an axis at
any time in [0, 1] is not below the least distance, and the one that is taken is off by 4u of all coordinates. PAD,
2⁻⁴⁵ of their sum, is far more than either; LEAST covers what underflows.

**Whether contact is on it.** The kernel's answer about ways (core/parts/ways.h) is asked twice: about a spheroid that
is larger, and about one that is smaller, by what the rounding of the difference of two centres may be in radii, as in
scene_pairs.py. The larger one clear is clear, the smaller one in contact is contact. What is left is decided from the
exact differences by truth/swept.py. Nowhere else does the kernel ask that room: no other exact decision about ways is
known. So is a way that may hit, and leaves the modelled height: of it the part at that height counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import inf

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.kernel.classify import kernel
from hypcheck.kernel.scene_index import Bodies, PlaneGrid
from hypcheck.kernel.scene_pairs import GREATEST, LEAST, MARGIN, ROUNDED
from hypcheck.scene.model import Mover, Point
from hypcheck.truth.swept import Passage, passage

PAD = 2.0**-45
MOST_PIECES = 256
"""A way of more pieces is looked up alone, among all hyperboloids."""

AT_A_TIME = 1 << 15
"""Pieces whose hyperboloids are looked up together, so that arrays stay in the cache."""


def pieces_of(grid: PlaneGrid, starts: Rows, ends: Rows) -> Indices:
    """How many pieces each way, (n, 3), is cut into; 0 for one that is to be looked up alone."""
    change = np.abs(ends - starts)
    pieces = np.ceil(np.maximum(change[:, 0], change[:, 1]) / grid.side)
    return np.where(pieces <= MOST_PIECES, np.maximum(pieces, 1), 0).astype(np.int64)


def in_batches(grid: PlaneGrid, pieces: Indices) -> list[slice]:
    """Consecutive ways, of these numbers of pieces, that are few enough to be looked up together."""
    batch = np.cumsum(pieces + len(grid.everywhere)) // AT_A_TIME
    bounds = [0, *(np.flatnonzero(np.diff(batch)) + 1).tolist(), len(pieces)]
    return [slice(first, last) for first, last in pairwise(bounds)]


def near_ways(grid: PlaneGrid, starts: Rows, ends: Rows, pieces: Indices) -> tuple[Indices, Indices]:
    """The hyperboloids that may be near ways (n, 3) with pieces: pairs of a way's number and a hyperboloid's."""
    cut = np.flatnonzero(pieces)
    way = np.repeat(cut, pieces[cut])
    here, there = starts[way, :2], ends[way, :2]
    pad = PAD * (np.abs(here) + np.abs(there))
    if len(way) > len(cut):
        number = np.arange(len(way)) - np.repeat(np.cumsum(pieces[cut]) - pieces[cut], pieces[cut])
        change, parts = there - here, pieces[way][:, None]
        here, there = here + change * (number[:, None] / parts), here + change * ((number[:, None] + 1) / parts)
    piece, body = grid.near_boxes(np.minimum(here, there) - pad, np.maximum(here, there) + pad)
    always = np.array(grid.everywhere, np.int64)
    return (
        np.concatenate([way[piece], np.repeat(cut, len(always))]),
        np.concatenate([body, np.tile(always, len(cut))]),
    )


def passed(starts: Rows, ends: Rows, query: Indices, origins: Rows, reaches: Floats) -> Mask:
    """Whether a way, `query` (m,) of those (n, 3), comes as near to an axis, at (m, 3), as the hyperboloid reaches."""
    x, y, x_end, y_end = starts[query, 0], starts[query, 1], ends[query, 0], ends[query, 1]
    u, v = origins[:, 0], origins[:, 1]
    pad = PAD * sum(map(np.abs, (x, y, x_end, y_end, u, v)), start=0.0) + LEAST
    across, along = x_end - x, y_end - y
    u, v = u - x, v - y
    length = across * across + along * along
    time = (across * u + along * v) / length
    time = np.where(time > 0, np.minimum(time, 1.0), 0.0)
    u, v, most = u - time * across, v - time * along, reaches * (1 + MARGIN) + pad
    return np.asarray(~((u * u + v * v > most * most) & (length < GREATEST)))


def hits_beside(bodies: Bodies, body: Indices, mover: Mover, axis: Point | None, starts: Rows, ends: Rows) -> Mask:
    """Which ways of a mover have contact with their hyperboloid, where it is modelled, (n,); `axis` where it leans.

    `starts` and `ends`, (n, 3), are in the scene's coordinates; each way is at some time at a modelled height.
    """
    origins, shapes = bodies.origins[body], bodies.shapes[body]
    low, high = np.minimum(starts[:, 2], ends[:, 2]), np.maximum(starts[:, 2], ends[:, 2])
    leaves = (low < bodies.heights[body, 0]) | (high > bodies.heights[body, 1])
    radii, leaning = (mover.b, mover.d), np.empty((len(body), 0))
    if axis is not None:
        leaning = np.broadcast_to(axis, (len(body), 3))
    with np.errstate(all="ignore"):
        (start, lost_start), (end, lost_end) = two_sum(starts, -origins), two_sum(ends, -origins)
        lost = np.maximum(np.abs(lost_start), np.abs(lost_end)).sum(axis=1)
        stretch = np.where(lost == 0, 0.0, lost / min(radii) * (1 + MARGIN) + ROUNDED)
        larger, smaller = np.outer(1 + stretch, radii), np.outer(1 - stretch, radii)
        fits = lost < GREATEST  # NaN where a difference overflows
        fits &= (smaller > LEAST).all(axis=1) & (larger < GREATEST).all(axis=1)
    hits = np.zeros(len(body), np.bool_)
    open_ways = ~fits
    asked = np.flatnonzero(fits)
    said = kernel().answer_ways(np.concatenate([shapes, larger, start, end, leaning], axis=1)[asked])[0]
    asked = asked[said != 0]
    said = kernel().answer_ways(np.concatenate([shapes, smaller, start, end, leaning], axis=1)[asked])[0]
    hits[asked] = said == 1
    open_ways[asked] = (said != 1) | leaves[asked]
    for index in np.flatnonzero(open_ways).tolist():
        sizes = (*shapes[index].tolist(), mover.b, mover.d)
        ends_of = (starts[index].tolist(), ends[index].tolist())
        hits[index] = exact_way(sizes, *ends_of, origins[index].tolist(), bodies.spans[body[index]].tolist(), axis).hit
    return hits


def exact_way(
    sizes: Sequence[float],
    start: Sequence[float],
    end: Sequence[float],
    origin: Sequence[float],
    span: Sequence[float],
    axis: Point | None,
) -> Passage:
    """What happens on the part of a way that is within the span of heights above the origin; there is such a part."""
    here, there = (
        [Fraction(each) - Fraction(centre) for each, centre in zip(point, origin, strict=True)]
        for point in (start, end)
    )
    change = [after - before for before, after in zip(here, there, strict=True)]
    first, last = Fraction(0), Fraction(1)
    if change[2]:
        at = [None if abs(height) == inf else (Fraction(height) - here[2]) / change[2] for height in span]
        enters, leaves = at if change[2] > 0 else reversed(at)
        first = first if enters is None else max(first, enters)
        last = last if leaves is None else min(last, leaves)
    centres = [[before + time * by for before, by in zip(here, change, strict=True)] for time in (first, last)]
    return passage(sizes, centres[0], centres[1], axis)


def all_parts_are_clear(
    bodies: Bodies, index: int, mover: Mover, start: Sequence[Sequence[float]], end: Sequence[Sequence[float]]
) -> bool:
    """Whether the mover's parts, each on the way between its own places, stay clear on one and the same side."""
    found: set[Position] = set()
    shape, origin, span = (each[index].tolist() for each in (bodies.shapes, bodies.origins, bodies.spans))
    for part, here, there in zip(mover.parts, start, end, strict=True):
        way = exact_way((*shape, part.b, part.d), here, there, origin, span, None)
        found.add(Position.CONTACT if way.hit else way.start)
    return len(found) == 1 and Position.CONTACT not in found
