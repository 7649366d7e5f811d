"""Rows (n, 13), whose hyperboloids end: what the kernel's bounds tell, and the rest in exact integers.

The rest is decided by truth/ends.py, the only exact decision about ends that there is. Clearances are enclosed by it
too: a spheroid scaled about its centre by 1 + clearance just touches wall, rim or disc. Let c be the clearance of a
clear pair. Whatever is nearer than c min(b, d) lies in the scaled spheroid, and the point that it touches is
c max(b, d) from the spheroid at most: the distance lies between, and of a sphere it is known.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS, Lengths, Pair, Position
from hypcheck.geometry.rows import CANNOT_SAY, Indices, Positions, Rows, invalid
from hypcheck.kernel.choice import Question
from hypcheck.kernel.classify import kernel
from hypcheck.kernel.clearance import Clearance, clearances
from hypcheck.kernel.scene_gaps import gaps
from hypcheck.truth import ended_clearance, exact, least
from hypcheck.truth.rationals import rounded_toward


def answer_ended_rows(rows: Rows, question: Question, threads: int | None = None) -> tuple[Positions, int]:
    """Answers for C-contiguous rows (n, 13) as kernel().answer_rows has them: 127 for invalid rows, and how many."""
    positions = kernel().answer_ended(rows, threads)
    for index in np.flatnonzero(positions == CANNOT_SAY).tolist():
        positions[index] = exact.position(Lengths.of(rows[index].tolist()))
    refused = positions == REFUSED
    if question != "position":
        positions = np.where(refused, REFUSED, positions == Position[question.upper()]).astype(np.int8)
    return positions, int(refused.sum())


def ended_clearances(rows: Rows, threads: int | None = None) -> Clearance:
    """What clearance() says of valid rows (n, 13): of those without ends as there, of the others one by one.

    `touch` is then the point of wall, rim or disc that the scaled spheroid touches, as far as floats know it, and so is
    `nearest` where no shorter gap was measured. Nothing is proved of their error.
    Invalid rows are left as rows of which nothing is known.
    """
    found = replace(clearances(np.ascontiguousarray(rows[:, : len(TILTED_COLUMNS)]), threads), rows=rows)
    refused = invalid(rows)
    for values in (found.lower, found.upper, found.touch, found.distance_lower, found.distance_upper, found.nearest):
        values[refused] = np.nan
    found.position[refused] = REFUSED
    ended = np.flatnonzero(np.isfinite(rows[:, 10:12]).any(axis=1) & ~refused)
    for index in ended.tolist():
        pair = Pair.from_row(rows[index].tolist())
        decision = exact.decide(pair.lengths)
        low, high = ended_clearance.enclosure(pair, decision)
        clear = decision.position is not Position.CONTACT
        found.position[index] = decision.position
        found.lower[index], found.upper[index] = rounded_toward(low, -np.inf), rounded_toward(high, np.inf)
        found.touch[index] = found.nearest[index] = least.to_border(pair).point
        found.touch_error[index] = np.inf
        found.distance_lower[index] = rounded_toward(low * Fraction(min(pair.b, pair.d)), -np.inf) if clear else 0.0
        found.distance_upper[index] = rounded_toward(high * Fraction(max(pair.b, pair.d)), np.inf) if clear else 0.0
    _measure_gaps(found, rows, ended[found.position[ended] != Position.CONTACT])
    return found


def _measure_gaps(found: Clearance, rows: Rows, clear: Indices) -> None:
    """Replace bounds of distances, and nearest points, by better ones where the gap can be measured."""
    some = rows[clear]
    measured = gaps(
        some[:, :4], some[:, 4:7], some[:, 7:10], some[:, 10:12], some[:, 12] != 0, found.distance_upper[clear]
    )
    better = measured.upper < found.distance_upper[clear]
    found.distance_lower[clear] = np.fmax(found.distance_lower[clear], measured.lower)
    found.distance_upper[clear[better]] = measured.upper[better]
    found.nearest[clear[better]] = measured.point[better]
