"""Numbers u + v √w with rational u, v and one w, a rational that is no square: exact arithmetic and signs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction


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
        u, v = _sign(self.u), _sign(self.v)
        if u * v >= 0:
            return u or v
        return u * _sign(self.u * self.u - self.v * self.v * self.w)

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


def _sign(number: Fraction) -> int:
    return (number > 0) - (number < 0)
