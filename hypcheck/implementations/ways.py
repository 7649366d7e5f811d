"""Methods that answer whether a spheroid meets the hyperboloid on a straight way, and when first.

Lengths are in spheroid radii here: across divided by b, along by d. The spheroid is then a unit ball, and it is in
contact as long as its centre is no farther than 1 from the surface. A method returns hits, int8 (n,), and times,
float64 (n,), NaN where it sees no contact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Rows
from hypcheck.kernel.classify import kernel
from hypcheck.truth.passage_error import scaled_passage

HitsAndTimes = tuple[NDArray[np.int8], Floats]

_HALVINGS = 100
"""Bisections of the multiplier: enough for every float64 between its two ends."""

_ZOOM, _ZOOMS = 64, 5
"""The least distance of a way is looked for on so many pieces, so often, then between the neighbours of the best."""

MOST_ADVANCES = 400
"""Steps of conservative advancement before it gives up."""

NEARNESS = 1e-6
"""Conservative advancement calls it contact within this part of a radius."""


def exact(rows: Rows) -> HitsAndTimes:
    """The exact decision, and the float64 below the first contact."""
    found = [scaled_passage(row) for row in rows.tolist()]
    return np.array([each.hit for each in found], dtype=np.int8), np.array([each.first_lower for each in found])


def sampled(rows: Rows, count: int) -> HitsAndTimes:
    """Exact positions at `count` equally distant times, both ends included: contact, or the other side than before."""
    times = np.linspace(0.0, 1.0, count)
    positions = _positions(rows, times)
    return _first(positions == 0, times)


def _positions(rows: Rows, times: Floats) -> NDArray[np.int8]:
    """Positions (n, m) at m times."""
    n, m = len(rows), len(times)
    asked = np.empty((n, m, len(COLUMNS)))
    asked[:, :, :4] = rows[:, None, :4]
    asked[:, :, 4:] = rows[:, None, 4:7] + times[None, :, None] * (rows[:, 7:10] - rows[:, 4:7])[:, None, :]
    asked[:, times == 1.0, 4:] = rows[:, None, 7:10]
    positions = kernel().answer_rows(asked.reshape(n * m, len(COLUMNS)), "position", 1)[0]
    return positions.reshape(n, m)


def _first(touching: NDArray[np.bool_], times: Floats) -> HitsAndTimes:
    """The first of the times at which each row is touching."""
    hits = touching.any(axis=1)
    first: Floats = np.where(hits, times[np.argmax(touching, axis=1)], np.nan)
    return np.asarray(hits, dtype=np.int8), first


def distances(rows: Rows, times: Floats) -> Floats:
    """Distances (n,) of the centres at the times (n,) from the surface, in spheroid radii.

    The nearest point is where a multiplier solves the secular equation, which falls in it, between two poles.
    """
    alpha, gamma, b, d = rows[:, :4].T
    a, c = alpha / b, gamma / d
    x, y, z = (rows[:, 4 + i] + times * (rows[:, 7 + i] - rows[:, 4 + i]) for i in range(3))
    r, q = np.hypot(x, y) / b, np.abs(z) / d
    low, high = -a * a, c * c
    with np.errstate(all="ignore"):
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            outer = (r / (a + middle / a)) ** 2 - (q / (c - middle / c)) ** 2 > 1
            low, high = np.where(outer, middle, low), np.where(outer, high, middle)
        near_r = r / (1 + low / (a * a))
        near_q = q / (1 - low / (c * c))
        outside = low > 0
        near_q = np.where(outside, c * np.sqrt(np.maximum((near_r / a) ** 2 - 1, 0)), near_q)
        near_r = np.where(outside, near_r, a * np.sqrt(1 + (near_q / c) ** 2))
    return np.asarray(np.hypot(r - near_r, q - near_q))


def least_distances(rows: Rows) -> Floats:
    """Rough least distances (n,) on each way, in spheroid radii: the factor of the size that first has contact."""
    n = len(rows)
    low, high = np.zeros(n), np.ones(n)
    best = np.full(n, np.inf)
    for _ in range(_ZOOMS):
        times = low[:, None] + np.linspace(0.0, 1.0, _ZOOM + 1)[None, :] * (high - low)[:, None]
        found = distances(np.repeat(rows, _ZOOM + 1, axis=0), times.ravel()).reshape(n, _ZOOM + 1)
        place = np.argmin(found, axis=1)
        best = np.minimum(best, found[np.arange(n), place])
        low = times[np.arange(n), np.maximum(place - 1, 0)]
        high = times[np.arange(n), np.minimum(place + 1, _ZOOM)]
    return best


def lengths_of(rows: Rows) -> Floats:
    """Lengths (n,) of ways in spheroid radii."""
    x, y, z = (rows[:, 7:10] - rows[:, 4:7]).T
    b, d = rows[:, 2], rows[:, 3]
    return np.asarray(np.hypot(np.hypot(x / b, y / b), z / d))


def advanced(rows: Rows) -> HitsAndTimes:
    """Conservative advancement: from each time as far as the distance then allows, until within NEARNESS of contact.

    CANNOT_SAY where MOST_ADVANCES steps reach neither the surface nor the end of the way.
    """
    n, speed = len(rows), lengths_of(rows)
    hits, times, now = np.full(n, CANNOT_SAY, dtype=np.int8), np.full(n, np.nan), np.zeros(n)
    going = np.arange(n)
    for _ in range(MOST_ADVANCES):
        gap = distances(rows[going], now[going]) - 1
        met = gap <= NEARNESS
        hits[going[met]], times[going[met]] = 1, now[going[met]]
        going, gap = going[~met], gap[~met]
        over = now[going] >= 1
        hits[going[over]] = 0
        going, gap = going[~over], gap[~over]
        with np.errstate(divide="ignore"):
            now[going] = np.minimum(1.0, now[going] + gap / speed[going])
        if not len(going):
            break
    return hits, times


def capsule(rows: Rows) -> HitsAndTimes:
    """The swept ball around the spheroid in its place: conservative advancement of a ball with the larger semi-axis."""
    balls = rows.copy()
    balls[:, 2] = balls[:, 3] = np.maximum(rows[:, 2], rows[:, 3])
    return advanced(balls)


def certified(rows: Rows) -> NDArray[np.int8]:
    """Hits (n,): by the kernel, whose bounds prove what they decide; by the exact decision where they do not tell."""
    hits = kernel().answer_ways(rows)[0]
    rest = np.flatnonzero(hits == CANNOT_SAY)
    hits[rest] = exact(rows[rest])[0]
    return hits


def rough_exponents(rows: Rows) -> Floats:
    """log2 of how far the sizes of spheroids are from those with which contact begins on their ways, roughly: (n,)."""
    off = np.abs(least_distances(rows) - 1)
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.isnan(off), -np.inf, np.log2(off)))
