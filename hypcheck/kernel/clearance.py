"""Clearances, distances and nearest points of many pairs, each between two proved numbers; and positions with a margin.

Without ends, clearance_bounds.py proves them by exact decisions. Where its bounds of a distance are farther apart than
promised, scene_gaps.py measures the gap by branch and bound: the guessed nearest point was another stationary one, or a
larger spheroid reaches the hyperboloid elsewhere.

Beside hyperboloids that end, rows (n, 13), exact decisions of truth/exact.py enclose the clearance. A spheroid scaled
about its centre by 1 + clearance just touches wall, rim or disc. Let c be the clearance of a clear pair. Every point
nearer than c min(b, d) lies in the scaled spheroid, and the point that it touches is at most c max(b, d) from the
spheroid: the distance lies between the two, and for a sphere they are equal.

With a margin δ, a spheroid that is not proved to be at least so far away counts as contact. Two proofs are tried. The
spheroid with the semi-axes √((v + δ)(b²/v + δ)) and √((v + δ)(d²/v + δ)) contains all points within δ of the given one,
for any v > 0 (clearance_bounds.py says why): if it is clear, so is the given one, on the same side, and its distance is
at least δ. Here v is b, for which the wider semi-axis is b + δ. If that proves nothing, the lower bound of the distance
decides. OUTWARD covers the twelve roundings of a semi-axis, for lengths in 2^±300.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.arithmetic import rounded_toward
from hypcheck.geometry.forms import Argument, questions_of
from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS, Pair, Position, trouble_with
from hypcheck.geometry.rows import PAIRS, Floats, Indices, Mask, Positions, Rows, invalid, upright_mask, with_heights
from hypcheck.kernel.choice import Question, answers_to, are_apart, required
from hypcheck.kernel.clearance_bounds import OUTWARD, RANGE, Clearance, clearances_without_ends
from hypcheck.kernel.clearance_points import reaching
from hypcheck.kernel.in_use import positions_of_rows
from hypcheck.kernel.scene_gaps import gaps, gaps_at

_ROUNDED = 2.0**-47
"""The rounding error of a point of a wall, in units of the lengths that it is computed from."""

_LEAST = 2.0**-1074
"""The rounding error of a point where its product with _ROUNDED underflows to 0."""

_FAR, _WIDE = 2.0**12, 2.0**-12
"""Of a wall so many times as large as a tilted spheroid, many places are nearly as near, and to tell them apart takes
30 ms a row: there gaps are measured where bounds are farther apart than that share."""

_AT_A_TIME = 256
"""How many gaps are measured together: each may need thousands of cells."""


@in_default_environment
def clearance(
    *pairs: Argument,
    axis: ArrayLike | None = None,
    z_min: ArrayLike = -math.inf,
    z_max: ArrayLike = math.inf,
    solid: ArrayLike = False,
    on_invalid: Literal["raise", "flag"] = "raise",
    threads: int | None = None,
    **columns: ArrayLike,
) -> Clearance:
    """Return the distance, the nearest points and the clearance of every pair, each between two proved numbers.

    Pairs are written as in classify: rows, a table, or sizes and centres. One pair of numbers is answered by numbers.
    The first invalid row raises InputError; with on_invalid="flag" such rows have the position 127 and NaN everywhere.

    The clearance is known within 2⁻³⁰ of 1 + clearance, or of 1 where that is greater, unless the spheroid so much
    enlarged leaves float64. The distance is known within 2⁻²⁹ of itself and the longer of b and d, unless lengths are
    more than 10³ times as large as others. Then it lies between clearance · min(b, d) and clearance · max(b, d), or
    nearer, as it mostly does. For some long and flat spheroids, and wherever the hyperboloid ends, a row takes
    milliseconds; beside ends no error of the touching point is proved.

    >>> near = clearance(2, 17.8, 0.25, 0.15, [3, 4, 0])
    >>> near.distance_lower <= 2.75 <= near.distance_upper
    True
    >>> near.normal.round(12)
    array([0.6, 0.8, 0. ])
    """
    number = required("position", threads, on_invalid)
    call = questions_of(pairs, columns, axis, (z_min, z_max, solid))
    queries = call.rows()
    result = clearances(queries, number)
    if on_invalid == "raise" and (result.position == REFUSED).any():
        call.require_valid(queries)
    return result.one if call.single else result


def clearances(queries: Rows, threads: int | None = None) -> Clearance:
    """Return clearances of rows of any width; invalid rows have the position 127 and NaN everywhere."""
    if PAIRS.has_heights(queries):
        return _ended_clearances(queries, threads)
    result = clearances_without_ends(queries, threads)
    _measure_gaps(result, np.flatnonzero(_still_apart(result, np.ones(len(queries), np.bool_))))
    return result


def _ended_clearances(rows: Rows, threads: int | None = None) -> Clearance:
    """Return the result of clearance() for valid rows (n, 13): rows with infinite ends together, the others one by one.

    `touch` is then the point of wall, rim or disc that the scaled spheroid touches, as far as floats know it, and so is
    `nearest` where no shorter gap was measured. Their errors have no proved bound. Invalid rows keep the values for
    unknown rows.
    """
    from hypcheck.truth import ended_error, exact, least  # noqa: PLC0415 - rows with heights alone need them

    result = replace(clearances_without_ends(np.ascontiguousarray(rows[:, : len(TILTED_COLUMNS)]), threads), rows=rows)
    refused = invalid(rows)
    for values in (
        result.lower,
        result.upper,
        result.touch,
        result.distance_lower,
        result.distance_upper,
        result.nearest,
    ):
        values[refused] = np.nan
    result.position[refused] = REFUSED
    ended = np.flatnonzero(np.isfinite(rows[:, 10:12]).any(axis=1) & ~refused)
    for index in ended.tolist():
        pair = Pair.from_row(rows[index].tolist())
        decision = exact.decide(pair.lengths)
        low, high = ended_error.enclosure(pair, decision)
        clear = decision.position is not Position.CONTACT
        result.position[index] = decision.position
        result.lower[index], result.upper[index] = rounded_toward(low, -np.inf), rounded_toward(high, np.inf)
        result.touch[index] = result.nearest[index] = least.to_border(pair).point
        result.touch_error[index] = np.inf
        result.distance_lower[index] = rounded_toward(low * Fraction(min(pair.b, pair.d)), -np.inf) if clear else 0.0
        result.distance_upper[index] = rounded_toward(high * Fraction(max(pair.b, pair.d)), np.inf) if clear else 0.0
    whole = np.asarray(np.isinf(rows[:, 10:12]).all(axis=1))
    wanted = _still_apart(result, whole)
    wanted[ended] = result.position[ended] != Position.CONTACT
    _measure_gaps(result, np.flatnonzero(wanted))
    return result


def _still_apart(result: Clearance, whole: Mask) -> Mask:
    """Return a mask of the rows whose gap must be measured, after the known nearest points were measured again.

    The bound of a long spheroid's measured gap grows by the square of d/b in clearance_bounds.py, and here not at all.
    """
    with np.errstate(all="ignore"):
        wanted = _apart(result) & whole
        apart = np.flatnonzero(wanted)
        if not len(apart):
            return wanted
        some = with_heights(result.rows[apart])
        upper, point = gaps_at(some[:, :4], some[:, 4:7], some[:, 7:10], result.nearest[apart])
        upper += _roundings(some, point)
        better = upper < result.distance_upper[apart]
        result.distance_upper[apart[better]], result.nearest[apart[better]] = upper[better], point[better]
        return _apart(result) & whole


def _apart(result: Clearance) -> Mask:
    """Return a mask of the rows with bounds of the distance that are too far apart, and a gap that can be measured."""
    low, high = result.distance_lower, result.distance_upper
    longer = np.maximum(result.rows[:, 2], result.rows[:, 3])
    apart: Mask = are_apart(low, high, longer) & np.isfinite(high)
    some = np.flatnonzero(apart)
    if not len(some):
        return apart
    rows, longer, low, high = result.rows[some], longer[some], low[some], high[some]
    reach = np.abs(rows[:, 2:7]).max(axis=1)
    shares = rows[:, :4] / reach[:, None]
    apart[some] = ((shares >= RANGE[0]) & (shares <= RANGE[1])).all(axis=1)
    if PAIRS.has_axis(rows):
        far = ~upright_mask(rows) & (np.maximum(reach, rows[:, 0]) > _FAR * longer)
        apart[some] &= ~far | (high - low > _WIDE * (low + longer))
    return apart


def _measure_gaps(result: Clearance, clear: Indices) -> None:
    """Replace bounds of distances, and nearest points, of some rows by better ones where the gap can be measured."""
    with np.errstate(all="ignore"):
        for start in range(0, len(clear), _AT_A_TIME):
            _measure_some(result, clear[start : start + _AT_A_TIME])


def _measure_some(result: Clearance, clear: Indices) -> None:
    """Do so for rows that are measured together."""
    some = with_heights(result.rows[clear])
    measured = gaps(
        some[:, :4], some[:, 4:7], some[:, 7:10], some[:, 10:12], some[:, 12] != 0, result.distance_upper[clear]
    )
    rounded = _roundings(some, measured.point)
    upper = measured.upper + rounded
    better = upper < result.distance_upper[clear]
    shown = measured.upper <= result.distance_upper[clear] + rounded
    result.distance_lower[clear] = np.fmax(result.distance_lower[clear], measured.lower)
    result.distance_upper[clear[better]] = upper[better]
    result.nearest[clear[shown]] = measured.point[shown]


def _roundings(rows: Rows, point: Rows) -> Floats:
    """Return the errors of points of walls and of their distances: 64u of the lengths that they are computed from."""
    lengths = np.abs(point).sum(axis=1) + np.abs(rows[:, 4:7]).sum(axis=1) + rows[:, 2:4].sum(axis=1)
    return np.asarray(_ROUNDED * lengths + _LEAST)


def checked_margin(margin: object) -> float:
    """Return the margin as a float, 0 or more. Raises InputError."""
    value = margin.item() if isinstance(margin, np.generic) else margin
    trouble = trouble_with("margin", value)
    if trouble is None and value < 0:  # type: ignore[operator]  # a number
        trouble = f"margin is {value!r}; it must be 0 or more"
    if trouble is not None:
        raise InputError(trouble)
    return float(value)  # type: ignore[arg-type]


def enlarged(b: ArrayLike, d: ArrayLike, margin: ArrayLike, half: ArrayLike | None = None) -> tuple[Floats, Floats]:
    """Return semi-axes of spheroids that contain all points within `margin` of those given, (n,) each.

    They are inf where they are not known.

    They are no larger than necessary in the directions in which the given ones are `half` (n,) wide; `half` is b by
    default.
    """
    b, d, margin = (np.asarray(numbers, np.float64) for numbers in (b, d, margin))
    margin = np.maximum(margin, RANGE[0])
    v = b if half is None else np.asarray(half, np.float64)
    fits = (np.minimum(b, d) >= RANGE[0]) & (np.maximum(b, d) <= RANGE[1]) & (margin <= RANGE[1]) & (v >= RANGE[0])
    with np.errstate(all="ignore"):
        wide, tall = (size * OUTWARD for size in reaching(b, d, v, margin))
    return np.where(fits, wide, math.inf), np.where(fits, tall, math.inf)


def with_margin(rows: Rows, positions: Positions, margin: float, question: Question, threads: int | None) -> Positions:
    """Return the answers for rows with these positions, 127 for invalid ones: contact unless the margin is proved."""
    margin = checked_margin(margin)
    result = positions.copy()
    clear = np.flatnonzero((positions != 0) & (positions != REFUSED))
    left = clear[~_by_growing(rows[clear], positions[clear], margin, threads)]
    if len(left):
        near = clearances(np.ascontiguousarray(rows[left]), threads)
        result[left[~(near.distance_lower >= margin)]] = 0
    return answers_to(question, result)


def _by_growing(rows: Rows, positions: Positions, margin: float, threads: int | None) -> Mask:
    """Return a mask of the rows for which the enlarged spheroid is clear on the same side: that proves the margin."""
    grown = rows.copy()
    grown[:, 2], grown[:, 3] = enlarged(rows[:, 2], rows[:, 3], margin)
    answers, _ = positions_of_rows(grown, "position", threads)
    return np.asarray(answers == positions)
