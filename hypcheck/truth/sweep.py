"""A sweep in integers: the pair at each time, and the proof by a multiplier λ about a whole piece of the sweep.

The centre is C(t) = C0 + t (C1 − C0). For a fixed λ a positive multiple of det(S + λH) is a polynomial of degree 2 at
most in t: the centre comes into it by its squares and products alone. Where λ is admissible and that polynomial is
positive on a piece of the sweep, the spheroid is clear there: outside where λ > 0, inside where λ < 0. One λ proves a
piece by one quadratic inequality.

F(λ, t), the cubic of an upright pair or the quartic of a tilted one (pencil.py), has coefficients of degree 2 at most
in t, so that its discriminant is a polynomial of degree 8 or 12 at most. Only its roots matter (docs/motion.md): the
position changes only through a tangency, where F has a multiple root. Where the same clear position is on both sides of
a root, that root is a tangency, unless the multiple root is the pole ℓ with a simple root before it: the ring, which is
clear. Upright, the ring needs z = 0. Tilted, ℓ is rational or in Q(√w), and so is the time at which F(ℓ, t) = 0; if
F(ℓ, t) = 0 at all times, the times of the ring are roots of a quadratic over Q(√w). Such numbers have exact signs, and
so have quadratics over them at each other's roots.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from hypcheck.geometry.arithmetic import QuadraticSurd, dot, exact_root, last, power_of_two, shortened, sign_of
from hypcheck.geometry.pair import Lengths, Position, Vector, to_integers
from hypcheck.truth import exact
from hypcheck.truth.pencil import (
    Quartic,
    cubic,
    cubic_coefficients,
    local_maximum,
    quartic,
    quartic_coefficients,
    rises,
    second_factor,
    slope_of_quotient,
)
from hypcheck.truth.polynomials import (
    Interval,
    Polynomial,
    polynomial_product,
    polynomial_sum,
    primitive,
    value,
)


def piece(pencil: Sequence[Polynomial], multiplier: Fraction) -> Polynomial:
    """Return det(S + λH), up to a positive factor, as a polynomial of degree 2 in t: three integers."""
    u, v = multiplier.numerator, multiplier.denominator
    total, scale = [0, 0, 0], v ** (len(pencil) - 1)
    for coefficient in reversed(pencil):
        for place, number in enumerate(reversed(coefficient), 1):
            total[-place] += number * scale
        scale = scale // v * u
    return tuple(total)


class InTime:
    """A polynomial in t in place of a number; it can be combined with such polynomials and integers.

    Its coefficients are integers, or numbers of one quadratic field.
    """

    __slots__ = ("f",)

    def __init__(self, f: Sequence[Any]) -> None:
        self.f = f

    def __add__(self, other: InTime | int) -> InTime:
        if isinstance(other, int):
            return InTime((*self.f[:-1], self.f[-1] + other))
        return InTime(polynomial_sum(self.f, other.f))

    def __mul__(self, other: InTime | int) -> InTime:
        if isinstance(other, int):
            return InTime(tuple([number * other for number in self.f]))
        return InTime(polynomial_product(self.f, other.f))

    def __sub__(self, other: InTime | int) -> InTime:
        return self + other * -1

    def __rsub__(self, other: int) -> InTime:
        return self * -1 + other

    __radd__, __rmul__ = __add__, __mul__


def _polynomial(number: InTime | int) -> Polynomial:
    """Return a number, or a polynomial in t, as a polynomial."""
    return tuple(number.f) if isinstance(number, InTime) else (number,)


@dataclass(frozen=True)
class StraightSweep:
    """A sweep: the pair at the start, and the changes of x, y, z over the sweep in their units."""

    start: Lengths
    step: Vector

    @property
    def moves(self) -> bool:
        """Whether start and end differ."""
        return any(self.step)

    @property
    def is_upright(self) -> bool:
        """Whether the axis is vertical, or the spheroid a sphere."""
        return self.start.is_upright

    def at(self, time: Fraction) -> Lengths:
        """Return the pair at a rational time."""
        u, v, w = (part * time.numerator for part in self.step)
        return self.start.finer(time.denominator, (u, v, w))

    def until(self, time: Fraction) -> StraightSweep:
        """Return the part of the sweep from its start to a rational time."""
        u, v, w = (part * time.numerator for part in self.step)
        return StraightSweep(self.start.finer(time.denominator), (u, v, w))

    def position(self, time: Fraction) -> Position:
        """Return the exact position at a rational time."""
        return exact.position(self.at(time))

    def tangent(self, time: Fraction) -> bool:
        """Decide whether the surfaces are tangent at a rational time."""
        return exact.decide(self.at(time)).tangent

    @cached_property
    def pencil(self) -> tuple[Polynomial, ...]:
        """The coefficients of F, the highest power of λ first, as polynomials in t."""
        here, (u, v, w) = self.start, self.step
        centre = InTime((u, here.x)), InTime((v, here.y)), InTime((w, here.z))
        coefficients = cubic_coefficients if self.is_upright else quartic_coefficients
        return tuple(map(_polynomial, coefficients(here, *centre)))

    def multipliers(self, time: Fraction) -> Iterator[Fraction]:
        """Return better and better λ for a time at which the spheroid is clear; from some λ on all prove it."""
        return _at_local_maximum(self.at(time)) if self.is_upright else _at_maximum(quartic(self.at(time)))

    def critical(self) -> Polynomial:
        """Return a primitive polynomial in t, not 0, with a root wherever the position without ends changes.

        It is the discriminant of F. For an upright sweep this is not 0 for every t (docs/motion.md); if it is for a
        tilted sweep, another polynomial replaces it.
        """
        return self.discriminant() or self._where_always_double()

    def discriminant(self) -> Polynomial:
        """Return the primitive discriminant of F: 0 wherever the surfaces, without ends, are tangent; () if always."""
        discriminant = exact.cubic_discriminant if self.is_upright else exact.quartic_discriminant
        return primitive(discriminant(*map(InTime, self.pencil)).f)

    def root_changes(self) -> Polynomial:
        """Return a primitive polynomial in t, not 0, that is 0 wherever F has fewer different roots than at most times.

        It is the discriminant; if F always has a multiple root, it is the next subresultant of F and F′ that is not
        always 0.
        """
        f = self.discriminant()
        if f or self.is_upright:
            return f or (1,)
        a, b, c, d, e = map(InTime, self.pencil)
        three = (
            a * a * (c * e * 16 - d * d * 18)
            + a * c * (b * d * 14 - c * c * 4)
            + b * b * (c * c - a * e * 6 - b * d * 3)
        )
        return primitive(three.f) or primitive((b * b * 3 - a * c * 8).f) or (1,)

    def touches(self, critical: Polynomial, time: Interval, side: Position) -> bool:
        """Decide whether a root of the critical polynomial is a contact, if both sides have the same clear position.

        The ring of an upright spheroid needs the height 0. If the height varies, this is one rational time. If it is
        always 0, the position depends monotonically on the distance from the axis only, so that only the root at the
        least distance can be a contact: again a rational time.
        """
        low, high = time
        if low == high:
            return self.position(low) is Position.CONTACT
        if not self.is_upright:
            return not _ring_between(*self._at_pole(int(side)), low, high)
        here = self.start
        height, rise = dot(here.upward, (here.x, here.y, here.z)), dot(here.upward, self.step)
        nearest = Fraction(-dot(self.step, (here.x, here.y, here.z)), dot(self.step, self.step))
        special = Fraction(-height, rise) if rise else nearest
        if low <= special <= high and value(critical, special) == 0:
            return self.position(special) is Position.CONTACT
        return bool(height or rise)

    def _where_always_double(self) -> Polynomial:
        """Return the times at which the position changes where F always has a multiple root.

        Where some position is clear, that root is ℓ towards interior all along, and the position is interior where
        F″(ℓ) > 0, else a tangency. The polynomial is F″(ℓ) times its conjugate. If no position is clear, all is
        contact.
        """
        curvature = self._at_pole(-1)[2]
        return norm_of(curvature) if any(curvature) else (1,)

    def _at_pole(self, side: int) -> tuple[Quadratic, Quadratic, Quadratic]:
        """Return F, F′ and F″/2 at ℓ, for μ = side · λ, as polynomials in t over Q(√w), the highest power first."""
        here = self.start
        pole: Field
        if side < 0 and here.b > here.d:
            pole = Fraction(here.alpha**2, here.b**2)
        else:
            e0, e1, e2 = second_factor(here)
            pole = exact_root(Fraction(e1 * e1 + 4 * e0 * e2, 4 * e2 * e2)) + Fraction(side * e1, 2 * e2)
        f = [((0, 0, *coefficient)[-3:], power) for power, coefficient in enumerate(reversed(self.pencil))]
        derivatives = []
        for order in range(3):
            total: list[Field] = [Fraction(0)] * 3
            for coefficient, power in reversed(f[order:]):  # Horner's scheme in μ
                factor = math.comb(power, order) * side**power
                total = [part * pole + factor * number for part, number in zip(total, coefficient, strict=True)]
            derivatives.append(total)
        return derivatives[0], derivatives[1], derivatives[2]


def norm_of(f: Sequence[Any]) -> Polynomial:
    """Return a primitive polynomial that is 0 wherever f, with coefficients in a quadratic field, is; () if always.

    It is the product with the conjugate, unless all coefficients are rational.
    """
    if any(isinstance(number, QuadraticSurd) for number in f):
        f = polynomial_product(f, [number.conjugate() for number in f])
    return primitive(to_integers(f))


def _at_local_maximum(lengths: Lengths) -> Iterator[Fraction]:
    """Yield the local maximum of g, rounded to ever more bits, where that is admissible."""
    g = cubic(lengths)
    bits = 12
    while g.n2 * g.n2 > 3 * g.n3 * g.n1:
        at = shortened(*local_maximum(g, bits), bits)
        u, v = at.numerator, at.denominator
        if u * g.t < v * g.s and -u * g.q < v * g.p:
            yield at
        bits *= 2


def _at_maximum(F: Quartic) -> Iterator[Fraction]:
    """Yield numbers that tend to the maximum of φ, by bisection with exact signs."""
    if F.side == 0:
        return
    slope = slope_of_quotient(F)
    largest = max(map(abs, (*F.coefficients, *slope))).bit_length()
    exponent = last(lambda exponent: rises(F, slope, power_of_two(exponent)), -largest - 1, largest + 1)
    low_end, width, bits = power_of_two(exponent), power_of_two(exponent), 8
    while True:
        for _ in range(bits):
            width /= 2
            if rises(F, slope, low_end + width):
                low_end += width
        yield low_end * F.side
        bits *= 2


def _ring_between(at_pole: Quadratic, slope: Quadratic, curvature: Quadratic, low: Fraction, high: Fraction) -> bool:
    """Decide whether F(ℓ) = F′(ℓ) = 0 < F″(ℓ) at the one time in an open interval at which F has a multiple root."""
    a, b, _ = at_pole
    if any(at_pole):  # F(ℓ) is a square of a linear polynomial in t, up to a factor
        if not a:
            return False
        time = b / (a * -2)
        return low < time < high and not value_of(slope, time) and value_of(curvature, time) > 0
    return sign_at_root(slope, curvature, low, high) > 0


Field = Fraction | QuadraticSurd
"""A number of one quadratic field, or a rational."""

Quadratic = Sequence[Field]
"""a, b, c of a t² + b t + c."""


def value_of(f: Quadratic, at: Field) -> Field:
    """Return the value of f at a number."""
    return (f[0] * at + f[1]) * at + f[2]


def sign_at_root(f: Quadratic, g: Quadratic, low: Fraction, high: Fraction) -> int:
    """Return the sign of g at the one root of f ≠ 0 in an open interval; 0 where there is none."""
    a, b, c = f
    if not a and not b:
        return 0
    if not a:
        root = -c / b
    elif b * b == a * c * 4:
        root = b / (a * -2)
    else:
        return _sign_at_simple_root(f, g, low, high)
    return sign_of(value_of(g, root)) if low < root < high else 0


def _sign_at_simple_root(f: Quadratic, g: Quadratic, low: Fraction, high: Fraction) -> int:
    """Return the sign as sign_at_root, if f has degree 2 and two roots: by the remainder of g, which is linear."""
    start = sign_of(value_of(f, low))
    if start * sign_of(value_of(f, high)) >= 0:
        return 0
    factor = g[0] / f[0]
    slope, constant = g[1] - factor * f[1], g[2] - factor * f[2]
    if not slope:
        return sign_of(constant)
    zero = -constant / slope
    if zero <= low:
        return sign_of(slope)
    if zero >= high:
        return -sign_of(slope)
    return sign_of(slope) * start * sign_of(value_of(f, zero))  # f still has its first sign there: the root is beyond
