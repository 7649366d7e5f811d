"""The least distance of a mover from the hyperboloids of a scene along flights that are clear: branch and bound.

A flight is a polyline of the mover's centre. The distance changes by no more than the centre moves, so where it is at
least f at one place of a piece of a flight, it is at least f − r on the piece, with r the length from that place to the
piece's farther end. Pieces are many segments at first, then one, then part of one; each is asked about the hyperboloids
near it alone. A pair of a piece and a hyperboloid is dropped when its bound is not below what was reached elsewhere,
except for a tolerance, and halved otherwise.

Near a least distance that takes many halvings. So of a piece within a segment one more proof is tried: the spheroid
that contains all points within δ of the mover (clearance.py), and no more than that along the normal, is asked whether
its whole sweep is clear. If it is, the distance is at least δ all along.

Which hyperboloids are near: a body stands in the cells of its reach (scene_index.py), and a mover that is larger by the
distance in question has a longer reach. The box of a piece, longer by the greatest difference of both, overlaps a cell
of each hyperboloid that is so near.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hypcheck.geometry.pair import UPRIGHT
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.kernel.clearance import enlarged
from hypcheck.kernel.clearance_points import unit_vectors
from hypcheck.kernel.scene_gaps import from_spheroids
from hypcheck.kernel.scene_index import OUTWARD, PAD, Bodies, PlaneGrid, reaches
from hypcheck.kernel.scene_nearest import cylinder_bounds, distances
from hypcheck.kernel.scene_sweeps import bounded_hits, hits_beside
from hypcheck.scene.model import Mover, Span

_TOLERANCE = 2.0**-26
"""How far apart both bounds of a least distance may be, in units of the distance and the mover's size."""

_ROUNDED = 2.0**-44
"""More than the rounding of a place on a segment, and of a distance there, in units of the coordinates."""

_ROUNDS, _MOST_PIECES = 200, 1 << 18
"""If more pieces than this would have to be tested, the bounds are not narrowed further."""

_FEW = 8
"""At most so many sweeps that bounds leave open are decided exactly; each takes some milliseconds."""

_LOOKED_AT = 1 << 12
"""From about so many segments of a flight a first upper bound is taken."""

_AT_A_TIME = 1 << 20
"""So many pairs are looked up together."""


@dataclass(frozen=True)
class Flights:
    """Segments of flights from `starts` to `ends`, (n, 3), with the mover's `axes` (n, 3), None where it is upright.

    `flight` (n,) is the number of the flight, from 0 and ascending. A flight's segments follow each other.
    """

    starts: Rows
    ends: Rows
    flight: Indices
    axes: Rows | None


@dataclass(frozen=True, eq=False)
class LeastDistance:
    """The least distance of the mover along each of k flights; every array is (k,). One flight has numbers.

    `distance_lower` ≤ distance ≤ `distance_upper`, in the scene's unit; both are 0 if the mover itself, without its
    parts, has contact. The upper bound is reached at `segment` and `time`, from hyperboloid `index`; the mover's centre
    is then at `center`, (k, 3). The bounds are 2⁻²⁶ of the distance and the mover's size apart, where no rounding of
    large coordinates is in the way.
    """

    distance_lower: Floats
    distance_upper: Floats
    segment: Indices
    time: Floats
    index: Indices
    center: Floats


@dataclass(frozen=True)
class _Pieces:
    """Pieces (n,) of flights, each with one hyperboloid: segments `first` to `last`.

    A piece of one segment is from the time `begin` to `end`.
    """

    first: Indices
    last: Indices
    begin: Floats
    end: Floats
    body: Indices

    def some(self, index: Indices | Mask) -> _Pieces:
        """Return the pieces with these indices."""
        return _Pieces(*(column[index] for column in vars(self).values()))


@dataclass(frozen=True)
class _Places:
    """A place on each piece: its segment, time and centre, the length of the piece from there, the rounding error."""

    segment: Indices
    time: Floats
    centre: Rows
    radius: Floats
    error: Floats


@dataclass(frozen=True)
class _Search:
    """The query: flights in a scene, with `grid` and `reach` of the scene.

    The reach of a hyperboloid is the distance from its axis beyond which the mover is exterior. `length` (n + 1,) is
    how long all flights are before each segment, with an error of at most `loose`. `width` (k,) is, for each flight,
    how far apart the bounds of the distance are at the place of the least upper bound so far.
    """

    bodies: Bodies
    mover: Mover
    grid: PlaneGrid
    reach: Floats
    flights: Flights
    length: Floats
    loose: float
    width: Floats

    def flight_of(self, pieces: _Pieces) -> Indices:
        """Return the number of each piece's flight."""
        return self.flights.flight[pieces.first]

    def axes_of(self, segment: Indices) -> Rows | None:
        """Return the mover's axes on these segments; None if it is upright."""
        return None if self.flights.axes is None else self.flights.axes[segment]

    def places(self, pieces: _Pieces) -> _Places:
        """Return the middle of each piece, or a corner of the flight near it."""
        alone = pieces.first == pieces.last
        segment = (pieces.first + pieces.last + 1) // 2
        time = np.where(alone, (pieces.begin + pieces.end) / 2, 0.0)
        starts, ends = self.flights.starts[segment], self.flights.ends[segment]
        centre = starts + time[:, None] * (ends - starts)
        whole = self.length[segment + 1] - self.length[segment] + self.loose
        farther = np.maximum(
            self.length[segment] - self.length[pieces.first], self.length[pieces.last + 1] - self.length[segment]
        )
        radius = np.where(alone, (pieces.end - pieces.begin) / 2 * whole, farther + self.loose) * OUTWARD
        error = _ROUNDED * (np.abs(starts).sum(axis=1) + np.abs(ends).sum(axis=1))
        return _Places(segment, time, centre, radius, error)


def least_distances(
    bodies: Bodies, mover: Mover, grid: PlaneGrid, reach: Floats, flights: Flights, count: int
) -> LeastDistance:
    """Compute the least distances of `count` flights. All segments in `flights` must be clear of all hyperboloids.

    A flight without segments here gets the bounds 0 and inf, and so does one whose numbers overflow. `grid` and `reach`
    are those of the scene. In the result `segment` is the number in `flights`, −1 for none, and `center` is not filled
    in yet.
    """
    nowhere = np.full(count, -1)
    least = LeastDistance(
        np.zeros(count), np.full(count, np.inf), nowhere, np.full(count, np.nan), nowhere.copy(),
        np.full((count, 3), np.nan),
    )  # fmt: skip
    if not len(flights.starts):
        return least
    lengths = np.sqrt(((flights.ends - flights.starts) ** 2).sum(axis=1))
    length = np.append(0.0, np.cumsum(lengths))
    loose = (len(lengths) + 4) * 2.0**-52 * float(length[-1])
    search = _Search(bodies, mover, grid, reach, flights, length, loose, np.zeros(count))
    _reach_some(search, least)
    flown = np.unique(flights.flight)
    flown = flown[np.isfinite(least.distance_upper[flown])]
    scale = np.frexp(least.distance_upper[flown])[1]
    for exponent in np.unique(scale).tolist():
        _narrow(search, least, flown[scale == exponent])
    return least


def _reach_some(search: _Search, least: LeastDistance) -> None:
    """Set an upper bound for each flight, at a place near a hyperboloid.

    Hyperboloids are looked for within a distance that doubles until each flight has one.
    """
    flights, within = search.flights.flight, 0.0
    left, begin, counts = np.unique(flights, return_index=True, return_counts=True)
    number = np.arange(len(flights)) - np.repeat(begin, counts)
    some = np.flatnonzero(number % np.repeat(1 + counts // _LOOKED_AT, counts) == 0)
    while len(left):
        segments = some[np.isin(flights[some], left)]
        pieces = _near_pieces(search, segments, within, np.full(len(least.distance_upper), within + search.grid.side))
        place = search.places(pieces)
        bound = _cylinder_bounds(search, pieces.body, place, np.full(len(pieces.body), np.inf))
        flight = search.flight_of(pieces)
        order = np.lexsort((bound, flight))
        _, first = np.unique(flight[order], return_index=True)
        chosen = order[first]
        _ask(search, least, pieces.some(chosen))
        left = np.setdiff1d(left, flight[chosen])
        within = max(2 * within, search.grid.side)


def _narrow(search: _Search, least: LeastDistance, wanted: Indices) -> None:
    """Narrow both bounds of these flights, whose upper bounds have the same exponent."""
    segments = np.flatnonzero(np.isin(search.flights.flight, wanted))
    pieces = _near_pieces(search, segments, float(least.distance_upper[wanted].max()), least.distance_upper)
    floor, size = least.distance_upper.copy(), max(search.mover.b, search.mover.d)
    for turn in range(_ROUNDS):
        flight = search.flight_of(pieces)
        place, bound, half = _ask(search, least, pieces)
        upper, width = least.distance_upper[flight], search.width[flight]
        bound = np.fmax(np.minimum(bound - place.radius, upper), 0)
        target = upper - width - _TOLERANCE * (upper + size) - 8 * place.error
        alone = np.flatnonzero((bound < target) & (pieces.first == pieces.last))
        proved = alone[_proved(search, pieces.some(alone), target[alone], half[alone])]
        bound[proved] = target[proved]
        short = (pieces.first == pieces.last) & (place.radius <= 4 * place.error)
        left = (bound < target) & ~short
        if turn + 1 == _ROUNDS or np.count_nonzero(left) > _MOST_PIECES:
            left[:] = False
        np.minimum.at(floor, flight[~left], bound[~left])
        if not left.any():
            break
        pieces = _halved(pieces.some(left))
    least.distance_lower[wanted] = floor[wanted]


def _ask(search: _Search, least: LeastDistance, pieces: _Pieces) -> tuple[_Places, Floats, Floats]:
    """Measure at a place of each piece, and lower the upper bounds of flights that are nearer there.

    Return the places, lower bounds of their distances, and half the mover's width along each gap.
    """
    place, flight = search.places(pieces), search.flight_of(pieces)
    bound = _cylinder_bounds(search, pieces.body, place, least.distance_upper[flight])
    half = np.full(len(bound), search.mover.b)
    some = np.flatnonzero(bound - place.radius <= least.distance_upper[flight])
    centre, axes, pairs = place.centre[some], search.axes_of(place.segment[some]), (flight[some], pieces.body[some])
    low, high, point = distances(search.bodies, search.mover, centre, axes, pairs, least.distance_upper)
    low, high = low - place.error[some], high + place.error[some]
    bound[some] = np.maximum(bound[some], low)
    half[some] = _half_widths(search.mover, axes, point - centre)
    order = np.lexsort((high, pairs[0]))
    reached, first = np.unique(pairs[0][order], return_index=True)
    best = order[first]
    better = high[best] < least.distance_upper[reached]
    to, chosen = reached[better], best[better]
    least.distance_upper[to], search.width[to], least.index[to] = high[chosen], (high - low)[chosen], pairs[1][chosen]
    least.segment[to], least.time[to] = place.segment[some][chosen], place.time[some][chosen]
    return place, bound, half


def _half_widths(mover: Mover, axes: Rows | None, offset: Rows) -> Floats:
    """Return half of how wide the mover is along its gaps to points, `offset` (n, 3) from its centre.

    It is b where it is not known.
    """
    with np.errstate(all="ignore"):
        unit = np.tile(UPRIGHT, (len(offset), 1)) if axes is None else unit_vectors(axes)
        b, d = np.full(len(offset), mover.b), np.full(len(offset), mover.d)
        _, normal = from_spheroids(b, d, unit, offset)
        steep = (normal * unit).sum(axis=1)
        half = np.hypot(b * np.sqrt(np.maximum(1 - steep * steep, 0)), d * steep)
        return np.asarray(np.where(half > 0, half, b))


def _proved(search: _Search, pieces: _Pieces, target: Floats, half: Floats) -> Mask:
    """Whether the sweep of a larger spheroid proves that the distance is at least the target on pieces of segments."""
    starts, ends = search.flights.starts[pieces.first], search.flights.ends[pieces.first]
    error = _ROUNDED * (np.abs(starts).sum(axis=1) + np.abs(ends).sum(axis=1))
    with np.errstate(all="ignore"):
        b, d = enlarged(search.mover.b, search.mover.d, target + error, half)
        sizes = np.stack(np.broadcast_arrays(b, d), axis=1)
        fits = np.flatnonzero(np.isfinite(sizes).all(axis=1))
    here, there = (starts + time[:, None] * (ends - starts) for time in (pieces.begin, pieces.end))
    body, sizes, here, there = pieces.body[fits], sizes[fits], here[fits], there[fits]
    axes = search.axes_of(pieces.first[fits])
    hits, undecided = bounded_hits(search.bodies, body, sizes, here, there, axes)
    few = np.flatnonzero(undecided)
    if len(few) <= _FEW:
        few_axes = None if axes is None else axes[few]
        hits[few] = hits_beside(search.bodies, body[few], sizes[few], here[few], there[few], few_axes)
        undecided[few] = False
    proved = np.zeros(len(target), np.bool_)
    proved[fits] = ~(hits | undecided)
    return proved


def _halved(pieces: _Pieces) -> _Pieces:
    """Return two halves of each piece; for a whole segment also its two ends, as pieces of length 0."""
    alone = pieces.first == pieces.last
    whole = pieces.some(alone & (pieces.begin == 0) & (pieces.end == 1))
    segment, middle = (pieces.first + pieces.last + 1) // 2, (pieces.begin + pieces.end) / 2
    several = [
        replace(pieces, last=np.where(alone, pieces.last, segment - 1), end=np.where(alone, middle, 1.0)),
        replace(pieces, first=np.where(alone, pieces.first, segment), begin=np.where(alone, middle, 0.0)),
        replace(whole, end=whole.begin),
        replace(whole, begin=whole.end),
    ]
    return _joined(several)


def _joined(several: Sequence[_Pieces]) -> _Pieces:
    """Return the pieces of several as one."""
    columns = zip(*(vars(some).values() for some in several), strict=True)
    return _Pieces(*(np.concatenate(column) for column in columns))


def _near_pieces(search: _Search, segments: Indices, within: float, most: Floats) -> _Pieces:
    """Return pieces, one or several of these segments, each with all hyperboloids that may be `within` that distance.

    Those whose cylinder is farther from a piece than its flight's `most` (k,) are left out.
    """
    flights, bodies, grid = search.flights, search.bodies, search.grid
    step = max(within, grid.side)
    place = np.floor((search.length[segments] - search.length[segments[0]]) / step)
    new = np.append(True, (np.diff(flights.flight[segments]) != 0) | (np.diff(place) != 0) | (np.diff(segments) != 1))
    if flights.axes is not None:
        new[1:] |= (np.diff(flights.axes[segments], axis=0) != 0).any(axis=1)
    begin = np.flatnonzero(new)
    first, last = segments[begin], segments[np.append(begin[1:], len(segments)) - 1]
    starts, ends = flights.starts[segments], flights.ends[segments]
    low = np.minimum(np.minimum.reduceat(starts, begin), np.minimum.reduceat(ends, begin))
    high = np.maximum(np.maximum.reduceat(starts, begin), np.maximum.reduceat(ends, begin))
    pad = _longer_reach(search, within, Span(float(low[:, 2].min()), float(high[:, 2].max())))
    padding = pad + PAD * (np.abs(low[:, :2]) + np.abs(high[:, :2]))
    low, high = low[:, :2] - padding, high[:, :2] + padding
    with np.errstate(all="ignore"):
        across = np.floor(high / grid.side) - np.floor(low / grid.side) + 1
        cells = np.where(np.isfinite(across).all(axis=1), across.prod(axis=1), np.inf)
    members = min(len(bodies.tall), max(len(grid.members), 1))
    load = np.minimum(cells, members) * (1 + len(grid.everywhere) / np.maximum(cells, 1))
    near = []
    for some in np.split(np.arange(len(first)), np.flatnonzero(np.diff(np.cumsum(load) // _AT_A_TIME)) + 1):
        piece, body = _looked_up(search, low[some], high[some], cells[some] < members)
        near.append(_worth_asking(search, first[some][piece], last[some][piece], body, most))
    return _joined(near)


def _looked_up(search: _Search, low: Floats, high: Floats, by_cells: Mask) -> tuple[Indices, Indices]:
    """Return pairs of the numbers of a box and of a hyperboloid: those in the cells of the box, or all."""
    bodies, grid = search.bodies, search.grid
    some, others = np.flatnonzero(by_cells), np.flatnonzero(~by_cells)
    box, body = grid.near_boxes(low[some], high[some])
    once = np.sort(some[box] * len(bodies.tall) + body)
    once = once[np.append(True, np.diff(once) != 0)[: len(once)]]
    always = np.array(grid.everywhere, np.int64)
    every = np.arange(len(bodies.tall))
    return (
        np.concatenate([once // len(every), np.repeat(some, len(always)), np.repeat(others, len(every))]),
        np.concatenate([once % len(every), np.tile(always, len(some)), np.tile(every, len(others))]),
    )


def _worth_asking(search: _Search, first: Indices, last: Indices, body: Indices, most: Floats) -> _Pieces:
    """Return these segments as pieces, without those whose cylinder is farther away than `most` of their flight."""
    pieces = _Pieces(first, last, np.zeros(len(first)), np.ones(len(first)), body)
    place, upper = search.places(pieces), most[search.flight_of(pieces)]
    bound = _cylinder_bounds(search, body, place, upper)
    return pieces.some(np.flatnonzero(bound - place.radius <= upper))


def _longer_reach(search: _Search, within: float, height: Span) -> float:
    """Return by how much the grid's reach must grow to find all hyperboloids `within` a distance of the mover."""
    mover = search.mover
    larger = Mover((mover.b + within) * OUTWARD, (mover.d + within) * OUTWARD, axis=mover.axis)
    far = reaches(search.bodies, larger, height)
    known = np.isfinite(search.reach)
    with np.errstate(all="ignore"):
        return float(np.maximum(far - search.reach, 0)[known].max(initial=0.0)) * OUTWARD + within * 2.0**-40


def _cylinder_bounds(search: _Search, body: Indices, place: _Places, most: Floats) -> Floats:
    """Return a lower bound of the distance of each place (n,), or of `most` (n,) and twice the piece's radius."""
    return cylinder_bounds(search.bodies, body, search.mover, place.centre.T, most + 2 * place.radius)
