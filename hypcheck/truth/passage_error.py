"""The error of an answer about a sweep: by the spheroid's size, and by the time of first contact.

A row is alpha, gamma, b, d, x0, y0, z0, x1, y1, z1, then axis_x, axis_y, axis_z if the spheroid is tilted, and then
z_min, z_max, solid if the hyperboloid ends. The answer is True for contact somewhere on the sweep.

**Contact is monotone in the size.** At each time the spheroid with b and d multiplied by k, a solid with a fixed
centre, is part of the one with a larger k; contact says that the solid and the hyperboloid have a point in common. So
if a spheroid has contact on its sweep, outside, inside or from the beginning, each larger one has contact too, no
later. There is a least factor k* ≥ 0 with contact, for contact is a closed condition. A wrong answer is right for a
factor just beyond k*: its size error is |k* − 1|, found by bisection on exact decisions. k* is 0 if the centre itself
meets the surface; then no smaller spheroid is clear.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np

from hypcheck.geometry.arithmetic import octave, power_of_two, rounded_toward
from hypcheck.geometry.pair import UPRIGHT
from hypcheck.geometry.rows import SWEEPS, Positions, Rows
from hypcheck.truth.swept import WIDTH_BITS, Passage, Rational, meets, passage_of_row, sweep_of_row

Row = tuple[float, ...]

CLEAR, HIT = 0, 1
SWEEP_ANSWERS = {CLEAR: "clear on the sweep", HIT: "in contact on the sweep"}
"""The truths about a sweep in words."""

_REMEMBERED = 1 << 16

RELATIVE_WIDTH = Fraction(1, 100)
"""A size error is bracketed to this part of itself."""

_LARGEST = 1 - Fraction(1, 2**53)
"""The largest tested change of the size, so that no size is 0."""


@dataclass(frozen=True, slots=True)
class SizeError:
    """Bounds of the least relative change of b and d together that makes an answer right.

    Both are 0 if the answer is right, or if arbitrarily small changes make it right. Both are inf if no change below 1
    is enough.
    """

    lower: float
    upper: float


@lru_cache(_REMEMBERED)
def passage_of(row: Row) -> Passage:
    """Return the passage of a sweep; cached, because the truth is needed before and after the answers."""
    return passage_of_row(row)


def first_contact(row: Row) -> tuple[float, float]:
    """Return float64 bounds of the time of the first contact; NaN twice if there is none."""
    result = passage_of(row)
    return result.first_lower, result.first_upper


def hits(rows: Rows) -> Positions:
    """Return HIT for contact on the sweep, else CLEAR: int8 (n,)."""
    return np.array([passage_of(tuple(row)).hit for row in rows.tolist()], dtype=np.int8)


def hits_at_size(row: Sequence[Rational], scale: Rational = 1) -> bool:
    """Decide whether the row's sweep has contact with b and d multiplied by `scale` > 0: exact, monotone in `scale`."""
    return meets(sweep_of_row(row, scale))


def size_error(row: Sequence[Rational], answer: bool) -> SizeError:
    """Return the size error of an answer, exact to RELATIVE_WIDTH of itself."""
    truth = passage_of_row(row)
    if truth.hit == answer or truth.grazes:
        return SizeError(0.0, 0.0)
    sign = 1 if answer else -1

    def right(change: Fraction) -> bool:
        return hits_at_size(row, 1 + sign * min(change, _LARGEST)) == answer

    if not right(Fraction(1)):
        return SizeError(math.inf, math.inf)
    low = power_of_two(octave(right, step=8))
    high = 2 * low
    while high - low > RELATIVE_WIDTH * low:
        middle = (low + high) / 2
        low, high = (low, middle) if right(middle) else (middle, high)
    return SizeError(rounded_toward(low, -math.inf), rounded_toward(high, math.inf))


def is_tolerated(row: Sequence[Rational], answer: bool, tolerance: Fraction) -> bool:
    """Decide whether an answer is right for b and d both multiplied by 1 + tolerance, or for both by 1 − tolerance.

    By monotony it is enough to decide one of the two. If the tolerance is 1 or more, no smaller spheroid is left, so
    that the answer "no contact" is always tolerated.
    """
    if answer:
        return hits_at_size(row, 1 + tolerance)
    return tolerance >= 1 or not hits_at_size(row, 1 - tolerance)


def tolerance(row: Sequence[Rational], units: Rational, roundoff: Rational) -> Fraction:
    """Return the relative change of b and d that covers relative changes of `units` roundoffs of each input.

    δ = units · roundoff, and the tolerance is δ K. Where an answer is right for inputs each of which is changed by δ of
    itself at most (the axis by δ of its length), it is right for b and d both multiplied by 1 + δ K, or both by
    1 − δ K. With ρ and ζ the largest (|x|+|y|)/b and |z|/d of both ends, for an upright spheroid

        K = 1 + ρ + ζ + (1+δ)/(1−δ) (ρ + ζ + 2);

    docs/motion.md derives it, the K of a tilted spheroid, and the addition for ends. In K, δ is at most 1/2, so that K
    is finite.
    """
    change = Fraction(units) * Fraction(roundoff)
    lengths, axis, heights = SWEEPS.split(row)
    alpha, gamma, b, d, *ends = map(Fraction, lengths)
    bounded = min(change, Fraction(1, 2))
    stretch = (1 + bounded) / (1 - bounded)
    across = max(abs(x) + abs(y) for x, y in (ends[:2], ends[3:5]))
    along = max(abs(ends[2]), abs(ends[5]))
    ended = any(map(math.isfinite, heights[:2]))
    if not axis or b == d or not any(axis[:2]):
        far = across / b + along / d
        more = 2 * stretch * (along / d + 1) * (1 + alpha * d / (gamma * b)) if ended else 0
        return change * (1 + far + stretch * (far + 2) + more)
    least, ratio = min(b, d), max(b / d, d / b)
    far = (across + along) / least
    more = 2 * stretch * (along / least + ratio) * (1 + alpha / gamma) if ended else 0
    return change * (1 + far + (1 + bounded) * (ratio + bounded) + stretch * (far + 2 * ratio) + more)


def time_is_within(row: Sequence[Rational], time: Rational, change: Rational) -> bool:
    """Decide whether a spheroid of a size changed by at most `change` can have its first contact at this time.

    The time, from 0 to 1, is too early if the spheroid grown by `change` is clear up to it, and too late if the shrunk
    spheroid has contact before it; with a change of 1 no shrunk spheroid is left. Both are decided at times that differ
    from the given time by 2^−60 of itself, in its favour, because first contacts are not enclosed more narrowly.
    """
    exact, part = Fraction(time), Fraction(change)
    slack = exact / 2**WIDTH_BITS
    if not meets(sweep_of_row(row, 1 + part).until(min(exact + slack, Fraction(1)))):
        return False
    return not exact or part >= 1 or not meets(sweep_of_row(row, 1 - part).until(exact - slack))


@lru_cache(_REMEMBERED)
def time_is_tolerated(row: Row, time: float, units: Rational, roundoff: Rational) -> bool:
    """Decide whether a time of first contact is right for sizes changed by the `tolerance`, on a sweep with contact.

    Cached, because causes of wrong times need it again.
    """
    passage = passage_of(row)
    if passage.first_lower <= time <= passage.first_upper:
        return True
    change = tolerance(row, units, roundoff)
    return bool(change) and time_is_within(row, time, change)


def radii_off(row: Row, time: float) -> float:
    """Return the length of the sweep between a time and the first contact, in spheroid radii."""
    result = passage_of(row)
    return max(result.first_lower - time, time - result.first_upper, 0.0) * sweep_in_radii(row)


def sweep_in_radii(row: Row) -> float:
    """Return the length of the sweep in spheroid radii; along and across the spheroid's axis the units are d and b.

    Of an upright spheroid its square is (Δx² + Δy²)/b² + Δz²/d².
    """
    b, d = row[2:4]
    step = [end - start for start, end in zip(row[4:7], row[7:10], strict=True)]
    direction = SWEEPS.split(row)[1] or UPRIGHT
    largest = max(map(abs, direction))
    axis = [component / largest for component in direction]
    length = math.hypot(*axis)
    along = sum(component / length * part for component, part in zip(axis, step, strict=True))
    across = [part - along * component / length for component, part in zip(axis, step, strict=True)]
    return math.hypot(*(part / b for part in across), along / d)
