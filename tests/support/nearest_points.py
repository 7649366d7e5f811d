"""The hyperboloid's nearest points to the centre of an upright spheroid, from the multiplier of the oracle."""

from __future__ import annotations

import math
from fractions import Fraction

from hypcheck.geometry.pair import Pair
from tests.support.inside import nearest, ratio

_BITS = 96

Point = tuple[float, float, float]


def nearest_points(pair: Pair) -> tuple[Point, ...]:
    """In the caller's coordinates, each within 1 ulp (inf beyond the largest float64).

    One point; two, above and below, for a centre in the waist plane beyond the evolute; for a centre on the axis one
    point of a circle of them, the one with x > 0 and y = 0.
    """
    at, lengths = nearest(pair).multiplier, pair.lengths
    A, B = Fraction(lengths.alpha, lengths.b) ** 2, Fraction(lengths.gamma, lengths.d) ** 2
    P, Q = Fraction(lengths.x**2 + lengths.y**2, lengths.b**2), Fraction(lengths.z, lengths.d) ** 2
    if P == 0:
        height = B / (A + B)
        return ((_root(pair.alpha, 1 + B * Q / (A + B) ** 2), 0.0, _times(pair.z, height)),)
    across = (_times(pair.x, A / (A + at)), _times(pair.y, A / (A + at)))
    if at == B:
        rise = A * P / (A + B) ** 2 - 1
        height = _root(pair.gamma, rise)
        return ((*across, height), (*across, -height)) if rise else ((*across, 0.0),)
    return ((*across, _times(pair.z, B / (B - at))),)


def is_circle(pair: Pair) -> bool:
    """Whether there is a circle of nearest points: the centre is on the axis."""
    return pair.x == pair.y == 0


def _times(value: float, factor: Fraction) -> float:
    product = Fraction(value) * factor
    return ratio(product.numerator, product.denominator)


def _root(value: float, square: Fraction) -> float:
    """value · √square, within 1 ulp."""
    whole = Fraction(value) ** 2 * square
    bits = max(0, _BITS + (whole.denominator.bit_length() - whole.numerator.bit_length()) // 2)
    return ratio(math.isqrt((whole.numerator << 2 * bits) // whole.denominator), 1 << bits)
