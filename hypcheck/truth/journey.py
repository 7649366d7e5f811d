"""A straight way in integers: the pair at each time, and what a multiplier λ proves about a whole piece of the way.

The centre is C(t) = C0 + t (C1 − C0). For a fixed λ a positive multiple of det(S + λH), the cubic g of an upright pair,
is a polynomial of degree 2 at most in t: the centre comes into it by its squares and products alone. Where λ is
admissible (in (−A, B), not 0) and that polynomial is positive on a piece of the way, the spheroid is clear there:
outside where λ > 0, inside where λ < 0. One λ proves a piece by one quadratic inequality.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth import exact
from hypcheck.truth.polynomial_roots import Interval, Polynomial, polynomial_product, polynomial_sum, primitive, value

Coordinate = tuple[int, int]
"""A coordinate at the start and its change over the way, in a unit of its own."""


class Journey(Protocol):
    """A spheroid on its way, upright or not."""

    @property
    def moves(self) -> bool:
        """Whether start and end differ."""

    @property
    def pencil(self) -> Sequence[Polynomial]:
        """The coefficients of a positive multiple of det(S + λH), the highest power of λ first, as polynomials in t."""

    def position(self, time: Fraction) -> Position:
        """The exact position at a rational time."""

    def tangent(self, time: Fraction) -> bool:
        """Whether the surfaces are tangent at a rational time."""

    def multipliers(self, time: Fraction) -> Iterator[Fraction]:
        """Ever better λ for a time at which the spheroid is clear; sooner or later all prove it."""

    def critical(self) -> Polynomial:
        """A polynomial in t, not 0, with a root wherever the position changes, primitive."""

    def touches(self, critical: Polynomial, time: Interval, side: Position) -> bool:
        """Whether a root of the critical polynomial is a contact, where both its sides have the same clear position."""


def piece(pencil: Sequence[Polynomial], multiplier: Fraction) -> Polynomial:
    """det(S + λH), up to a positive factor, as a polynomial of degree 2 in t: three integers."""
    u, v = multiplier.numerator, multiplier.denominator
    total, scale = [0, 0, 0], v ** (len(pencil) - 1)
    for coefficient in reversed(pencil):
        for place, number in enumerate(reversed(coefficient), 1):
            total[-place] += number * scale
        scale = scale // v * u
    return tuple(total)


def square(coordinate: Coordinate) -> Polynomial:
    """(start + step t)²."""
    return times(coordinate, coordinate)


def times(first: Coordinate, second: Coordinate) -> Polynomial:
    """(start + step t)(start' + step' t)."""
    (a, u), (b, v) = first, second
    return (u * v, a * v + b * u, a * b)


@dataclass(frozen=True, slots=True)
class UprightJourney:
    """Sizes and a way, radial and axial lengths each in their own unit."""

    alpha: int
    b: int
    gamma: int
    d: int
    x: Coordinate
    y: Coordinate
    z: Coordinate

    @property
    def moves(self) -> bool:
        """Whether start and end differ."""
        return any(step for _, step in (self.x, self.y, self.z))

    def at(self, time: Fraction) -> Lengths:
        """The pair at a rational time."""
        n, m = time.numerator, time.denominator
        x, y, z = (start * m + step * n for start, step in (self.x, self.y, self.z))
        return Lengths(self.alpha * m, self.b * m, x, y, self.gamma * m, self.d * m, z)

    def position(self, time: Fraction) -> Position:
        """The exact position at a rational time."""
        return exact.position(self.at(time))

    def tangent(self, time: Fraction) -> bool:
        """Whether the surfaces are tangent at a rational time."""
        return exact.decide(self.at(time)).tangent

    @property
    def pencil(self) -> Sequence[Polynomial]:
        """N times the cubic's coefficients, those of exact.Cubic, as polynomials in t."""
        p, q, s, t = self.alpha**2, self.b**2, self.gamma**2, self.d**2
        (r2, r1, r0), (h2, h1, h0) = polynomial_sum(square(self.x), square(self.y)), square(self.z)
        return (
            (q * t,),
            (-t * r2 - q * h2, -t * r1 - q * h1, (p + q - r0) * t - (s + h0) * q),
            (s * r2 - p * h2, s * r1 - p * h1, p * (t - s - h0) + s * (r0 - q)),
            (-p * s,),
        )

    def multipliers(self, time: Fraction) -> Iterator[Fraction]:
        """The local maximum of g, rounded to ever more bits, where that is admissible."""
        g = exact.cubic(self.at(time))
        h = g.n2 * g.n2 - 3 * g.n3 * g.n1
        bits = 12
        while h > 0:
            shift = max(0, bits + 8 - h.bit_length() // 2)
            root = math.isqrt(h << 2 * shift)
            n2 = g.n2 << shift  # λm = n1/(√h − n2) or −(n2 + √h)/(3 n3): the form that does not cancel
            top, bottom = (g.n1 << shift, root - n2) if g.n2 < 0 else (-(n2 + root), 3 * g.n3 << shift)
            at = shortened(top, bottom, bits)
            u, v = at.numerator, at.denominator
            if u * g.t < v * g.s and -u * g.q < v * g.p:
                yield at
            bits *= 2

    def critical(self) -> Polynomial:
        """N⁴ Δ as a polynomial in t: it is not 0 for every t (docs/motion.md)."""
        (n3,), n2, n1, (n0,) = self.pencil
        square2, square1 = polynomial_product(n2, n2), polynomial_product(n1, n1)
        return primitive(
            polynomial_sum(
                polynomial_product(square1, square2),
                polynomial_product((-4 * n3,), polynomial_product(n1, square1)),
                polynomial_product((18 * n0 * n3,), polynomial_product(n1, n2)),
                polynomial_product((-4 * n0,), polynomial_product(n2, square2)),
                (-27 * n3 * n3 * n0 * n0,),
            )
        )

    def touches(self, critical: Polynomial, time: Interval, side: Position) -> bool:
        """Whether a root of Δ is a contact, where both its sides have the same clear position: unless it is the ring's.

        The ring needs z = 0. Where z varies that is one rational time. Where z = 0 all along, the position depends on
        x² + y² alone, monotonically, so that only the root where it is least can be a contact: a rational time again.
        """
        del side
        low, high = time
        special = low if low == high else self._special_time()
        if low <= special <= high and value(critical, special) == 0:
            return self.position(special) is Position.CONTACT
        return any(self.z)

    def _special_time(self) -> Fraction:
        if self.z[1]:
            return Fraction(-self.z[0], self.z[1])
        across = self.x[1] ** 2 + self.y[1] ** 2
        return Fraction(-self.x[0] * self.x[1] - self.y[0] * self.y[1], across)


def shortened(top: int, bottom: int, bits: int) -> Fraction:
    """top/bottom, bottom > 0, cut off after about that many significant bits."""
    shift = bits + bottom.bit_length() - abs(top).bit_length()
    whole = (top << shift) // bottom if shift >= 0 else top // (bottom << -shift)
    return Fraction(whole, 1 << shift) if shift >= 0 else Fraction(whole << -shift)
