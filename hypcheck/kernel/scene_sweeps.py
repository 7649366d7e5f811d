"""Sweeps of one mover beside one hyperboloid, straight motions in the scene's coordinates: contact or none, exactly.

The kernel's answer about sweeps (core/parts/ways.h) is asked twice: about a spheroid that is larger, and about one that
is smaller, by what the rounding of the difference of two centres may be in radii, as for positions (scene_pairs.py).
The larger one clear is clear, the smaller one in contact is contact. What is left is decided from the exact differences
by truth/swept.py. Nowhere else does the kernel ask that room: no other exact decision about sweeps is known. So is a
sweep that may hit, and leaves the modelled height: of it the part at that height counts. Beside a tilted hyperboloid
both ends and the mover's axis are turned into its frame (scene_frames.py), and the roundings of that are added.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, isqrt

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import UPRIGHT, Position, to_integers
from hypcheck.geometry.rows import Floats, Indices, Mask, Rows
from hypcheck.kernel.classify import kernel
from hypcheck.kernel.scene_frames import TURNING, frames_of, turned, turned_axes
from hypcheck.kernel.scene_index import Bodies
from hypcheck.kernel.scene_pairs import LEAST, larger_and_smaller
from hypcheck.scene.model import Mover
from hypcheck.truth.swept import passage


def hits_beside(
    bodies: Bodies, body: Indices, mover: Mover, starts: Rows, ends: Rows, axes: Rows | None = None
) -> Mask:
    """Which ways of a mover have contact with their hyperboloid, where it is modelled, (n,).

    `starts` and `ends`, (n, 3), are in the scene's coordinates, and `axes`, (n, 3), the mover's; None: it is upright.
    """
    origins, shapes, spans = bodies.origins[body], bodies.shapes[body], bodies.spans[body]
    with np.errstate(all="ignore"):
        (start, lost_start), (end, lost_end) = two_sum(starts, -origins), two_sum(ends, -origins)
        lost = np.maximum(np.abs(lost_start), np.abs(lost_end)).sum(axis=1)
        own_axes = axes
        if bodies.leaning[body].any():
            start, end, own_axes, turning = _in_frames(bodies.axes[body], mover, start, end, axes)
            lost = lost + turning
        low = np.minimum(start[:, 2], end[:, 2]) - lost
        high = np.maximum(start[:, 2], end[:, 2]) + lost
        leaves, beyond = (low < spans[:, 0]) | (high > spans[:, 1]), (high < spans[:, 0]) | (low > spans[:, 1])
    larger, smaller, fits = larger_and_smaller(np.broadcast_to((mover.b, mover.d), (len(body), 2)), lost)
    place = [start, end] if own_axes is None else [start, end, own_axes]
    hits = np.zeros(len(body), np.bool_)
    open_ways = ~fits & ~beyond
    asked = np.flatnonzero(fits & ~beyond)
    said = kernel().answer_ways(np.concatenate([shapes, larger, *place], axis=1)[asked])[0]
    asked = asked[said != 0]
    said = kernel().answer_ways(np.concatenate([shapes, smaller, *place], axis=1)[asked])[0]
    hits[asked] = said == 1
    open_ways[asked] = (said != 1) | leaves[asked]
    for index in np.flatnonzero(open_ways).tolist():
        axis = UPRIGHT if axes is None else axes[index].tolist()
        way = Sweep(starts[index].tolist(), ends[index].tolist(), axis)
        hits[index] = not is_clear(bodies, int(body[index]), [(mover.b, mover.d, way)], way)
    return hits


def _in_frames(
    upward: Rows, mover: Mover, start: Floats, end: Floats, axes: Rows | None
) -> tuple[Floats, Floats, Floats, Floats]:
    """Both ends and the mover's axis in the frames of hyperboloids with these axes, and how far they are off at most.

    An axis that is off by an angle δ moves no point of the spheroid farther than δ times its longer semi-axis.
    """
    frames = frames_of(upward)
    lean = (upward[:, :2] != 0).any(axis=1)
    size = np.maximum(np.abs(start).sum(axis=1), np.abs(end).sum(axis=1)) + max(mover.b, mover.d)
    error = np.where(lean, TURNING * size + LEAST, 0.0)
    return turned(frames, start), turned(frames, end), turned_axes(frames, axes), error


@dataclass(frozen=True, slots=True)
class Sweep:
    """Where a spheroid goes straight, in the scene's coordinates, and its axis."""

    start: Sequence[float]
    end: Sequence[float]
    axis: Sequence[float]


Times = tuple[Fraction, Fraction]
"""A first and a last time; none, where the last is before the first."""


def is_clear(bodies: Bodies, index: int, spheroids: Sequence[tuple[float, float, Sweep]], mover: Sweep) -> bool:
    """Whether spheroids (b, d, way) stay clear of a hyperboloid, on one side, while a mover is at its modelled height.

    Ends of that height may be irrational, where the hyperboloid is tilted. They are enclosed ever more narrowly, until
    between the outer ones all is clear, or between the inner ones it is not. A contact at the very instant, within
    2^−_MOST_BITS of it, counts as one.
    """
    shape, origin = bodies.shapes[index].tolist(), bodies.origins[index].tolist()
    span, upward = _span_and_axis(bodies, index)
    for outer, inner in _times_within(mover, origin, span, upward):
        if _stays_clear(shape, origin, upward, spheroids, outer):
            return True
        if inner == outer or not _stays_clear(shape, origin, upward, spheroids, inner):
            return False
    return False


def _span_and_axis(bodies: Bodies, index: int) -> tuple[list[float], Sequence[float]]:
    """The modelled heights and the direction in which they are counted, which is up where the axis is vertical."""
    return bodies.spans[index].tolist(), bodies.axes[index].tolist() if bodies.leaning[index] else UPRIGHT


def _stays_clear(
    shape: Sequence[float],
    origin: Sequence[float],
    upward: Sequence[float],
    spheroids: Sequence[tuple[float, float, Sweep]],
    times: Times,
) -> bool:
    if times[0] > times[1]:
        return True
    found = set()
    for b, d, way in spheroids:
        here, there = (
            [Fraction(part) - Fraction(centre) for part, centre in zip(point, origin, strict=True)]
            for point in (way.start, way.end)
        )
        ends = [[low + time * (high - low) for low, high in zip(here, there, strict=True)] for time in times]
        what = passage((*shape, b, d), ends[0], ends[1], way.axis, upward)
        found.add(Position.CONTACT if what.hit else what.start)
    return len(found) == 1 and Position.CONTACT not in found


_MOST_BITS = 1024


def _times_within(
    way: Sweep, origin: Sequence[float], span: Sequence[float], upward: Sequence[float]
) -> Iterator[tuple[Times, Times]]:
    """Enclosures, from without and from within, of the times at which a centre is at heights above an origin.

    The height is w·(X − c)/|w|. Where |w| is rational both are the same, and the only ones.
    """
    w: list[int] = to_integers(upward)
    below, above = (
        sum((Fraction(part) - Fraction(centre)) * along for part, centre, along in zip(point, origin, w, strict=True))
        for point in (way.start, way.end)
    )
    square, bits = sum(along * along for along in w), 64
    while bits <= _MOST_BITS:
        root = Fraction(isqrt(square << 2 * bits), 1 << bits)
        exact = root * root == square
        lengths = (root, root if exact else root + Fraction(1, 1 << bits))
        outer, inner = (
            _crossing_times(Fraction(below), Fraction(above), span, lengths, wide) for wide in (True, False)
        )
        yield outer, outer if exact else inner
        if exact:
            return
        bits *= 2


def _crossing_times(
    below: Fraction, above: Fraction, span: Sequence[float], lengths: tuple[Fraction, Fraction], wide: bool
) -> Times:
    """The first and last time in [0, 1] at which a number that goes from `below` to `above` is in the span · |w|.

    |w| lies between two lengths; `wide` takes the ones with which the times are more, not fewer.
    """
    low, high = (
        None if abs(end) == inf else pick(Fraction(end) * length for length in lengths)
        for end, pick in zip(span, (min, max) if wide else (max, min), strict=True)
    )
    if above == below:
        inside = (low is None or low <= below) and (high is None or below <= high)
        return Fraction(0), Fraction(1) if inside else Fraction(-1)
    at = [None if level is None else (level - below) / (above - below) for level in (low, high)]
    enters, leaves = at if above > below else reversed(at)
    first = Fraction(0) if enters is None else max(Fraction(0), enters)
    last = Fraction(1) if leaves is None else min(Fraction(1), leaves)
    return first, last


def meets_height(bodies: Bodies, index: int, way: Sweep) -> bool:
    """Whether a mover on its way is at some time at the modelled height of a hyperboloid."""
    times = [outer for outer, _ in _times_within(way, bodies.origins[index].tolist(), *_span_and_axis(bodies, index))][
        -1
    ]
    return times[0] <= times[1]
