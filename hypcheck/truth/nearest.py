"""The nearest-point oracle for one pair, by exact enclosures of the squared distance: no rounding decides anything.

Space is mapped so that the spheroid is the unit ball. With M and D the matrices of the two surfaces and C the centre,

    D(λ) = λ Cᵀ D (M + λD)⁻¹ M C − λ,   λ₋ < λ < λ₊, where M + λD is positive definite,

is the Lagrange dual of the least squared distance from the ball's centre to the hyperboloid: it is concave there, its
supremum is that squared distance, and the clearance is the root of it less 1. D(λ) > 1 says apart, outside for λ > 0,
inside for λ < 0. D is a quotient of polynomials with integer coefficients, and so is its slope: nothing is rounded. One
pole of D is known, that of the horizontal direction across the spheroid's axis; the others are roots of a quadratic.
Of an upright pair D(λ) = λ (P/(A + λ) − Q/(B − λ) − 1) with A = (α/b)², B = (γ/d)², P = (x² + y²)/b², Q = (z/d)².

The enclosures. Where D no longer rises from λ₁ at λ₂, or λ₂ is beyond the end of the interval, the supremum is at least
D(λ₁) and, D being concave, at most D(λ₁) + D′(λ₁)(λ₂ − λ₁). The precision of λ doubles until that leaves one float64 to
round to. An interval cannot distinguish a tangency from its neighbourhood. At a tangency λ is rational; it is guessed
from its digits, and an exact test proves it. If a tie of the rounding may be in the interval, the clearance is taken as
the tie when the interval is narrower than 2⁻²⁵⁶ of the clearance.

Nothing is shared with the other oracles. This module loads no numpy. nearest_rows.py answers many rows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction

from hypcheck.geometry.arithmetic import dot, exponent_of, sign_of, times
from hypcheck.geometry.pair import Lengths, Pair, Position, reduced
from hypcheck.truth.polynomials import Polynomial, derivative, difference, polynomial_product, scaled, value

_FIRST_BITS = 96
_HINT_BITS = 64  # of λ, relative to the distance to the nearer pole
_TIE_BITS = 256
_SHORT_OF_END = 76  # the bits of λ that a hint at an end of the interval shares with it
_MOST_STEPS = 8  # of Newton's iteration in one precision; the next precision goes on from there


class NearestStage(IntEnum):
    """The stage that decided a clearance; STAGES has the names."""

    DOUBLE_DOUBLE = 0
    """In double-double arithmetic, its error bound leaving no doubt."""
    PRECISE = 1
    """By exact enclosures, narrowed as far as needed."""
    EXACT = 2
    """By a closed form (the hard cases) or the exact test for tangency."""


STAGES = ("double-double", "precise", "exact")
"""The stages' names, in the order of their numbers."""


@dataclass(frozen=True, slots=True)
class NearestPoint:
    """The distance of the hyperboloid from the spheroid's centre, in the metric in which the spheroid is a unit ball.

    `clearance` is the factor by which the spheroid, grown about its centre, first touches the hyperboloid, less 1:
    positive when apart, negative when overlapping, 0 exactly when tangent. It is the float64 nearest to the true value
    (to within 2⁻²⁵⁶ of it), inf beyond the largest, and ±5e-324 where a value other than 0 would round to 0.

    `multiplier` is the λ at the optimum, to 2⁻⁶⁴ of its distance to the nearer end of the interval, exactly in the
    stage EXACT. It is above 0 where the centre is outside the hyperboloid and below 0 inside.
    """

    position: Position
    clearance: float
    multiplier: Fraction
    stage: NearestStage

    @property
    def tangent(self) -> bool:
        """Whether the surfaces touch and cross nowhere."""
        return self.clearance == 0


@dataclass(frozen=True, slots=True)
class Dual:
    """The function D of a pair, as a quotient of polynomials in ν = λ/unit: D = value/under.

    The interval of λ is where `first`, which is linear, and `second`, of degree 2 at most, are > 0. A ν is given as an
    integer L and a number of bits: ν = L/2^shift. `slope` is value′ under − value under′, so that D′ = slope/under².
    The degree of `value` is one more than that of `under`, the degree of `slope` twice it.
    """

    value: Polynomial
    under: Polynomial
    slope: Polynomial
    first: tuple[int, int]
    second: tuple[int, int, int]
    unit: Fraction

    @classmethod
    def of(cls, lengths: Lengths) -> Dual:
        """Return the dual of a pair."""
        return _upright(lengths) if lengths.is_upright else _general(lengths)

    def inside(self, L: int, shift: int) -> bool:
        """Decide whether ν = L/2^shift lies in the interval."""
        return value_at(self.first, L, shift) > 0 and value_at(self.second, L, shift) > 0

    def direction(self, L: int, shift: int) -> int:
        """Return the sign of D′ at ν = L/2^shift; beyond an end of the interval the sign that points back to it."""
        if not self.inside(L, shift):
            return 1 if L < 0 else -1
        return sign_of(value_at(self.slope, L, shift))

    def end(self, side: int, shift: int) -> int:
        """Return the last multiple of 2^-shift in the interval on one side of 0, as a distance from 0."""
        a, b = self.first
        e2, e1, e0 = self.second
        e1 *= side
        ends = [((b << shift) - 1) // a] if side < 0 else []
        if e2:
            root = (e1 << shift) + math.isqrt((e1 * e1 - 4 * e0 * e2) << 2 * shift)
            ends.append(root // (-2 * e2))
        elif e1 < 0:
            ends.append(((e0 << shift) - 1) // -e1)
        last = min(ends)
        return last - (not self.inside(side * last, shift))

    def touches(self, at: Fraction) -> bool:
        """Decide whether the surfaces touch at ν = `at`: D, rising up to it in the closed interval from 0, is 1 there.

        There value − under has a root, of a higher order than under, and is negative before it. Inside the interval,
        where under > 0, that is a root of order 2.
        """
        if at == 0 or min(value(self.first, at), value(self.second, at)) < 0:
            return False
        under, gap = self.under, difference(self.value, (0, *self.under))
        pole = root = 0
        while not value(under, at):
            under, pole = derivative(under), pole + 1
        while not (rest := value(gap, at)):
            gap, root = derivative(gap), root + 1
        return root > max(pole, 1) and rest * (-1 if root % 2 and at > 0 else 1) < 0


def _upright(lengths: Lengths) -> Dual:
    """Return the D of an upright pair; each group of lengths has its own unit."""
    p, q, R = reduced((lengths.alpha**2, lengths.b**2, lengths.x**2 + lengths.y**2))
    s, t, Z = reduced((lengths.gamma**2, lengths.d**2, lengths.z**2))
    under = (-q * t, q * s - p * t, p * s)
    return _quotient((-R * t - Z * q, R * s - Z * p), under, (q, p), (0, -t, s), (1, 1))


def _general(lengths: Lengths) -> Dual:
    """Return the D of any pair.

    p, s, q, t are the squares of α, γ, b, d, and V is that of the axis. With N = q t V M and Q = p s D in integers, M +
    λD = (N + νQ)/(q t V) for ν = λ q t V/(p s). The adjugate of N + νQ is that of N, plus ν times a mixed one, plus ν²
    times that of Q.
    """
    p, s, q, t = lengths.alpha**2, lengths.gamma**2, lengths.b**2, lengths.d**2
    v, C = lengths.axis, (lengths.x, lengths.y, lengths.z)
    V, Q = dot(v, v), (s, s, -p)
    N = [[(i == j) * t * V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
    left, right = [a * b for a, b in zip(Q, C, strict=True)], times(N, C)
    mixed = [[-N[i][j] * Q[3 - i - j] if i != j else 0 for j in range(3)] for i in range(3)]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        mixed[i][i] = Q[j] * N[k][k] + Q[k] * N[j][j]
    k3, k2 = -p * s * s, -p * s * (N[0][0] + N[1][1]) + s * s * N[2][2]
    e2, e0, horizontal = -p * s, q * t * V * V, t * V  # N + νQ has the determinant s ν + t V in that direction
    second = (e2, (k2 - horizontal * e2) // s, e0)
    under = (k3, k2, s * e0 + horizontal * second[1], horizontal * e0)
    over = (k3 * dot(C, right), dot(left, times(mixed, right)), under[3] * dot(left, C))
    return _quotient(over, under, (s, horizontal), second, (p * s, q * t * V))


def _quotient(
    over: Polynomial, under: Polynomial, first: tuple[int, int], second: tuple[int, int, int], unit: tuple[int, int]
) -> Dual:
    """Return the Dual with D = ν (over/under − m)/n, where the unit of λ is m/n."""
    m, n = unit
    value = (*difference((0, *over), scaled(m, under)), 0)
    under = scaled(n, under)
    content = math.gcd(*value, *under)
    value, under = (tuple(part // content for part in polynomial) for polynomial in (value, under))
    slope = difference(polynomial_product(derivative(value), under), polynomial_product(value, derivative(under)))
    return Dual(value, under, slope, first, second, Fraction(m, n))


def value_at(f: Polynomial, L: int, shift: int) -> int:
    """Return f(L/2^shift) times 2^shift to the power of f's degree."""
    total = scale = 0
    for coefficient in f:
        total = total * L + (coefficient << scale)
        scale += shift
    return total


@dataclass(frozen=True, slots=True)
class Enclosure:
    """Integers that enclose a clearance: low ≤ 2^bits · clearance ≤ high."""

    low: int
    high: int
    bits: int

    @property
    def rounded(self) -> float | None:
        """The float64, never 0, to which the whole interval rounds; None if there are several, or 0 is inside."""
        if self.low <= 0 <= self.high:
            return None
        unit = 1 << self.bits
        low, high = ratio(self.low, unit), ratio(self.high, unit)
        if low != high and (self.high - self.low) << _TIE_BITS > abs(self.low):
            return None
        if low != high:  # a tie: halves go to the even neighbour
            low = high if math.isinf(high) else float((Fraction(low) + Fraction(high)) / 2)
        return low or (math.ulp(0.0) if self.low > 0 else -math.ulp(0.0))


def nearest(pair: Pair) -> NearestPoint:
    """Return the position and the clearance of any valid pair."""
    return _in_closed_form(pair.lengths) or _enclosed(Dual.of(pair.lengths))


def multiplier(row: Sequence[float | Fraction]) -> Fraction:
    """Find approximately the λ at which D is largest, for ten valid numbers; a hint without a proof.

    If this is an end of the interval, the hint is a little before it, because M + λD must be definite around it.
    """
    dual = Dual.of(Lengths.of(row))
    side = dual.direction(0, 0)
    if not side:
        return Fraction(0)
    L, shift, at_end = _start(dual, side, _FIRST_BITS)
    L = L - (L >> _SHORT_OF_END) if at_end else _newton(dual, L, shift, _FIRST_BITS)[0]
    return _fraction(L, shift) * dual.unit


def _in_closed_form(lengths: Lengths) -> NearestPoint | None:
    """Return the nearest point if D is largest at an end of its interval, else None.

    That can be so only for an upright pair with its centre on the axis or in the plane of the waist.
    """
    if not lengths.is_upright or (lengths.z and (lengths.x or lengths.y)):
        return None
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    R, Z, W = lengths.x**2 + lengths.y**2, lengths.z**2, p * t + s * q  # W = b² d² (A + B)
    if R == 0:
        clearance, side, at = _clearance_of_square(p * (W + Z * q), q * W), -1, Fraction(-p, q)
    elif p * R * t * t >= W * W:
        clearance, side, at = _clearance_of_square(s * (R * t - W), t * W), 1, Fraction(s, t)
    else:
        return None
    return NearestPoint(_position(clearance, side), clearance, at, NearestStage.EXACT)


def _enclosed(dual: Dual) -> NearestPoint:
    """Find the nearest point with a precision that doubles until it suffices."""
    side = dual.direction(0, 0)
    if not side:  # the centre is on the hyperboloid
        return NearestPoint(Position.CONTACT, -1.0, Fraction(0), NearestStage.EXACT)
    bits = _FIRST_BITS
    L, shift, at_end = _start(dual, side, bits)
    while True:
        L, guess = (side * dual.end(side, shift), 1) if at_end else _newton(dual, L, shift, bits)
        doubt = _doubt(dual, L, shift, guess)
        enclosure = _enclosure(dual, L, doubt, shift, 2 * bits)
        at = _fraction(L, shift) * dual.unit
        if enclosure.low <= 0 <= enclosure.high:
            touch = at.limit_denominator(1 << max(8, (shift - exponent_of(dual.unit)) // 2 - 16))
            if dual.touches(touch / dual.unit):
                return NearestPoint(Position.CONTACT, 0.0, touch, NearestStage.EXACT)
        if at_end or doubt << _HINT_BITS <= _room(dual, L, shift):
            clearance = enclosure.rounded
            if clearance is not None:
                # Above 0 it means D > 1: by weak duality the sign of that λ is the side.
                return NearestPoint(_position(clearance, side), clearance, at, NearestStage.PRECISE)
        L, shift, bits = L << bits, shift + bits, 2 * bits


def _position(clearance: float, side: int) -> Position:
    """Return contact unless the clearance is above 0; else exterior or interior, as `side` is above or below 0."""
    return Position.CONTACT if clearance <= 0 else Position(side)


def _start(dual: Dual, side: int, bits: int) -> tuple[int, int, bool]:
    """Find a ν near the one at which D is largest; return L, shift and whether that is an end of the interval.

    ν = L/2^shift. The ratio of its distance from 0 to its distance from the end is right within a factor of 2: it is
    searched among powers of 2. No optimum inside the interval is so near to its end as the last of them. The unit is
    one in which `bits` bits count the distance to the nearer end.
    """
    size = _bits(dual.slope)
    probe = next(shift for shift in (64, size) if shift == size or dual.end(side, shift))
    length = dual.end(side, probe).bit_length() - probe

    fine = max(0, bits - length)
    end = dual.end(side, fine)

    def place(octave: int) -> tuple[int, int]:
        shift = max(0, abs(octave) + 16 - length)
        whole = end >> fine - shift if shift <= fine else dual.end(side, shift)
        return side * ((whole << max(octave, 0)) // ((1 << abs(octave)) + 1)), shift

    def before(octave: int) -> bool:
        return octave < size and value_at(dual.slope, *place(octave)) * side > 0

    step = 1 if before(0) else -1
    near, far = 0, step
    while before(far) is (step > 0) and abs(far) <= size:
        near, far = far, 2 * far
    while abs(far - near) > 1:
        middle = (near + far) // 2
        near, far = (middle, far) if before(middle) is (step > 0) else (near, middle)
    if near == size - 1:
        return side * end, fine, True
    L, shift = place(min(near, far))
    more = max(-shift, bits - _room(dual, L, shift).bit_length())
    return L << more if more >= 0 else L >> -more, shift + more, False


def _room(dual: Dual, L: int, shift: int) -> int:
    """Return the distance from ν = L/2^shift to the nearer end of the interval, in units of 2^-shift, at least 1."""
    return max(1, min(dual.end(1, shift) - L, dual.end(-1, shift) + L))


def _newton(dual: Dual, L: int, shift: int, bits: int) -> tuple[int, int]:
    """Improve ν = L/2^shift, near the maximum of D, by Newton's iteration; return the new L and its error, estimated.

    Both are in units of 2^-shift. ν, L and D are those of Dual.

    From a start good to half of `bits` one step does; each squares the error relative to the nearer end's distance. The
    steps D′/|D″| are computed with twice as many bits as they need, from coefficients cut off: they prove nothing.
    """
    low, high = -dual.end(-1, shift), dual.end(1, shift)
    whole = max(abs(L).bit_length(), 1)
    slope, under = (_cut(f, whole - shift, 2 * max(bits, whole) + 32) for f in (dual.slope, dual.under))
    polynomials = (slope, under, derivative(slope), derivative(under))
    room = step = 1
    for _ in range(_MOST_STEPS):
        room = max(1, min(high - L, L - low))
        rise, k, bend, k_rise = (_fixed(f, L, whole) for f in polynomials)
        curvature = 2 * rise * k_rise - bend * k
        newton = (rise * k << whole) // curvature if curvature > 0 else 0
        step = min(max(newton, (low - L) // 2), (high - L) // 2)
        L += step
        if abs(step) << (bits // 2 - 8) <= room:
            break
    return L, 4 * step * step // room + 4


def _cut(f: Polynomial, exponent: int, bits: int) -> Polynomial:
    """Return about f(2^exponent u) as a polynomial in u, up to a factor; its largest coefficient has `bits` bits."""
    sizes = [
        part.bit_length() + exponent * power for part, power in zip(f, range(len(f) - 1, -1, -1), strict=True) if part
    ]
    left = [bits - max(sizes) + exponent * power for power in range(len(f) - 1, -1, -1)]
    return tuple(part << more if more >= 0 else part >> -more for part, more in zip(f, left, strict=True))


def _fixed(f: Polynomial, L: int, bits: int) -> int:
    """Return about f(L/2^bits)."""
    total = 0
    for part in f:
        total = (total * L >> bits) + part
    return total


def _doubt(dual: Dual, L: int, shift: int, width: int) -> int:
    """Return a distance from ν = L/2^shift, in units of 2^-shift, within which D is largest, as the sign of D′ proves.

    It is `width` if this suffices, else more.
    """
    side = dual.direction(L, shift)
    while dual.direction(L + side * width, shift) * side > 0:
        width <<= 8
    return width


def _enclosure(dual: Dual, L: int, width: int, shift: int, bits: int) -> Enclosure:
    """Enclose the clearance by D and its slope at ν = L/2^shift; D is largest within `width` units of 2^-shift of it.

    Square roots are rounded outward at 2^-bits.
    """
    value, under, slope = (value_at(f, L, shift) for f in (dual.value, dual.under, dual.slope))
    low = _root(value, under << shift, bits)
    high = _root(value * under + abs(slope) * width, under * under << shift, bits) + 1
    return Enclosure(low - (1 << bits), high - (1 << bits), bits)


def _clearance_of_square(numerator: int, denominator: int) -> float:
    """Return the clearance of an exactly known squared distance."""
    if numerator == denominator:
        return 0.0
    bits = _FIRST_BITS
    while True:
        root = _root(numerator, denominator, bits) - (1 << bits)
        clearance = Enclosure(root, root + 1, bits).rounded
        if clearance is not None:
            return clearance
        bits *= 2


def ratio(numerator: int, denominator: int) -> float:
    """Return the quotient, denominator > 0, rounded to nearest; ±inf beyond the largest float64."""
    try:
        return numerator / denominator
    except OverflowError:
        return math.inf if numerator > 0 else -math.inf


def _root(numerator: int, denominator: int, bits: int) -> int:
    """Return the square root of the quotient (of 0, where that is negative), in units of 2^-bits, rounded down."""
    return math.isqrt(max(0, (numerator << 2 * bits) // denominator))


def _bits(f: Polynomial) -> int:
    """Return the number of bits of the largest coefficient."""
    return max(abs(part) for part in f).bit_length()


def _fraction(L: int, shift: int) -> Fraction:
    """Return L/2^shift."""
    return Fraction(L, 1 << shift)
