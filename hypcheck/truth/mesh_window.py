"""The part of the meridian that can come within reach of the spheroid, in exact integers (docs/mesh-oracle.md).

Space is scaled by 1/b, 1/b, 1/d (Theorem 1): the spheroid becomes the unit sphere about C, the surface gets the radii
a = α/b, c = γ/d. By symmetry C is turned to azimuth 0 and lifted to height ζ ≥ 0, and the point of the surface nearest
to C is then found at azimuth 0 with z ≥ 0. That half branch of a hyperbola, the meridian, has the parametrisation

    r = a (e + 1/e) / 2,    z = c (e − 1/e) / 2,    e ≥ 1.

It has rational points for rational e, and its tangents at e and f meet in the rational point
r = a (e f + 1) / (e + f), z = c (e f − 1) / (e + f). Both coordinates grow with e.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from hypcheck.pairs import Pair

UNIT_BITS = 96
UNIT = 1 << UNIT_BITS
"""Lengths are integers, in units of 2⁻⁹⁶ spheroid radii."""

REACH = 5 * UNIT // 4
"""Surface farther than this from C, in r or in z, is left out: its distance is above 5/4 radii."""


@dataclass(frozen=True, slots=True)
class Meridian:
    """A pair in its meridian half plane: radii a and c, and the centre ρ, ζ in units, each rounded down.

    `side` is the exact sign of F(C) = (x² + y²)/α² − z²/γ² − 1: 1 outside the surface, −1 inside, 0 on it.
    Values of e are integers, `one` standing for 1.
    """

    a: Fraction
    c: Fraction
    rho: int
    zeta: int
    side: int
    one: int

    def tangents_meet(self, e: int, f: int) -> tuple[int, int]:
        """Where the tangents at e and at f meet: (r, z) in units, each coordinate rounded down; at e = f the point."""
        product, square, total = e * f, self.one * self.one, (e + f) * self.one
        return (
            ((self.a.numerator * (product + square)) << UNIT_BITS) // (self.a.denominator * total),
            ((self.c.numerator * (product - square)) << UNIT_BITS) // (self.c.denominator * total),
        )


def meridian_of(pair: Pair) -> Meridian:
    """The pair in its meridian half plane: exact but for the two roundings of the centre, whatever the magnitudes."""
    lengths = pair.lengths
    a, c = Fraction(lengths.alpha, lengths.b), Fraction(lengths.gamma, lengths.d)
    radius2, alpha2, gamma2 = lengths.x**2 + lengths.y**2, lengths.alpha**2, lengths.gamma**2
    level = (radius2 - alpha2) * gamma2 - lengths.z**2 * alpha2
    return Meridian(
        a=a,
        c=c,
        rho=isqrt((radius2 << 2 * UNIT_BITS) // lengths.b**2),
        zeta=(abs(lengths.z) << UNIT_BITS) // lengths.d,
        side=(level > 0) - (level < 0),
        # dr/de < a/2 and dz/de ≤ c: a step of e, 1/one, moves a point by less than 2⁻⁶³ radii.
        one=1 << (64 + (int(max(a, c)) + 1).bit_length()),
    )


def window_of(meridian: Meridian) -> tuple[int, int] | None:
    """The e of the first and the last point with |r − ρ| ≤ 5/4 and |z − ζ| ≤ 5/4, rounded outwards; None without any.

    Both conditions hold on one interval of e, since r and z grow with e. The roundings make it stick out by less than
    2⁻⁶⁰ radii: one step of X moves the bound's own r by a/one, one of Z its z by c/one, a step of e either by less.
    """
    first = max(
        meridian.one,
        _e_of_radius(meridian, meridian.rho - REACH),
        _e_of_height(meridian, meridian.zeta - REACH),
    )
    last = min(
        _e_of_radius(meridian, meridian.rho + 1 + REACH, up=True),
        _e_of_height(meridian, meridian.zeta + 1 + REACH, up=True),
    )
    return (first, last) if first < last else None


def _e_of_radius(meridian: Meridian, r: int, *, up: bool = False) -> int:
    """e = X + √(X² − 1), X = r/a, rounded down, or up to more than it; 0 where r is below the waist."""
    x = _quotient(r, meridian.a, meridian.one, up=up)
    return x + isqrt(x * x - meridian.one**2) + up if x >= meridian.one else 0


def _e_of_height(meridian: Meridian, z: int, *, up: bool = False) -> int:
    """e = Z + √(Z² + 1), Z = z/c, rounded down, or up to more than it; 0 where z is below the waist."""
    height = _quotient(z, meridian.c, meridian.one, up=up)
    return height + isqrt(height * height + meridian.one**2) + up if height >= 0 else 0


def _quotient(length: int, radius: Fraction, one: int, *, up: bool) -> int:
    """length / radius in multiples of 1/one, rounded down, or up to more than it."""
    return length * radius.denominator * one // (radius.numerator << UNIT_BITS) + up
