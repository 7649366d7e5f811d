"""Flights of a mover in a scene, polylines of its centre: first contacts, least distances, and the data of a picture.

A flight's segments are sweeps, and each is decided exactly (scene_sweeps.py); the first that has contact has the
flight's first. Where there is none, scene_least.py finds the least distance. A picture shows contacts, and the least
distance on each piece of one flight.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import CENTER
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows, as_numbers
from hypcheck.kernel.passages import First, Passages
from hypcheck.kernel.scene_least import LeastDistance
from hypcheck.messages import counted
from hypcheck.pictures import ShownContact, ShownFlight
from hypcheck.scene.model import FREE, SceneModel, places_of_parts

_PATH = "it must be points (T, 3), an array (k, T, 3), or a list of such points"


@dataclass(frozen=True)
class Paths:
    """Polylines: their segments from `starts` to `ends`, (n, 3), one path after the other.

    `first` (k + 1,) is the number of each path's first segment, and n. `single`: one path was given, and not a list.
    """

    starts: Rows
    ends: Rows
    first: Indices
    single: bool

    @property
    def path(self) -> Indices:
        """The number of each segment's path, (n,)."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))


@dataclass(frozen=True)
class Swept:
    """Sweeps (n,) of a mover, and pairs (m,) of them and of hyperboloids near them, sorted by sweep.

    `movers` are the mover's axes, None where it is upright. `own` marks the pairs in which the mover itself has
    contact, `hits` those in which its parts have contact too, if it has parts.
    """

    starts: Rows
    ends: Rows
    headings: Floats
    movers: Rows | None
    query: Indices
    body: Indices
    own: Mask
    hits: Mask


def paths_of(path: ArrayLike | Sequence[ArrayLike]) -> Paths:
    """Return one polyline, points (T, 3), or many: (k, T, 3), or a list of points. Raises InputError.

    A path of one point has one segment, which stays there.
    """
    many = isinstance(path, (list, tuple)) and len(path) > 0 and _is_of_points(path[0])
    paths = path if many else as_numbers("the path is", path, _PATH)
    single = not many and np.ndim(paths) == 2  # type: ignore[arg-type]  # numbers by now
    if not many and np.ndim(paths) not in (2, 3):  # type: ignore[arg-type]
        raise InputError(f"the path is of shape {np.shape(paths)}; {_PATH}")  # type: ignore[arg-type]
    points: list[Any] = [paths] if single else list(paths)  # type: ignore[arg-type]  # an array, or a list
    if not points:
        raise InputError("there is no path; there must be one at least")
    named = [("the path" if single else f"path {number}", track) for number, track in enumerate(points)]
    corners = [_points(name, track) for name, track in named]
    starts = [track[: max(len(track) - 1, 1)] for track in corners]
    counts = [len(track) for track in starts]
    return Paths(
        np.concatenate(starts), np.concatenate([track[-count:] for track, count in zip(corners, counts, strict=True)]),
        np.cumsum([0, *counts]), single,
    )  # fmt: skip


def require_for_each(paths: Paths, name: str, shape: tuple[int, ...]) -> None:
    """Raise InputError unless a value is given once, or for each segment."""
    if shape not in ((), (len(paths.starts),)):
        raise InputError(
            f"{name} is given for {' × '.join(map(str, shape))} segments, and there are {len(paths.starts)}; it must "
            "be the same all along, or one for each segment"
        )


def _is_of_points(path: object) -> bool:
    """Whether it is a path in a list of paths, not a point in a path."""
    if hasattr(path, "ndim"):
        return bool(path.ndim > 1)
    return isinstance(path, (list, tuple)) and any(isinstance(point, (list, tuple)) or np.ndim(point) for point in path)


def _points(name: str, path: ArrayLike) -> Rows:
    """Return a path as points (T, 3). Raises InputError."""
    points = as_numbers(f"{name} is", path, "it must be points (T, 3)")
    if points.ndim != 2 or points.shape[1] != len(CENTER) or not len(points):
        raise InputError(f"{name} is of shape {points.shape}; it must be points (T, 3), one at least")
    finite = np.isfinite(points)
    if not finite.all():
        place, column = (int(index[0]) for index in np.nonzero(~finite))
        raise InputError(
            f"{name}, point {place}: {CENTER[column]} is {float(points[place, column])!r}; it must be finite"
        )
    return points


@dataclass(frozen=True, eq=False)
class FirstContact:
    """The first contact on each of k flights; every array is (k,). One flight has numbers.

    `hit`: whether there is contact anywhere on the flight; `segment`: the first segment that has contact, counted from
    0; −1 if there is none. Both are exact.
    """

    hit: Mask | bool
    segment: Indices | int
    passages: Passages = field(repr=False)
    """What happens on the first segments with contact, one for each flight that has it."""
    paths: Paths = field(repr=False)
    find_least: Callable[[], LeastDistance] = field(repr=False)

    @cached_property
    def time_lower(self) -> Floats:
        """The first contact is not before this time of its segment, from 0 at its start to 1; NaN: none."""
        times: Floats = self._of_hits(self.passages.first_lower, np.nan)
        return times

    @cached_property
    def time_upper(self) -> Floats:
        """The first contact is not after this time of its segment; NaN: none."""
        times: Floats = self._of_hits(self.passages.first_upper, np.nan)
        return times

    @cached_property
    def index(self) -> Indices:
        """The hyperboloid that is touched first, its number from 0; −1: none."""
        numbers: Indices = self._of_hits(self.passages.index, -1)
        return numbers

    @cached_property
    @in_default_environment
    def center(self) -> Floats:
        """The mover's centre at `time_upper`, rounded, (k, 3) or (3,); NaN: no contact."""
        center = _centers(self.paths, np.atleast_1d(self.segment), np.atleast_1d(self.time_upper))
        return center[0] if self.paths.single else center

    @cached_property
    @in_default_environment
    def least(self) -> LeastDistance:
        """The least distance along the flight, and where."""
        result = self.find_least()
        segment = np.where(result.segment >= 0, result.segment - self.paths.first[:-1], -1)
        center = _centers(self.paths, segment, result.time)
        values: list[Any] = [result.distance_lower, result.distance_upper, segment, result.time, result.index]
        if self.paths.single:
            values, center = [value[0].item() for value in values], center[0]
        lower, upper, segment, time, index = values
        return LeastDistance(lower, upper, segment, time, index, center)

    def _of_hits(self, values: Any, otherwise: float) -> Any:  # noqa: ANN401 - an array, or its number
        """Return values of the flights with contact as values of all flights."""
        hit_values = np.asarray(values)
        of_flights = np.full(len(self.paths.first) - 1, otherwise, hit_values.dtype)
        of_flights[np.atleast_1d(self.hit)] = hit_values
        return of_flights[0].item() if self.paths.single else of_flights


def _centers(paths: Paths, segment: Indices, time: Floats) -> Floats:
    """Return the mover's centre at these times of these segments of the paths, (k, 3); NaN where there is none."""
    place = paths.first[:-1] + np.maximum(segment, 0)
    here, there = paths.starts[place], paths.ends[place]
    centers = np.where((time == 1)[:, None], there, here + time[:, None] * (there - here))
    return np.asarray(np.where((segment >= 0)[:, None], centers, np.nan))


def first_segments(paths: Paths, hits: Indices) -> tuple[Mask, Indices]:
    """Return a mask of the paths with contact, (k,), and the first segment with contact of each path that has one.

    `hits` are the numbers of all segments that have contact, ascending.
    """
    path = paths.path[hits]
    with_contact, first = np.unique(path, return_index=True)
    hit = np.zeros(len(paths.first) - 1, np.bool_)
    hit[with_contact] = True
    return hit, hits[first]


def measured(measure: Callable[[int], First], segments: Indices) -> Passages:
    """Return the passages on these segments, all of which have contact."""
    return Passages(np.ones(len(segments), np.bool_), lambda place: measure(int(segments[place])))


PIECES = 240
"""A picture cuts a flight into so many pieces, each with a least distance."""

_MOST_CONTACTS = 100
"""On at most so many segments the first contact is found; each takes a millisecond."""


class Asked(Protocol):
    """The methods of a Scene that a picture needs."""

    @property
    def model(self) -> SceneModel:
        """The scene as its file describes it."""

    def passage(
        self, start: ArrayLike, end: ArrayLike, heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> Passages:
        """As Scene.passage."""

    def first_contact(
        self, path: ArrayLike | Sequence[ArrayLike], heading: ArrayLike = 0.0, *, axis: ArrayLike | None = None
    ) -> FirstContact:
        """As Scene.first_contact."""


def shown_flight(
    scene: Asked,
    path: ArrayLike,
    heading: ArrayLike = 0.0,
    axis: ArrayLike | None = None,
    count_of_pieces: int = PIECES,
) -> ShownFlight:
    """Return the data of a picture of one flight, with the least distance on each of `pieces` pieces.

    Raises InputError as first_contact, and for more flights than one.
    """
    paths = paths_of(path)
    if not paths.single:
        raise InputError("a picture shows one flight, and many are given; give points (T, 3)")
    contact = scene.first_contact(path, heading, axis=axis)
    count = len(paths.starts)
    headings = np.broadcast_to(np.asarray(heading, np.float64), count)
    fixed = scene.model.mover.axis
    own = np.asarray(axis if fixed == FREE else fixed, np.float64)
    axes = np.ascontiguousarray(np.broadcast_to(own, (count, 3)))
    free = axes if fixed == FREE else None
    passages = scene.passage(paths.starts, paths.ends, headings, axis=free)
    hits = np.atleast_1d(passages.hit)
    contacts = []
    for segment in np.flatnonzero(hits)[:_MOST_CONTACTS].tolist():
        (low, high), index = passages.measure(segment)
        here, there = paths.starts[segment], paths.ends[segment]
        contacts.append(ShownContact(segment, (here + float((low + high) / 2) * (there - here)).tolist(), index))
    pieces, segments, flown = _pieces(np.vstack([paths.starts[:1], paths.ends]), count_of_pieces)
    near = _least_on(scene, pieces, segments, headings, free)
    whole = contact.least
    least_flown = float(flown[whole.segment] + whole.time * (flown[whole.segment + 1] - flown[whole.segment]))
    parts = scene.model.mover.parts
    places = [places_of_parts(parts, (0, 0, 0), *turn) for turn in zip(headings.tolist(), axes.tolist(), strict=True)]
    caption = f"{counted(count, 'segment')}, {float(flown[-1]):.6g} long; " + (
        f"{counted(int(hits.sum()), 'segment')} with contact, the first is segment {contact.segment}"
        if contact.hit
        else f"clear, its least distance is {float(whole.distance_lower):.6g}"
    )
    return ShownFlight(
        np.vstack([paths.starts[:1], paths.ends]), axes, hits, contacts,
        np.array(places, np.float64).reshape(count, len(parts), 3), *near,
        (least_flown, float(whole.distance_lower), float(whole.distance_upper)), caption,
    )  # fmt: skip


def _least_on(
    scene: Asked, pieces: Sequence[Floats], segments: Sequence[Indices], headings: Floats, axes: Floats | None
) -> tuple[Floats, Floats, Indices, Mask]:
    """Return both bounds of the least distance on each piece, its hyperboloid, and whether there is contact.

    Where the mover meets contact, the distance is 0, and the hyperboloid is not determined.
    """

    def first_contacts(chosen: list[int]) -> FirstContact:
        owner = np.concatenate([segments[piece] for piece in chosen])
        these = [pieces[piece] for piece in chosen]
        return scene.first_contact(these, headings[owner], axis=None if axes is None else axes[owner])

    lower, upper, index = np.zeros(len(pieces)), np.zeros(len(pieces)), np.zeros(len(pieces), np.intp)
    clear = np.flatnonzero(~np.asarray(first_contacts(list(range(len(pieces)))).hit))
    if len(clear):
        least = first_contacts(clear.tolist()).least
        lower[clear], index[clear] = least.distance_lower, np.maximum(least.index, 0)
        upper[clear] = np.where(np.isfinite(least.distance_upper), least.distance_upper, 0.0)
        clear = clear[least.distance_upper != 0]
    touched = np.ones(len(pieces), np.bool_)
    touched[clear] = False
    return lower, upper, index, touched


def _pieces(points: Floats, count: int) -> tuple[list[Floats], list[Indices], Floats]:
    """Return the points and segments of each of `count` equally long pieces, and the length flown up to each point."""
    steps = np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1))
    flown = np.append(0.0, np.cumsum(steps))
    if flown[-1] == 0 or not np.isfinite(flown[-1]):
        return [points], [np.arange(len(steps))], np.where(np.isfinite(flown), flown, 0.0)
    cuts = np.linspace(0, flown[-1], count + 1)
    pieces: list[Floats] = []
    segments: list[Indices] = []
    for low, high in pairwise(cuts.tolist()):
        first = min(int(np.searchsorted(flown, low, "right")) - 1, len(steps) - 1)
        last = min(max(int(np.searchsorted(flown, high, "left")) - 1, first), len(steps) - 1)
        ends = [_at(points, flown, first, low), *points[first + 1 : last + 1], _at(points, flown, last, high)]
        pieces.append(np.array(ends))
        segments.append(np.arange(first, last + 1))
    return pieces, segments, flown


def _at(points: Floats, flown: Floats, segment: int, length: float) -> Floats:
    """Return the point of a segment at this length along the flight."""
    step = flown[segment + 1] - flown[segment]
    share = min(max((length - flown[segment]) / step, 0.0), 1.0) if step > 0 else 0.0
    return np.asarray(points[segment] + share * (points[segment + 1] - points[segment]))
