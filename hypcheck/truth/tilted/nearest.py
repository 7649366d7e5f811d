"""The nearest-point oracle in general position: the distance from the spheroid's centre to the hyperboloid.

With v̂ the axis of unit length, M^(1/2) = I/b + (1/d − 1/b) v̂ v̂ᵀ makes the spheroid a unit ball about c = M^(1/2) C
and the hyperboloid yᵀ K y = 1, K = M^(−1/2) D M^(−1/2). K has a horizontal eigenvector across v and two in the plane of
v and the hyperboloid's axis, where K is a 2×2 matrix in the basis (v̂, ŵ), ŵ across v̂. In its eigenbasis the
hyperboloid is y1²/A1 + y2²/A2 − y3²/B = 1 and c has components with squares P1, P2, Q. The Lagrange dual of min |y −
c|² − 1 over it,

    φ(λ) = λ (P1/(A1 + λ) + P2/(A2 + λ) − Q/(B − λ)) − 1 − λ,   −min(A1, A2) < λ < B,

is concave and has no gap: sup φ = distance² − 1. Its slope F(λ) = A1 P1/(A1 + λ)² + A2 P2/(A2 + λ)² − B Q/(B − λ)² − 1
is the hyperboloid's equation at the point nearest for λ. So any λ gives two bounds, φ(λ) ≤ sup φ ≤ φ(λ) + |F(λ)| · (the
way to the end of the interval to which F points), and no answer rests on an iteration having converged. φ(λ) > 0 says
apart, outside for λ > 0, inside for λ < 0; an upper bound < 0 says in contact.

All is enclosed in intervals (mpmath), with more bits until the bounds tell. Only a tangency never shows in them: then
λ, rational there, is guessed from its digits, and the point of touch is verified in rational arithmetic. Nothing is
shared with the other oracles, and upright spheroids are no special case.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

from mpmath import MPContext, MPIntervalContext, mpf
from mpmath.ctx_iv import ivmpf

from hypcheck.geometry.pair import Pair, Position

STAGES = (100, 300, 1000, 4000, 16000)
"""Bits, one stage after the other. Ordinary rows need the first, near contacts the second."""

_LARGEST = 1e60
"""Floats find λ as long as A1, A2, B and P1, P2, Q are not beyond this, nor the first three below its inverse."""

Vector = list[Fraction]
Number: TypeAlias = float | mpf


@dataclass(frozen=True, slots=True)
class TiltedNearest:
    """What the distance says. `position` is None where the last stage cannot tell it from a tangency.

    `clearance` is the distance to the hyperboloid minus 1, in spheroid radii, < 0 where the pair overlaps, 0 if and
    only if `tangent` (or where None was answered); rounded to float64, within one unit in the last place. One that
    would round to 0 is ±5e-324, one beyond the largest float64 is inf. `bits` is the precision that was enough.
    """

    position: Position | None
    clearance: float
    tangent: bool
    bits: int


def nearest(pair: Pair) -> TiltedNearest:
    """The position and the clearance of any valid pair."""
    for bits in STAGES:
        spectrum = _Spectrum((*pair.row[:7], *pair.axis), bits)
        at = spectrum.optimum()
        lower, upper = spectrum.bounds(at)
        if _may_touch(lower, upper, bits) and _touches(pair, at, bits):
            return TiltedNearest(Position.CONTACT, 0.0, tangent=True, bits=bits)
        found, clearance = _position(at, lower, upper), _clearance(spectrum.plain, lower, upper)
        if found is not None and clearance is not None:
            return TiltedNearest(found, clearance, tangent=False, bits=bits)
    return TiltedNearest(None, 0.0, tangent=False, bits=STAGES[-1])


def position(pair: Pair) -> Position | None:
    """The position alone, for which fewer bits are enough; None as in nearest."""
    for bits in STAGES:
        spectrum = _Spectrum((*pair.row[:7], *pair.axis), bits)
        at = spectrum.optimum()
        lower, upper = spectrum.bounds(at)
        found = _position(at, lower, upper)
        if found is not None:
            return found
        if _may_touch(lower, upper, bits) and _touches(pair, at, bits):
            return Position.CONTACT
    return None


def multiplier(row: Sequence[float | Fraction]) -> Fraction:
    """About the λ at which φ is largest, for ten valid numbers; a hint, of which nothing is proved."""
    return fraction(_Spectrum(row, STAGES[0], enclosed=False).optimum())


def _position(at: mpf, lower: mpf, upper: mpf) -> Position | None:
    if lower > 0:
        return Position.EXTERIOR if at > 0 else Position.INTERIOR
    return Position.CONTACT if upper < 0 else None


def _clearance(context: MPContext, lower: mpf, upper: mpf) -> float | None:
    """√(1 + φ) − 1 as float64 where both bounds give the same or neighbours; φ/(1 + √(1 + φ)) does not cancel.

    φ is as small as a product of two offsets, far below the least float64: the sign of a bound is never rounded away.
    """
    low, high = (_signed(each / (1 + context.sqrt(max(1 + each, 0)))) for each in (lower, upper))
    return low if high <= math.nextafter(low, math.inf) else None


def _signed(number: mpf) -> float:
    """The number as float64, 0 only where it is 0."""
    return float(number) or math.ulp(0.0) * ((number > 0) - (number < 0))


@lru_cache(maxsize=len(STAGES))
def _contexts(bits: int) -> tuple[MPIntervalContext, MPContext]:
    """mpmath's contexts for intervals and for numbers, which take longer to make than a row to answer."""
    interval, plain = MPIntervalContext(), MPContext()
    interval.prec = plain.prec = bits
    return interval, plain


class _Spectrum:
    """A1, A2, B and P1, P2, Q of a row in `bits` bits: enclosed in intervals, or near enough for a hint."""

    def __init__(self, row: Sequence[float | Fraction], bits: int, *, enclosed: bool = True) -> None:
        self.bits = bits
        self.interval, self.plain = _contexts(bits)
        self.context = iv = self.interval if enclosed else self.plain
        alpha, gamma, b, d, x, y, z, v_x, v_y, v_z = (
            iv.mpf(each) if isinstance(each, float) else iv.mpf(each.numerator) / each.denominator for each in row
        )
        horizontal = iv.sqrt(v_x * v_x + v_y * v_y)
        length = iv.sqrt(v_x * v_x + v_y * v_y + v_z * v_z)
        azimuth_x, azimuth_y = (v_x / horizontal, v_y / horizontal) if row[7] or row[8] else (1, 0)
        sine, cosine = horizontal / length, v_z / length
        ahead, aside = x * azimuth_x + y * azimuth_y, y * azimuth_x - x * azimuth_y
        radial, axial = 1 / alpha**2, 1 / gamma**2
        # K and c in the plane of both axes, along v̂ = (sine, cosine) and across, ŵ = (cosine, −sine)
        e = d**2 * (sine**2 * radial - cosine**2 * axial)
        g = b**2 * (cosine**2 * radial - sine**2 * axial)
        f = b * d * sine * cosine * (radial + axial)
        along, across = (ahead * sine + z * cosine) / d, (ahead * cosine - z * sine) / b
        self.A1, self.P1 = (alpha / b) ** 2, (aside / b) ** 2
        positive, direction = self._eigenpair(e, f, g, (b * d / (alpha * gamma)) ** 2)
        self.A2, self.B = 1 / positive, positive * (alpha * gamma / (b * d)) ** 2
        square = direction[0] ** 2 + direction[1] ** 2
        self.P2 = (along * direction[0] + across * direction[1]) ** 2 / square
        self.Q = (across * direction[0] - along * direction[1]) ** 2 / square

    def _eigenpair(self, e: ivmpf, f: ivmpf, g: ivmpf, minus_det: ivmpf) -> tuple[ivmpf, tuple[ivmpf, ivmpf]]:
        """The positive eigenvalue of [[e, f], [f, g]] and an eigenvector; e g − f² = −minus_det < 0."""
        half, trace = (e - g) / 2, (e + g) / 2
        root = self.context.sqrt(half * half + f * f)
        size = self.context.sqrt(trace * trace + minus_det)  # the same number, enclosed from another side
        positive = trace + size if trace > 0 else minus_det / (size - trace)
        first = self._middle(half) > 0
        direction = (root + half, f) if first else (f, root - half)
        return positive, direction

    def bounds(self, at: mpf) -> tuple[mpf, mpf]:
        """Proved bounds on sup φ from one λ; −1 and inf where these bits do not show it to lie in the interval."""
        exactly = self.interval.mpf(at)
        poles = self.A1 + exactly, self.A2 + exactly, self.B - exactly
        if min(self._low(each) for each in poles) <= 0:
            return self.plain.mpf(-1), self.plain.inf
        one, two, three = (each / pole for each, pole in zip((self.P1, self.P2, self.Q), poles, strict=True))
        value = exactly * (one + two - three) - 1 - exactly
        slope = self.A1 * one / poles[0] + self.A2 * two / poles[1] - self.B * three / poles[2] - 1
        rise = max(self._high(slope * poles[2]), min(self._high(-slope * pole) for pole in poles[:2]), 0)
        return self._low(value), self._high(value) + rise

    def optimum(self) -> mpf:
        """About where φ is largest: by floats in the first stage, as long as those hold the numbers."""
        numbers = [self._middle(each) for each in self._six()]
        floats = [float(each) for each in numbers]
        if self.bits == STAGES[0] and min(floats[:3]) > 1 / _LARGEST and max(floats) < _LARGEST:
            end, odds, steps = *_root(floats, -500, self.bits - 24), 1
        else:
            end, odds, steps = *_root(numbers, -20_000, self.bits - 24), self.bits.bit_length()
        whole = numbers[2] if end > 0 else -min(numbers[:2])
        return self._newton(numbers, whole * odds / (1 + self.plain.mpf(odds)), steps)

    def _newton(self, numbers: list[mpf], at: mpf, steps: int) -> mpf:
        A1, A2, B, P1, P2, Q = numbers
        for _ in range(steps):
            one, two, three = A1 + at, A2 + at, B - at
            slope = A1 * P1 / one**2 + A2 * P2 / two**2 - B * Q / three**2 - 1
            curvature = A1 * P1 / one**3 + A2 * P2 / two**3 + B * Q / three**3
            step = slope / (2 * curvature) if curvature else 0
            if not -min(one, two) < 2 * step < three:
                break
            at += step
        return at

    def _six(self) -> tuple[ivmpf, ...]:
        return self.A1, self.A2, self.B, self.P1, self.P2, self.Q

    def _middle(self, number: ivmpf | mpf) -> mpf:
        return number if self.context is self.plain else (self._low(number) + self._high(number)) / 2

    def _low(self, enclosure: ivmpf) -> mpf:
        return self.plain.mpf(enclosure.a)

    def _high(self, enclosure: ivmpf) -> mpf:
        return self.plain.mpf(enclosure.b)


def _root(numbers: list[Number], low: int, high: int) -> tuple[Number, Number]:
    """The root of the falling F between −min(A1, A2) and B: the end that it lies towards, and the odds of its way.

    Odds are the way from 0 gone against the way left, so that neither is a difference that cancels: first a power of
    two between 2^low and 2^high, then 50 bits more.
    """
    A1, A2, B, P1, P2, Q = numbers
    least = min(A1, A2)
    outside = P1 / A1 + P2 / A2 - Q / B - 1 > 0

    def reached(odds: Number) -> bool:
        """Whether the root lies nearer to 0. Where a pole is not felt (P or Q is 0) there may be none: then never."""
        end = B if outside else least
        left = end / (1 + odds)
        gone = left * odds
        one, two, three = (A1 + gone, A2 + gone, left) if outside else (A1 - least + left, A2 - least + left, B + gone)
        slope = A1 * P1 / one**2 + A2 * P2 / two**2 - B * Q / three**2 - 1
        return bool((slope > 0) is not outside)

    two = B / B + B / B
    while high - low > 1:
        k = (low + high) // 2
        low, high = (low, k) if reached(two**k) else (k, high)
    less, more = two**low, two**high
    for _ in range(50):
        middle = (less + more) / 2
        less, more = (less, middle) if reached(middle) else (middle, more)
    return (B if outside else -least), less


def _may_touch(lower: mpf, upper: mpf, bits: int) -> bool:
    """Whether the bounds leave little more than a tangency."""
    return bool(lower <= 0 <= upper and (upper - lower) * 2 ** (bits // 3) < 1)


def _touches(pair: Pair, near: mpf, bits: int) -> bool:
    """Whether the rational λ of few digits near this one proves a tangency.

    With G = M + λD positive definite X = G⁻¹ M C is nearest for λ, and the surfaces touch in it if it lies on both.
    Where G is singular, λ an end of the interval, X with no component in the kernel does, moved by some ±τ k, k in the
    kernel: the hyperboloid's equation at X + τk is h(X) + τ² kᵀDk, that of the spheroid s(X) + τ² kᵀMk, kᵀMk = −λ kᵀDk.
    """
    at = fraction(near).limit_denominator(1 << bits // 2 - 16)
    alpha, gamma, b, d, *center = map(Fraction, pair.row[:7])
    v = [Fraction(each) for each in pair.axis]
    along = (1 / d**2 - 1 / b**2) / sum(each * each for each in v)
    M = [[(i == j) / b**2 + along * v[i] * v[j] for j in range(3)] for i in range(3)]
    D = (1 / alpha**2, 1 / alpha**2, -1 / gamma**2)
    G = [[M[i][j] + (i == j) * at * D[i] for j in range(3)] for i in range(3)]
    kernel = _kernel(G)
    right = _times(M, center)
    if any(_dot(k, right) for k in kernel):
        return False
    for k in kernel:  # G + Mk (Mk)ᵀ is regular, and its solution has no component along k
        image = _times(M, k)
        G = [[G[i][j] + image[i] * image[j] for j in range(3)] for i in range(3)]
    if not _positive_definite(G):
        return False
    X = _solved(G, right)
    way = [p - q for p, q in zip(X, center, strict=True)]
    spheroid = _dot(way, _times(M, way)) - 1
    hyperboloid = sum(D[i] * X[i] ** 2 for i in range(3)) - 1
    if not kernel:
        return spheroid == 0 and hyperboloid == 0
    return spheroid + at * hyperboloid == 0 and at * hyperboloid >= 0


def _kernel(G: list[Vector]) -> list[Vector]:
    """A basis of the kernel of a singular G = M + λD, across M: empty, one vector, or the horizontal plane's two."""
    crosses = [_cross(G[i], G[j]) for i, j in ((0, 1), (1, 2), (2, 0))]
    found = [each for each in crosses if any(each)]
    if not found:
        return [[Fraction(1), Fraction(0), Fraction(0)], [Fraction(0), Fraction(1), Fraction(0)]]
    return found[:1] if not any(_dot(row, found[0]) for row in G) else []


def _positive_definite(G: list[Vector]) -> bool:
    """By Sylvester's minors."""
    last = _cross(G[0], G[1])
    return G[0][0] > 0 and last[2] > 0 and _dot(G[2], last) > 0


def _solved(G: list[Vector], right: Vector) -> Vector:
    """The solution of a regular system, by Cramer's rule for a symmetric matrix."""
    adjugate = [_cross(G[1], G[2]), _cross(G[2], G[0]), _cross(G[0], G[1])]
    determinant = _dot(G[0], adjugate[0])
    return [sum((adjugate[i][j] * right[i] for i in range(3)), Fraction(0)) / determinant for j in range(3)]


def _cross(p: Vector, q: Vector) -> Vector:
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def _dot(p: Vector, q: Vector) -> Fraction:
    return sum((a * b for a, b in zip(p, q, strict=True)), Fraction(0))


def _times(matrix: list[Vector], vector: Vector) -> Vector:
    return [_dot(row, vector) for row in matrix]


def fraction(number: mpf) -> Fraction:
    """An mpf, exactly; its mantissa has no sign."""
    size = Fraction(int(number.man)) * Fraction(2) ** int(number.exp)
    return -size if number < 0 else size
