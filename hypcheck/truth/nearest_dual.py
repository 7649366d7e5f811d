"""The dual function of the nearest-point problem in integers, and a first approximation to its maximum.

With T = K α² + b² L and Z = K γ² − d² L, λ = L/K lies in (−A, B) if T, Z > 0, and the dual function D and its
derivative F (docs/mathematics.md, "Nearest point and clearance") are quotients of integers over T Z: nothing is
rounded. D is concave and its supremum over (−A, B) is the squared distance from the spheroid's centre to the
hyperboloid, in spheroid radii.

`start` approximates the maximum in floats; only the time of the exact enclosures depends on it. With p = a r,
q = c |z|, W = A + B, τ = A + λ and σ = B − λ = W − τ, F(λ) = 0 reads τ √(1 + (q/σ)²) = p. The left side is convex and
increasing in τ, so Newton's iteration falls steadily onto the root from any start above it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

import mpmath

from hypcheck.geometry.pair import Pair


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


_WIDE = mpmath.MPContext()  # our own context, so that mpmath's precision stays what it is; not changed after this
_WIDE.prec = 64  # and an exponent without limits

_FLOAT_RANGE = 120
"""Binary orders within which A, B, P, Q must lie for the iteration in float64: then nothing overflows in it."""
_MOST_STEPS = 100  # many more than it takes


def start(squares: SquaredLengths) -> tuple[bool, int, int]:
    """Whether −A is the pole nearer to the maximum (else B), and its distance as mantissa and binary exponent.

    The maximum must be inside (−A, B): r > 0, and z ≠ 0 or a r < A + B. The relative error is about 2⁻⁵⁰.
    """
    if _fits_float(squares):
        tau, sigma = _iterate(squares, lambda n, d: n / d, math.sqrt)
        fraction, exponent = math.frexp(min(tau, sigma))
    else:
        tau, sigma = _iterate(squares, lambda n, d: _wide(n) / _wide(d), _WIDE.sqrt)
        fraction, exponent = _WIDE.frexp(min(tau, sigma))
    return tau <= sigma, int(fraction * 2**64), exponent - 64


def _wide(number: int) -> float:
    """The number, to 80 bits before it is rounded: mpmath takes off the zeros that a long one ends in 8 at a time."""
    excess = max(0, number.bit_length() - 80)
    return cast("float", _WIDE.ldexp(number >> excess, excess))


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
    for _ in range(_MOST_STEPS):
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
