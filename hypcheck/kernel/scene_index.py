"""The scene index (broad phase): hyperboloids as columns, how far each reaches, and a grid over the plane.

Beyond its reach from a hyperboloid's axis a mover is exterior without a test. A spheroid at height z occupies
heights z − d … z + d and reaches b from its centre. The surface is nowhere wider in that range than
ρ = α √(1 + ((|z| + d)/γ)²), so a centre farther than ρ + b from the axis touches nothing and is outside. That is formed
in floats with eight roundings at most, on positive terms: OUTWARD, far more than 8u, covers them, and the rounding of a
distance that is compared with it; LEAST covers what underflows.

A tilted spheroid lies in the ball of its longer semi-axis r, which takes the place of b and d. A hyperboloid that is
tilted and ends h from its centre lies in the ball of radius √(h² + ρ²) about that, with ρ = α √(1 + (h/γ)²); a mover
that touches it is at most r farther away. Each cell of the grid has the hyperboloids that can be touched from within
it. Cells share the places of a table by a hash (Teschner et al. 2003, "Optimized spatial hashing for collision
detection"): a hyperboloid from another cell may share the place, which costs a useless test, but none is left out. A
hyperboloid that reaches over too many cells, or has no end, is stored separately and always tested: for example one
tower among many trees.

**Sweeps.** A sweep is cut into pieces no longer than a cell of the grid, and the hyperboloids of all cells that
the box of a piece overlaps are candidates. Those whose axis the sweep passes beyond their reach are left out. Floats
carry both: a piece's end is off by three roundings of both ends' coordinates; the distance from an axis at any time in
[0, 1] is not below the least distance, and the one that is taken is off by 4u of all coordinates. PAD, 2⁻⁴⁵ of their
sum, is far more than either; LEAST_OF_SWEEPS covers what underflows.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import ceil, floor, inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.scene.model import UPRIGHT, Hyperboloid, Mover, Point, Span, is_tilted


@dataclass(frozen=True)
class Bodies:
    """The m hyperboloids of a scene in columns: `shapes` are α and γ (m, 2), `origins` are their centres (m, 3).

    `spans` (m, 2) are the heights along the `axes` (m, 3), relative to the centres, between which they exist; `tall`
    (m,) is the farther one's distance from the centre. `solid` (m,) says that flat ends belong to them. `heights` (m,
    2) enclose the z that a hyperboloid occupies in the scene: within a rounding if it is upright, −inf and inf if it is
    tilted. A vertical axis points up.
    """

    shapes: Floats
    origins: Floats
    tall: Floats
    heights: Floats
    spans: Floats
    axes: Floats
    solid: Mask

    @cached_property
    def tilted(self) -> Mask:
        """A mask of the tilted hyperboloids, (m,)."""
        return np.asarray((self.axes[:, :2] != 0).any(axis=1))

    def one(self, index: int) -> BodyNumbers:
        """Return the numbers of one hyperboloid."""
        columns = (self.shapes, self.origins, self.axes, self.spans)
        shape, origin, axis, span = (tuple(column[index].tolist()) for column in columns)
        return BodyNumbers(shape, origin, axis, span, bool(self.solid[index]))


class BodyNumbers(NamedTuple):
    """The numbers of one hyperboloid, as Bodies has them in columns; `shape` are α and γ."""

    shape: tuple[float, float]
    origin: Point
    axis: Point
    span: tuple[float, float]
    solid: bool


def bodies_of(hyperboloids: Sequence[Hyperboloid]) -> Bodies:
    """Return the columns of these hyperboloids."""
    table = np.fromiter((number for body in hyperboloids for number in _numbers(body)), np.float64).reshape(-1, 11)
    origins, relative, axes, solid = table[:, 2:5], table[:, 5:7], table[:, 7:10], table[:, 10] != 0
    vertical = (axes[:, :2] == 0).all(axis=1)
    down = vertical & (axes[:, 2] < 0)
    relative[down] = -relative[down, ::-1]
    axes[vertical & (axes[:, 2] != 0) & np.isfinite(axes[:, 2])] = UPRIGHT
    with np.errstate(all="ignore"):
        ends, lost = two_sum(origins[:, 2:], relative)
    heights = np.where(lost == 0, ends, np.nextafter(ends, (-inf, inf)))  # what was lost is NaN where a sum overflowed
    heights[~vertical] = -inf, inf
    return Bodies(table[:, :2], origins, np.abs(relative).max(axis=1), heights, relative, axes, solid)


def _numbers(body: Hyperboloid) -> tuple[float, ...]:
    """Return the eleven numbers of a hyperboloid; without ends its heights are −inf and inf."""
    low, high = (-inf, inf) if body.height is None else (body.height.low, body.height.high)
    return (body.alpha, body.gamma, *body.center, low, high, *body.axis, body.solid)


TURNING = 128 * 2.0**-53
"""The error of a vector that is turned into a hyperboloid's frame, in units of the sum of coordinates (frames_of)."""


def frames_of(axes: Floats) -> Floats:
    """Return frames (n, 3, 3): the rows are two unit vectors across an axis and one along it; I where that is vertical.

    The numbers of the first two rows are within 6 u of those of an exact frame, so that those of their cross product
    are within 20 u. With three products and two sums in floats, each number of a turned vector is off by 24 u of the
    sum of the vector's numbers, and the vector by √3 times that; an axis, of which that sum is √3 lengths at most, by
    an angle of 72 u. TURNING is more than all of these.
    """
    frames = np.tile(np.eye(3), (len(axes), 1, 1))
    tilted = np.flatnonzero((axes[:, :2] != 0).any(axis=1))
    along = axes[tilted] / np.abs(axes[tilted]).max(axis=1, keepdims=True)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    least = np.eye(3)[np.abs(along).argmin(axis=1)]  # the coordinate axis that is farthest from it
    across = np.cross(least, along)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    frames[tilted] = np.stack([across, np.cross(along, across), along], axis=1)
    return frames


def turned(frames: Floats, vectors: Floats) -> Floats:
    """Return vectors (n, 3) in frames (n, 3, 3)."""
    result: Floats = np.einsum("nij,nj->ni", frames, vectors)
    return result


def turned_axes(frames: Floats, axes: Floats | None) -> Floats:
    """Return the axes (n, 3) of a mover in frames; None means that it is upright.

    They are made about 1 long, so that none is rounded to 0.
    """
    if axes is None:
        return turned(frames, np.broadcast_to(UPRIGHT, (len(frames), 3)))
    return turned(frames, axes / np.abs(axes).max(axis=1, keepdims=True))


OUTWARD = 1 + 2.0**-40
LEAST = 2.0**-1000
"""A reach is multiplied by OUTWARD, and LEAST is added, so that no rounding makes it too short (above)."""


def reaches(bodies: Bodies, mover: Mover, height: Span | None) -> Floats:
    """Return the reach of each hyperboloid for centres in this span of the scene's z, (m,).

    It is inf where they have no end.
    """
    level = bodies.origins[:, 2]
    longest = max(mover.b, mover.d)
    b, d = (longest, longest) if is_tilted(mover.axis) else (mover.b, mover.d)
    with np.errstate(all="ignore"):
        most = np.full(len(level), np.inf)
        if height is not None:
            most = np.maximum(np.abs(height.low - level), np.abs(height.high - level)) * OUTWARD
        far = _farthest(bodies, np.minimum(most, bodies.tall * OUTWARD), b, d)
        if bodies.tilted.any():
            tall = bodies.tall * OUTWARD
            far[bodies.tilted] = (np.hypot(tall, _farthest(bodies, tall, 0.0, 0.0)) + longest)[bodies.tilted]
        return np.asarray(far * OUTWARD + LEAST)


def _farthest(bodies: Bodies, height: Floats, b: float, d: float) -> Floats:
    """Return the greatest distance from each axis at which a spheroid at this height can be in contact."""
    share = (height + d) / bodies.shapes[:, 1]
    return np.asarray(bodies.shapes[:, 0] * np.sqrt(1 + share * share) + b)


def in_reach(bodies: Bodies, mover: Mover, centre: tuple[float, float, float]) -> NDArray[np.int64]:
    """Return the hyperboloids that a mover at this very place can touch."""
    x, y, z = centre
    far = reaches(bodies, mover, Span(z, z))
    with np.errstate(all="ignore"):
        distance = np.hypot(x - bodies.origins[:, 0], y - bodies.origins[:, 1])
    return np.flatnonzero(~(distance > far))


MOST_CELLS = 64
"""The most cells that one hyperboloid may occupy; a hyperboloid in more cells is always tested."""

WIDEST = 2**30
"""Cells are numbered from −WIDEST to WIDEST on either axis; hyperboloids farther out are always tested."""

ROOM = 2
"""The table has at least so many places for each entry."""

ACROSS, ALONG = 73856093, 19349663
"""The primes of the hash; a cell's number times one of them is below 2^57."""


@dataclass(frozen=True)
class PlaneGrid:
    """A grid of square cells over the plane, as wide as `side`, in a table whose size is a power of two.

    Place p of the table holds the hyperboloids `members[starts[p]:starts[p + 1]]`. `everywhere` are the hyperboloids
    that are tested for every centre.
    """

    side: float
    starts: array[int]
    members: array[int]
    everywhere: list[int]

    def near(self, x: float, y: float) -> Sequence[int]:
        """Return the hyperboloids that a mover with its centre at (x, y) can touch, and perhaps others."""
        across, along = x / self.side, y / self.side
        if not (-WIDEST < across < WIDEST and -WIDEST < along < WIDEST):
            return self.everywhere
        place = (floor(across) * ACROSS ^ floor(along) * ALONG) & (len(self.starts) - 2)
        inside = self.members[self.starts[place] : self.starts[place + 1]]
        return [*self.everywhere, *inside] if self.everywhere else inside

    def near_each(self, x: Floats, y: Floats) -> tuple[Indices, Indices]:
        """As near, for many centres (n,): pairs of a centre's number and a hyperboloid's, centre by centre."""
        with np.errstate(over="ignore"):
            cells = np.floor(np.stack([x, y]) / self.side)
        inside = np.flatnonzero((np.abs(cells) < WIDEST).all(axis=0))
        column, row = cells[:, inside].astype(np.int64)
        cell, member = self._members_of(column, row)
        always = np.tile(np.array(self.everywhere, np.int64), len(x))
        return (
            np.concatenate([inside[cell], np.repeat(np.arange(len(x)), len(self.everywhere))]),
            np.concatenate([member, always]),
        )

    def near_sweep(self, x: float, y: float, x_end: float, y_end: float) -> set[int] | None:
        """Return the hyperboloids that may be near a sweep.

        Return None if it is too long or too far out for a quick look-up.
        """
        pad_x, pad_y = PAD * (abs(x) + abs(x_end)), PAD * (abs(y) + abs(y_end))
        across, along = x_end - x, y_end - y
        count = max(abs(across), abs(along)) / self.side
        if not (count <= MOST_AT_ONCE and max(pad_x, pad_y) <= self.side):
            return None
        pieces, near = max(ceil(count), 1), set(self.everywhere)
        for piece in range(pieces):
            here, there = piece / pieces, (piece + 1) / pieces
            (low_x, high_x), (low_y, high_y) = (
                sorted((x + across * here, x + across * there)),
                sorted((y + along * here, y + along * there)),
            )
            columns = range(floor((low_x - pad_x) / self.side), floor((high_x + pad_x) / self.side) + 1)
            rows = range(floor((low_y - pad_y) / self.side), floor((high_y + pad_y) / self.side) + 1)
            for column in columns:
                for row in rows:
                    place = (column * ACROSS ^ row * ALONG) & (len(self.starts) - 2)
                    near.update(self.members[self.starts[place] : self.starts[place + 1]])
        return near

    def near_boxes(self, low: Floats, high: Floats) -> tuple[Indices, Indices]:
        """Return the hyperboloids in all cells that boxes overlap, without those in every cell: pairs of numbers.

        `low` and `high` are the boxes' corners, (n, 2); a pair may come several times.
        """
        first, last = (np.floor(np.clip(corner / self.side, -WIDEST, WIDEST)) for corner in (low, high))
        column, row, box = _entries(first[:, 0], last[:, 0], first[:, 1], last[:, 1], np.arange(len(low)))
        cell, member = self._members_of(column, row)
        return box[cell], member

    def _members_of(self, column: Indices, row: Indices) -> tuple[Indices, Indices]:
        """Return the content of cells: pairs of a cell's number among these (n,) and a hyperboloid's, cell by cell."""
        place = hashed(column, row, len(self.starts) - 1)
        starts, members = np.frombuffer(self.starts, np.intc), np.frombuffer(self.members, np.intc)
        first = starts[place].astype(np.int64)
        counts = starts[place + 1] - first
        member = members[np.repeat(first, counts) + _counted(counts)]
        return np.repeat(np.arange(len(place)), counts), member.astype(np.int64)


def _counted(counts: Indices) -> Indices:
    """Return 0, 1, 2, … for each of the counts, one after the other."""
    return np.asarray(np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts))


def grid_of(x: Floats, y: Floats, reaches: Floats) -> PlaneGrid:
    """Return the grid of hyperboloids at (x, y) with these reaches, (m,) each; its cells are as wide as most reach."""
    finite = reaches[np.isfinite(reaches)]
    with np.errstate(over="ignore"):  # one cell that holds everything
        side = float(2 * np.median(finite)) if len(finite) else 1.0
    columns, rows, members, everywhere = _cells_of(x, y, reaches, side)
    size = 1 << (ROOM * len(members)).bit_length()
    places = hashed(columns, rows, size)
    order = np.lexsort((members, places))
    places, members = places[order], members[order]
    again = np.append(False, (np.diff(places) == 0) & (np.diff(members) == 0))[: len(places)]
    places, members = places[~again], members[~again]
    starts = np.searchsorted(places, np.arange(size + 1))
    return PlaneGrid(side, packed(starts), packed(members), everywhere)


def cells_of(x: Floats, y: Floats, reaches: Floats, side: float) -> tuple[Indices, Indices, list[int]]:
    """Return columns and rows of the cells that hyperboloids at (x, y) occupy, and which occupy too many cells."""
    columns, rows, _, everywhere = _cells_of(x, y, reaches, side)
    return columns, rows, everywhere


def _cells_of(x: Floats, y: Floats, reaches: Floats, side: float) -> tuple[Indices, Indices, Indices, list[int]]:
    """Return columns and rows of the occupied cells, the hyperboloid of each, and which occupy too many cells."""
    with np.errstate(all="ignore"):
        low_x, high_x, low_y, high_y = (
            np.floor((centre + sign * reaches) / side) for centre in (x, y) for sign in (-1.0, 1.0)
        )
        few = (high_x - low_x + 1) * (high_y - low_y + 1) <= MOST_CELLS
        few &= (np.abs(np.stack([low_x, high_x, low_y, high_y])) < WIDEST).all(axis=0)
    return *_entries(low_x, high_x, low_y, high_y, np.flatnonzero(few)), np.flatnonzero(~few).tolist()


def _entries(
    low_x: Floats, high_x: Floats, low_y: Floats, high_y: Floats, chosen: Indices
) -> tuple[Indices, Indices, Indices]:
    """Return column, row and hyperboloid for each cell that a chosen hyperboloid occupies."""
    across = (high_x[chosen] - low_x[chosen]).astype(np.int64) + 1
    along = (high_y[chosen] - low_y[chosen]).astype(np.int64) + 1
    counts = across * along
    place = _counted(counts)
    wide = np.repeat(across, counts)
    column = np.repeat(low_x[chosen].astype(np.int64), counts) + place % wide
    row = np.repeat(low_y[chosen].astype(np.int64), counts) + place // wide
    return column, row, np.repeat(chosen, counts)


def hashed(column: Indices, row: Indices, size: int) -> Indices:
    """Return the places of cells in a table of that size."""
    return np.asarray((column * ACROSS ^ row * ALONG) & (size - 1))


def packed(numbers: NDArray[np.integer[Any]]) -> array[int]:
    """Return the numbers as an array that Python indexes without making numpy's scalars of them."""
    return array("i", numbers.astype(np.intc).tobytes())


PAD = 2.0**-45
LEAST_OF_SWEEPS, LONGEST_SQUARE = 2.0**-200, 2.0**200
"""Squares of lengths above LEAST_OF_SWEEPS do not underflow. A sweep whose length squared is above LONGEST_SQUARE
counts as near every hyperboloid."""

MOST_AT_ONCE = 16
"""A sweep of at most so many pieces is looked up without arrays."""

MOST_PIECES = 256
"""A sweep of more pieces is looked up alone, among all hyperboloids."""

AT_A_TIME = 1 << 15
"""So many pieces are looked up together, so that arrays stay in the cache."""


def near_sweeps(
    bodies: Bodies, mover: Mover, region: Span | None, grid: PlaneGrid, reach: Floats, starts: Rows, ends: Rows
) -> tuple[Indices, Indices]:
    """Return the hyperboloids to test for sweeps (n, 3): sorted pairs of a sweep's and a hyperboloid's number.

    `grid` and `reach` are those of the bodies for centres in this span of z.
    """
    low, high = np.minimum(starts[:, 2], ends[:, 2]), np.maximum(starts[:, 2], ends[:, 2])
    kept = []

    def take(sweep: Indices, body: Indices, far: Floats) -> None:
        keep = np.flatnonzero(passed(starts, ends, sweep, bodies.origins[body], far))
        kept.append((sweep[keep], body[keep]))

    with np.errstate(all="ignore"):
        pieces = _pieces_of(grid, starts, ends)
        if region is not None:  # beyond it the grid promises nothing
            pieces[(low < region.low) | (high > region.high)] = 0
        for some in in_batches(grid, pieces):
            sweep, body = _beside_pieces(grid, starts[some], ends[some], pieces[some])
            take(sweep + some.start, body, reach[body])
        for alone in np.flatnonzero(pieces == 0).tolist():
            far = reaches(bodies, mover, Span(float(low[alone]), float(high[alone])))
            take(np.full(len(far), alone), np.arange(len(far)), far)
    sweep, body = (np.concatenate(column) for column in zip(*kept, strict=True))
    with np.errstate(all="ignore"):
        reach = max(mover.b, mover.d) * OUTWARD + PAD * (np.abs(low) + np.abs(high))
        keep = (high + reach)[sweep] >= bodies.heights[body, 0]
        keep &= (low - reach)[sweep] <= bodies.heights[body, 1]
    pairs = np.unique(sweep[keep] * len(bodies.tall) + body[keep])
    return pairs // len(bodies.tall), pairs % len(bodies.tall)


def _pieces_of(grid: PlaneGrid, starts: Rows, ends: Rows) -> Indices:
    """Return the number of pieces of each sweep, (n, 3); 0 for a sweep that is looked up alone.

    That is also one so far out that the padding of a piece, for its rounding, is wider than a cell.
    """
    change = np.abs(ends - starts)
    pieces = np.ceil(np.maximum(change[:, 0], change[:, 1]) / grid.side)
    fine = (_padding(starts[:, :2], ends[:, :2]) <= grid.side).all(axis=1)
    return np.where((pieces <= MOST_PIECES) & fine, np.maximum(pieces, 1), 0).astype(np.int64)


def _padding(here: Floats, there: Floats) -> Floats:
    """Return an upper bound of the rounding errors of the ends of a piece, in each coordinate."""
    return PAD * (np.abs(here) + np.abs(there))


def in_batches(grid: PlaneGrid, pieces: Indices) -> list[slice]:
    """Return consecutive sweeps, of these numbers of pieces, that are few enough to be looked up together."""
    batch = np.cumsum(pieces + len(grid.everywhere)) // AT_A_TIME
    bounds = [0, *(np.flatnonzero(np.diff(batch)) + 1).tolist(), len(pieces)]
    return [slice(first, last) for first, last in pairwise(bounds)]


def _beside_pieces(grid: PlaneGrid, starts: Rows, ends: Rows, pieces: Indices) -> tuple[Indices, Indices]:
    """Return the hyperboloids that may be near sweeps (n, 3): pairs of a sweep's and a hyperboloid's number."""
    cut = np.flatnonzero(pieces)
    sweep = np.repeat(cut, pieces[cut])
    here, there = starts[sweep, :2], ends[sweep, :2]
    pad = _padding(here, there)
    if len(sweep) > len(cut):
        number = _counted(pieces[cut])
        change, parts = there - here, pieces[sweep][:, None]
        here, there = here + change * (number[:, None] / parts), here + change * ((number[:, None] + 1) / parts)
    piece, body = grid.near_boxes(np.minimum(here, there) - pad, np.maximum(here, there) + pad)
    always = np.array(grid.everywhere, np.int64)
    return (
        np.concatenate([sweep[piece], np.repeat(cut, len(always))]),
        np.concatenate([body, np.tile(always, len(cut))]),
    )


def passed(starts: Rows, ends: Rows, query: Indices, origins: Rows, reaches: Floats) -> Mask:
    """Whether each sweep comes as near to a vertical axis as its body reaches, (m,).

    `query` (m,) are the indices of the sweeps among `starts` and `ends` (n, 3); `origins` (m, 3) are on the axes.
    """
    x, y, x_end, y_end = starts[query, 0], starts[query, 1], ends[query, 0], ends[query, 1]
    u, v = origins[:, 0], origins[:, 1]
    pad = PAD * sum(map(np.abs, (x, y, x_end, y_end, u, v)), start=0.0) + LEAST_OF_SWEEPS
    across, along = x_end - x, y_end - y
    u, v = u - x, v - y
    length = across * across + along * along
    time = (across * u + along * v) / length
    time = np.where(time > 0, np.minimum(time, 1.0), 0.0)
    u, v, most = u - time * across, v - time * along, reaches * OUTWARD + pad
    return np.asarray(~((u * u + v * v > most * most) & (length < LONGEST_SQUARE)))
