"""Sweeps beside hyperboloids that end: ends, rims, discs and times forgotten or taken for others; and some right ones.

Each takes rows of sixteen numbers and returns hits and times, exact ones after what its sentence says was done to the
row; so it is wrong because of that alone.
"""

from __future__ import annotations

import numpy as np

from hypcheck import classify
from hypcheck.geometry.pair import AXIS, HEIGHTS, SIZES, SWEEP_COLUMNS
from hypcheck.implementations import sweeps
from tests.support.inside import answer_sweeps, passage_of
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

hypcheck = {"question": "passage", "times": True, "takes": ["axis", "heights"]}

BESIDE_ENDS = ("--families", "*ended-way-*", "--count", "0")
"""What they are asked, which is enough to reject the wrong ones."""

NAMES = (*SWEEP_COLUMNS, *AXIS, *HEIGHTS)
WITHOUT_ENDS = {"z_min": -np.inf, "z_max": np.inf, "solid": 0.0}


def _of(rows, name):
    return rows[:, NAMES.index(name)]


def _with(rows, **columns):
    """The rows with other numbers in some columns."""
    changed = rows.copy()
    for name, values in columns.items():
        changed[:, NAMES.index(name)] = values
    return changed


def _answered(rows):
    """The right answers to these rows."""
    found = [passage_of(tuple(row)) for row in rows.tolist()]
    return np.array([each.hit for each in found], dtype=np.int8), np.array([each.first_lower for each in found])


def _only_where(there, rows):
    """The right answers where the mask says so, and clear elsewhere."""
    hits, times = np.zeros(len(rows), dtype=np.int8), np.full(len(rows), np.nan)
    hits[there], times[there] = _answered(rows[there])
    return hits, times


def _centre(rows, times):
    """Centres at one time for each row: (n, 3)."""
    start, end = rows[:, 4:7], rows[:, 7:10]
    return np.where(times[:, None] == 1, end, start + times[:, None] * (end - start))


def _positions(rows, times):
    """Exact positions at one time for each row."""
    return classify(np.hstack([rows[:, : len(SIZES)], _centre(rows, times), rows[:, len(SWEEP_COLUMNS) :]]))


def _sampled(rows, count):
    """Contact at the first of so many equally distant times, both ends included, at which there is some."""
    hits, first = np.zeros(len(rows), dtype=np.int8), np.full(len(rows), np.nan)
    for time in np.linspace(0, 1, count):
        left = hits == 0
        met = _positions(rows[left], np.full(left.sum(), time)) == 0
        first[np.flatnonzero(left)[met]] = time
        hits[np.flatnonzero(left)[met]] = 1
    return hits, first


def _reaches_an_end(rows):
    """Whether the spheroid, or a ball around it, comes to an end of the hyperboloid or beyond."""
    reach = np.maximum(_of(rows, "b"), _of(rows, "d"))
    lowest, highest = (pick(_of(rows, "z0"), _of(rows, "z1")) for pick in (np.minimum, np.maximum))
    return (lowest - reach < _of(rows, "z_min")) | (highest + reach > _of(rows, "z_max"))


@wrong(claim=BESIDE_ENDS)
def ends_ignored(rows):
    """The sweep without ends."""
    return _answered(_with(rows, **WITHOUT_ENDS))


@wrong(claim=BESIDE_ENDS)
def heights_of_the_centre_alone(rows):
    """Clear where the centre stays above, or stays below, both ends; else the sweep without ends."""
    low, high = (pick(_of(rows, "z0"), _of(rows, "z1")) for pick in (np.minimum, np.maximum))
    beside = (high >= _of(rows, "z_min")) & (low <= _of(rows, "z_max"))
    return _only_where(beside, _with(rows, **WITHOUT_ENDS))


@wrong(claim=BESIDE_ENDS)
def while_the_centre_is_between_the_heights(rows):
    """The sweep without ends, cut to the times at which the centre is between the heights."""
    start, rise = _of(rows, "z0"), _of(rows, "z1") - _of(rows, "z0")
    ends = np.stack([_of(rows, "z_min"), _of(rows, "z_max")])
    with np.errstate(all="ignore"):
        passing = np.sort((ends - start) / rise, axis=0)
    level = np.where((ends[0] <= start) & (start <= ends[1]), [[0], [1]], [[1], [0]])
    first, last = np.clip(np.where(rise == 0, level, passing), 0, 1)
    cut = _with(rows, **WITHOUT_ENDS)
    cut[:, 4:7], cut[:, 7:10] = (_centre(rows, times) for times in (first, last))
    hits, times = _only_where((first < last) | ((first == last) & _between(rows, first)), cut)
    return hits, np.where(hits == 1, np.clip(first + times * (last - first), 0, 1), np.nan)


def _between(rows, times):
    """Whether the centre is between the heights at a time."""
    z = _centre(rows, times)[:, 2]
    return (_of(rows, "z_min") <= z) & (z <= _of(rows, "z_max"))


@wrong(claim=BESIDE_ENDS)
def only_the_start_and_the_end(rows):
    """The positions at the start and at the end."""
    return _sampled(rows, 2)


@wrong(claim=BESIDE_ENDS)
def sixteen_times(rows):
    """The positions at 16 times."""
    return _sampled(rows, 16)


@wrong(claim=BESIDE_ENDS)
def discs_forgotten(rows):
    """A solid body has no flat ends."""
    return _answered(_with(rows, solid=0.0))


@wrong(claim=BESIDE_ENDS)
def closed_for_open(rows):
    """Every body has flat ends."""
    return _answered(_with(rows, solid=1.0))


@wrong(claim=BESIDE_ENDS)
def rim_forgotten(rows):
    """The wall is looked for strictly between the ends, a millionth of a radius away from them."""
    low, high = _of(rows, "z_min") + 1e-6 * _of(rows, "d"), _of(rows, "z_max") - 1e-6 * _of(rows, "d")
    return _only_where(low < high, _with(rows, z_min=low, z_max=high))


@wrong(claim=BESIDE_ENDS)
def lower_end_with_the_other_sign(rows):
    """z_min is how far the body goes down, so that its sign is turned."""
    low, most = _of(rows, "z_min"), _of(rows, "z_max") - 1e-3 * _of(rows, "d")
    return _answered(_with(rows, z_min=np.where(np.isinf(low), low, np.minimum(-low, most))))


@wrong(claim=BESIDE_ENDS)
def upper_end_with_the_other_sign(rows):
    """The body ends as far below the waist as it should end above it."""
    high, least = _of(rows, "z_max"), _of(rows, "z_min") + 1e-3 * _of(rows, "d")
    return _answered(_with(rows, z_max=np.where(np.isinf(high), high, np.maximum(-high, least))))


@wrong(claim=BESIDE_ENDS)
def lower_end_forgotten(rows):
    """The body goes down for ever."""
    return _answered(_with(rows, z_min=-np.inf))


@wrong(claim=BESIDE_ENDS)
def radius_of_the_waist_at_the_rim(rows):
    """Where the spheroid reaches beyond an end, the wall is a cylinder as wide as the waist."""
    gamma = _of(rows, "gamma")
    return _answered(_with(rows, gamma=np.where(_reaches_an_end(rows), 1e6 * gamma, gamma)))


@wrong(claim=BESIDE_ENDS)
def ends_along_the_axis_of_the_spheroid(rows):
    """Ends are measured along the spheroid's axis."""
    axis = rows[:, 10:13]
    along = np.maximum(np.abs(axis[:, 2]) / np.sqrt((axis * axis).sum(axis=1)), 1e-3)
    return _answered(_with(rows, z_min=_of(rows, "z_min") / along, z_max=_of(rows, "z_max") / along))


@wrong(claim=BESIDE_ENDS)
def lowest_point_d_below(rows):
    """The spheroid ends d below and above its centre, however it is tilted: beyond that all the time it is clear."""
    d = _of(rows, "d")
    low, high = (pick(_of(rows, "z0"), _of(rows, "z1")) for pick in (np.minimum, np.maximum))
    return _only_where((high + d >= _of(rows, "z_min")) & (low - d <= _of(rows, "z_max")), rows)


@wrong(claim=BESIDE_ENDS)
def leaving_is_contact(rows):
    """The side changes where the centre passes an end, and so there is contact then."""
    hits, times = _answered(rows)
    sides = [_positions(rows, np.full(len(rows), time)) for time in (0.0, 1.0)]
    left = (hits == 0) & (sides[0] != sides[1])
    return np.where(left, 1, hits).astype(np.int8), np.where(left, 0.5, times)


@wrong(claim=BESIDE_ENDS)
def time_without_ends(rows):
    """The hit is right, the time that of the first contact without ends, where there is one."""
    hits, times = _answered(rows)
    endless = _answered(_with(rows, **WITHOUT_ENDS))[1]
    return hits, np.where((hits == 1) & ~np.isnan(endless), endless, times)


@wrong(claim=BESIDE_ENDS)
def time_of_the_wall(rows):
    """The hit is right, the time that of the first contact with the wall, where there is one."""
    hits, times = _answered(rows)
    wall = _answered(_with(rows, solid=0.0))[1]
    return hits, np.where((hits == 1) & ~np.isnan(wall), wall, times)


@wrong(claim=BESIDE_ENDS)
def late_times(rows):
    """Its times are one part in a million late."""
    hits, times = _answered(rows)
    return hits, np.minimum(times * (1 + 1e-6) + 1e-6, 1)


@wrong(claim=BESIDE_ENDS)
def times_a_trillionth_late(rows):
    """Its times are one part in a trillion late, thousands of units."""
    hits, times = _answered(rows)
    return hits, np.minimum(times * (1 + 1e-12), 1)


@wrong(claim=BESIDE_ENDS)
def times_in_float32(rows):
    """Its times are rounded to float32."""
    hits, times = _answered(rows)
    return hits, times.astype(np.float32).astype(np.float64)


@right(claim=BESIDE_ENDS, asked=NO_TOLERANCE)
def exact(rows):
    """What the wrong ones are made of: the exact decision."""
    return _answered(rows)


@right(claim=BESIDE_ENDS, asked=NO_TOLERANCE)
def exact_from_above(rows):
    """The exact decision, its times rounded up."""
    found = [passage_of(tuple(row)) for row in rows.tolist()]
    return np.array([each.hit for each in found], dtype=np.int8), np.array([each.first_upper for each in found])


@right(claim=BESIDE_ENDS, asked=NO_TOLERANCE)
def certified(rows):
    """The certified steps, and the exact times."""
    hits = sweeps.certified(rows)
    return hits, np.where(hits == 1, _answered(rows)[1], np.nan)


@right(claim=BESIDE_ENDS)
def certified_times(rows):
    """What the certified steps say alone, times too, which are early but no more than is tolerated."""
    return answer_sweeps(np.ascontiguousarray(rows))


@right(claim=BESIDE_ENDS, asked=NO_TOLERANCE)
def mirrored_below_the_waist(rows):
    """Everything mirrored at z = 0: both centres, the axis, and the ends exchanged."""
    names = ("z0", "z1", "axis_z")
    turned = {name: -_of(rows, name) for name in names}
    return _answered(_with(rows, **turned, z_min=-_of(rows, "z_max"), z_max=-_of(rows, "z_min")))
