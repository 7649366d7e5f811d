"""The nearest-point oracle for many rows: in double-double arithmetic if this can decide, else exactly.

In space scaled so that the spheroid is a unit ball, the pair is clear, on the side of the centre, if the distance from
the centre to the hyperboloid is over 1; else it is in contact (docs/mathematics.md, "Nearest point and clearance"). The
distance comes from its Lagrange dual, which has no duality gap: every value of the dual is a lower bound, so no answer
rests on an iteration having converged. Nothing is shared with the other oracles.

Upright rows are decided here, other rows in nearest_tilted.py, with an error bound that shows which answers are
certain. Exact enclosures decide the rest, pair by pair (nearest.py). All round the clearance to the same float64.

**Upright.** The dual function: on (−A, B)

    D(λ) = S(λ) + λ F(λ),   S = λ² (P/(A+λ)² + Q/(B−λ)²),   F = A P/(A+λ)² − B Q/(B−λ)² − 1 = D′(λ)

is concave, its supremum is the squared distance from the spheroid's centre to the hyperboloid, and the clearance is its
square root less 1. A λ is found in float64 and then taken as exact: any λ gives D(λ) ≤ distance², and the difference is
F²/(2|F′|), up to a known factor, because F′ changes little over distances much smaller than the distance to a pole. The
unknown is u, the distance from λ to the nearer pole; with C = A or B, λ = ±(u − C), and A + B − u ≥ u is the other one.

Rounding (η = double_double.ERROR bounds an operation; relative errors unless said otherwise):
    A, B, Q 3η, P and W = A + B 4η; W − u, at least W/2, 13η; |λ| = |u − C| within 4η(u + C), absolutely;
    P/(A+λ)² and Q/(B−λ)²: near 5η, far 33η, their sum 34η; S within 8η|λ|(u + C)(near + far) + 36ηS, with the larger of
    the true and the computed |λ|;
    F within 40ηT where T sums the magnitudes of its three terms; λF within 41η|λ|T + 4η(u + C)|F|; their sum one more.
So D is within 64η(|λ|(u + C)(near + far) + |λ|T + (u + C)|F|), where 64 for 45 covers higher orders and the rounding of
this float64 expression itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Pair
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows, require_valid, upright_mask
from hypcheck.truth import double_double, nearest_tilted
from hypcheck.truth.double_double import DoubleDouble
from hypcheck.truth.nearest import NearestStage, nearest
from hypcheck.truth.nearest_tilted import Decided

_CHUNK = 4096
"""Rows whose intermediate arrays fit in a core's second-level cache."""


@dataclass(frozen=True, slots=True)
class NearestBatch:
    """For n rows: clearances as in NearestPoint (n,), positions (n,), and the NearestStage of each, uint8 (n,)."""

    clearance: Floats
    position: Positions
    stage: NDArray[np.uint8]

    @property
    def tangent(self) -> Mask:
        """A mask (n,) of the tangent pairs."""
        return np.asarray(self.clearance == 0.0)


def positions(rows: Rows) -> NearestBatch:
    """Return the positions and tangencies of rows (n, 7) or (n, 10). Raises InputError about the first invalid row.

    Clearances are only right within a factor, and 0 if tangent.
    """
    return _run(rows, clearances_wanted=False)


def clearances(rows: Rows) -> NearestBatch:
    """Return the clearances and positions of rows (n, 7) or (n, 10). Raises InputError about the first invalid row."""
    return _run(rows, clearances_wanted=True)


def _run(rows: Rows, *, clearances_wanted: bool) -> NearestBatch:
    """Decide rows in double-double arithmetic, chunk by chunk, and exactly where that leaves a doubt."""
    require_valid(rows)
    count = len(rows)
    batch = NearestBatch(
        np.empty(count), np.empty(count, np.int8), np.full(count, NearestStage.DOUBLE_DOUBLE, np.uint8)
    )
    upright = upright_mask(rows)
    for places, decide, width in (
        (np.flatnonzero(upright), decide_upright, len(COLUMNS)),
        (np.flatnonzero(~upright), nearest_tilted.decide, rows.shape[1]),
    ):
        for begin in range(0, len(places), _CHUNK):
            chunk = places[begin : begin + _CHUNK]
            decided = decide(rows[chunk, :width])
            batch.clearance[chunk], batch.position[chunk] = decided.clearance, decided.position
            certain = decided.clearance_certain if clearances_wanted else decided.position_certain
            for index in chunk[~certain].tolist():
                result = nearest(Pair.from_row(rows[index].tolist()))
                batch.clearance[index], batch.position[index] = result.clearance, result.position
                batch.stage[index] = result.stage
    return batch


_BOUND = 64.0 * double_double.ERROR
_FLOOR = 2.0**-400
"""Covers what underflows: within the limits below no rounding error of an underflow reaches D with more than 2⁻⁹⁰⁰."""
_NUMBER_RANGE = (2.0**-900, 2.0**900)
_RATIO_RANGE = (2.0**-120, 2.0**120)
_MOST_STEPS = 40


@dataclass(frozen=True, slots=True)
class ScaledArrays:
    """The problem with a unit sphere: A, B, P, Q as in docs/mathematics.md, each (n,) in double-double.

    `inside` marks the rows within the limits for which the error bounds hold: every number 0 or in 2^±900, each of A,
    B, P, Q in 2^±120, save P, Q = 0 from a centre on the axis or in the waist plane. There the distances to the poles
    lie in 2^-361 … 2^121 and every product in 2^±970, away from overflow.
    """

    A: DoubleDouble
    B: DoubleDouble
    P: DoubleDouble
    Q: DoubleDouble
    inside: Mask


@dataclass(frozen=True, slots=True)
class DualArrays:
    """Values of the dual function D at a λ, (n,) each.

    `value` is D, with the error bound `error`; `gap` is how far the supremum of D is above it, with the error bound
    `gap_error`, which is inf if it is only known that the supremum is not below D. `side` is the sign of λ, 0 if it is
    uncertain.
    """

    value: DoubleDouble
    error: Floats
    gap: Floats
    gap_error: Floats
    side: Floats


def decide_upright(rows: Rows) -> Decided:
    """Decide clearance and position of valid rows (n, 7) in double-double where it can; n ~ 4096 is fastest."""
    with np.errstate(all="ignore"):
        scaled = _scale(rows)
        return _judge(scaled.inside, _evaluate(scaled, *_solve(scaled)))


def _scale(rows: Rows) -> ScaledArrays:
    """Compute A, B, P and Q of the rows."""
    columns = np.ascontiguousarray(rows.T)
    alpha, gamma, b, d, x, y, z = columns
    A, B, Q = (
        double_double.square(double_double.quotient_of_floats(*pair)) for pair in ((alpha, b), (gamma, d), (z, d))
    )
    P = double_double.add(
        double_double.square(double_double.quotient_of_floats(x, b)),
        double_double.square(double_double.quotient_of_floats(y, b)),
    )
    magnitude = np.abs(columns)
    smallest = np.where(magnitude > 0.0, magnitude, 1.0).min(axis=0)
    inside = (smallest >= _NUMBER_RANGE[0]) & (magnitude.max(axis=0) <= _NUMBER_RANGE[1])
    for ratio, zero in ((A, False), (B, False), (P, (x == 0.0) & (y == 0.0)), (Q, z == 0.0)):
        inside &= (ratio[0] >= _RATIO_RANGE[0]) & (ratio[0] <= _RATIO_RANGE[1]) | zero
    return ScaledArrays(A, B, P, Q, inside)


def _solve(scaled: ScaledArrays) -> tuple[Floats, Floats]:
    """Find A + λ and B − λ in float64, the smaller one to nearly full relative precision, at the λ where F vanishes.

    With p = a r, q = c z, W = A + B, τ = A + λ and σ = B − λ = W − τ: F = 0 is τ √(1 + (q/σ)²) = p, and its left side
    is convex and increasing in τ, so Newton's iteration falls steadily onto the root from any start above it. Where the
    supremum is at an end of (−A, B) the distance to that end is 0 (centre on the axis, or in the waist plane beyond
    the evolute: the two hard cases).
    """
    A, B, P, Q = scaled.A[0], scaled.B[0], scaled.P[0], scaled.Q[0]
    p, q, W = np.sqrt(A * P), np.sqrt(B * Q), A + B
    hard = (P == 0.0) | ((Q == 0.0) & (p >= W))
    tau, sigma = _start(p, q, W)
    active = np.flatnonzero(scaled.inside & ~hard)
    for _ in range(_MOST_STEPS):
        if not len(active):
            break
        whole = len(active) == len(tau)
        here = slice(None) if whole else active
        near, far, height = tau[here], sigma[here], q[here]
        slope = height / far
        slope *= slope
        root = np.sqrt(1.0 + slope)
        step = (p[here] - near * root) / (root + slope * (near / far) / root)
        near = near + step
        far = far - step
        tau[here], sigma[here] = near, far
        # Newton's error is squared from step to step: after a relative 2⁻²⁶ it is at the rounding level.
        active = active[np.abs(step) > 2.0**-26 * np.minimum(near, far)]
    tau = np.where(hard, np.where(P == 0.0, 0.0, W), tau)
    sigma = np.where(hard, np.where(P == 0.0, W, 0.0), sigma)
    return tau, sigma


def _start(p: Floats, q: Floats, W: Floats) -> tuple[Floats, Floats]:
    """Find τ and σ with τ at or above the root, each within a modest factor.

    τ < p and τ/p < σ/q bound τ; the second is p/τ > q/σ. That τ is also less than twice the root. If it is over W/2 the
    root is over W/4, and q²/σ² = (p − τ)(p + τ)/τ² ≤ (g + σ)·32p/W² with g = max(p − W, 0) bounds σ from below.
    """
    cone = p + q
    tau = np.minimum(p, p * (W / cone))
    sigma = np.maximum(W - p, W * (q / cone))
    excess = 2.0 * np.maximum(p - W, 0.0)
    flat = (q * W) ** 2 / (32.0 * p)
    bound = np.minimum(np.cbrt(0.5 * flat), np.sqrt(flat / excess))
    raised = (2.0 * tau > W) & (bound > sigma)
    sigma = np.where(raised, bound, sigma)
    return np.where(raised, W - sigma, tau), sigma


def _evaluate(scaled: ScaledArrays, tau: Floats, sigma: Floats) -> DualArrays:
    """Compute the dual at the λ that is u = min(τ, σ) from its pole; λ = one·size, `one` being 1 near −A, else −1."""
    near_minus_A = tau <= sigma
    one = np.where(near_minus_A, 1.0, -1.0)
    near_square, far_square = _swapped(near_minus_A, scaled.P, scaled.Q)
    near_size, far_size = _swapped(near_minus_A, scaled.A, scaled.B)
    W = double_double.add(scaled.A, scaled.B)

    u = np.minimum(np.minimum(tau, sigma), 0.5 * W[0])
    ended = u == 0.0
    divisor = np.where(ended, 1.0, u)  # at the end of the interval the numerator is 0
    other = double_double.add_float(W, -u)
    size = double_double.add_float((-near_size[0], -near_size[1]), u)
    near = double_double.divide(near_square, double_double.two_square(divisor))
    far = double_double.divide(far_square, double_double.square(other))
    near_term = double_double.multiply(near_size, near)
    far_term = double_double.multiply(far_size, far)
    F = double_double.add_float(
        double_double.subtract(near_term, far_term), -one
    )  # one·F: near B the two terms change places
    S = double_double.multiply(double_double.square(size), double_double.add(near, far))
    value = double_double.add(S, double_double.multiply(size, F))

    length = u + near_size[0]
    size_error = 4.0 * double_double.ERROR * length
    largest = np.abs(size[0]) + size_error
    terms = near_term[0] + far_term[0] + 1.0
    slope, slope_error = np.abs(F[0]), _BOUND * terms
    error = _BOUND * (largest * (length * (near[0] + far[0]) + terms) + length * slope) + _FLOOR
    error = np.where(u >= 0.0, error, np.inf)  # beyond its poles the dual is no bound at all

    curvature = 2.0 * (near_term[0] / divisor + far_term[0] / other[0])
    gap, gap_error = _gap(slope, slope_error, curvature, np.minimum(u, other[0]))
    # At an end of the interval D is the supremum if its slope pushes outward: at −A always, at B where F > 0.
    supreme = (near_square[0] == 0.0) & (near_minus_A | (-F[0] > slope_error))
    gap = np.where(ended, 0.0, gap)
    gap_error = np.where(ended, np.where(supreme, 0.0, np.inf), gap_error)
    side = np.where(np.abs(size[0]) > 2.0 * size_error, np.where(size[0] < 0.0, -one, one), 0.0)
    return DualArrays(value, error, gap, gap_error, side)


def _swapped(straight: Mask, first: DoubleDouble, second: DoubleDouble) -> tuple[DoubleDouble, DoubleDouble]:
    """Return the two numbers, exchanged where `straight` is false."""
    return double_double.where(straight, first, second), double_double.where(straight, second, first)


def _judge(inside: Mask, dual: DualArrays) -> Decided:
    """Return the clearance and position by the dual, and masks of those that the error bounds make certain.

    A row is called clear only by its own λ with D(λ) > 1, on the side of the sign of λ.
    """
    squared = double_double.add_float(dual.value, dual.gap)
    (high, low), error = _clearance(squared, dual.error + dual.gap_error)
    clear = inside & ((dual.value[0] - 1.0) + dual.value[1] > 1.001 * dual.error) & (dual.side != 0.0)
    contact = inside & (high < -1.001 * error)
    position = np.where(clear, dual.side, 0.0).astype(np.int8)
    certain = clear | contact
    return Decided(high, certain & double_double.rounds_to_high((high, low), error), position, certain)


def _gap(slope: Floats, slope_error: Floats, curvature: Floats, pole: Floats) -> tuple[Floats, Floats]:
    """Estimate distance² − D(λ) from |F|, its error, and |F′| at λ; return the estimate and a bound of its error.

    `pole` is the distance from λ to the nearer pole.

    Within a distance k·pole of λ, |F′| lies between (1 + k)⁻³ and (1 − k)⁻³ times its value at λ, as both its terms are
    inverse cubes of the distances to the poles. So with κ = |F|/(|F′|·pole) ≤ 1/8 the root lies within 2κ·pole, since
    (1 + 2κ)³ ≤ 2, and the gap F²/(2|F′|) is known to a factor (1 ± 2κ)^±3, a relative 8κ. Else nothing is claimed.
    """
    largest = slope + slope_error
    kappa = 1.001 * largest / (curvature * pole)
    estimate = slope * slope / (2.0 * curvature)
    error = (4.001 * kappa + 2.0**-46) * (largest * largest / curvature) + 1.001 * largest * slope_error / curvature
    return estimate, np.where(kappa <= 0.125, error, np.inf)


def _clearance(squared: DoubleDouble, error: Floats) -> tuple[DoubleDouble, Floats]:
    """Return √squared − 1 and a bound of its error, for a squared distance known within `error`.

    |√s − √t| is at most |s − t|/√s, and at most √|s − t|, which is what serves near a distance of 0. The sum of D and
    the gap is rounded by η s, which leaves (η/2)√s after the root; the root is rounded by η√s, and the subtraction by
    η(1 + √s). 4η(1 + √s) covers all three. Where the sum is below 0, so is the exact one, and t is at most `error`.
    """
    below = squared[0] < 0.0
    root = double_double.square_root((np.where(below, 0.0, squared[0]), np.where(below, 0.0, squared[1])))
    bound = error / np.maximum(root[0], np.sqrt(error)) + 4.0 * double_double.ERROR * (1.0 + root[0])
    return double_double.add_float(root, -1.0), bound
