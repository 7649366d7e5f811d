"""What proves an answer about a sweep, and the check of that proof, in rational arithmetic alone.

S(t) and H are the 4×4 matrices of the spheroid at time t and of the hyperboloid, M and D their upper 3×3 parts. M does
not change on the sweep. With a λ for which M + λD is positive definite, S(t) + λH is so exactly where

    φ(t) = λ C(t)ᵀ M (M + λD)⁻¹ D C(t) − 1 − λ > 0,

and then the spheroid is clear (certificate.py). C(t) is linear in t, so φ is of degree 2, and on [t0, t1] it is
positive if its Bernstein coefficients φ(t0), φ(t0, t1), φ(t1) are, or if the first and last are and the square of the
middle one is below their product; φ(s, t) is the bilinear form that belongs to φ. So it is enough:

- clear up to a time: pieces (λ, end), each beginning where the one before ends, the first at 0;
- contact: a time, and a certificate of contact at that time.

This module shares no code with what makes certificates: it starts from the floats of the row and the definitions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import COLUMNS, SIZES, SWEEP_COLUMNS, UPRIGHT, WITHOUT_ENDS, Position
from hypcheck.truth.certificate import Certificate, Point, check_certificate, surfaces

Rationals = tuple[Fraction, ...]


@dataclass(frozen=True, slots=True)
class PairAtTime:
    """A pair at a rational time of a sweep: seven rational numbers, and the axis."""

    row: Rationals
    axis: Rationals
    heights: Sequence[float] = WITHOUT_ENDS


@dataclass(frozen=True, slots=True)
class PassageCertificate:
    """What proves an answer: `pieces` (λ, end) without contact, and the contact at a `time`; None where there is none.

    `points` are in the caller's coordinates; `double_root` is that of a tangency, in place of points.
    """

    pieces: tuple[tuple[Fraction, Fraction], ...] = ()
    time: Fraction | None = None
    points: tuple[Point, ...] = ()
    double_root: Fraction | None = None


def place(row: Sequence[float], time: Fraction) -> PairAtTime:
    """The pair of a row of ten or thirteen numbers at a time."""
    numbers = [Fraction(number) for number in row]
    start, end = numbers[len(SIZES) : len(COLUMNS)], numbers[len(COLUMNS) : len(SWEEP_COLUMNS)]
    centre = [a + time * (b - a) for a, b in zip(start, end, strict=True)]
    axis = numbers[len(SWEEP_COLUMNS) :] or list(map(Fraction, UPRIGHT))
    return PairAtTime((*numbers[: len(SIZES)], *centre), tuple(axis))


def clear_until(row: Sequence[float], certificate: PassageCertificate) -> Fraction | None:
    """The time up to which the pieces prove the spheroid clear; None where there is none, or a piece fails."""
    last = Fraction(0)
    S, H = surfaces(place(row, last))
    unit, numbers = _whole([number for matrix in (S, H) for line in matrix[:3] for number in line[:3]])
    M, D = [numbers[3 * i : 3 * i + 3] for i in range(3)], [numbers[9 + 4 * i] for i in range(3)]
    for multiplier, end in certificate.pieces:
        if not last < end <= 1:
            return None
        first, middle, final = _bernstein(
            M, D, unit, multiplier, [place(row, time).row[len(SIZES) :] for time in (last, end)]
        )
        if min(first, final) <= 0 or (middle < 0 and middle * middle >= first * final):
            return None
        last = end
    return last if certificate.pieces else None


def _bernstein(
    M: list[list[int]], D: list[int], unit: int, multiplier: Fraction, centers: Sequence[Rationals]
) -> tuple[int, int, int]:
    """The Bernstein coefficients of φ between two centres, times one positive number; zeros unless M + λD > 0.

    M and D are times `unit`. With λ = p/q, F = q M + p D has the same `unit`, and (M + λD)⁻¹ = q unit adj F / det F;
    so with centres that are times k, φ is [p q CᵀM adj(F) D C − unit k² (p + q) det F] / (q unit k² det F).
    """
    p, q = multiplier.numerator, multiplier.denominator
    F = [[q * M[i][j] + (i == j) * p * D[i] for j in range(3)] for i in range(3)]
    others = ((1, 2), (2, 0), (0, 1))
    adjugate = [[F[r][u] * F[s][v] - F[r][v] * F[s][u] for r, s in others] for u, v in others]
    determinant = sum(a * line[0] for a, line in zip(F[0], adjugate, strict=True))
    if min(F[0][0], adjugate[2][2], determinant) <= 0:
        return 0, 0, 0
    k, whole = _whole([coordinate for center in centers for coordinate in center])
    ends = whole[:3], whole[3:]
    left = [[sum(c * M[i][j] for i, c in enumerate(end)) for j in range(3)] for end in ends]
    right = [[sum(line[j] * D[j] * c for j, c in enumerate(end)) for line in adjugate] for end in ends]
    lost = unit * k * k * (p + q) * determinant
    first, middle, final = (
        p * q * sum(a * b for a, b in zip(left[i], right[j], strict=True)) - lost for i, j in ((0, 0), (0, 1), (1, 1))
    )
    return first, middle, final


def _whole(numbers: Sequence[Fraction]) -> tuple[int, list[int]]:
    """The least number that makes all of them whole, and them times it."""
    unit = math.lcm(*(number.denominator for number in numbers))
    return unit, [number.numerator * (unit // number.denominator) for number in numbers]


def contact_at(row: Sequence[float], certificate: PassageCertificate) -> Fraction | None:
    """The time from 0 to 1 at which the certificate proves contact; None where it does not."""
    time = certificate.time
    if time is None or not 0 <= time <= 1:
        return None
    claim = Certificate(Position.CONTACT, points=certificate.points, double_root=certificate.double_root)
    return time if check_certificate(place(row, time), claim) else None


def check_passage(row: Sequence[float], certificate: PassageCertificate, first: tuple[float, float] | None) -> bool:
    """Whether the certificate proves the answer: clear all along, or the first contact from first[0] to first[1]."""
    if first is None:
        return certificate.time is None and clear_until(row, certificate) == 1
    lower, upper = (Fraction(bound) for bound in first)
    time = contact_at(row, certificate)
    if time is None or not lower <= time <= upper:
        return False
    return lower == 0 or (clear_until(row, certificate) or 0) >= lower
