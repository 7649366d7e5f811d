"""A straight way in integers: the pair at each time, and what a multiplier λ proves about a whole piece of the way.

The centre is C(t) = C0 + t (C1 − C0). For a fixed λ a positive multiple of det(S + λH), the cubic g of an upright pair,
is a polynomial of degree 2 at most in t: the centre comes into it by its squares and products alone. Where λ is
admissible (in (−A, B), not 0) and that polynomial is positive on a piece of the way, the spheroid is clear there:
outside where λ > 0, inside where λ < 0. One λ proves a piece by one quadratic inequality.

Where the axis leans, and keeps its direction, F(λ, t), the quartic of pencil.py, has coefficients of degree 2 at
most in t, so that its discriminant is a polynomial of degree 12 at most. Its roots are all that matters
(docs/motion.md): the position changes only through a tangency, where F has a multiple root. Where the same clear
position is on both sides of a root, that root is a tangency, unless the multiple root is the pole ℓ with a simple root
before it: the ring, which is clear. ℓ is rational or in Q(√w), and so is the time at which F(ℓ, t) = 0; where that is
so all along, the times of the ring are roots of a quadratic over Q(√w). Signs of such numbers are signs of integers.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from hypcheck.geometry.pair import Lengths, Position, Vector
from hypcheck.truth import exact
from hypcheck.truth.pencil import Quartic, cubic, inside, quartic, sign_at, slope_of_quotient
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

    def at(self, time: Fraction) -> Lengths:
        """The pair at a rational time."""

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
        """N times the cubic's coefficients, those of pencil.Cubic, as polynomials in t."""
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
        g = cubic(self.at(time))
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


@dataclass(frozen=True, slots=True)
class TiltedJourney:
    """Sizes and a way in one unit, the axis, neither vertical nor that of a sphere, in another."""

    alpha: int
    gamma: int
    b: int
    d: int
    x: Coordinate
    y: Coordinate
    z: Coordinate
    axis: Vector

    @property
    def moves(self) -> bool:
        """Whether start and end differ."""
        return any(step for _, step in (self.x, self.y, self.z))

    def at(self, time: Fraction) -> Lengths:
        """The pair at a rational time."""
        n, m = time.numerator, time.denominator
        x, y, z = (start * m + step * n for start, step in (self.x, self.y, self.z))
        return Lengths(
            alpha=self.alpha * m, b=self.b * m, x=x, y=y, gamma=self.gamma * m, d=self.d * m, z=z, axis=self.axis
        )

    def position(self, time: Fraction) -> Position:
        """The exact position at a rational time."""
        return exact.position(self.at(time))

    def tangent(self, time: Fraction) -> bool:
        """Whether the surfaces are tangent at a rational time."""
        return exact.decide(self.at(time)).tangent

    @property
    def pencil(self) -> Sequence[Polynomial]:
        """f4 to f0 of pencil.Quartic, for λ itself, as polynomials in t."""
        p, s, q, t = self.alpha**2, self.gamma**2, self.b**2, self.d**2
        v_x, v_y, v_z = self.axis
        c, W = v_z * v_z, v_x * v_x + v_y * v_y
        V, g1, g2 = W + c, t * W + q * c, q * W + t * c
        e0, e1, e2 = p * s * V, s * g1 - p * g2, q * t * V
        R, Z = polynomial_sum(square(self.x), square(self.y)), square(self.z)
        along = tuple(v_x * a + v_y * b for a, b in zip(self.x, self.y, strict=True))
        across = tuple(v_y * a - v_x * b for a, b in zip(self.x, self.y, strict=True))
        T = times(_pair(along), _pair(tuple(v_z * a for a in self.z)))
        off_plane = _scaled(q - t, square(_pair(across)))
        G1 = polynomial_sum(_scaled(V * s, R), _scaled(-V * p, Z), (-e0 - e1,))
        G2 = polynomial_sum((e2 - e1,), _scaled(-g2, R), _scaled(-g1, Z), _scaled(-2 * (q - t), T))
        return (
            (q * e2,),
            polynomial_sum((p * e2,), _scaled(q, G2), _scaled(q, off_plane)),
            polynomial_sum(_scaled(p, G2), _scaled(q, G1), _scaled(-s, off_plane)),
            polynomial_sum(_scaled(p, G1), (-q * e0,)),
            (-p * e0,),
        )

    def multipliers(self, time: Fraction) -> Iterator[Fraction]:
        """Numbers that tend to where φ has its maximum, by bisection with exact signs."""
        F = quartic(self.at(time))
        if F.side == 0:
            return
        slope = slope_of_quotient(F)
        largest = max(abs(each) for each in (*F.coefficients, *slope)).bit_length()
        low, high = -largest - 1, largest + 1  # exponents first
        while high - low > 1:
            middle = (low + high) // 2
            at = Fraction(2) ** middle
            low, high = (middle, high) if _rises(F, slope, at) else (low, middle)
        low_end, width, bits = Fraction(2) ** low, Fraction(2) ** low, 8
        while True:
            for _ in range(bits):
                width /= 2
                if _rises(F, slope, low_end + width):
                    low_end += width
            yield low_end * F.side
            bits *= 2

    def critical(self) -> Polynomial:
        """The discriminant of F as a polynomial in t; where that is 0 throughout, what takes its place."""
        a, b, c, d, e = self.pencil
        ae, bd, cc = polynomial_product(a, e), polynomial_product(b, d), polynomial_product(c, c)
        H = polynomial_sum(_scaled(12, ae), _scaled(-3, bd), cc)
        J = polynomial_sum(
            polynomial_product(c, polynomial_sum(_scaled(72, ae), _scaled(9, bd), _scaled(-2, cc))),
            _scaled(-27, polynomial_product(a, polynomial_product(d, d))),
            _scaled(-27, polynomial_product(e, polynomial_product(b, b))),
        )
        cube, twice = polynomial_product(H, polynomial_product(H, H)), polynomial_product(J, J)
        found = primitive(polynomial_sum(_scaled(4, cube), _scaled(-1, twice)))
        return found or self._where_always_double()

    def _where_always_double(self) -> Polynomial:
        """The times at which the position changes where F always has a multiple root.

        Where some position is clear, that root is ℓ towards interior all along, and the position is interior where
        F″(ℓ) > 0, else a tangency. The polynomial is F″(ℓ) times its conjugate. It is all contact otherwise.
        """
        curvature = self._at_pole(-1)[2]
        if not any(each.sign for each in curvature):
            return (1,)
        w = curvature[0].w
        unit = math.lcm(*(part.denominator for each in curvature for part in (each.u, each.v)))
        u, v = (
            tuple(int(part * unit) for part in parts) for parts in zip(*((f.u, f.v) for f in curvature), strict=True)
        )
        squares = polynomial_product(u, u), polynomial_product(v, v)
        return primitive(polynomial_sum(_scaled(w.denominator, squares[0]), _scaled(-w.numerator, squares[1])))

    def touches(self, critical: Polynomial, time: Interval, side: Position) -> bool:
        """Whether a root of the critical polynomial is a contact, both its sides having the same clear position."""
        del critical
        low, high = time
        if low == high:
            return self.position(low) is Position.CONTACT
        return not _ring_between(*self._at_pole(int(side)), low, high)

    def _at_pole(self, side: int) -> tuple[list[Surd], list[Surd], list[Surd]]:
        """F, F′ and F″/2 at ℓ, for μ = side · λ, as polynomials in t over Q(√w), the highest power first."""
        p, s, q, t = self.alpha**2, self.gamma**2, self.b**2, self.d**2
        v_x, v_y, v_z = self.axis
        c, W = v_z * v_z, v_x * v_x + v_y * v_y
        V = W + c
        if side < 0 and q > t:
            pole = Surd(Fraction(p, q))
        else:
            e0, e1, e2 = p * s * V, side * (s * (t * W + q * c) - p * (q * W + t * c)), q * t * V
            pole = Surd.root(Fraction(e1, 2 * e2), Fraction(e1 * e1 + 4 * e0 * e2, 4 * e2 * e2))
        zero = Surd(Fraction(0), Fraction(0), pole.w)
        found = []
        for order in range(3):
            total = [zero] * 3
            for power, coefficient in enumerate(reversed(self.pencil)):
                if power >= order:
                    factor = pole.power(power - order) * (math.comb(power, order) * side**power)
                    for place, number in enumerate(reversed(coefficient), 1):
                        total[-place] = total[-place] + factor * number
            found.append(total)
        return found[0], found[1], found[2]


def _rises(F: Quartic, slope: tuple[int, ...], at: Fraction) -> bool:
    """Whether `at` lies in (0, ℓ) before the maximum of φ."""
    return inside(F, at) and sign_at(slope, at) > 0


def _ring_between(at_pole: list[Surd], slope: list[Surd], curvature: list[Surd], low: Fraction, high: Fraction) -> bool:
    """Whether F(ℓ) = F′(ℓ) = 0 < F″(ℓ) at the one time in an open interval at which F has a multiple root."""
    a, b, _ = at_pole
    if any(each.sign for each in at_pole):  # F(ℓ) is a square of a linear polynomial in t, up to a factor
        if not a.sign:
            return False
        time = b / (a * -2)
        between = (time - low).sign > 0 > (time - high).sign
        return between and not _at(slope, time).sign and _at(curvature, time).sign > 0
    return _sign_at_root(slope, curvature, low, high) > 0


def _sign_at_root(f: list[Surd], g: list[Surd], low: Fraction, high: Fraction) -> int:
    """The sign of g at the one root of f ≠ 0 in an open interval, both of degree 2 at most; 0 where there is none."""
    a, b, c = f
    if not a.sign:
        time = c / (b * -1) if b.sign else None
    elif not (b * b - a * c * 4).sign:
        time = b / (a * -2)
    else:
        return _sign_at_simple_root(f, g, low, high)
    if time is None or not (time - low).sign > 0 > (time - high).sign:
        return 0
    return _at(g, time).sign


def _sign_at_simple_root(f: list[Surd], g: list[Surd], low: Fraction, high: Fraction) -> int:
    """The same where f has degree 2 and two different roots, by the remainder of g, which is linear."""
    start = _at(f, low).sign
    if start * _at(f, high).sign >= 0:
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
    return slope.sign * start * _at(f, zero).sign  # f still has its first sign at the zero: the root is beyond


def _at(f: list[Surd], time: Surd | Fraction) -> Surd:
    return (f[0] * time + f[1]) * time + f[2]


def _scaled(factor: int, f: Polynomial) -> Polynomial:
    return tuple(factor * each for each in f)


def _pair(values: tuple[int, ...]) -> Coordinate:
    first, second = values
    return first, second
