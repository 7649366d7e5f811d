"""Clearances beside hyperboloids that end, rows (n, 13), enclosed by exact decisions of truth/exact.py.

A spheroid scaled about its centre by 1 + clearance just touches wall, rim or disc. Let c be the clearance of a clear
pair. Whatever is nearer than c min(b, d) lies in the scaled spheroid, and the point that it touches is c max(b, d) from
the spheroid at most: the distance lies between, and of a sphere it is known.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS, Pair, Position
from hypcheck.geometry.rows import Indices, Rows, invalid
from hypcheck.kernel.clearance_bounds import Clearance, clearances_without_ends
from hypcheck.kernel.scene_gaps import gaps
from hypcheck.truth import ended_error, exact, least
from hypcheck.truth.rationals import rounded_toward

_ROUNDED = 2.0**-47


def ended_clearances(rows: Rows, threads: int | None = None) -> Clearance:
    """What clearance() says of valid rows (n, 13): of those without ends as there, of the others one by one.

    `touch` is then the point of wall, rim or disc that the scaled spheroid touches, as far as floats know it, and so is
    `nearest` where no shorter gap was measured. Nothing is proved of their error.
    Invalid rows are left as rows of which nothing is known.
    """
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
    _measure_gaps(result, rows, ended[result.position[ended] != Position.CONTACT])
    return result


def _measure_gaps(result: Clearance, rows: Rows, clear: Indices) -> None:
    """Replace bounds of distances, and nearest points, by better ones where the gap can be measured."""
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
