"""Numbers u + v √w with rational u, v, w: exact signs, also of quadratics at each other's roots."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.truth.rationals import sign_with_root


@dataclass(frozen=True, slots=True)
class Surd:
    """u + v √w. Two operands have the same w, or v = 0 in one of them; where w is 0, v is."""

    u: Fraction
    v: Fraction = Fraction(0)
    w: Fraction = Fraction(0)

    @classmethod
    def root(cls, u: Fraction, w: Fraction) -> Surd:
        """u + √w for w > 0; rational where w is a square."""
        root = Fraction(math.isqrt(w.numerator), math.isqrt(w.denominator))
        return cls(u + root) if root * root == w else cls(u, Fraction(1), w)

    @property
    def sign(self) -> int:
        """+1, 0 or −1; 0 for 0 alone, since √w is irrational."""
        return sign_with_root(self.u, self.v, self.w)

    def __add__(self, other: Surd | Fraction | int) -> Surd:
        if not isinstance(other, Surd):
            return Surd(self.u + other, self.v, self.w)
        return Surd(self.u + other.u, self.v + other.v, self.w or other.w)

    def __sub__(self, other: Surd | Fraction | int) -> Surd:
        return self + other * -1

    def __mul__(self, other: Surd | Fraction | int) -> Surd:
        if not isinstance(other, Surd):
            return Surd(self.u * other, self.v * other, self.w)
        w = self.w or other.w
        return Surd(self.u * other.u + self.v * other.v * w, self.u * other.v + self.v * other.u, w)

    def __truediv__(self, other: Surd) -> Surd:
        norm = other.u * other.u - other.v * other.v * other.w
        return self * Surd(other.u / norm, -other.v / norm, other.w)

    def power(self, exponent: int) -> Surd:
        """The number to the power of an exponent ≥ 0."""
        result = Surd(Fraction(1), Fraction(0), self.w)
        for _ in range(exponent):
            result = result * self
        return result


Quadratic = Sequence[Surd]
"""a, b, c of a t² + b t + c."""


def value(f: Quadratic, at: Surd | Fraction) -> Surd:
    """f there."""
    return (f[0] * at + f[1]) * at + f[2]


def sign_at_root(f: Quadratic, g: Quadratic, low: Fraction, high: Fraction) -> int:
    """The sign of g at the one root of f ≠ 0 in an open interval; 0 where there is none."""
    a, b, c = f
    if not a.sign:
        root = c / (b * -1) if b.sign else None
    elif not (b * b - a * c * 4).sign:
        root = b / (a * -2)
    else:
        return _sign_at_simple_root(f, g, low, high)
    if root is None or not (root - low).sign > 0 > (root - high).sign:
        return 0
    return value(g, root).sign


def _sign_at_simple_root(f: Quadratic, g: Quadratic, low: Fraction, high: Fraction) -> int:
    """The same where f has degree 2 and two different roots, by the remainder of g, which is linear."""
    start = value(f, low).sign
    if start * value(f, high).sign >= 0:
        return 0
    factor = g[0] / f[0]
    slope, constant = g[1] - factor * f[1], g[2] - factor * f[2]
    if not slope.sign:
        return constant.sign
    zero = constant / (slope * -1)
    if (zero - low).sign <= 0:
        return slope.sign
    if (zero - high).sign >= 0:
        return -slope.sign
    return slope.sign * start * value(f, zero).sign  # f still has its first sign at the zero: the root is beyond
