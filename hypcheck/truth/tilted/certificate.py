"""What proves an answer about a tilted spheroid, and the check of that proof, in rational arithmetic alone.

S and H are the 4×4 matrices of spheroid and hyperboloid, M and D their upper 3×3 parts. If λ > 0 and S + λH is positive
definite, the hyperboloid's equation is > 0 on the whole closed spheroid; if λ < 0, it is < 0 there. So it is enough:

- exterior, interior: λ > 0, λ < 0 with S + λH positive definite: the pivots of L D Lᵀ (from elimination) are > 0;
- contact: two points of the closed spheroid on opposite sides of the hyperboloid, or one that lies on it;
- tangency: a root m of det(S + λH), where M + mD is positive semidefinite and φ = det(S + λH)/det(M + λD), concave
  where M + λD is definite, has its maximum, and that is 0. Where M + mD is definite, a double root says so. Where k of
  its pivots are 0, det(M + λD) has a root of order k, and det(S + λH) must have one of order k + 1; for k = 1 its
  second derivative must then not be > 0, or φ would be > 0 before m (k = 2 needs an upright spheroid or a sphere,
  where φ has no other root on this side).

A certificate is that of truth/certificate.py. This module shares no code with what makes certificates: it starts from
the ten floats and the definitions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import permutations
from typing import Protocol

from hypcheck.geometry.pair import Position
from hypcheck.truth.certificate import Certificate

Matrix = list[list[Fraction]]


class Query(Protocol):
    """A pair: alpha, gamma, b, d, x, y, z and more, and the axis, floats or rationals."""

    @property
    def row(self) -> Sequence[float | Fraction]:
        """The numbers in the order of geometry.pair.TILTED_COLUMNS; seven are enough."""

    @property
    def axis(self) -> Sequence[float | Fraction]:
        """A vector along the axis of revolution."""


def check_certificate(pair: Query, certificate: Certificate) -> bool:
    """Whether the certificate proves its claim about this pair; a double root proves tangency, not contact alone.

    Numbers of other types are taken as the rationals that they are. Raises ValueError for a claim that is no position,
    and for NaN.
    """
    S, H = matrices(pair)
    at, m = (None if each is None else Fraction(each) for each in (certificate.multiplier, certificate.double_root))
    claim = Position(certificate.position)
    if claim is not Position.CONTACT:
        return at is not None and at * claim > 0 and all(pivot > 0 for pivot in pivots(_sum(S, H, at)))
    if m is not None:
        pencil = _sum(S, H, m)
        inner = pivots([row[:3] for row in pencil[:3]])
        zeros, derivatives = inner.count(Fraction(0)), _derivatives(pencil, H)
        vanish = not any(derivatives[: max(2, zeros + 1)])
        return m != 0 and min(inner) >= 0 and vanish and (zeros != 1 or derivatives[2] <= 0)
    sides = set()
    for point in certificate.points:
        spheroid, hyperboloid = (_at(form, [*map(Fraction, point), Fraction(1)]) for form in (S, H))
        if spheroid > 0:
            return False
        sides.add((hyperboloid > 0) - (hyperboloid < 0))
    return 0 in sides or sides == {-1, 1}


def matrices(pair: Query) -> tuple[Matrix, Matrix]:
    """S and H, from their definitions."""
    alpha, gamma, b, d, *center = (Fraction(each) for each in pair.row[:7])
    v = [Fraction(each) for each in pair.axis]
    along = (1 / d**2 - 1 / b**2) / sum(each * each for each in v)
    M = [[(i == j) / b**2 + along * v[i] * v[j] for j in range(3)] for i in range(3)]
    shift = [-sum((M[i][j] * center[j] for j in range(3)), Fraction(0)) for i in range(3)]
    last = -sum((shift[i] * center[i] for i in range(3)), Fraction(0)) - 1
    diagonal = (1 / alpha**2, 1 / alpha**2, -1 / gamma**2, Fraction(-1))
    H = [[diagonal[i] if i == j else Fraction(0) for j in range(4)] for i in range(4)]
    return [*([*M[i], shift[i]] for i in range(3)), [*shift, last]], H


def pivots(matrix: Matrix) -> list[Fraction]:
    """The diagonal of L D Lᵀ by elimination, up to the first pivot that shows the matrix not positive semidefinite.

    All are > 0 if and only if the matrix is positive definite, all ≥ 0 if and only if it is semidefinite: a pivot of 0
    with anything else than zeros beside it counts as −1.
    """
    rows, found = [row[:] for row in matrix], []
    for i, row in enumerate(rows):
        pivot = row[i] if row[i] or not any(row[i:]) else Fraction(-1)
        found.append(pivot)
        if pivot < 0:
            break
        for other in rows[i + 1 :] if pivot else ():
            factor = other[i] / pivot
            other[:] = [a - factor * b for a, b in zip(other, row, strict=True)]
    return found


def _derivatives(pencil: Matrix, H: Matrix) -> list[int]:
    """det(S + λH) and its first two derivatives over 0!, 1!, 2!, by Leibniz's formula, times one positive integer.

    `pencil` is S + λH. Both are made whole first, because products of fractions take most of the time of a check.
    """
    unit = math.lcm(*(entry.denominator for form in (pencil, H) for row in form for entry in row))
    values, slopes = ([[int(entry * unit) for entry in row] for row in form] for form in (pencil, H))
    total = [0, 0, 0]
    for order in permutations(range(4)):
        sign = (-1) ** sum(order[j] < order[i] for i in range(4) for j in range(i + 1, 4))
        term = [sign, 0, 0]
        for i, j in enumerate(order):
            value, slope = values[i][j], slopes[i][j]
            term = [term[0] * value, term[1] * value + term[0] * slope, term[2] * value + term[1] * slope]
        total = [a + b for a, b in zip(total, term, strict=True)]
    return total


def _sum(S: Matrix, H: Matrix, at: Fraction) -> Matrix:
    return [[a + at * b for a, b in zip(*rows, strict=True)] for rows in zip(S, H, strict=True)]


def _at(form: Matrix, point: list[Fraction]) -> Fraction:
    rows = (sum((a * b for a, b in zip(row, point, strict=True) if a), Fraction(0)) for row in form)
    return sum((a * b for a, b in zip(rows, point, strict=True)), Fraction(0))
