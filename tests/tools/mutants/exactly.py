"""The right answer in whole numbers, taken apart so that a mutant replaces one piece and leaves the others right.

Only so does a rejection show that the gate saw that piece: in plain floats the whole formula is wrong somewhere.

With U = b²d² the terms A U = α²d², B U = γ²b², P U = (x² + y²)d² and Q U = z²b² of docs/mathematics.md are whole where
the lengths are. Let A, B, P, Q stand for these multiples and λ be counted in U as well; then g keeps its form, each
product that is short of a factor has U for it, and no sign changes:

    c2 = A − B + U − P − Q    c1 = −AB + U(A − B) + BP − AQ    c0 = −ABU

What decides is the coefficient rule for all regimes of that page.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Any

import numpy as np

RADIAL, AXIAL = (0, 2, 4, 5), (1, 3, 6)


@dataclass(frozen=True, slots=True)
class Lengths:
    """The seven columns as arrays of whole numbers of any size; radial and axial ones in a unit of their own."""

    alpha: Any
    gamma: Any
    b: Any
    d: Any
    x: Any
    y: Any
    z: Any


@dataclass(frozen=True, slots=True)
class Terms:
    """A, B, P, Q and the spheroid's own radius squared, U, which is 1 in the paper."""

    A: Any
    B: Any
    P: Any
    Q: Any
    U: Any


def lengths(rows):
    """The rows in whole numbers. The answers do not depend on the two units."""
    columns = [None] * 7
    for group in (RADIAL, AXIAL):
        mantissas, exponents = np.frexp(rows[:, group])
        least = np.where(mantissas == 0, 2000, exponents).min(axis=1, keepdims=True)
        shift = np.where(mantissas == 0, 0, exponents - least).astype(object)
        whole = np.ldexp(mantissas, 53).astype(np.int64).astype(object) << shift
        for place, column in enumerate(group):
            columns[column] = whole[:, place]
    return Lengths(*columns)


def terms(of):
    """A, B, P, Q and U."""
    alpha, gamma, b, d, x, y, z = (length * length for length in astuple(of))
    return Terms(alpha * d, gamma * b, (x + y) * d, z * b, b * d)


def c0(t):
    return -t.A * t.B * t.U


def c1(t):
    return -t.A * t.B + t.U * (t.A - t.B) + t.B * t.P - t.A * t.Q


def c2(t):
    return t.A - t.B + t.U - t.P - t.Q


def delta_terms(k0, k1, k2):
    """The five terms of equation (13)."""
    return -4 * k2**3 * k0, k2**2 * k1**2, 18 * k2 * k1 * k0, -4 * k1**3, -27 * k0**2


def delta(t, k0, k1, k2):
    return sum(delta_terms(k0, k1, k2))


def all_positive(k1, k2):
    """Whether three real roots are all positive."""
    return (k2 < 0) & (k1 > 0)


def beyond_B(t, k1, k2):
    """Whether three positive roots are all at B or beyond, but for a double root at B."""
    return (k2 < -3 * t.B) & (3 * t.B * t.B + 2 * k2 * t.B + k1 > 0)


def above_minus_A(t, k1, k2):
    """Whether the two negative roots lie in (−A, 0)."""
    return (k2 < 3 * t.A) & (3 * t.A * t.A - 2 * k2 * t.A + k1 > 0)


def ring(t, k1, k2):
    """Whether B is a double root and the simple one lies below it: clear with Δ = 0."""
    return (t.Q == 0) & (3 * t.B * t.B + 2 * k2 * t.B + k1 == 0) & (t.A * t.U < t.B * t.B)


def decide(t, k1, k2, discriminant, *, positive=all_positive, beyond=beyond_B, above=above_minus_A, ring=ring):
    """The position in every regime, unless a part of the rule is replaced."""
    distinct, all_are = discriminant > 0, positive(k1, k2)
    exterior = (distinct & all_are & ~beyond(t, k1, k2)) | ring(t, k1, k2)
    interior = distinct & ~all_are & above(t, k1, k2)
    return signs(exterior, interior)


def signs(exterior, interior):
    """+1, 0, −1."""
    return np.where(exterior, 1, np.where(interior, -1, 0)).astype(np.int8)


def position(rows, *, terms=terms, c0=c0, c1=c1, c2=c2, delta=delta, decide=decide, **rule):
    """The exact position of each row, unless a piece is replaced; `rule` are parts of decide()."""
    t = terms(lengths(np.asarray(rows)))
    k0, k1, k2 = c0(t), c1(t), c2(t)
    return decide(t, k1, k2, delta(t, k0, k1, k2), **rule)


def moved(answers):
    """Other answers than these."""
    return np.where(answers == 0, 1, 0).astype(np.int8)
