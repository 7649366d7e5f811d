"""Certificates of answers about an ellipsoid and a quadric, and their check, only in exact arithmetic.

S and H are the symmetric 4×4 matrices of the two surfaces, X̃ = (x, y, z, 1); the ellipsoid is s = X̃ᵀSX̃ ≤ 0, and the
quadric's side of a point is the sign of h = X̃ᵀHX̃. M and D are their upper 3×3 parts, M positive definite. Where
S + λH is positive definite, λh > −s ≥ 0 on the whole closed ellipsoid. So it is enough:

- exterior (h > 0), interior (h < 0): λ > 0, λ < 0 with S + λH positive definite: the pivots of L D Lᵀ are > 0;
- contact: two points of the closed ellipsoid on opposite sides of the quadric, or one that lies on it;
- tangency: a root m of f(λ) = det(S + λH) where M + mD is positive semidefinite and φ = f/det(M + λD), which is
  concave where M + λD is definite, reaches its greatest value between 0 and m at m, and that is 0. Where M + mD is
  definite, a double root of f says so. Where k of its pivots are 0, det(M + λD) has a root of order k at m, and f must
  have one of order k + 1 at least; φ is not > 0 before m if f is not: if its derivative of order k + 1 is 0 or has the
  sign that makes f < 0 between 0 and m.

Where the hyperboloid ends, with the body K = {h ≤ 0, z_min ≤ z ≤ z_max} and its wall, where h = 0:

- the wall is missed: the heights are covered by pieces [l, u], each with a λ and a μ ≥ 0 for which S + λH + μZ is
  positive definite, Z = (z − l)(z − u), or l − z or z − u where a piece has one end. On the piece h = 0 and Z ≤ 0, so
  that s > 0. Where every λ ≥ 0, s > 0 on all of K. One λ for all heights needs no pieces. Then the side of the centre
  is the position (open), or a solid body is exterior;
- inside a solid: interior without ends, and the lowest and highest points lie strictly between the ends;
- contact: two points of the ellipsoid between the ends on opposite sides of h; with a solid, one in K and one that is
  not in its inner part.

A contact that is a touch has no points: only the exact rule proves it (exact.py).

**A sweep.** S(t) is the spheroid's matrix at time t; M does not change. With a λ for which M + λD is positive definite,
S(t) + λH is so exactly where

    φ(t) = λ C(t)ᵀ M (M + λD)⁻¹ D C(t) − 1 − λ > 0.

C(t) is linear in t, so φ is of degree 2, and on [t0, t1] it is positive if its Bernstein coefficients φ(t0), φ(t0, t1),
φ(t1) are, or if the first and last are and the square of the middle one is below their product; φ(s, t) is the bilinear
form that belongs to φ. So it is enough:

- clear up to a time: pieces (λ, end), each beginning where the one before ends, the first at 0;
- contact: a time, and a certificate of contact at that time.

The ellipsoid and the quadric need not be round here, and no axis needs to be vertical. `surfaces` makes the matrices of
a spheroid and a hyperboloid. This module shares no code with what makes certificates: it starts from the numbers of a
row and the definitions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from typing import Protocol

from hypcheck.geometry.pair import COLUMNS, SIZES, SWEEP_COLUMNS, UPRIGHT, WITHOUT_ENDS, Position, over_one_denominator

Point = tuple[Fraction, Fraction, Fraction]
Matrix = list[list[Fraction]]


@dataclass(frozen=True, slots=True)
class Piece:
    """Heights from `low` to `high` (None: no end), with the λ and the μ that prove the wall clear there."""

    low: Fraction | None
    high: Fraction | None
    multiplier: Fraction
    plane: Fraction


@dataclass(frozen=True, slots=True)
class Certificate:
    """A claim with its witness: `multiplier` λ, or `points` (in the caller's coordinates), or `double_root` m.

    If the hyperboloid ends, it may have `pieces`; a contact without any of these is not proved.
    """

    position: Position
    multiplier: Fraction | None = None
    points: tuple[Point, ...] = ()
    double_root: Fraction | None = None
    pieces: tuple[Piece, ...] = ()


class Query(Protocol):
    """A pair: alpha, gamma, b, d, x, y, z and more, and the axis, floats or rationals."""

    @property
    def row(self) -> Sequence[float | Fraction]:
        """The numbers in the order of geometry.pair.COLUMNS; later numbers are not read."""

    @property
    def axis(self) -> Sequence[float | Fraction]:
        """A vector along the spheroid's axis of revolution."""

    @property
    def heights(self) -> Sequence[float | Fraction]:
        """z_min, z_max and whether the body is solid."""


def check_certificate(pair: Query, certificate: Certificate) -> bool:
    """Decide whether the certificate proves its claim about this pair; a double root proves a tangency.

    Numbers of other types are converted to their exact rationals: a single float would round all results, and a pivot
    could become > 0 by rounding. Raises ValueError for a claim that is not a position, and for NaN.
    """
    low, high, _ = pair.heights
    if low != -math.inf or high != math.inf:
        return _proves_between(*surfaces(pair), pair, certificate)
    return proves(*surfaces(pair), certificate)


def _proves_between(S: Matrix, H: Matrix, pair: Query, certificate: Certificate) -> bool:
    """Decide whether the certificate proves its claim about a hyperboloid that ends."""
    low, high, solid = pair.heights
    claim = Position(certificate.position)
    if claim is Position.CONTACT:
        return _crosses_border(S, H, low, high, certificate.points, solid=bool(solid))
    at = certificate.multiplier
    pieces = certificate.pieces if at is None else (Piece(None, None, Fraction(at), Fraction(0)),)
    if solid and claim is Position.INTERIOR:
        return at is not None and at < 0 and is_positive(S, H, pieces[0]) and _lies_between(pair)
    if not _cover(pieces, low, high) or not all(is_positive(S, H, piece) for piece in pieces):
        return False
    if solid:
        return all(piece.multiplier >= 0 for piece in pieces)
    center = [*(Fraction(number) for number in pair.row[4:7]), Fraction(1)]
    inside = _at(H, center) <= 0 and low <= center[2] <= high
    return inside == (claim is Position.INTERIOR)


def _crosses_border(
    S: Matrix, H: Matrix, low: float | Fraction, high: float | Fraction, points: Sequence[Point], *, solid: bool
) -> bool:
    """Decide whether points of the ellipsoid lie on both sides of the border of the body, or one of them on it."""
    sides = set()
    for point in points:
        place = [*map(Fraction, point), Fraction(1)]
        between = low <= place[2] <= high
        if _at(S, place) > 0 or not (solid or between):
            return False
        height = _at(H, place)
        if solid:
            inner = height < 0 and low < place[2] < high
            sides.add(-1 if inner else 0 if height <= 0 and between else 1)
        else:
            sides.add((height > 0) - (height < 0))
    return 0 in sides or sides == {-1, 1}


def _lies_between(pair: Query) -> bool:
    """Decide whether the lowest and the highest point of the spheroid lie strictly between the ends."""
    b, d, z = (Fraction(pair.row[place]) for place in (2, 3, 6))
    v = [Fraction(part) for part in pair.axis]
    reach = b * b + (d * d - b * b) * v[2] * v[2] / sum((part * part for part in v), Fraction(0))
    low, high, _ = pair.heights
    rooms = [away for away, end in ((z - low, low), (high - z, high)) if abs(end) != math.inf]
    return all(away > 0 and Fraction(away) ** 2 > reach for away in rooms)


def _cover(pieces: Sequence[Piece], low: float | Fraction, high: float | Fraction) -> bool:
    """Decide whether pieces cover all heights from `low` to `high`, which may be infinite."""
    reached: float | Fraction | None = low
    for piece in pieces:
        if reached is None or (piece.low is not None and piece.low > reached):
            break
        reached = piece.high
    return bool(pieces) and (reached is None or reached >= high)


def is_positive(S: Matrix, H: Matrix, piece: Piece) -> bool:
    """Decide whether S + λH + μZ of a piece is positive definite, and μ ≥ 0."""
    form, (low, high, mu) = pencil(S, H, piece.multiplier), (piece.low, piece.high, piece.plane)
    if low is not None and high is not None:
        form[2][2] += mu
        tilt, level = -(low + high) / 2, low * high
    else:
        tilt = Fraction(0) if low is None and high is None else Fraction(-1 if high is None else 1, 2)
        level = low if low is not None else -high if high is not None else Fraction(0)
    form[2][3] += mu * tilt
    form[3][2] += mu * tilt
    form[3][3] += mu * level
    return mu >= 0 and all(pivot > 0 for pivot in pivots(form))


def surfaces(pair: Query) -> tuple[Matrix, Matrix]:
    """Make S and H of a spheroid and a hyperboloid, from their definitions.

    Lengths are counted in units of 1/`unit` and the axis v in one of its own, so that all are integers and each entry
    is one quotient: with q = b², t = d² and V = v·v, M is t V I + (q − t) v vᵀ over q t V.
    """
    (alpha, gamma, b, d, *center), unit = over_one_denominator(pair.row[:7])
    v, _ = over_one_denominator(pair.axis)
    q, t, V = b * b, d * d, sum(part * part for part in v)
    M = [[(i == j) * t * V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
    shift = [-sum(part * coordinate for part, coordinate in zip(row, center, strict=True)) for row in M]
    last = -sum(part * coordinate for part, coordinate in zip(shift, center, strict=True)) - q * t * V
    scale, square = q * t * V, unit * unit
    S = [[Fraction(square * part, scale) for part in row] for row in M]
    beside = [Fraction(unit * part, scale) for part in shift]
    p, s = Fraction(square, alpha * alpha), Fraction(-square, gamma * gamma)
    H = [[part if i == j else Fraction(0) for j in range(4)] for i, part in enumerate((p, p, s, Fraction(-1)))]
    return [*([*row, part] for row, part in zip(S, beside, strict=True)), [*beside, Fraction(last, scale)]], H


def proves(S: Matrix, H: Matrix, certificate: Certificate) -> bool:
    """Decide whether the certificate proves its claim about an ellipsoid and any quadric, given by their matrices.

    M, the upper 3×3 part of S, must be positive definite. Raises ValueError as check_certificate does.
    """
    at, m = (
        None if number is None else Fraction(number) for number in (certificate.multiplier, certificate.double_root)
    )
    claim = Position(certificate.position)
    if claim is not Position.CONTACT:
        return at is not None and at * claim > 0 and all(pivot > 0 for pivot in pivots(pencil(S, H, at)))
    if m is not None:
        return m != 0 and _touches(pencil(S, H, m), H, 1 if m > 0 else -1)
    return _crosses_border(S, H, *WITHOUT_ENDS[:2], certificate.points, solid=False)


def _touches(both: Matrix, H: Matrix, side: int) -> bool:
    """Decide whether φ reaches 0 from below at a number m of this sign; `both` is S + mH."""
    inner = pivots([row[:3] for row in both[:3]])
    zeros, f = inner.count(Fraction(0)), _derivatives(both, H)
    if min(inner) < 0 or any(f[: max(2, zeros + 1)]):
        return False
    return zeros == 0 or f[zeros + 1] * (-side) ** (zeros + 1) <= 0


def pencil(S: Matrix, H: Matrix, at: Fraction) -> Matrix:
    """Return S + λH; `at` is λ."""
    return [[a + at * b for a, b in zip(*rows, strict=True)] for rows in zip(S, H, strict=True)]


def pivots(matrix: Matrix) -> list[Fraction]:
    """Return the diagonal of L D Lᵀ by elimination, up to the first pivot that shows the matrix not semidefinite.

    All are > 0 if and only if the matrix is positive definite, all ≥ 0 if and only if it is semidefinite: a pivot of 0
    with a nonzero number in its row counts as −1.
    """
    rows, result = [row[:] for row in matrix], []
    for i, row in enumerate(rows):
        pivot = row[i] if row[i] or not any(row[i:]) else Fraction(-1)
        result.append(pivot)
        if pivot < 0:
            break
        for other in rows[i + 1 :] if pivot else ():
            if other[i]:
                factor = other[i] / pivot
                other[:] = [a - factor * b if b else a for a, b in zip(other, row, strict=True)]
    return result


def _derivatives(both: Matrix, H: Matrix) -> list[int]:
    """Return f and its first four derivatives over 0!, 1! … 4!, times one positive integer, by Leibniz's formula.

    `both` is S + λH. Both are made whole first, because products of fractions take most of the time of a check.
    """
    unit = math.lcm(*(entry.denominator for form in (both, H) for row in form for entry in row))
    values, slopes = ([[int(entry * unit) for entry in row] for row in form] for form in (both, H))
    total = [0, 0, 0, 0, 0]
    for order in permutations(range(4)):
        term = [(-1) ** sum(order[j] < order[i] for i in range(4) for j in range(i + 1, 4))]
        for i, j in enumerate(order):
            value, slope = values[i][j], slopes[i][j]
            term = [a * value + b * slope for a, b in zip([*term, 0], [0, *term], strict=True)]
        total = [a + b for a, b in zip(total, term, strict=True)]
    return total


def _at(form: Matrix, point: list[Fraction]) -> Fraction:
    """Return the value of a quadratic form at a point."""
    rows = (sum((a * b for a, b in zip(row, point, strict=True) if a), Fraction(0)) for row in form)
    return sum((a * b for a, b in zip(rows, point, strict=True)), Fraction(0))


Rationals = tuple[Fraction, ...]


@dataclass(frozen=True, slots=True)
class PairAtTime:
    """A pair at a rational time of a sweep: seven rational numbers, and the axis."""

    row: Rationals
    axis: Rationals
    heights: Sequence[float] = WITHOUT_ENDS


@dataclass(frozen=True, slots=True)
class PassageCertificate:
    """The certificate of a sweep's answer: `pieces` (λ, end) without contact, and contact at a `time`, if there is any.

    `points` are in the caller's coordinates; `double_root` is the double root of a tangency; a tangency has no points.
    """

    pieces: tuple[tuple[Fraction, Fraction], ...] = ()
    time: Fraction | None = None
    points: tuple[Point, ...] = ()
    double_root: Fraction | None = None


def place(row: Sequence[float], time: Fraction) -> PairAtTime:
    """Return the pair at a time of the sweep in a row of ten or thirteen numbers."""
    numbers = [Fraction(number) for number in row]
    start, end = numbers[len(SIZES) : len(COLUMNS)], numbers[len(COLUMNS) : len(SWEEP_COLUMNS)]
    centre = [a + time * (b - a) for a, b in zip(start, end, strict=True)]
    axis = numbers[len(SWEEP_COLUMNS) :] or list(map(Fraction, UPRIGHT))
    return PairAtTime((*numbers[: len(SIZES)], *centre), tuple(axis))


def clear_until(row: Sequence[float], certificate: PassageCertificate) -> Fraction | None:
    """Return the time up to which the pieces prove the spheroid clear; None if there are no pieces, or one fails."""
    last = Fraction(0)
    S, H = surfaces(place(row, last))
    numbers, unit = over_one_denominator([number for matrix in (S, H) for line in matrix[:3] for number in line[:3]])
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
    """Return the Bernstein coefficients of φ between two centres, times one positive number; zeros unless M + λD > 0.

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
    whole, k = over_one_denominator([coordinate for center in centers for coordinate in center])
    ends = whole[:3], whole[3:]
    left = [[sum(c * M[i][j] for i, c in enumerate(end)) for j in range(3)] for end in ends]
    right = [[sum(line[j] * D[j] * c for j, c in enumerate(end)) for line in adjugate] for end in ends]
    lost = unit * k * k * (p + q) * determinant
    first, middle, final = (
        p * q * sum(a * b for a, b in zip(left[i], right[j], strict=True)) - lost for i, j in ((0, 0), (0, 1), (1, 1))
    )
    return first, middle, final


def contact_at(row: Sequence[float], certificate: PassageCertificate) -> Fraction | None:
    """Return the time from 0 to 1 at which the certificate proves contact; None if it does not."""
    time = certificate.time
    if time is None or not 0 <= time <= 1:
        return None
    claim = Certificate(Position.CONTACT, points=certificate.points, double_root=certificate.double_root)
    return time if check_certificate(place(row, time), claim) else None


def check_passage(row: Sequence[float], certificate: PassageCertificate, first: tuple[float, float] | None) -> bool:
    """Decide whether the certificate proves the answer: clear all along, or first contact from first[0] to first[1]."""
    if first is None:
        return certificate.time is None and clear_until(row, certificate) == 1
    lower, upper = (Fraction(bound) for bound in first)
    time = contact_at(row, certificate)
    if time is None or not lower <= time <= upper:
        return False
    return lower == 0 or (clear_until(row, certificate) or 0) >= lower
