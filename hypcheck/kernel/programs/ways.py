"""The programs of straight ways: what one half plane proves about a piece of a way, with a bound of its error.

The centre goes along (x, y, z) + s (u, v, w), 0 ≤ s ≤ 1, and R − M T − K is a quadratic in s there, R = x² + y² and
T = z². Beside a line that proves exterior positions (side 1, lines.TANGENT_BEYOND) it is to be positive, beside one
that proves interior positions (side −1, lines.TANGENT_WITHIN and TANGENT_HIGH) negative. PIECE gives three numbers with

    side (R − M T − K) ≥ here + 2 slope s + bend s²   for all s in [0, 1].

Rounding (u = 2⁻⁵², which covers every rounding mode). A term carries at most 4 factors: R two and one for the
difference, M T two, one for the sum with K and one for the difference. So each coefficient is off by 4u (1 + 4u) times
the sum of its terms' sizes at most. 8u SLACK of that sum, as computed, is taken off: it covers the 4 factors that the
sum carries as well, and the rounding of the last difference, u of the sum at most, with 2u to spare.

Underflow. What products lose that underflow or are flushed is at most 2⁻¹⁰²¹ (2 + M) for each coefficient, with M ≤
GREATEST_SLOPE = 2⁴⁰⁰ less than 2⁻⁶¹⁸ for all s in [0, 1]; `here` has 2u |K| ≥ 2⁻³⁵¹ to spare for that, by |K| ≥
LEAST_CONSTANT. Overflow is excluded: who uses the result asks for `size` < CAP first, which no infinity is, nor NaN,
nor the largest finite number.

TANGENT_HIGH is TANGENT_WITHIN for μ < 1, where its K is negative: high up in a hyperboloid whose throat is narrow. K is
−b² (A − μ)(1 − μ)/μ; the error of A − μ is added there to make K smaller, and taken off M. It carries 7 factors.
"""

from __future__ import annotations

from hypcheck.derivation.program import program_of

PIECE = program_of(
    "piece",
    ("x", "y", "z", "u", "v", "w", "K", "M", "side", "u_8"),
    """
    xx = x * x
    yy = y * y
    R = xx + yy
    T = z * z
    rise = M * T
    line = K + rise
    gap = R - line
    size_K = abs K
    size_line = size_K + rise
    size_here = R + size_line
    error_here = u_8 * size_here
    side_gap = side * gap
    here = side_gap - error_here
    xu = x * u
    yv = y * v
    R_slope = xu + yv
    zw = z * w
    rise_slope = M * zw
    gap_slope = R_slope - rise_slope
    size_xu = abs xu
    size_yv = abs yv
    size_R_slope = size_xu + size_yv
    size_rise_slope = abs rise_slope
    size_slope = size_R_slope + size_rise_slope
    error_slope = u_8 * size_slope
    side_gap_slope = side * gap_slope
    slope = side_gap_slope - error_slope
    uu = u * u
    vv = v * v
    R_bend = uu + vv
    ww = w * w
    rise_bend = M * ww
    gap_bend = R_bend - rise_bend
    size_bend = R_bend + rise_bend
    error_bend = u_8 * size_bend
    side_gap_bend = side * gap_bend
    bend = side_gap_bend - error_bend
    size_ends = size_here + size_bend
    size = size_ends + size_slope
""",
)
"""From a centre, its change, a line and its side to `here`, `slope` and `bend`, valid where `size` < CAP."""

TANGENT_HIGH = program_of(
    "tangent-high",
    ("alpha", "gamma", "b", "d", "mu", "u_8", "more", "less"),
    """
    p = alpha * alpha
    q = b * b
    q_mu = q * mu
    across = p - q_mu                   # b² (A − μ)
    across_terms = p + q_mu
    across_error = u_8 * across_terms
    across_least = across - across_error
    across_most = across + across_error
    one_minus_mu = 1 - mu
    product = across_most * one_minus_mu
    fall = product / mu                 # b² (A − μ)(1 − μ)/μ
    fall_most = more * fall
    s = gamma * gamma
    t = d * d
    t_mu = t * mu
    along = s + t_mu                    # d² (B + μ)
    M = across_least / along
    M_least = less * M
""",
)
"""From sizes and μ in (0, 1) to K = −fall_most and M_least of a half plane R < K + M T that proves interior positions,
where across_least > 0."""
