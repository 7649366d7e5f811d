"""The nearest-point oracle for one pair, by exact enclosures of the squared distance: no rounding decides anything.

The dual function. With T = K α² + b² L and Z = K γ² − d² L, λ = L/K lies in (−A, B) if T, Z > 0, and the dual function
D and its derivative F (docs/mathematics.md, "Nearest point and clearance") are quotients of integers over T Z: nothing
is rounded. D is concave and its supremum over (−A, B) is the squared distance from the spheroid's centre to the
hyperboloid, in spheroid radii.

`start` approximates the maximum in floats; only the time of the exact enclosures depends on it. With p = a r,
q = c |z|, W = A + B, τ = A + λ and σ = B − λ = W − τ, F(λ) = 0 reads τ √(1 + (q/σ)²) = p. The left side is convex and
increasing in τ, so Newton's iteration falls steadily onto the root from any start above it.

The enclosures. Where F is ≥ 0 at λ₁ and ≤ 0 at λ₂ ≥ λ₁ the supremum of D is at least D(λ₁) and, D being concave, at
most D(λ₁) + F(λ₁)(λ₂ − λ₁). The precision of λ doubles until that interval leaves one float64 to round to. An interval
never tells a tangency from its neighbourhood: the exact test, `tangency`, does. Where a tie of the rounding might be
hidden in the interval, it is taken for one once the interval is narrower than 2⁻²⁵⁶ of the clearance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from functools import cache
from typing import Any, cast

from hypcheck.geometry.pair import Pair, Position


@dataclass(frozen=True, slots=True)
class SquaredLengths:
    """The squares of a pair's lengths: α², b², R = x² + y² in one unit, γ², d², z² in another."""

    alpha: int
    b: int
    R: int
    gamma: int
    d: int
    z: int

    @classmethod
    def of(cls, pair: Pair) -> SquaredLengths:
        """The squares, exactly, without the powers of two that all three of a group share."""
        lengths = pair.lengths
        radial = _reduced(lengths.alpha**2, lengths.b**2, lengths.x**2 + lengths.y**2)
        axial = _reduced(lengths.gamma**2, lengths.d**2, lengths.z**2)
        return cls(*radial, *axial)


@dataclass(frozen=True, slots=True)
class Dual:
    """D and F at λ = L/K: D = value/(K T Z), F = slope/(T Z)². T and Z are b² K (A + λ) and d² K (B − λ)."""

    L: int
    K: int
    T: int
    Z: int
    value: int
    slope: int


def dual(squares: SquaredLengths, L: int, K: int) -> Dual:
    """The dual function and its derivative at λ = L/K, K > 0; λ must lie in (−A, B)."""
    T = K * squares.alpha + L * squares.b
    Z = K * squares.gamma - L * squares.d
    product = T * Z
    value = L * (K * (squares.R * Z - squares.z * T) - product)
    slope = K * K * (squares.alpha * squares.R * Z * Z - squares.gamma * squares.z * T * T) - product * product
    return Dual(L, K, T, Z, value, slope)


def newton_step(squares: SquaredLengths, at: Dual) -> int:
    """The step F/|F′| of Newton's iteration from λ, in units of 1/K, rounded down."""
    curvature = squares.alpha * squares.R * squares.b * at.Z**3 + squares.gamma * squares.z * squares.d * at.T**3
    return at.slope * at.T * at.Z // (2 * at.K * at.K * curvature)


def tangency(squares: SquaredLengths) -> Dual | None:
    """The dual at its maximum if that maximum is exactly 1 and inside (−A, B): the surfaces touch. None if they do not.

    There D = 1 and F = 0, which suffices, as D is concave: that is what is tested. Such a λ is a double root of the
    cubic g of docs/mathematics.md, and no triple one, as D is strictly concave if it has a maximum inside. The double
    root of a cubic is the rational function of its coefficients that is tried here; its denominator is, up to a square,
    twice the square of the distance to the third root, hence positive.
    """
    alpha, b, R, gamma, d, z = squares.alpha, squares.b, squares.R, squares.gamma, squares.d, squares.z
    n3 = b * d
    n2 = alpha * d - gamma * b + b * d - R * d - z * b
    n1 = alpha * (d - gamma - z) + gamma * (R - b)
    n0 = -alpha * gamma
    numerator, denominator = 9 * n0 * n3 - n1 * n2, 2 * (n2 * n2 - 3 * n1 * n3)
    if denominator <= 0 or not -alpha * denominator < b * numerator or not d * numerator < gamma * denominator:
        return None
    at = dual(squares, numerator, denominator)
    return at if at.slope == 0 and at.value == at.K * at.T * at.Z else None


def _reduced(first: int, second: int, third: int) -> tuple[int, int, int]:
    """The three divided by the largest power of two that divides all."""
    union = first | second | third
    shift = (union & -union).bit_length() - 1
    return first >> shift, second >> shift, third >> shift


@cache
def _without_range() -> Any:  # noqa: ANN401 - mpmath has no types
    """A context of 64 bits and an exponent without limits: our own, so that mpmath's precision stays what it is."""
    import mpmath  # noqa: PLC0415 - only for lengths beyond the range of the iteration in float64

    context = mpmath.MPContext()
    context.prec = 64
    return context


_FLOAT_RANGE = 120
"""Binary orders within which A, B, P, Q must lie for the iteration in float64: then nothing overflows in it."""
_MOST_FLOAT_STEPS = 100  # many more than it takes


def start(squares: SquaredLengths) -> tuple[bool, int, int]:
    """Whether −A is the pole nearer to the maximum (else B), and its distance as mantissa and binary exponent.

    The maximum must be inside (−A, B): r > 0, and z ≠ 0 or a r < A + B. The relative error is about 2⁻⁵⁰.
    """
    if _fits_float(squares):
        tau, sigma = _iterate(squares, lambda n, d: n / d, math.sqrt)
        fraction, exponent = math.frexp(min(tau, sigma))
    else:
        context = _without_range()
        tau, sigma = _iterate(squares, lambda n, d: _wide(n) / _wide(d), context.sqrt)
        fraction, exponent = context.frexp(min(tau, sigma))
    return tau <= sigma, int(fraction * 2**64), exponent - 64


def _wide(number: int) -> float:
    """The number, to 80 bits before it is rounded: mpmath takes off the zeros that a long one ends in 8 at a time."""
    excess = max(0, number.bit_length() - 80)
    return cast("float", _without_range().ldexp(number >> excess, excess))


def _fits_float(squares: SquaredLengths) -> bool:
    """Whether A, B, P and Q, where not 0, are within the range of float64 with room to spare."""
    ratios = ((squares.alpha, squares.b), (squares.gamma, squares.d), (squares.R, squares.b), (squares.z, squares.d))
    return all(abs(n.bit_length() - d.bit_length()) < _FLOAT_RANGE for n, d in ratios if n)


def _iterate(
    squares: SquaredLengths, ratio: Callable[[int, int], float], sqrt: Callable[[float], float]
) -> tuple[float, float]:
    """τ and σ, the smaller one to nearly full relative precision, in float64 or in any type that counts like it.

    Steps are taken on both, so neither is a difference. p − τ is g + σ with g = p − W = (p² − W²)/(p + W) from exact
    squares: near the evolute's cusp, where p is about W, σ would drown in the rounding of p and W.
    """
    s = squares
    sizes = s.alpha * s.d + s.gamma * s.b  # b² d² W
    W = ratio(sizes, s.b * s.d)
    p, q = sqrt(ratio(s.alpha * s.R, s.b * s.b)), sqrt(ratio(s.gamma * s.z, s.d * s.d))
    excess = ratio(s.alpha * s.R * s.d * s.d - sizes * sizes, s.b * s.b * s.d * s.d) / (p + W)
    tau, sigma = _above(p, q, W, excess)
    for _ in range(_MOST_FLOAT_STEPS):
        slope = (q / sigma) * (q / sigma)
        root = sqrt(1 + slope)
        rest = p - tau if tau <= sigma else excess + sigma
        step = (rest - tau * slope / (1 + root)) / (root + slope * (tau / sigma) / root)
        tau, sigma = tau + step, sigma - step
        if abs(step) <= 2.0**-26 * min(tau, sigma):  # the next step would be below the rounding
            break
    return tau, sigma


def _above(p: float, q: float, W: float, excess: float) -> tuple[float, float]:
    """τ and σ with τ at or above the root, within a modest factor of it, and σ likewise at or below.

    τ < p, and τ/p < σ/q since p/τ > q/σ: both bound τ, and the smaller bound is less than twice the root. If it is over
    W/2 the root is over W/4 and q²/σ² = (p − τ)(p + τ)/τ² ≤ (g + σ)·32p/W² with g = max(p − W, 0): that bounds σ. Where
    g > 0, τ < W makes σ less than s = q W/√(p² − W²); so σ = q τ/√((g + σ)(p + τ)) is over q (W − s)/√((g + s)(p + W)),
    which is near to it, however far the lengths are apart, unless p is about W.
    """
    tau, sigma = min(p, p * (W / (p + q))), max(-excess, W * (q / (p + q)))
    if 2 * tau <= W or not q:
        return tau, sigma
    flat = (q * W) * (q * W) / (32 * p)
    bound = (flat / 2) ** (1 / 3)
    if excess > 0:
        if flat < 2 * excess * bound * bound:
            bound = (flat / (2 * excess)) ** 0.5
        most = q * W / (excess * (p + W)) ** 0.5
        bound = max(bound, q * (W - most) / ((excess + most) * (p + W)) ** 0.5)
    return (W - bound, bound) if bound > sigma else (tau, sigma)


Point = tuple[float, float, float]

_FIRST_BITS = 96
_POINT_BITS = 64  # of λ, relative to the distance to the nearer pole; the points' coordinates inherit it
_TIE_BITS = 256
_MOST_STEPS = 8  # of Newton's iteration in one precision; the next precision goes on from there


class NearestStage(IntEnum):
    """How a clearance was decided; STAGES has the names."""

    DOUBLE_DOUBLE = 0
    """In double-double arithmetic, its error bound leaving no doubt."""
    PRECISE = 1
    """By exact enclosures, narrowed as far as needed."""
    EXACT = 2
    """By a closed form (the hard cases) or the exact test for tangency."""


STAGES = ("double-double", "precise", "exact")
"""The stages' names, in the order of their numbers."""


@dataclass(frozen=True, slots=True)
class Nearest:
    """The hyperboloid's nearest points to the spheroid's centre, in the metric in which the spheroid is a unit ball.

    `clearance` is the factor by which the spheroid, grown about its centre, first touches the hyperboloid, less 1:
    positive when apart, negative when overlapping, 0 exactly when tangent. It is the float64 nearest to the true value
    (to within 2⁻²⁵⁶ of it), inf beyond the largest, and ±5e-324 where a value other than 0 would round to 0.

    `points` are in the caller's coordinates, each coordinate within 1 ulp (inf beyond the largest float64): one point;
    two, above and below, for a centre in the waist plane beyond the evolute; with `circle`, for a centre on the axis,
    one point of a circle of them, the one with x > 0 and y = 0.

    `multiplier` is the dual variable at the optimum, t* of docs/mathematics.md, to 2⁻⁶⁴ of its distance to the nearer
    of −A and B, and rounded. It is above 0 where the centre is outside the hyperboloid and below 0 inside.

    `stage` is one of STAGES; for one pair never double-double.
    """

    position: Position
    clearance: float
    points: tuple[Point, ...]
    circle: bool
    multiplier: float
    stage: str


@dataclass(frozen=True, slots=True)
class Optimum:
    """Position, clearance and stage as in Nearest, and the λ = L/K of the dual's maximum (exact in the exact stage)."""

    position: Position
    clearance: float
    L: int
    K: int
    stage: NearestStage


@dataclass(frozen=True, slots=True)
class Enclosure:
    """low ≤ 2^bits · clearance ≤ high."""

    low: int
    high: int
    bits: int

    @property
    def rounded(self) -> float | None:
        """The one float64, never 0, to which the whole interval rounds; None if there are more or 0 is inside."""
        if self.low <= 0 <= self.high:
            return None
        unit = 1 << self.bits
        low, high = ratio(self.low, unit), ratio(self.high, unit)
        if low != high and (self.high - self.low) << _TIE_BITS > abs(self.low):
            return None
        if low != high:  # a tie: halves go to the even neighbour
            low = high if math.isinf(high) else float((Fraction(low) + Fraction(high)) / 2)
        return low or (math.ulp(0.0) if self.low > 0 else -math.ulp(0.0))


def nearest(pair: Pair) -> Nearest:
    """The position, the clearance and the nearest points of one pair."""
    squares = SquaredLengths.of(pair)
    optimum = optimise(squares)
    return Nearest(
        position=optimum.position,
        clearance=optimum.clearance,
        points=_points(pair, squares, optimum),
        circle=squares.R == 0,
        multiplier=ratio(optimum.L, optimum.K),
        stage=STAGES[optimum.stage],
    )


def optimise(squares: SquaredLengths) -> Optimum:
    """The clearance and the dual's maximum: in closed form where that is at an end of (−A, B), else by enclosures."""
    alpha, b, R, gamma, d, z = squares.alpha, squares.b, squares.R, squares.gamma, squares.d, squares.z
    W = alpha * d + gamma * b  # b² d² (A + B)
    if R == 0:
        clearance = _clearance_of_square(alpha * (W + z * b), b * W)
        return Optimum(_position(clearance, -1), clearance, -alpha, b, NearestStage.EXACT)
    if z == 0 and alpha * R * d * d >= W * W:
        clearance = _clearance_of_square(gamma * (R * d - W), d * W)
        return Optimum(_position(clearance, 1), clearance, gamma, d, NearestStage.EXACT)
    return _enclose(squares)


def ratio(numerator: int, denominator: int) -> float:
    """The quotient, denominator > 0, rounded to nearest; ±inf beyond the largest float64."""
    try:
        return numerator / denominator
    except OverflowError:
        return math.inf if numerator > 0 else -math.inf


def _enclose(squares: SquaredLengths) -> Optimum:
    """The clearance where the dual's maximum is inside (−A, B), in a precision that doubles until it suffices."""
    at_A, mantissa, exponent = start(squares)
    bits = _FIRST_BITS
    shift = max(0, bits - exponent - mantissa.bit_length())  # 1/K = 2^-shift: `bits` bits to the nearer pole
    pole = mantissa << (exponent + shift)
    L = pole - (squares.alpha << shift) // squares.b if at_A else (squares.gamma << shift) // squares.d - pole
    apart = False
    while True:
        at, doubt = _newton(squares, L, 1 << shift, bits)
        first, last = _bracket(squares, at, doubt)
        enclosure = _enclosure(first, last, 2 * bits)
        if enclosure.low <= 0 <= enclosure.high and not apart:
            touch = tangency(squares)
            if touch is not None:
                return Optimum(Position.CONTACT, 0.0, touch.L, touch.K, NearestStage.EXACT)
            apart = True
        if (last.L - first.L) << _POINT_BITS <= _pole(squares, at):
            clearance = enclosure.rounded
            if clearance is not None:
                # Above 0 it means D(first) > 1: by weak duality the sign of that λ is the side.
                return Optimum(_position(clearance, first.L), clearance, at.L, at.K, NearestStage.PRECISE)
        L, shift, bits = at.L << bits, shift + bits, 2 * bits


def _position(clearance: float, side: int) -> Position:
    """Contact unless the clearance is above 0; else exterior or interior, as `side` is above or below 0."""
    if clearance <= 0:
        return Position.CONTACT
    return Position.EXTERIOR if side > 0 else Position.INTERIOR


def _newton(squares: SquaredLengths, L: int, K: int, bits: int) -> tuple[Dual, int]:
    """The dual near its maximum by Newton's iteration from λ = L/K, and a guess at the error that is left, in 1/K.

    From a start good to half of `bits` one step does; each squares the error relative to the nearer pole's distance.
    """
    at = dual(squares, L, K)
    for _ in range(_MOST_STEPS):
        pole = _pole(squares, at)
        step = newton_step(squares, at)
        at = dual(squares, _within(squares, at.L + step, K), K)
        if abs(step) << (bits // 2 - 8) <= pole:
            break
    return at, 4 * step * step // pole + 4


def _bracket(squares: SquaredLengths, at: Dual, width: int) -> tuple[Dual, Dual]:
    """Duals on both sides of the maximum, which F's signs prove; `width` away from `at` if that suffices, else more."""
    while True:
        first = dual(squares, _within(squares, at.L - width, at.K), at.K)
        last = dual(squares, _within(squares, at.L + width, at.K), at.K)
        if first.slope >= 0 >= last.slope:
            return first, last
        width <<= 8


def _enclosure(first: Dual, last: Dual, bits: int) -> Enclosure:
    """The clearance from duals on both sides of the maximum, with the square roots rounded outward at 2^-bits."""
    product = first.T * first.Z
    upper = first.value * product + first.slope * (last.L - first.L)
    low = _root(first.value, first.K * product, bits)
    high = _root(upper, first.K * product * product, bits) + 1
    return Enclosure(low - (1 << bits), high - (1 << bits), bits)


def _clearance_of_square(numerator: int, denominator: int) -> float:
    """The clearance of an exactly known squared distance."""
    if numerator == denominator:
        return 0.0
    bits = _FIRST_BITS
    while True:
        root = _root(numerator, denominator, bits) - (1 << bits)
        clearance = Enclosure(root, root + 1, bits).rounded
        if clearance is not None:
            return clearance
        bits *= 2


def _root(numerator: int, denominator: int, bits: int) -> int:
    """The square root of the quotient (of 0, where that is negative), in units of 2^-bits, rounded down."""
    return math.isqrt(max(0, (numerator << 2 * bits) // denominator))


def _within(squares: SquaredLengths, L: int, K: int) -> int:
    """The integer nearest to L for which L/K is inside (−A, B)."""
    return min(max(L, -((K * squares.alpha - 1) // squares.b)), (K * squares.gamma - 1) // squares.d)


def _pole(squares: SquaredLengths, at: Dual) -> int:
    """The distance from λ to the nearer pole, −A or B, in units of 1/K, rounded down."""
    return min(at.T // squares.b, at.Z // squares.d)


def _points(pair: Pair, squares: SquaredLengths, optimum: Optimum) -> tuple[Point, ...]:
    """The nearest points: the centre's x and y times A/(A + λ), its z times B/(B − λ); see Nearest."""
    T = optimum.K * squares.alpha + optimum.L * squares.b
    Z = optimum.K * squares.gamma - optimum.L * squares.d
    if T == 0:
        W = squares.alpha * squares.d + squares.gamma * squares.b
        height = _scaled(pair.z, squares.gamma * squares.b, W)
        # On H, x² = α²(1 + z²/γ²) = α²(1 + γ² z0² b⁴/(b² d² W)²) with W = A + B times b² d².
        return ((_scaled_root(pair.alpha, W * W + squares.gamma * squares.z * squares.b**2, W * W), 0.0, height),)
    across = (_scaled(pair.x, optimum.K * squares.alpha, T), _scaled(pair.y, optimum.K * squares.alpha, T))
    if Z == 0:
        # On H, z² = γ²(ρ²/A − 1) with ρ² = A² P/(A + λ)².
        rise = optimum.K**2 * squares.alpha * squares.R - T * T
        height = _scaled_root(pair.gamma, rise, T * T)
        return ((*across, height), (*across, -height)) if rise else ((*across, 0.0),)
    return ((*across, _scaled(pair.z, optimum.K * squares.gamma, Z)),)


def _scaled(value: float, numerator: int, denominator: int) -> float:
    """value · numerator/denominator, rounded to nearest."""
    over, under = value.as_integer_ratio()
    return ratio(over * numerator, under * denominator)


def _scaled_root(value: float, numerator: int, denominator: int) -> float:
    """value · √(numerator/denominator), within 1 ulp."""
    over, under = value.as_integer_ratio()
    numerator, denominator = over * over * numerator, under * under * denominator
    bits = max(0, _FIRST_BITS + (denominator.bit_length() - numerator.bit_length()) // 2)
    return ratio(_root(numerator, denominator, bits), 1 << bits)
