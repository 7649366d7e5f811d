"""The exact decision about any ellipsoid and any quadric with both signs, of revolution or not, upright or not.

S and H are their symmetric 4×4 matrices, X̃ = (x, y, z, 1). The ellipsoid is the solid s = X̃ᵀSX̃ ≤ 0, the upper 3×3
part of S positive definite, its inside not empty; the quadric's side of a point is the sign of h = X̃ᵀHX̃, exterior
where h > 0.

**The S-lemma.** The solid is compact. It meets h = 0 unless S + λH is positive definite for some real λ, and then λh >
−s ≥ 0 on all of it: the side is the sign of λ. Both signs at once are impossible. These λ form an open interval between
two neighbouring real roots of f(λ) = det(S + λH), or beyond the last root; f(0) = det S < 0, so f is not 0. Between two
neighbouring roots S + λH is definite everywhere or nowhere, so one rational in each gap is enough. The sign of f is not
enough: f is also positive for signature (2, 2). The test of definiteness is that all leading minors are > 0.

exact.py decides about a spheroid and a circular hyperboloid much faster, because more is known about their f and λ.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from hypcheck.geometry.pair import Position
from hypcheck.truth.polynomial_roots import isolate
from hypcheck.truth.polynomials import Polynomial, polynomial_product, polynomial_sum, primitive, squarefree

Matrix = Sequence[Sequence[Fraction | int]]


def position(S: Matrix, H: Matrix) -> Position:
    """The exact position of the solid of S to the surface of H."""
    at = multiplier(S, H)
    if at is None:
        return Position.CONTACT
    return Position.EXTERIOR if at > 0 else Position.INTERIOR


def multiplier(S: Matrix, H: Matrix) -> Fraction | None:
    """A λ for which S + λH is positive definite, the certificate of a clear pair; None if there is none."""
    unit = math.lcm(*(Fraction(entry).denominator for form in (S, H) for row in form for entry in row))
    solid, surface = ([[int(entry * unit) for entry in row] for row in form] for form in (S, H))
    pencil: list[list[Polynomial]] = [
        [(b, a) for a, b in zip(*rows, strict=True)] for rows in zip(solid, surface, strict=True)
    ]
    for at in _between_roots(squarefree(primitive(_determinant(pencil)))):
        n, k = at.numerator, at.denominator
        if _is_positive_definite([[n * b + k * a for b, a in row] for row in pencil]):
            return at
    return None


def _between_roots(f: Polynomial) -> list[Fraction]:
    """A rational in each gap between real roots of a squarefree polynomial, before the first and after the last."""
    roots = isolate(f) if len(f) > 1 else []
    ends = [end for root in roots for end in root]
    return [(ends[max(0, i - 1)] + ends[min(i, len(ends) - 1)]) / 2 for i in range(0, len(ends) + 1, 2)] if ends else []


def _determinant(matrix: list[list[Polynomial]]) -> Polynomial:
    """The determinant of a matrix of polynomials, by its first column."""
    if len(matrix) == 1:
        return matrix[0][0]
    terms = []
    for place, row in enumerate(matrix):
        minor = _determinant([other[1:] for other in (*matrix[:place], *matrix[place + 1 :])])
        terms.append(polynomial_product(((-1) ** place,), polynomial_product(row[0], minor)))
    return polynomial_sum(*terms)


def _is_positive_definite(matrix: list[list[int]]) -> bool:
    """Whether all leading minors are > 0; in Bareiss's elimination they are the pivots, and all divisions are exact."""
    before = 1
    for k, row in enumerate(matrix):
        pivot = row[k]
        if pivot <= 0:
            return False
        for other in matrix[k + 1 :]:
            first = other[k]
            other[:] = [(pivot * a - first * b) // before for a, b in zip(other, row, strict=True)]
        before = pivot
    return True
