"""The public function: clearances, distances and nearest points of many pairs, each between two proved numbers.

Beside hyperboloids that end, rows (n, 13), exact decisions of truth/exact.py enclose the clearance. A spheroid scaled
about its centre by 1 + clearance just touches wall, rim or disc. Let c be the clearance of a clear pair. Every point
nearer than c min(b, d) lies in the scaled spheroid, and the point that it touches is at most c max(b, d) from the
spheroid: the distance lies between the two, and for a sphere they are equal.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.forms import Argument, pairs_of
from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS, Pair, Position
from hypcheck.geometry.rows import PAIRS, Indices, Rows, invalid
from hypcheck.kernel.choice import required
from hypcheck.kernel.clearance_bounds import Clearance, clearances_without_ends

_ROUNDED = 2.0**-47


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
    """The distance, the nearest points and the clearance of every pair, each between two numbers that are proved.

    Pairs are written as in classify: rows, a table, or sizes and centres. One pair of numbers is answered by numbers.
    The first invalid row raises InputError; with on_invalid="flag" such rows have the position 127 and NaN everywhere.

    The clearance is known within 2⁻³⁰ of 1 + clearance, or of 1 where that is greater, unless the spheroid so much
    enlarged leaves float64. The distance is known within 2⁻²⁹ of itself and b or d, unless a spheroid that holds all
    points so near reaches the hyperboloid elsewhere: long ones in a groove, and some tilted ones. Then it lies between
    clearance · min(b, d) and clearance · max(b, d), or nearer. So it does where the hyperboloid ends; there no error of
    the touching point is proved, and a row takes some milliseconds.

    >>> near = clearance(2, 17.8, 0.25, 0.15, [3, 4, 0])
    >>> near.distance_lower <= 2.75 <= near.distance_upper
    True
    >>> near.normal.round(12)
    array([0.6, 0.8, 0. ])
    """
    number = required("position", threads, on_invalid)
    call = pairs_of(pairs, columns, axis, (z_min, z_max, solid))
    queries = call.rows()
    result = clearances(queries, number)
    if on_invalid == "raise" and (result.position == REFUSED).any():
        call.require_valid(queries)
    return result.one if call.single else result


def clearances(queries: Rows, threads: int | None = None) -> Clearance:
    """The same of rows of any width; invalid ones have the position 127 and NaN everywhere."""
    if not PAIRS.has_heights(queries):
        return clearances_without_ends(queries, threads)
    return _ended_clearances(queries, threads)


def _ended_clearances(rows: Rows, threads: int | None = None) -> Clearance:
    """The result of clearance() for valid rows (n, 13): rows with infinite ends together, the others one by one.

    `touch` is then the point of wall, rim or disc that the scaled spheroid touches, as far as floats know it, and so is
    `nearest` where no shorter gap was measured. Their errors have no proved bound. Invalid rows keep the values for
    unknown rows.
    """
    from hypcheck.truth import ended_error, exact, least, rationals  # noqa: PLC0415 - rows with heights alone need them

    toward = rationals.rounded_toward
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
        result.lower[index], result.upper[index] = toward(low, -np.inf), toward(high, np.inf)
        result.touch[index] = result.nearest[index] = least.to_border(pair).point
        result.touch_error[index] = np.inf
        result.distance_lower[index] = toward(low * Fraction(min(pair.b, pair.d)), -np.inf) if clear else 0.0
        result.distance_upper[index] = toward(high * Fraction(max(pair.b, pair.d)), np.inf) if clear else 0.0
    _measure_gaps(result, rows, ended[result.position[ended] != Position.CONTACT])
    return result


def _measure_gaps(result: Clearance, rows: Rows, clear: Indices) -> None:
    """Replace bounds of distances, and nearest points, by better ones where the gap can be measured."""
    from hypcheck.kernel.scene_gaps import gaps  # noqa: PLC0415 - as above

    some = rows[clear]
    measured = gaps(
        some[:, :4], some[:, 4:7], some[:, 7:10], some[:, 10:12], some[:, 12] != 0, result.distance_upper[clear]
    )
    # Points and distances are right within 64u of the lengths that they are computed from.
    lengths = np.abs(measured.point).sum(axis=1) + np.abs(some[:, 4:7]).sum(axis=1) + some[:, 2:4].sum(axis=1)
    upper = measured.upper + _ROUNDED * lengths
    better = upper < result.distance_upper[clear]
    result.distance_lower[clear] = np.fmax(result.distance_lower[clear], measured.lower)
    result.distance_upper[clear[better]] = upper[better]
    result.nearest[clear[better]] = measured.point[better]
