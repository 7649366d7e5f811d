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
from collections.abc import Iterator, Sequence
from fractions import Fraction

from hypcheck.geometry.arithmetic import changes_of_sign, power_near, power_of_two
from hypcheck.geometry.pair import Position
from hypcheck.truth.polynomials import (
    Interval,
    Polynomial,
    polynomial_product,
    polynomial_sum,
    primitive,
    squarefree,
    sturm_chain,
    value,
)

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


def isolate(f: Polynomial) -> list[Interval]:
    """Open intervals with one root of f each, in order, all real roots covered; no 0 inside any.

    f is squarefree and is not 0 at 0.
    """
    near, far = (power_of_two(exponent) for exponent in root_exponents(f))
    mirrored = tuple(-number if place % 2 else number for place, number in enumerate(f))
    below = ((-high, -low) for low, high in _isolated(mirrored, near, far))
    return sorted([*below, *_isolated(f, near, far)])


def root_exponents(f: Polynomial) -> tuple[int, int]:
    """Exponents near, far with 2^near < |root| < 2^far for all roots of f, f(0) ≠ 0.

    Cauchy: |root| < 1 + max |f_i / f_0| < 2 max(1, max |f_i / f_0|), and the same for 1/root with the order reversed.
    With n bits for the largest coefficient, m for the end one, the quotient is below 2^(n − m + 1).
    """
    largest = max(coefficient.bit_length() for coefficient in f)
    return f[-1].bit_length() - largest - 2, largest - f[0].bit_length() + 2


def _isolated(f: Polynomial, low: Fraction, high: Fraction) -> Iterator[Interval]:
    """Open intervals with one root each of a squarefree f, for all roots from low to high; 0 ≤ low < high are no roots.

    Sturm's theorem counts them.
    """
    chain = sturm_chain(f)
    pending = [(low, variations(chain, low), high, variations(chain, high))]
    while pending:
        low, left, high, right = pending.pop()
        if left - right == 1:
            yield low, high
        elif left > right:
            middle = _no_root_between(f, low, high)
            count = variations(chain, middle)
            pending += [(low, left, middle, count), (middle, count, high, right)]


def variations(chain: Sequence[Polynomial], x: Fraction) -> int:
    """The changes of sign in the values of a Sturm chain at x, which is not a root of its first polynomial."""
    return changes_of_sign(value(f, x) for f in chain)


def _no_root_between(f: Polynomial, low: Fraction, high: Fraction) -> Fraction:
    """A number near the middle, or near the middle of their exponents, that is not a root.

    Among more numbers than f has roots, one is not a root.
    """
    middle = power_near(low, high) if 0 < 4 * low < high else (low + high) / 2
    step = min(middle - low, high - middle) / 16
    return next(x for x in (middle + k * step for k in range(len(f))) if value(f, x))
