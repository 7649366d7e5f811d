"""The clearance beside a hyperboloid that ends: 1 + clearance is the factor at which the scaled spheroid just touches.

Scaled about its centre by more than that the spheroid meets the wall or a disc, by less it does not: that is decided
exactly. least.py guesses the factor, and where it cannot, the factor is found by halving exponents and then intervals.
"""

from __future__ import annotations

import math
from fractions import Fraction

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import exact, least
from hypcheck.truth.exact import Decision

_GUESSED, _BITS = 40, 56
_WIDTH = 2.0**-14
"""Where to guess better takes longer than to halve the interval."""
_FARTHEST = 2200


def clearance(pair: Pair, decision: Decision) -> float:
    """The clearance in spheroid radii, within 2⁻⁵⁴ of 1 + clearance; 0 for a touch, −1 for a centre on the wall."""
    low, high = enclosure(pair, decision)
    try:
        return float((low + high) / 2)
    except OverflowError:
        return math.inf


def enclosure(pair: Pair, decision: Decision) -> tuple[Fraction, Fraction]:
    """Two numbers that the clearance lies between, 2⁻⁵⁶ of 1 + clearance apart at most."""
    if decision.tangent:
        return Fraction(0), Fraction(0)
    low, high = _bracket(pair)
    while (high - low) * 2**_BITS > high:
        middle = (low + high) / 2
        low, high = (low, middle) if _meets(pair, middle) else (middle, high)
    return low - 1, high - 1


def _bracket(pair: Pair) -> tuple[Fraction, Fraction]:
    """Two factors, the spheroid scaled by the first being clear and by the second in contact."""
    guess = least.to_border(pair, width=_WIDTH)
    if math.isfinite(guess.upper) and guess.lower > 0:
        loose = Fraction(1, 2**_GUESSED)
        low, high = Fraction(guess.lower) * (1 - loose), Fraction(guess.upper) * (1 + loose)
        if not _meets(pair, low) and _meets(pair, high):
            return low, high
    if _meets(pair, _power(-_FARTHEST)):
        return Fraction(0), Fraction(0)  # the centre lies on the border
    first, last = -_FARTHEST, _FARTHEST
    while last - first > 1:
        middle = (first + last) // 2
        first, last = (first, middle) if _meets(pair, _power(middle)) else (middle, last)
    return _power(first), _power(last)


def _power(exponent: int) -> Fraction:
    return Fraction(2) ** exponent


def _meets(pair: Pair, factor: Fraction) -> bool:
    b, d = factor * Fraction(pair.b), factor * Fraction(pair.d)
    scaled = (pair.alpha, pair.gamma, b, d, pair.x, pair.y, pair.z, *pair.axis, *pair.heights)
    return exact.position(Lengths.of(scaled)) is Position.CONTACT
