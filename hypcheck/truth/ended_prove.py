"""The search for the certificate of an answer about a hyperboloid that ends; certificate.py checks it.

A wall that is missed is cut into pieces, each with a λ and a μ: λ is that of the middle height (sections.py), and then
the best μ is known. With A w² + B w + C the least e + λ h at a height w, the form with μ (w − l)(w − u) is positive
definite if A + μ > 0 and 4 (A + μ)(C + μ l u) > (B − μ (l + u))², of which the difference is greatest at
μ = 2 (C + A l u + B (l + u)/2)/(u − l)². Where the spheroid does not reach, λ is 0. A piece that cannot be proved is
halved; this ends, since the pair is clear.

Two points of a contact lie beside a point of the wall within the spheroid, which floats find (least.py): it is made
rational, moved a little outward and inward, and checked exactly.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import least
from hypcheck.truth.certificate import Certificate, Matrix, Piece, Point, check_certificate, is_positive, surfaces
from hypcheck.truth.exact import Decision
from hypcheck.truth.rationals import root_of, rounded
from hypcheck.truth.sections import Sections

_BITS = (8, 24, 64, 160)


def prove(pair: Pair, decision: Decision, multiplier: Fraction | None) -> Certificate:
    """A certificate for the exact answer about a pair with ends; `multiplier` is the pair's without ends, if any.

    For a touch, and for a crossing that floats do not find, it has only the position: see certificate.py.
    """
    position = decision.position
    if position is Position.CONTACT:
        candidates = (Certificate(position, points=points) for points in _crossings(pair))
    else:
        candidates = (Certificate(position, multiplier=at) for at in (multiplier,) if at is not None)
    for certificate in candidates:
        if check_certificate(pair, certificate):
            return certificate
    pieces = () if position is Position.CONTACT else tuple(_pieces(pair))
    return Certificate(position, pieces=pieces)


def _pieces(pair: Pair) -> Iterator[Piece]:
    """Pieces of [z_min, z_max] that prove that the wall, or a solid body, is missed."""
    S, H = surfaces(pair)
    sections = Sections.of(pair.lengths)
    unit = Fraction(pair.lengths.d) / Fraction(pair.d)
    bottom, top = _beyond_reach(pair)
    low, high = max(Fraction(bottom), _end(pair.z_min, bottom)), min(Fraction(top), _end(pair.z_max, top))
    if pair.z_min < bottom:
        yield _outside(pair, None, bottom)
    pending = [(low, high)] if low < high else []
    while pending:
        low, high = pending.pop()
        middle = (low + high) / 2
        tried = _tried(S, H, (low, high), sections.multiplier(middle * unit), solid=bool(pair.solid))
        piece = next(tried, None)
        if piece is None:
            pending += [(middle, high), (low, middle)]
        else:
            yield piece
    if pair.z_max > top:
        yield _outside(pair, top, None)


def _end(height: float, otherwise: Fraction) -> Fraction:
    return Fraction(height) if math.isfinite(height) else otherwise


def _half_height_squared(pair: Pair) -> Fraction:
    """The square of the spheroid's half height."""
    b, d, v = Fraction(pair.b), Fraction(pair.d), [Fraction(part) for part in pair.axis]
    return b * b + (d * d - b * b) * v[2] * v[2] / sum((part * part for part in v), Fraction(0))


def _beyond_reach(pair: Pair) -> tuple[Fraction, Fraction]:
    """Heights below the lowest and above the highest point of the spheroid."""
    half = rounded(root_of(_half_height_squared(pair), 16, upward=True) * Fraction(9, 8), 8)
    return Fraction(pair.z) - half, Fraction(pair.z) + half


def _outside(pair: Pair, low: Fraction | None, high: Fraction | None) -> Piece:
    """The piece above `low`, or below `high`, which the spheroid does not reach: λ is 0."""
    z = Fraction(pair.z)
    away = z - high if high is not None else (low or Fraction(0)) - z
    return Piece(low, high, Fraction(0), rounded(2 * away / _half_height_squared(pair), 16))


def _tried(S: Matrix, H: Matrix, heights: tuple[Fraction, Fraction], at: Fraction, *, solid: bool) -> Iterator[Piece]:
    """The proved pieces with this λ, rounded to more and more bits."""
    low, high = heights
    for bits in _BITS:
        multiplier = rounded(at, bits) if at else at
        if solid and multiplier < 0:
            multiplier = Fraction(0)
        quadratic = _least_at_height(S, H, multiplier)
        if quadratic is None:
            continue
        A, B, C = quadratic
        best = 2 * (C + A * low * high + B * (low + high) / 2) / (high - low) ** 2
        piece = Piece(low, high, multiplier, rounded(best, bits + 8) if best > 0 else Fraction(0))
        if is_positive(S, H, piece):
            yield piece


def _least_at_height(S: Matrix, H: Matrix, at: Fraction) -> tuple[Fraction, Fraction, Fraction] | None:
    """A, B, C; None if e + λh is not convex in horizontal planes."""
    rows = [[a + at * b for a, b in zip(*pair, strict=True)] for pair in zip(S, H, strict=True)]
    for i in (0, 1):
        if rows[i][i] <= 0:
            return None
        for other in rows[i + 1 :]:
            factor = other[i] / rows[i][i]
            other[:] = [a - factor * b for a, b in zip(other, rows[i], strict=True)]
    return rows[2][2], 2 * rows[2][3], rows[3][3]


def _crossings(pair: Pair) -> Iterator[tuple[Point, Point]]:
    """Pairs of points that may prove a contact."""
    center = (Fraction(pair.x), Fraction(pair.y), Fraction(pair.z))
    low, high = (Fraction(end) if math.isfinite(end) else None for end in (pair.z_min, pair.z_max))
    nearest = least.to_border(pair).point
    if not all(map(math.isfinite, nearest)):
        return
    place = tuple(map(Fraction, nearest))
    for shrink in (Fraction(0), Fraction(1, 1 << 30), Fraction(1, 1 << 10), Fraction(1, 16)):
        x, y, w = (p + shrink * (c - p) for p, c in zip(place, center, strict=True))
        w = w if low is None else max(w, low)
        w = w if high is None else min(w, high)
        for step in (40, 30, 20, 10, 4):
            near = Fraction(1, 1 << step)
            yield (x * (1 + near), y * (1 + near), w), (x * (1 - near), y * (1 - near), w)
    if pair.solid:
        yield (place[0], place[1], place[2]), center
