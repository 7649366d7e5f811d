"""Sweeps of one mover beside one hyperboloid, straight motions in the scene's coordinates: contact or none, exactly.

The kernel's answer about sweeps (core/parts/sweeps.h) is asked twice: about a larger and about a smaller spheroid, by
what the rounding of the difference of two centres may be in radii, as for positions (scene_pairs.py). The larger one
clear is clear, the smaller one in contact is contact. What is left is decided from the exact differences by
truth/swept.py. No other exact decision about sweeps is known, so the kernel uses that of truth/.
Beside a tilted hyperboloid both ends and the mover's axis are turned into its frame (frames_of), and the
roundings of that are added.

Where the hyperboloid ends, what is clear of the whole one is clear of its wall. A mover that reaches beyond an end, and
no other, is asked about the ends as well: those decide where it may hit, and of a solid one always.

A planner asks for one motion at a time, and arrays of one number each cost it twenty times what the answer does. So for
an upright mover among upright hyperboloids the bounds of scene_index.py and of this module are asked with numbers of
Python, and the kernel once or twice for all hyperboloids that are near: about the larger mover and the smaller one. At
each time the touched wall, rim or end lies in the larger spheroid, which has a point on either side of it or on it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf, isfinite

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import UPRIGHT, WITHOUT_ENDS
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.kernel.in_use import kernel
from hypcheck.kernel.scene_index import (
    LEAST_OF_SWEEPS,
    LONGEST_SQUARE,
    OUTWARD,
    PAD,
    TURNING,
    Bodies,
    BodyNumbers,
    PlaneGrid,
    frames_of,
    turned,
    turned_axes,
)
from hypcheck.kernel.scene_pairs import (
    GREATEST,
    LEAST,
    MARGIN,
    ROUNDED,
    Numbers,
    along_and_across,
    larger_and_smaller,
    meets_for_sure,
)
from hypcheck.scene.model import Mover, Point
from hypcheck.truth import ended_sweeps, swept
from hypcheck.truth.ended_sweeps import EndedSweep


def hits_beside(
    bodies: Bodies, body: Indices, semi_axes: Rows, starts: Rows, ends: Rows, axes: Rows | None = None
) -> Mask:
    """Return a mask of the sweeps of spheroids with contact with their hyperboloid, (n,).

    `semi_axes` are b and d (n, 2); `starts` and `ends`, (n, 3), are in the scene's coordinates, and `axes`, (n, 3),
    those of the spheroids; None: they are upright.
    """
    hits, undecided = bounded_hits(bodies, body, semi_axes, starts, ends, axes)
    for index in np.flatnonzero(undecided).tolist():
        axis = UPRIGHT if axes is None else axes[index].tolist()
        sweep = Sweep(starts[index].tolist(), ends[index].tolist(), axis)
        b, d = semi_axes[index].tolist()
        hits[index] = not is_clear(bodies.one(int(body[index])), (b, d, sweep))
    return hits


def bounded_hits(
    bodies: Bodies, body: Indices, semi_axes: Rows, starts: Rows, ends: Rows, axes: Rows | None = None
) -> tuple[Mask, Mask]:
    """Return masks (n,) of the sweeps with contact by bounds, and of those that bounds do not decide."""
    origins, shapes, spans = bodies.origins[body], bodies.shapes[body], bodies.spans[body]
    with np.errstate(all="ignore"):
        (start, lost_start), (end, lost_end) = two_sum(starts, -origins), two_sum(ends, -origins)
        lost = np.maximum(np.abs(lost_start), np.abs(lost_end)).sum(axis=1)
        longest = semi_axes.max(axis=1)
        own_axes = np.broadcast_to(UPRIGHT, (len(body), 3)) if axes is None else axes
        if bodies.tilted[body].any():
            start, end, own_axes, turning = _in_frames(bodies.axes[body], longest, start, end, axes)
            lost = lost + turning
        reach = longest * (1 + MARGIN) + lost + MARGIN * (np.abs(start[:, 2]) + np.abs(end[:, 2]))
        low, high = np.minimum(start[:, 2], end[:, 2]), np.maximum(start[:, 2], end[:, 2])
        leaves = ~((low - reach > spans[:, 0]) & (high + reach < spans[:, 1])) & np.isfinite(spans).any(axis=1)
        beyond = (high + reach < spans[:, 0]) | (low - reach > spans[:, 1])
    larger, smaller, fits = larger_and_smaller(semi_axes, lost)
    heights = [spans, bodies.solid[body][:, None]] if leaves.any() else []
    hits, left = np.zeros(len(body), np.bool_), ~fits & ~beyond
    open_rows = np.flatnonzero(fits & ~beyond)
    for size, surely in ((larger, 0), (smaller, 1)):
        replies = kernel().answer_sweeps(
            np.concatenate([shapes, size, start, end, own_axes, *heights], axis=1)[open_rows]
        )[0]
        hits[open_rows[replies == surely]] = surely == 1
        open_rows = open_rows[replies != surely]
    left[open_rows] = True
    some = np.flatnonzero(left & fits & leaves)
    places = shapes[some], spans[some], start[some], end[some], lost[some]
    met = some[_meet_on_the_sweep(semi_axes[some].min(axis=1), *places)]
    hits[met], left[met] = True, False
    return hits, left


def _meet_on_the_sweep(least: Floats, shapes: Rows, spans: Rows, start: Floats, end: Floats, lost: Floats) -> Mask:
    """Whether bounds show contact at one of five times, in the frames of hyperboloids with these ends."""
    met = np.zeros(len(shapes), np.bool_)
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        met |= meets_for_sure(least, shapes, spans, start + share * (end - start), lost)
    return met


def _in_frames(
    upward: Rows, longest: Floats, start: Floats, end: Floats, axes: Rows | None
) -> tuple[Floats, Floats, Floats, Floats]:
    """Return both ends and the mover's axis in the frames of hyperboloids with these axes, and bounds of their errors.

    An axis that is off by an angle δ moves no point of the spheroid farther than δ times its longer semi-axis.
    """
    frames = frames_of(upward)
    tilted = (upward[:, :2] != 0).any(axis=1)
    size = np.maximum(np.abs(start).sum(axis=1), np.abs(end).sum(axis=1)) + longest
    error = np.where(tilted, TURNING * size + LEAST, 0.0)
    return turned(frames, start), turned(frames, end), turned_axes(frames, axes), error


@dataclass(frozen=True, slots=True)
class Sweep:
    """The straight motion of a spheroid, in the scene's coordinates, and its axis."""

    start: Sequence[float | Fraction]
    end: Sequence[float | Fraction]
    axis: Sequence[float]


Spheroid = tuple[float, float, Sweep]
"""b, d, and the motion."""


def is_clear(body: BodyNumbers, mover: Spheroid, parts: Sequence[Spheroid] = ()) -> bool:
    """Whether a mover (b, d, sweep) stays clear of a hyperboloid, or its parts do, always together on one side.

    The parts are tested at the times at which the mover is in contact.
    """
    spheroids = [mover, *parts]
    if all(_between_ends(body, *spheroid) for spheroid in spheroids):
        sweeps = [swept.passage(*_between(body, *spheroid)) for spheroid in (parts or [mover])]
        return not any(sweep.hit for sweep in sweeps) and len({sweep.start for sweep in sweeps}) == 1
    heights = (*body.span, float(body.solid))
    whole, *others = (swept.sweep_of(*_between(body, *spheroid), heights) for spheroid in spheroids)
    return not ended_sweeps.meets(EndedSweep(whole, tuple(others)))


def _between_ends(body: BodyNumbers, b: float, d: float, sweep: Sweep) -> bool:
    """Whether a spheroid surely stays between the ends of a hyperboloid."""
    (low, high), axis = body.span, body.axis
    reach = (d if sweep.axis[0] == sweep.axis[1] == axis[0] == axis[1] == 0 else max(b, d)) * (1 + MARGIN)
    points = [[float(part) for part in point] for point in (sweep.start, sweep.end)]
    reach += MARGIN * max(sum(map(abs, point)) for point in points)  # fractions are rounded
    places = (along_and_across(point, body.origin, axis) for point in points)
    return (low, high) == WITHOUT_ENDS[:2] or all(
        low + reach + error < along < high - reach - error for along, _, error in places
    )


_Numbers = Sequence[float | Fraction]


def _between(
    body: BodyNumbers, b: float, d: float, sweep: Sweep
) -> tuple[_Numbers, _Numbers, _Numbers, _Numbers, _Numbers]:
    """Return the sizes, the exact start and end from the hyperboloid's centre, and the axes of both."""
    start, end = (
        [Fraction(part) - Fraction(centre) for part, centre in zip(point, body.origin, strict=True)]
        for point in (sweep.start, sweep.end)
    )
    return (*body.shape, b, d), start, end, sweep.axis, body.axis


def enters(origins: Rows, reaches: Floats, start: Floats, end: Floats) -> list[float]:
    """Return times before which a mover on its sweep is farther from axes at (k, 3) than these reach, (k,).

    PAD of all coordinates is more than the rounding of a place, of the least distance from an axis and of the chord
    (scene_index.py); where a number is not finite, or a reach is infinite, the time is 0.
    """
    origins = origins[:, :2]
    with np.errstate(all="ignore"):
        place, change = origins - start[:2], end[:2] - start[:2]
        pad = PAD * (np.abs(start[:2]) + np.abs(end[:2]) + np.abs(origins)).sum(axis=1)
        square = (change * change).sum()
        time = (place * change).sum(axis=1) / square
        off = place - time[:, None] * change
        most = reaches * OUTWARD + 2 * pad
        chord = np.sqrt(np.maximum(most * most - (off * off).sum(axis=1), 0)) * OUTWARD + pad
        first = time - chord / np.sqrt(square)
    ordinary = np.isfinite(first) & (LEAST < square) & (square < GREATEST)
    times: list[float] = np.where(ordinary, np.maximum(first, 0), 0.0).tolist()
    return times


_HALVINGS = 60


def first_contact(body: BodyNumbers, mover: Spheroid, parts: Sequence[Spheroid] = ()) -> tuple[Fraction, Fraction]:
    """Return an interval for the time of first contact of a mover that is not clear by is_clear.

    It is one number twice if the time is exact.

    Where parts decide, exact decisions about the sweep up to a time halve the interval.
    """
    low, high = body.span
    first = swept.passage(*_between(body, *mover), z_min=low, z_max=high, solid=float(body.solid)).first
    if first is None:
        raise AssertionError("a sweep on which is_clear finds contact has none")
    if not parts:
        return first
    until, contact = first[0], Fraction(1)
    if not is_clear(body, *_cut(mover, parts, Fraction(0))):
        return Fraction(0), Fraction(0)
    for _ in range(_HALVINGS):
        middle = (until + contact) / 2
        if is_clear(body, *_cut(mover, parts, middle)):
            until = middle
        else:
            contact = middle
    return until, contact


def _at(sweep: Sweep, time: Fraction) -> list[Fraction]:
    """Return the centre's exact place at a time of the sweep."""
    ends = zip(*([Fraction(part) for part in point] for point in (sweep.start, sweep.end)), strict=True)
    return [here + time * (there - here) for here, there in ends]


def _cut(mover: Spheroid, parts: Sequence[Spheroid], time: Fraction) -> tuple[Spheroid, list[Spheroid]]:
    """Return the mover and its parts with their sweeps cut off at a time."""
    whole, *others = ((b, d, replace(sweep, end=_at(sweep, time))) for b, d, sweep in (mover, *parts))
    return whole, others


def point_at_once(point: object) -> Point | None:
    """Return three finite numbers in a list, a tuple or an array, and None for everything else that may be a point."""
    values = point.tolist() if type(point) is np.ndarray and point.shape == (3,) else point
    if not isinstance(values, (list, tuple)) or len(values) != 3:
        return None
    if not all(isinstance(value, float) or type(value) is int for value in values):
        return None
    x, y, z = (float(value) if abs(value) < GREATEST else inf for value in values)
    return (x, y, z) if isfinite(x) and isfinite(y) and isfinite(z) else None


def hit_at_once(
    grid: PlaneGrid, reaches: Floats, numbers: Callable[[int], Numbers], mover: Mover, start: Point, end: Point
) -> bool | None:
    """Whether the mover itself has contact on its sweep; None if bounds do not decide.

    `numbers` gives those of a hyperboloid; `reaches` are those of scene_index for the mover.
    """
    candidates = grid.near_sweep(start[0], start[1], end[0], end[1])
    if candidates is None:
        return None
    beside, most = [], 0.0
    for index in _passed(candidates, reaches, numbers, start, end):
        shape, origin, _, span, solid = numbers(index)[0]
        begin, lost_at_start = _differences(start, origin)
        finish, lost_at_end = _differences(end, origin)
        beside.append((shape, (*begin, *finish, *UPRIGHT, *span, solid)))
        lost = sum(map(max, lost_at_start, lost_at_end))
        if not lost < GREATEST:
            return None
        most = max(most, lost)
    if not beside:
        return False
    if not (min(mover.b, mover.d) > LEAST and max(mover.b, mover.d) < GREATEST):
        return None
    stretch = most / min(mover.b, mover.d) * (1 + MARGIN) + ROUNDED if most else 0.0
    larger = _hits(beside, mover, 1 + stretch)
    if not any(larger):
        return False
    if stretch == 0:
        return True if 1 in larger else None
    touched = [numbers for numbers, hit in zip(beside, larger, strict=True) if hit]
    return True if stretch < 1 and 1 in _hits(touched, mover, 1 - stretch) else None


def _hits(beside: Sequence[tuple[tuple[float, float], tuple[float, ...]]], mover: Mover, scale: float) -> list[int]:
    """Return the kernel's answers for the mover, larger or smaller by a factor, beside each hyperboloid."""
    semi_axes = mover.b * scale, mover.d * scale
    rows = np.array([(*shape, *semi_axes, *ends) for shape, ends in beside])
    hits: list[int] = kernel().answer_sweeps(rows)[0].tolist()
    return hits


def _differences(point: Point, centre: Point) -> tuple[Point, Point]:
    """Return the differences of coordinates, rounded, and how much each has lost, by TwoSum.

    What is lost is NaN where it is not known.
    """
    (x, y, z), (u, v, w) = point, centre
    across, along, up = x - u, y - v, z - w
    back_x, back_y, back_z = across + u, along + v, up + w
    return (across, along, up), (
        abs((x - back_x) - (u - (back_x - across))),
        abs((y - back_y) - (v - (back_y - along))),
        abs((z - back_z) - (w - (back_z - up))),
    )


def _passed(
    candidates: set[int], reaches: Floats, numbers: Callable[[int], Numbers], start: Point, end: Point
) -> list[int]:
    """Return the candidates whose reach the sweep enters: scene_index.passed, for one sweep."""
    (x, y, z), (x_end, y_end, z_end) = start, end
    lowest, highest = (z, z_end) if z < z_end else (z_end, z)
    across, along = x_end - x, y_end - y
    length = across * across + along * along
    size = abs(x) + abs(y) + abs(x_end) + abs(y_end)
    passed_by = []
    for index in candidates:
        body, (low, high, _, _) = numbers(index)
        if highest < low or lowest > high:  # beyond an end
            continue
        u, v, _ = body.origin
        most = reaches.item(index) * OUTWARD + (PAD * (size + abs(u) + abs(v)) + LEAST_OF_SWEEPS)
        u, v = u - x, v - y
        time = (across * u + along * v) / length if length else 0.0
        time = min(time, 1.0) if time > 0 else 0.0
        u, v = u - time * across, v - time * along
        if not (u * u + v * v > most * most and length < LONGEST_SQUARE):
            passed_by.append(index)
    return passed_by
