"""The backward error of an answer: the least relative change of the inputs that makes it right; of pairs and rows.

The exterior positions are an up-set: a pair stays exterior when α falls, γ grows, b or d falls, |x| or |y| grows, |z|
falls; the interior ones likewise with α, γ, x, y, z the other way round (docs/mathematics.md, "Monotone in every
input"). So among all relative changes of at most ε the best for a target is one known corner of the box, and the
distance is found by bisection on exact decisions: nothing is linearised and nothing is sampled.

`distance_exponents` does this for many rows, by exact positions of changed float64 rows. Floats do not hold the corner
of the box of relative changes 2^k. So a corner a little inside of that box and one a little outside are asked: a flip
at the inner one is a flip at 2^k, and no flip at the outer one is none at 2^k, since flips are monotone in every
change. The changes asked for are 2^k (1 ∓ 2⁻⁸); each product is rounded once, by 2⁻⁵³ of itself at most, so that for
k ≥ LEAST every change comes out on its side of 2^k. What lies between the two, one row in a hundred, and what is nearer
than 2^LEAST, is left to `backward_error_exponent`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows
from hypcheck.truth import exact, float_filter
from hypcheck.truth.exact import Decision


@dataclass(frozen=True, slots=True)
class Bracket:
    """Two proved ends of a backward error, inf twice where no change up to 1 is enough."""

    lower: float
    upper: float


DIGITS = 4
"""Significant digits of a backward error."""


def corner(lengths: Lengths, change: Fraction, toward: Position) -> Lengths:
    """The corner of the box of relative changes up to `change` that is nearest to `toward`; farthest, if that is < 0.

    |change| < 1; `toward` is EXTERIOR or INTERIOR. Lengths are scaled by the denominator of `change`, which leaves the
    ratios alone.
    """
    grown, shrunk = change.denominator + change.numerator, change.denominator - change.numerator
    wide, tall = (shrunk, grown) if toward is Position.EXTERIOR else (grown, shrunk)
    return Lengths(
        alpha=lengths.alpha * wide,
        b=lengths.b * shrunk,
        x=lengths.x * tall,
        y=lengths.y * tall,
        gamma=lengths.gamma * tall,
        d=lengths.d * shrunk,
        z=lengths.z * wide,
    )


def makes_right(lengths: Lengths, truth: Position, answer: Position, change: Fraction) -> bool:
    """Whether a relative change of at most `change` (< 1) of each input can make the wrong `answer` right."""
    if answer is not Position.CONTACT:
        return exact.position(corner(lengths, change, answer)) is answer
    # "Equals contact" is not monotone (a corner can pass right through), "is no longer the truth" is. From exterior
    # the corner opposite to the exterior one has α, b, d and z grown, γ, x and y shrunk.
    return exact.position(corner(lengths, -change, truth)) is not truth


def backward_error(lengths: Lengths, truth: Decision, answer: Position) -> float:
    """The infimum of the relative changes that make `answer` right, rounded up to DIGITS significant digits.

    0 when the answer is right, or the limit of right answers (`truth` is a tangency from that side); inf when no
    change up to 1 is enough, which only the answer "exterior" for a centre on the axis can be.
    """
    exponent = backward_error_exponent(lengths, truth, answer)
    if not math.isfinite(exponent):
        return 0.0 if exponent < 0 else math.inf
    low, high = Fraction(2) ** int(exponent), Fraction(2) ** (int(exponent) + 1)
    for _ in range(math.ceil(DIGITS * math.log2(10))):
        middle = (low + high) / 2
        if makes_right(lengths, truth.position, answer, middle):
            high = middle
        else:
            low = middle
    return float(high) or math.ulp(0.0)  # a distance below the least float64 is still not 0


def backward_error_exponent(lengths: Lengths, truth: Decision, answer: Position) -> float:
    """floor(log2) of the backward error: −inf for 0, inf for inf.

    The exponent k returned has 2^k ≤ backward error ≤ 2^(k+1): exact decisions at both ends say so.
    """
    if answer is truth.position or truth.limit_of is answer:
        return -math.inf
    if answer is Position.EXTERIOR and lengths.x == lengths.y == 0:
        return math.inf

    def reached(exponent: int) -> bool:
        # At 2^0 the sizes vanish; every flip but the one excluded above happens before.
        return exponent >= 0 or makes_right(lengths, truth.position, answer, Fraction(2) ** exponent)

    step, low = 1, -10
    while reached(low):  # terminates: the distance is not 0
        low -= step
        step *= 2
    high = min(low + step, 0)
    while not reached(high):
        low, high, step = high, min(high + 2 * step, 0), 2 * step
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if reached(middle) else (middle, high)
    return low


LEAST = -44
INNER, OUTER = 1 - 2.0**-8, 1 + 2.0**-8
SMALLEST, LARGEST = 2.0**-90, 2.0**90
"""Lengths that no change brings out of the range in which floats decide."""

TOWARD_EXTERIOR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Which way α, γ, b, d, x, y, z change: the sizes of the spheroid fall for either clear position, the others turn."""
TOWARD_INTERIOR = np.array([1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 1.0])


def distance_exponents(rows: Rows, positions: Positions) -> Floats:
    """floor(log2) of each row's distance to the nearest other position, (n,); NaN where floats cannot tell.

    Such rows are for `backward_error_exponent`. `positions` are the exact positions of the rows.
    """
    lengths = np.abs(rows)
    within = ((lengths >= SMALLEST) & (lengths <= LARGEST) | (lengths == 0)).all(axis=1)
    found = np.full(len(rows), np.nan)
    places = np.flatnonzero(within)
    places = places[~_changes_position(rows[places], positions[places], np.full(len(places), LEAST), OUTER)]
    low: NDArray[np.int64] = np.full(len(places), LEAST)
    high: NDArray[np.int64] = np.zeros(len(places), dtype=np.int64)
    while len(places):
        done = high - low == 1
        found[places[done]] = low[done]
        places, low, high = (each[~done] for each in (places, low, high))
        middle = (low + high) // 2
        nearer = _changes_position(rows[places], positions[places], middle, INNER)
        farther = ~nearer
        farther[farther] = ~_changes_position(rows[places[farther]], positions[places[farther]], middle[farther], OUTER)
        known = nearer | farther
        high, low = np.where(nearer, middle, high)[known], np.where(farther, middle, low)[known]
        places = places[known]
    return found


def _changes_position(rows: Rows, positions: Positions, exponents: NDArray[np.int64], factor: float) -> Mask:
    """Whether changes of 2^exponent · factor bring each row to another position, (n,)."""
    change = np.ldexp(factor, exponents)[:, None]
    clear, side = positions != Position.CONTACT, (positions == Position.INTERIOR)[:, None]
    # A clear row is changed away from where it is, and has flipped once it is there no more.
    away = np.where(side, -TOWARD_INTERIOR, -TOWARD_EXTERIOR)
    flipped = np.zeros(len(rows), dtype=np.bool_)
    flipped[clear] = _positions_of_changed(rows[clear], away[clear], change[clear]) != positions[clear]
    for toward, position in ((TOWARD_EXTERIOR, Position.EXTERIOR), (TOWARD_INTERIOR, Position.INTERIOR)):
        rest = np.flatnonzero(~clear & ~flipped)
        flipped[rest] = _positions_of_changed(rows[rest], toward, change[rest]) == position
    return flipped


def _positions_of_changed(rows: Rows, direction: Floats, change: Floats) -> Positions:
    return float_filter.positions(rows * (1 + direction * change))
