"""A first approximation to the dual's maximum: nothing depends on it but the time the exact enclosures take.

With p = a r, q = c |z|, W = A + B, τ = A + λ and σ = B − λ = W − τ, F(λ) = 0 reads τ √(1 + (q/σ)²) = p. The left side
is convex and increasing in τ, so Newton's iteration falls steadily onto the root from any start above it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import cast

import mpmath

from hypcheck.truth.nearest_dual import Squares

_WIDE = mpmath.MPContext()  # of our own, so that nobody's precision is changed; never written to after this
_WIDE.prec = 64  # and an exponent without limits

_FLOAT_RANGE = 120
"""Binary orders within which A, B, P, Q must lie for the iteration in float64: then nothing overflows in it."""
_MOST_STEPS = 100  # many more than it takes


def start(squares: Squares) -> tuple[bool, int, int]:
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


def _fits_float(squares: Squares) -> bool:
    """Whether A, B, P and Q, where not 0, are within the range of float64 with room to spare."""
    ratios = ((squares.alpha, squares.b), (squares.gamma, squares.d), (squares.R, squares.b), (squares.z, squares.d))
    return all(abs(n.bit_length() - d.bit_length()) < _FLOAT_RANGE for n, d in ratios if n)


def _iterate(
    squares: Squares, ratio: Callable[[int, int], float], sqrt: Callable[[float], float]
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
