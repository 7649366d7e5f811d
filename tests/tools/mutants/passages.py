"""Ways answered wrongly: ends, instants, intervals and columns mistaken, other bodies, late times; and right ones.

Each takes rows (n, 10) and returns hits and times. Most answer exactly after what their sentence says was done to the
row, so that they are wrong because of that alone.
"""

from __future__ import annotations

import math

import numpy as np

from hypcheck import classify
from hypcheck.implementations import sweeps
from tests.support.inside import passage, passage_of
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

hypcheck = {"question": "passage", "times": True}

TRAPS = (
    "--families",
    "way-small-integers,way-end,way-grazing,way-ring,way-still,way-anywhere",
    "--count",
    "0",
)
"""What they are asked, which is enough to reject the wrong ones; deciding ways exactly takes its time."""


def _found(rows):
    return [passage_of(tuple(row)) for row in rows.tolist()]


def _told(found):
    hits = np.array([each.hit for each in found], dtype=np.int8)
    return hits, np.array([each.first_lower for each in found])


def _changed(rows, **columns):
    """The right answers to rows with other values in these columns."""
    names = ("alpha", "gamma", "b", "d", "x0", "y0", "z0", "x1", "y1", "z1")
    other = rows.copy()
    for name, values in columns.items():
        other[:, names.index(name)] = values
    return _told(_found(other))


@wrong(claim=TRAPS)
def samples_only_the_end(rows):
    """It tests the end of the step alone."""
    touching = classify(np.ascontiguousarray(rows[:, [0, 1, 2, 3, 7, 8, 9]])) == 0
    return touching.astype(np.int8), np.where(touching, 1.0, np.nan)


@wrong(claim=TRAPS)
def samples_only_the_start(rows):
    """It tests the start alone."""
    touching = classify(np.ascontiguousarray(rows[:, :7])) == 0
    return touching.astype(np.int8), np.where(touching, 0.0, np.nan)


@wrong(claim=TRAPS)
def samples_both_ends(rows):
    """It tests both ends."""
    return sweeps.sampled(rows, 2)


@wrong(claim=TRAPS)
def samples_16_points(rows):
    """It tests 16 points."""
    return sweeps.sampled(rows, 16)


@wrong(claim=TRAPS)
def samples_256_points(rows):
    """It tests 256 points, and times are those of points."""
    return sweeps.sampled(rows, 256)


@wrong(claim=TRAPS)
def ignores_start(rows):
    """It takes the way to begin at the origin."""
    return _changed(rows, x0=0.0, y0=0.0, z0=0.0)


@wrong(claim=TRAPS)
def ignores_the_rise(rows):
    """It takes the way to be horizontal."""
    return _changed(rows, z1=rows[:, 6])


@wrong(claim=TRAPS)
def ignores_the_drift(rows):
    """It takes the way to be vertical."""
    return _changed(rows, x1=rows[:, 4], y1=rows[:, 5])


@wrong(claim=TRAPS)
def swaps_x_and_z(rows):
    """It reads z where x is."""
    return _changed(rows, x0=rows[:, 6], z0=rows[:, 4], x1=rows[:, 9], z1=rows[:, 7])


@wrong(claim=TRAPS)
def swaps_ends(rows):
    """It goes from the end to the start."""
    return _changed(rows, x0=rows[:, 7], y0=rows[:, 8], z0=rows[:, 9], x1=rows[:, 4], y1=rows[:, 5], z1=rows[:, 6])


@wrong(claim=TRAPS)
def end_is_a_step(rows):
    """It adds the end to the start, as if it were a step."""
    x, y, z = (rows[:, 4:7] + rows[:, 7:10]).T
    return _changed(rows, x1=x, y1=y, z1=z)


@wrong(claim=TRAPS)
def swaps_semi_axes(rows):
    """It reads d where b is."""
    return _changed(rows, b=rows[:, 3], d=rows[:, 2])


@wrong(claim=TRAPS)
def ball_around(rows):
    """It takes the ball around the spheroid."""
    return _changed(rows, b=rows[:, 2:4].max(axis=1), d=rows[:, 2:4].max(axis=1))


@wrong(claim=TRAPS)
def ball_within(rows):
    """It takes the ball within the spheroid."""
    return _changed(rows, b=rows[:, 2:4].min(axis=1), d=rows[:, 2:4].min(axis=1))


@wrong(claim=TRAPS, asked=NO_TOLERANCE)
def open_interval(rows):
    """Contact at time 0 or 1 alone does not count."""
    hits, times = _told(_found(rows))
    for place, row in enumerate(rows.tolist()):
        inner = passage(row[:4], *(_at(row, time) for time in (2.0**-20, 1 - 2.0**-20)))
        if not inner.hit:
            hits[place], times[place] = 0, math.nan
    return hits, times


def _at(row, time):
    return [start + time * (end - start) for start, end in zip(row[4:7], row[7:10], strict=True)]


@wrong(claim=TRAPS)
def endless_line(rows):
    """It takes the line for the way, three times as long."""
    start, end = rows[:, 4:7], rows[:, 7:10]
    step = end - start
    x0, y0, z0 = (start - step).T
    x1, y1, z1 = (end + step).T
    hits, times = _changed(rows, x0=x0, y0=y0, z0=z0, x1=x1, y1=y1, z1=z1)
    return hits, np.clip(3 * times - 1, 0, 1)


@wrong(claim=TRAPS, asked=NO_TOLERANCE)
def grazing_is_clear(rows):
    """A surface that is only touched for an instant does not count."""
    return _told_unless(rows, [each.grazes for each in _found(rows)])


@wrong(claim=TRAPS)
def unmoved_is_clear(rows):
    """Where nothing moves it divides by 0, and says clear."""
    return _told_unless(rows, (rows[:, 4:7] == rows[:, 7:10]).all(axis=1))


def _told_unless(rows, clear):
    hits, times = _told(_found(rows))
    clear = np.asarray(clear)
    return np.where(clear, 0, hits).astype(np.int8), np.where(clear, np.nan, times)


@wrong(claim=TRAPS)
def ring_is_contact(rows):
    """A way that crosses the ring, where the discriminant vanishes, counts as contact."""
    hits, times = _told(_found(rows))
    alpha, gamma, b, d = rows[:, :4].T
    a, c = alpha / b, gamma / d
    ring = np.sqrt((c * c + 1) * (a * a + c * c) / (c * c))
    start, end = np.hypot(rows[:, 4], rows[:, 5]) / b, np.hypot(rows[:, 7], rows[:, 8]) / b
    level = (rows[:, 6] == 0) & (rows[:, 9] == 0)
    crosses = level & (c * c > a) & ((start - ring) * (end - ring) <= 0) & (hits == 0)
    return np.where(crosses, 1, hits).astype(np.int8), np.where(crosses, 0.5, times)


@wrong(claim=TRAPS)
def inside_is_contact(rows):
    """A spheroid inside the hyperboloid counts as in contact."""
    found = _found(rows)
    inside = np.array([each.start == -1 or each.end == -1 for each in found])
    hits, times = _told(found)
    return np.where(inside, 1, hits).astype(np.int8), np.where(inside & (hits == 0), 0.0, times)


@wrong(claim=TRAPS)
def contact_is_a_change_of_sides(rows):
    """It sees contact only where both ends of the way have another position."""
    return _told_unless(rows, [each.start == each.end for each in _found(rows)])


@wrong(claim=TRAPS)
def late_times(rows):
    """Its times are one part in a million late."""
    hits, times = _told(_found(rows))
    return hits, np.minimum(times * (1 + 1e-6) + 1e-6, 1.0)


@wrong(claim=TRAPS)
def early_times(rows):
    """Its times are one part in a million early."""
    hits, times = _told(_found(rows))
    return hits, np.maximum(times * (1 - 1e-6), 0.0)


@wrong(claim=TRAPS)
def times_backwards(rows):
    """Its times count from the end."""
    hits, times = _told(_found(rows))
    return hits, 1 - times


@wrong(claim=TRAPS)
def times_in_float32(rows):
    """Its times are rounded to float32."""
    hits, times = _told(_found(rows))
    return hits, times.astype(np.float32).astype(np.float64)


@wrong(claim=TRAPS)
def never(rows):
    """It always says clear."""
    return np.zeros(len(rows), dtype=np.int8), np.full(len(rows), np.nan)


@wrong(claim=TRAPS)
def always(rows):
    """It always says contact at once."""
    return np.ones(len(rows), dtype=np.int8), np.zeros(len(rows))


@right(claim=TRAPS, asked=NO_TOLERANCE)
def exact(rows):
    """The exact decision."""
    return sweeps.exact(rows)


@right(claim=TRAPS, asked=NO_TOLERANCE)
def exact_from_above(rows):
    """The exact decision, its times rounded up."""
    found = _found(rows)
    return np.array([each.hit for each in found], dtype=np.int8), np.array([each.first_upper for each in found])


@right(claim=TRAPS, asked=NO_TOLERANCE)
def certified(rows):
    """The certified steps, and the exact times."""
    hits = sweeps.certified(rows)
    return hits, np.where(hits == 1, _told(_found(rows))[1], np.nan)
