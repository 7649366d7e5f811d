"""The programs of the numpy kernel's first stage: half planes of one slope a side, looked at in single precision.

In numpy a row costs what its passes over arrays cost, and float32 halves each. The two lines that bound a side, beyond
and under, or within and above (lines.py), get one slope M, so that they are two thresholds of the same number:

    R − M T > K proves exterior, R − M T < K not exterior; likewise on the inner side.

*Any M will do.* A line K' + M' T that proves something for all T in [0, `reach`] proves it beside K + M T too, where K
is the extreme of K' + (M' − M) T at the two ends. In return each chunk must be looked at once: T ≤ `reach` and R < CAP.

Rounding (u = 2⁻²³, which covers every rounding mode). With V = R − M T, V̂ is computed from x, y, z rounded to float32:
R̂ carries 4 factors, M T̂ also 4 and the difference one more, so

    |V̂ − V| ≤ 5u (1 + 5u) (R + M T) + tiny = 5u (1 + 5u) (V + 2 M T) + tiny,        tiny = 2⁻⁸⁰,

since a square that underflows, or is flushed to zero, is off by 2⁻¹²⁴ at most and M ≤ GREATEST_SLOPE = 2⁴⁰. A threshold
moved to the safe side by MARGIN (|K| + 2 M reach) + tiny, MARGIN = 16u, hence decides about the exact V; half of that
is for its own rounding to float32. T̂ ≤ LESS reach, LESS = 1 − MARGIN, says T ≤ `reach` of the exact T.

Range. With `reach` and the squares of the sizes in 2^±60, M ≤ 2⁴⁰ and R̂ < CAP = 2¹⁰⁰ nothing overflows; infinities,
NaN and the largest float32 are not below CAP. Scenes outside are left to the lines in float64.
"""

from __future__ import annotations

from hypcheck.derivation.listing import program_of

U = 2.0**-23
MARGIN = 16 * U
LESS = 1 - MARGIN
TINY = 2.0**-80
CAP = 2.0**100
LEAST_REACH, GREATEST_REACH = 2.0**-60, 2.0**60
GREATEST_SLOPE = 2.0**40

PLANE = program_of(
    "plane",
    ("x", "y", "z"),
    """
    xx = x * x
    yy = y * y
    R = xx + yy
    T = z * z
""",
)
"""From a centre to the place in the plane of R = x² + y² and T = z²."""

PARALLEL_LINES = program_of(
    "parallel-lines",
    ("R", "T", "M_outer", "K_beyond", "K_under", "M_inner", "K_within", "K_above"),
    """
    rise_outer = M_outer * T
    outer = R - rise_outer
    exterior = outer > K_beyond
    is_under = outer < K_under
    rise_inner = M_inner * T
    inner = R - rise_inner
    interior = inner < K_within
    is_above = inner >= K_above
    contact = is_under and is_above
    clear = exterior or interior
    decided = clear or contact
""",
)
"""From there to `exterior`, `interior` and `decided`, where T ≤ LESS reach and R < CAP."""
