"""The paper's rules as they are printed, typed anew from its text, in exact rationals; nothing here is hypcheck's.

Lengths are those after Theorem 1, so a = α/b, c = γ/d, and the centre is that of the unit sphere.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Cubic:
    """The coefficients of g; Δ is (13)."""

    c2: Fraction
    c1: Fraction
    c0: Fraction

    @property
    def delta(self) -> Fraction:
        """Δ by (13)."""
        c2, c1, c0 = self.c2, self.c1, self.c0
        return -4 * c2**3 * c0 + c2**2 * c1**2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2

    @property
    def numbers(self) -> tuple[Fraction, Fraction, Fraction]:
        """Δ, c2 and c1."""
        return self.delta, self.c2, self.c1


def by_14(a, c, x, y, z) -> Cubic:
    """The coefficients that (14) prints."""
    c0 = -(a**2) * c**2
    c1 = -(a**2) * c**2 + a**2 - c**2 + c**2 * x**2 + c**2 * y**2 - a**2 * z**2
    c2 = a**2 - c**2 + 1 - x**2 - y**2 - z**2
    return Cubic(c2, c1, c0)


def by_12(a, c, x, y, z) -> Cubic:
    """The coefficients that (12) prints."""
    c2 = a**2 - c**2 + 1 - x**2 - y**2
    c1 = -(a**2 * c**2 - a**2 + c**2 - c**2 * x**2 - c**2 * y**2 + a**2 * z**2)
    return Cubic(c2, c1, -(a**2) * c**2)


def in_regime_3(a, c) -> bool:
    return c**2 >= a


def in_regime_5(a) -> bool:
    return a > 1


def proposition_3_1(g: Cubic) -> bool:
    """Whether the printed condition says exterior."""
    return g.delta > 0 and g.c2 < 0 and g.c1 > 0


def proposition_5_1(g: Cubic) -> bool:
    """Whether the printed condition says interior."""
    return g.delta > 0 and ((g.c2 > 0 and g.c1 != 0) or (g.c2 < 0 and g.c1 < 0))


def says_contact(g: Cubic) -> bool:
    """Propositions 3.2 and 5.2."""
    return g.delta <= 0


def table_2(alpha, gamma, b, d, x0, y0, z0) -> bool:
    """Line by line."""
    A = (alpha / b) ** 2
    B = (gamma / d) ** 2
    c0 = -A * B
    C = c0 + A - B
    P = (x0**2 + y0**2) / b**2
    Q = (z0 / d) ** 2
    c1 = C + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    return delta > 0 and c2 < 0 and c1 > 0


def procedure_2a(rotors: list[Cubic]) -> bool:
    """Whether Table 3 says valid."""
    if any(g.delta <= 0 for g in rotors):
        return False
    return all((g.c2 > 0 and g.c1 != 0) or (g.c2 < 0 and g.c1 < 0) for g in rotors)


def procedure_2b(body: Cubic, rotors: list[Cubic]) -> bool:
    """Whether Table 4 says valid."""
    if body.delta <= 0:
        return procedure_2a(rotors)
    return (body.c2 > 0 and body.c1 != 0) or (body.c2 < 0 and body.c1 < 0)


def rotors_of(a, c, r, z, size, arm) -> list[tuple[Fraction, ...]]:
    """The rotors of a body as rows a, c, x, y, z in rotor radii; g1 = −45° in (15), where no coordinate has a root."""
    centres = ((r + arm, 0), (r, arm), (r - arm, 0), (r, -arm))
    return [(a / size, c / size, Fraction(x) / size, Fraction(y) / size, z / size) for x, y in centres]
