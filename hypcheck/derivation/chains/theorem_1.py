"""Theorem 1: dividing x, y by b and z by d changes no position, and makes the spheroid the unit sphere."""

from __future__ import annotations

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import Chain, Link, identity, known, sign


def theorem_1() -> Chain:
    """The chain; the map is X̄ = A·X with A = diag(1/b, 1/b, 1/d) of equation (9)."""
    scaling = sympy.diag(1 / pencil.SMALL_B, 1 / pencil.SMALL_B, 1 / pencil.SMALL_D)
    return Chain(
        "Theorem 1",
        "The spheroid stands to the hyperboloid as the unit sphere stands to the scaled hyperboloid.",
        (
            Link(
                "X̄ = A·X is one-to-one: A = diag(1/b, 1/b, 1/d) has a determinant above 0.",
                "sign",
                (identity("det A = 1/(b²·d)", scaling.det()), sign("1/(b²·d) > 0", "b d")),
            ),
            Link(
                "The hyperboloid's equation, with its values inside and outside, becomes (7).",
                "identity",
                (identity("h(A⁻¹·X̄) = x²/(α/b)² + y²/(α/b)² − z²/(γ/d)² − 1", pencil.scaled(pencil.hyperboloid())),),
            ),
            Link(
                "The spheroid's equation becomes (8), that of a unit sphere. So points in common go to points in "
                "common, and inside stays inside.",
                "identity",
                (identity("e(A⁻¹·X̄) = (x − x0/b)² + (y − y0/b)² + (z − z0/d)² − 1", pencil.scaled(pencil.spheroid())),),
            ),
            Link(
                "The roots stay the same too: the determinant of the pencil changes by a constant factor.",
                "identity",
                (known("Theorem 1 divides the pencil's determinant by the constant 1/(b⁴d²)"),),
            ),
        ),
    )
