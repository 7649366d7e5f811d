"""Flights of a mover in a scene, polylines of its centre: the first contact of each, and its least distance.

A flight's segments are sweeps, and each is decided exactly (scene_sweeps.py); the first that has contact has the
flight's first. Where there is none, scene_least.py finds the least distance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import CENTER
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows, as_numbers
from hypcheck.kernel.passages import First, Passages
from hypcheck.kernel.scene_least import Least

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
    """One polyline, points (T, 3), or many: (k, T, 3), or a list of points. Raises InputError.

    A path of one point has one segment, which stays there.
    """
    many = isinstance(path, (list, tuple)) and len(path) > 0 and _is_of_points(path[0])
    given = path if many else as_numbers("the path is", path, _PATH)
    single = not many and np.ndim(given) == 2  # type: ignore[arg-type]  # numbers by now
    if not many and np.ndim(given) not in (2, 3):  # type: ignore[arg-type]
        raise InputError(f"the path is of shape {np.shape(given)}; {_PATH}")  # type: ignore[arg-type]
    points: list[Any] = [given] if single else list(given)  # type: ignore[arg-type]  # an array, or a list
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
    find_least: Callable[[], Least] = field(repr=False)

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
        """Where the mover's centre is at `time_upper`, rounded, (k, 3) or (3,); NaN: no contact."""
        center = _centers(self.paths, np.atleast_1d(self.segment), np.atleast_1d(self.time_upper))
        return center[0] if self.paths.single else center

    @cached_property
    @in_default_environment
    def least(self) -> LeastDistance:
        """The least distance along the flight, and where."""
        result = self.find_least()
        segment = np.where(result.segment >= 0, result.segment - self.paths.first[:-1], -1)
        center = _centers(self.paths, segment, result.time)
        values: list[Any] = [result.lower, result.upper, segment, result.time, result.body]
        if self.paths.single:
            values, center = [value[0].item() for value in values], center[0]
        lower, upper, segment, time, index = values
        return LeastDistance(lower, upper, segment, time, index, center)

    def _of_hits(self, values: Any, otherwise: float) -> Any:  # noqa: ANN401 - an array, or its number
        given = np.asarray(values)
        of_flights = np.full(len(self.paths.first) - 1, otherwise, given.dtype)
        of_flights[np.atleast_1d(self.hit)] = given
        return of_flights[0].item() if self.paths.single else of_flights


def _centers(paths: Paths, segment: Indices, time: Floats) -> Floats:
    """The mover's centre at these times of these segments of the paths, (k, 3); NaN where there is none."""
    place = paths.first[:-1] + np.maximum(segment, 0)
    here, there = paths.starts[place], paths.ends[place]
    centers = np.where((time == 1)[:, None], there, here + time[:, None] * (there - here))
    return np.asarray(np.where((segment >= 0)[:, None], centers, np.nan))


def first_segments(paths: Paths, hits: Indices) -> tuple[Mask, Indices]:
    """Which paths have contact, (k,), and the number of the first segment that has it, among all (m,), ascending.

    `hits` are the numbers of all segments that have contact, ascending.
    """
    path = paths.path[hits]
    with_contact, first = np.unique(path, return_index=True)
    hit = np.zeros(len(paths.first) - 1, np.bool_)
    hit[with_contact] = True
    return hit, hits[first]


def measured(measure: Callable[[int], First], segments: Indices) -> Passages:
    """The passages on these segments, all of which have contact."""
    return Passages(np.ones(len(segments), np.bool_), lambda place: measure(int(segments[place])))
