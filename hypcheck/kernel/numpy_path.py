"""The fast path in numpy: the Hessian discriminant with a running error bound, and integers where it cannot tell.

u = 2⁻⁵³ throughout; every bound is multiplied by SLACK, which covers the rounding of the bound itself.

Coefficients. A = (α/b)² and B = (γ/d)² come with at most 3 rounding factors (1+δ), |δ| ≤ u, P = (x²+y²)/b² with 4, Q
with 3 (fewer where a scene's constants are rounded once from exact rationals). Counting the factors along the sums, in
the order in which they are evaluated below, gives 7 for c0 = −AB, 11 at most for a term of
c1 = (((c0 + A) − B) + B P) − A Q and 7 for a term of c2 = (((A − B) + 1) − P) − Q; the second-order part is below u:

    |ĉ0 − c0| ≤ e0 = 8u AB,   |ĉ1 − c1| ≤ e1 = 12u (AB + A + B + BP + AQ),   |ĉ2 − c2| ≤ e2 = 8u (A + B + 1 + P + Q).

Discriminant. With mᵢ = |ĉᵢ| + eᵢ, which bounds |cᵢ| too, and |x̂ŷ − xy| ≤ |x̂| e_y + |y| e_x:

    h1 = c2² − 3c1     E1 = 2 m2 e2 + 3 e1 + 4u (m2² + 3 m1)
    h2 = c2 c1 − 9c0   E2 = m2 e1 + m1 e2 + 9 e0 + 4u (m2 m1 + 9 m0)
    h3 = c1² − 3c2c0   E3 = 2 m1 e1 + 3 (m2 e0 + m0 e2) + 4u (m1² + 3 m2 m0)
    3Δ = 4 h1 h3 − h2²  with aᵢ = |ĥᵢ| + Eᵢ:  E = 4 (a1 E3 + a3 E1) + 2 a2 E2 + 4u (4 a1 a3 + a2²)

(at most three roundings an expression, so 4u). g'(B) = 3B² + 2c2 B + c1 and g'(−A) = 3A² − 2c2 A + c1, where the
regime asks for them: 2B e2 + e1 + 16u (3B² + 2 m2 B + m1), B carrying 3 factors and the sum 4.

Range. Sizes within 2^±200 and A, B within 2^±100 are asked for. A centre coordinate whose square underflows changes P
by at most 2^-1074/2^-400 and c1, c2 by less than TINY = 2^-500, which e1 and e2 contain; E then exceeds 9 a2 e0 ≥
2^-1000 > any underflow in Δ. Whatever overflows makes E infinite or NaN, and every test below is then false.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel import integers
from hypcheck.pairs import Pair
from hypcheck.rows import Positions, Rows

CHUNK = 8192
"""Rows at a time: the temporaries of one chunk stay in the cache (measured: 4k to 16k are alike)."""

UNDECIDED = 2
U = 2.0**-53
SLACK = 1 + 2.0**-20
TINY = 2.0**-500
SIZE_LIMITS = (2.0**-200, 2.0**200)
RATIO_LIMITS = (2.0**-100, 2.0**100)

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


def positions(rows: Rows, out: Positions | None = None) -> Positions:
    """The exact position of every valid row, int8 (n,); rows float64 (n, 7) as in rows.py."""
    result = np.empty(len(rows), dtype=np.int8) if out is None else out
    for start in range(0, len(rows), CHUNK):
        chunk = rows[start : start + CHUNK]
        alpha, gamma, b, d, x, y, z = chunk.T
        with np.errstate(all="ignore"):
            A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
            decided = _decide(A, B, P, Q, _in_range(chunk[:, :4].T, A, B))
        for index in np.flatnonzero(decided == UNDECIDED):
            decided[index] = _exact(chunk[index].tolist())
        result[start : start + CHUNK] = decided
    return result


def positions_of_scene(
    sizes: tuple[float, float, float, float], x: Floats, y: Floats, z: Floats, out: Positions | None = None
) -> Positions:
    """The exact position of every centre (x, y, z), float64 (n,) each, for one α, γ, b, d; int8 (n,)."""
    alpha, gamma, b, d = map(Fraction, sizes)
    result = np.empty(len(x), dtype=np.int8) if out is None else out
    A, B, per_b, per_d = (_nearest_float(value) for value in ((alpha / b) ** 2, (gamma / d) ** 2, 1 / b**2, 1 / d**2))
    usable = _in_range(np.array(sizes), A, B)
    for start in range(0, len(x), CHUNK):
        part = slice(start, start + CHUNK)
        u, v, w = x[part], y[part], z[part]
        with np.errstate(all="ignore"):
            decided = _decide(A, B, (u * u + v * v) * per_b, w * w * per_d, usable)
        for index in np.flatnonzero(decided == UNDECIDED):
            decided[index] = _exact((*sizes, float(u[index]), float(v[index]), float(w[index])))
        result[part] = decided
    return result


def _nearest_float(value: Fraction) -> np.float64:
    """`value` rounded once; inf where it is beyond float64, which _in_range then refuses."""
    try:
        return np.float64(float(value))
    except OverflowError:
        return np.float64(np.inf)


def _exact(row: tuple[float, ...] | list[float]) -> int:
    return int(integers.position(Pair.from_row(row).lengths))


def _in_range(sizes: Floats, A: Floats | np.float64, B: Floats | np.float64) -> Mask:
    """Whether the bounds hold for these sizes (4,) or (4, n) and ratios."""
    inside = (sizes > SIZE_LIMITS[0]).all(axis=0) & (sizes < SIZE_LIMITS[1]).all(axis=0)
    low, high = RATIO_LIMITS
    return np.asarray(inside & (A > low) & (A < high) & (B > low) & (B < high))


def _decide(A: Floats | np.float64, B: Floats | np.float64, P: Floats, Q: Floats, usable: Mask) -> Positions:
    """+1, 0, −1 where the bounds of the module's docstring prove it, else UNDECIDED."""
    c0 = -(A * B)
    BP, AQ = B * P, A * Q
    c1 = (((c0 + A) - B) + BP) - AQ
    c2 = (((A - B) + 1) - P) - Q
    e0 = (8 * U * SLACK) * -c0
    e1 = (12 * U * SLACK) * (BP + AQ + (A + B - c0)) + TINY
    e2 = (8 * U * SLACK) * (P + Q + (A + B + 1)) + TINY
    m0, m1, m2 = -c0 + e0, np.abs(c1) + e1, np.abs(c2) + e2

    h1, h2, h3 = c2 * c2 - 3 * c1, c2 * c1 - 9 * c0, c1 * c1 - 3 * c2 * c0
    E1 = 2 * m2 * e2 + 3 * e1 + 4 * U * (m2 * m2 + 3 * m1)
    E2 = m2 * e1 + m1 * e2 + 9 * e0 + 4 * U * (m2 * m1 + 9 * m0)
    E3 = 2 * m1 * e1 + 3 * (m2 * e0 + m0 * e2) + 4 * U * (m1 * m1 + 3 * m2 * m0)
    a1, a2, a3 = np.abs(h1) + E1, np.abs(h2) + E2, np.abs(h3) + E3
    delta = 4 * h1 * h3 - h2 * h2
    E = SLACK * (4 * (a1 * E3 + a3 * E1) + 2 * a2 * E2 + 4 * U * (4 * a1 * a3 + a2 * a2))

    three_roots = usable & (delta > E)
    positive_roots = three_roots & (c2 < -e2) & (c1 > e1)
    negative_roots = three_roots & ((c2 > e2) | (c1 < -e1))
    exterior = positive_roots & ((B * B > SLACK * A) | (c2 + 3 * B > e2 + 16 * U * B))
    interior = negative_roots & (SLACK < A)
    contact = usable & (delta < -E)

    result = np.full(P.shape, UNDECIDED, dtype=np.int8)
    result[contact] = 0
    result[exterior] = 1
    result[interior] = -1
    rest = (positive_roots & ~exterior) | (negative_roots & ~interior)
    if rest.any():  # outside the paper's regimes: where the pair of roots lies to −A and B has to be asked
        np.copyto(result, _outside_regimes(A, B, c1, c2, e1, e2, positive_roots), where=rest)
    return result


def _outside_regimes(
    A: Floats | np.float64, B: Floats | np.float64, c1: Floats, c2: Floats, e1: Floats, e2: Floats, positive: Mask
) -> Positions:
    """The position of a pair with three distinct roots, by the slopes of g at the poles."""
    pole, toward = np.where(positive, B, A), np.where(positive, 1.0, -1.0)
    slope = 3 * pole * pole + 2 * toward * c2 * pole + c1
    slope_error = SLACK * (2 * pole * e2 + e1 + 16 * U * (3 * pole * pole + 2 * np.abs(c2) * pole + np.abs(c1)))
    # The inflection −c2/3 against the pole. Both roots lie beyond the pole where the inflection and the slope say so.
    offset = toward * c2 + 3 * pole
    offset_error = SLACK * (e2 + 16 * U * pole)
    within = (offset > offset_error) & (slope > slope_error)
    within |= positive & ((offset > offset_error) | (slope < -slope_error))
    beyond = (offset < -offset_error) & (slope > slope_error)
    beyond |= ~positive & ((offset < -offset_error) | (slope < -slope_error))
    result = np.where(within, np.where(positive, 1, -1), np.where(beyond, 0, UNDECIDED))
    return result.astype(np.int8)
