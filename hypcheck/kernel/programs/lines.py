"""The programs of the first stage: half planes that prove a position of one scene, and the numbers they are made of.

In the plane of R = x² + y² and T = z² the exterior positions are the union over λ in (0, B) of the half planes

    R > b² (A+λ)(1 + 1/λ) + (b²/d²) (A+λ)/(B−λ) T,

the interior ones the union over μ in (0, A) of R < b² (A−μ)(1 − 1/μ) + (b²/d²) (A−μ)/(B+μ) T (docs/mathematics.md, "A
line is a proof"). So the positions that are *not* exterior form a convex set, an intersection of half planes, and so do
those that are not interior: a point under the chord of two positions that are not exterior is not exterior, one above
the chord of two that are not interior is not interior, and where both hold the bodies are in contact. *A chord is a
proof too*, and contact, which no single λ can show, costs two comparisons a side.

Margins (u = 2⁻⁵², which covers every rounding mode). R̂ carries 2 rounding factors, T̂ one, M T̂ two and K + M T̂ three,
all terms being positive; so a comparison of R̂ with K + M T̂ decides that of R with K + M T where K and M have been moved
to the safe side by MARGIN = 16u relatively: 16 > 2 + 3 with room for the constants' own roundings, counted below.
A product that underflows (or is flushed) changes a side by at most 2⁻¹⁰²¹ (1 + M); with K ≥ LEAST_CONSTANT = 2⁻³⁰⁰ and
M ≤ GREATEST_SLOPE = 2⁴⁰⁰ that is less than uK; the line R ≥ 0, K = M = 0, needs no margin. `reach` is the square of a
height ≥ 2⁻¹⁵⁰ less a margin, so that it bounds T and not T̂ alone.

Rows whose R + T is not below CAP = 2⁴⁰⁰ are for the next stage: nothing overflows, and no comparison with an infinity,
NaN, or the largest finite number that an overflow becomes when it is rounded down, passes for a proof. It suffices to
ask that of the sum of R + T over many rows, since no term is negative.
"""

from __future__ import annotations

from hypcheck.derivation.listing import program_of

U = 2.0**-52
MARGIN = 16 * U
CAP = 2.0**400
LEAST_CONSTANT = 2.0**-300
GREATEST_SLOPE = 2.0**400
LEAST_SIZE, GREATEST_SIZE = 2.0**-100, 2.0**100
"""Sizes of a scene outside these limits are left to the later stages."""

MORE, LESS = 1 + 2 * MARGIN, 1 - 2 * MARGIN
U_8 = 8 * U

SIDES = {"beyond": ">", "within": "<", "under": "<", "above": ">="}
"""R > K + M T proves exterior, R < K + M T interior; R < K + M T under a chord, with T ≤ `reach`, that the position is
not exterior, R ≥ K + M T above one that it is not interior."""

PLACES = (0, 1, 2)
"""Line 0 of a side serves a whole scene, or lines 1 and 2 serve its lower and its upper part."""

LINE_CONSTANTS = tuple(f"{part}_{side}_{place}" for side in SIDES for place in PLACES for part in "KM")

_PLANE = """
    xx = x * x
    yy = y * y
    R = xx + yy
    T = z * z
    R_plus_T = R + T
    in_reach = T <= reach
"""

_ANSWERS = """
    contact_in_reach = is_under and is_above
    contact = contact_in_reach and in_reach
    clear = exterior or interior
    decided = clear or contact
    not_exterior = is_under and in_reach
    exterior_decided = exterior or not_exterior
    not_interior = is_above and in_reach
    interior_decided = interior or not_interior
"""


def _line(side: str, place: int, name: str) -> str:
    return f"""
    rise_{side}_{place} = M_{side}_{place} * T
    line_{side}_{place} = K_{side}_{place} + rise_{side}_{place}
    {name} = R {SIDES[side]} line_{side}_{place}
"""


_NAMES = {"beyond": "exterior", "within": "interior", "under": "is_under", "above": "is_above"}
_JOINED = {"beyond": "or", "within": "or", "under": "and", "above": "and"}

ONE_LINE = program_of(
    "one-line",
    ("x", "y", "z", "reach", *LINE_CONSTANTS),
    _PLANE,
    *(_line(side, 0, _NAMES[side]) for side in SIDES),
    _ANSWERS,
)
"""From x, y, z and the scene's constants to `exterior`, `interior` and `decided`, and what settles one side alone
(`exterior_decided`, `interior_decided`), where R_plus_T < CAP."""

TWO_LINES = program_of(
    "two-lines",
    ("x", "y", "z", "reach", *LINE_CONSTANTS),
    _PLANE,
    *(_line(side, place, f"{_NAMES[side]}_{place}") for side in SIDES for place in (1, 2)),
    *(f"{_NAMES[side]} = {_NAMES[side]}_1 {_JOINED[side]} {_NAMES[side]}_2" for side in SIDES),
    _ANSWERS,
)
"""The same with two lines a side: more work a row, and fewer rows left."""

# The constants of a half plane from any λ in (0, B), or any μ in (1, A). `gap` is B − λ in units of 1/d², `across`
# A ± λ in units of 1/b². Where these are differences they may cancel: their error, at most 3u of their terms, is taken
# off. K and M then carry at most 8 factors; `more` = 1 + 2 MARGIN and `less` = 1 − 2 MARGIN leave MARGIN beyond that.
TANGENT_BEYOND = program_of(
    "tangent-beyond",
    ("alpha", "gamma", "b", "d", "lambda_", "u_8", "more"),
    """
    p = alpha * alpha
    q = b * b
    q_lambda = q * lambda_
    across = p + q_lambda               # b² (A + λ)
    one_plus_lambda = 1 + lambda_
    product = across * one_plus_lambda
    K = product / lambda_               # b² (A + λ)(1 + 1/λ)
    K_most = more * K
    s = gamma * gamma
    t = d * d
    t_lambda = t * lambda_
    gap = s - t_lambda                  # d² (B − λ)
    gap_terms = s + t_lambda
    gap_error = u_8 * gap_terms
    gap_least = gap - gap_error
    M = across / gap_least
    M_most = more * M
""",
)

TANGENT_WITHIN = program_of(
    "tangent-within",
    ("alpha", "gamma", "b", "d", "mu", "u_8", "less"),
    """
    p = alpha * alpha
    q = b * b
    q_mu = q * mu
    across = p - q_mu                   # b² (A − μ)
    across_terms = p + q_mu
    across_error = u_8 * across_terms
    across_least = across - across_error
    mu_minus_one = mu - 1
    product = across_least * mu_minus_one
    K = product / mu                    # b² (A − μ)(1 − 1/μ)
    K_least = less * K
    s = gamma * gamma
    t = d * d
    t_mu = t * mu
    along = s + t_mu                    # d² (B + μ)
    M = across_least / along
    M_least = less * M
""",
)

# Whether the line K + M T passes below, or above, the points (T_0, R_0) and (T_1, R_1), hence their chord, with MARGIN
# to spare: two factors on the left, one on the right.
CHORD = program_of(
    "chord",
    ("K", "M", "T_0", "R_0", "T_1", "R_1", "less", "more"),
    """
    rise_0 = M * T_0
    line_0 = K + rise_0
    rise_1 = M * T_1
    line_1 = K + rise_1
    lowered_0 = less * R_0
    lowered_1 = less * R_1
    raised_0 = more * R_0
    raised_1 = more * R_1
    below_0 = line_0 <= lowered_0
    below_1 = line_1 <= lowered_1
    above_0 = line_0 >= raised_0
    above_1 = line_1 >= raised_1
    below = below_0 and below_1
    above = above_0 and above_1
""",
)
