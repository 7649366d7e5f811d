"""The exact numbers that check a proof by hand (docs/mathematics.md, "A certificate for every answer")."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.pairs import Pair
from hypcheck.truth.certificate import Point


@dataclass(frozen=True, slots=True)
class Squares:
    """A = (α/b)², B = (γ/d)², P = (x²+y²)/b², Q = (z/d)²: all that the position depends on."""

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    @classmethod
    def of(cls, pair: Pair) -> Squares:
        """Those of a pair."""
        alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
        return cls((alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2)

    def g(self, at: Fraction) -> Fraction:
        """The cubic of equation (12) of the paper, as repaired."""
        A, B, P, Q = self.A, self.B, self.P, self.Q
        return (A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at)

    def third_root(self, double: Fraction) -> Fraction:
        """The root of g that is left when `double` is a double one: the three add up to −c2."""
        return self.B + self.P + self.Q - self.A - 1 - 2 * double


def height(pair: Pair, point: Point) -> Fraction:
    """h = x²/α² + y²/α² − z²/γ² − 1 of a point: above 0 outside the hyperboloid, below 0 inside, 0 on it."""
    u, v, w = point
    alpha, gamma = Fraction(pair.alpha), Fraction(pair.gamma)
    return (u * u + v * v) / (alpha * alpha) - (w / gamma) ** 2 - 1


def reach(pair: Pair, point: Point) -> Fraction:
    """s, the square of a point's distance from the spheroid's centre in spheroid radii: at most 1 in the spheroid."""
    u, v, w = (
        coordinate - Fraction(center) for coordinate, center in zip(point, (pair.x, pair.y, pair.z), strict=True)
    )
    return (u * u + v * v) / Fraction(pair.b) ** 2 + (w / Fraction(pair.d)) ** 2
