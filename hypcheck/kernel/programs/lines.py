"""The programs of lines: half planes and half spaces that prove positions in one scene, also along sweeps.

α, γ are the sizes of the hyperboloid and b, d those of the spheroid; A = (α/b)² and B = (γ/d)². x, y, z is the
spheroid's centre, seen from the hyperboloid's. A line is named by K and M: it is R = K + M T, with R and T below. R̂ is
a number as it is computed, R the exact one.

**Half planes.** They are the first stage. In the plane of R = x² + y² and T = z² the exterior positions are the union
over λ in (0, B) of the half planes

    R > b² (A+λ)(1 + 1/λ) + (b²/d²) (A+λ)/(B−λ) T,

the interior ones the union over μ in (0, A) of R < b² (A−μ)(1 − 1/μ) + (b²/d²) (A−μ)/(B+μ) T (docs/mathematics.md, "A
line is a proof"). So the positions that are *not* exterior form a convex set, an intersection of half planes, and so do
those that are not interior: a point under the chord of two positions that are not exterior is not exterior, one above
the chord of two that are not interior is not interior, and where both hold the bodies are in contact. So *a chord is a
proof too*, and contact, which no single λ can show, costs two comparisons for each side.

Margins (u = 2⁻⁵², which covers every rounding mode). R̂ carries 2 rounding factors, T̂ one, M T̂ two and K + M T̂
three, all terms being positive; so a comparison of R̂ with K + M T̂ decides that of R with K + M T where K and M have
been moved to the safe side by MARGIN = 16u relatively: 16 > 2 + 3 with room for the constants' own roundings, counted
below. A product that underflows (or is flushed) changes a side by at most 2⁻¹⁰²¹ (1 + M); with K ≥ LEAST_CONSTANT =
2⁻³⁰⁰ and M ≤ GREATEST_SLOPE = 2⁴⁰⁰ that is less than uK; the line R ≥ 0, K = M = 0, needs no margin. `reach` is the
square of the greatest height, at least 2⁻¹⁵⁰, for which the chords hold, less a margin: so it bounds T and not only T̂.

Rows whose R + T is not below CAP = 2⁴⁰⁰ are for the next stage: nothing overflows, and no comparison with an infinity,
NaN, or the largest finite number that an overflow becomes when it is rounded down, passes for a proof. It suffices to
ask that of the sum of R + T over many rows, since no term is negative.

**Single precision.** PARALLEL_LINES is for numpy: a row there costs what its passes over arrays cost, and float32
halves each. The two lines that bound a side, beyond and under, or within and above, get one slope M, so that they are
two thresholds of the same number:

    R − M T > K proves exterior, R − M T < K not exterior; likewise on the inner side.

*Any M is right.* A line K' + M' T that proves something for all T in [0, `reach`] proves it beside K + M T too, where K
is the extreme of K' + (M' − M) T at the two ends. In return each chunk must first be tested: T ≤ `reach` and R < CAP.

Rounding (u = 2⁻²³, which covers every rounding mode). With V = R − M T, V̂ is computed from x, y, z rounded to float32:
R̂ carries 4 factors, M T̂ also 4 and the difference one more, so

    |V̂ − V| ≤ 5u (1 + 5u) (R + M T) + tiny = 5u (1 + 5u) (V + 2 M T) + tiny,        tiny = 2⁻⁸⁰,

since a square that underflows, or is flushed to zero, is off by 2⁻¹²⁴ at most and M ≤ FLOAT32_GREATEST_SLOPE = 2⁴⁰. A
threshold moved to the safe side by FLOAT32_MARGIN (|K| + 2 M reach) + tiny, FLOAT32_MARGIN = 16u, hence decides about
the exact V; half of that is for its own rounding to float32. T̂ ≤ FLOAT32_LESS reach, FLOAT32_LESS = 1 −
FLOAT32_MARGIN, says T ≤ `reach` of the exact T.

Range. With `reach` and the squares of the sizes in 2^±60, M ≤ 2⁴⁰ and R̂ < FLOAT32_CAP = 2¹⁰⁰ nothing overflows;
infinities, NaN and the largest float32 are not below it. Scenes outside are left to the lines in float64.

**Half spaces.** They are the first stage of a tilted spheroid, for one orientation. In the basis in which both
matrices are diagonal, with P1, P2 and Q the squares of the centre's components,

    exterior positions are the union over λ in (0, B) of   P1 + β P2 > κ + ν Q,
        β = (A1+λ)/(A2+λ),   κ = (A1+λ)(1 + 1/λ),   ν = (A1+λ)/(B−λ);

for interior ones the sign of the comparison is turned, and λ = −μ with μ in (0, min(A1, A2)). So those that are not
exterior form a convex set, as do those that are not interior. A plane under corners that are not exterior is a proof,
as a chord is: the part of 0 ≤ Q ≤ Q_most with P1 + a P2 ≤ K + M Q is the hull of its corners on the two P axes and of
what lies below them in P1 and P2, or above them in Q; likewise the other side.

The components are computed with an error. With |C| ≤ max(b, d) √N, N = P1 + P2 + Q, the rounded component is within
η √N of the exact one, η = max(b, d) Σ (4u |r| + e) over the row r of the basis, known within e; so each square is
within ζ N, ζ = 2η + η² + 2u, and a test with a, K, M decides what the plane with

    1 ± z, a ± z, K, M ∓ z,        z ≥ (1 + a + M) ζ,

says of the exact squares. core/parts/tilted_scene.h chooses a, K, M so that this is a plane that was proved. u = 2⁻⁵²
covers every rounding mode. The comparison's own roundings, 2 on the left and 2 on the right of positive terms, are in
MARGIN, and so is underflow, where K ≥ LEAST_CONSTANT and a, M ≤ GREATEST_SLOPE. |C|² summed over a block is below CAP;
with sizes in 2^±100 no product overflows then, and NaN is not below it.

**Sweeps.** The centre goes along (x, y, z) + s (u, v, w), 0 ≤ s ≤ 1, and R − M T − K is a quadratic in s there.
For a line that proves exterior positions (side 1, TANGENT_BEYOND) it must be positive, for one that proves interior
positions (side −1, TANGENT_WITHIN and TANGENT_HIGH) negative. PIECE computes three numbers with

    side (R − M T − K) ≥ here + 2 slope s + bend s²   for all s in [0, 1].

Rounding (u = 2⁻⁵², which covers every rounding mode). A term carries at most 4 factors: R two and one for the
difference, M T two, one for the sum with K and one for the difference. So each coefficient is off by 4u (1 + 4u) times
the sum of its terms' sizes at most. 8u SLACK of that sum, as computed, is taken off: it covers the 4 factors that the
sum carries as well, and the rounding of the last difference, u of the sum at most, with 2u to spare.

Underflow. What products lose that underflow or are flushed is at most 2⁻¹⁰²¹ (2 + M) for each coefficient, with M ≤
GREATEST_SLOPE = 2⁴⁰⁰ less than 2⁻⁶¹⁸ for all s in [0, 1]; `here` has 2u |K| ≥ 2⁻³⁵¹ to spare for that, by |K| ≥
LEAST_CONSTANT. Overflow is excluded: a caller first tests `size` < CAP, which does not hold for an infinity, NaN or the
largest finite number.

TANGENT_HIGH is TANGENT_WITHIN for μ < 1, where its K is negative: high up in a hyperboloid whose throat is narrow. K is
−b² (A − μ)(1 − μ)/μ; the error of A − μ is added there to make K smaller, and taken off M. It carries 7 factors.
"""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.derivation.program import Program, program_of

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
"""By name of a kind of line, the comparison of R with K + M T that it is about. `beyond` proves exterior and `within`
interior. With T ≤ `reach`, `under` (a chord) proves that the position is not exterior, `above` that it is not
interior."""

PLACES = (0, 1, 2)
"""The numbers of a side's lines: a whole scene has line 0, or lines 1 and 2 for its lower and its upper part."""

LINE_CONSTANTS = tuple(f"{part}_{side}_{place}" for side in SIDES for place in PLACES for part in "KM")

_PLANE = """
    xx = x * x
    yy = y * y
    R = xx + yy
    T = z * z
"""
"""The steps from a centre to its place in the plane of R = x² + y² and T = z²."""

_IN_REACH = f"""
    {_PLANE}
    R_plus_T = R + T
    in_reach = T <= reach
"""

_ANSWERS = """
    contact_in_reach = is_under and is_above
    contact = contact_in_reach and in_reach
    clear = exterior or interior
    decided = clear or contact
"""

_LINE_ANSWERS = f"""{_ANSWERS}
    not_exterior = is_under and in_reach
    exterior_decided = exterior or not_exterior
    not_interior = is_above and in_reach
    interior_decided = interior or not_interior
"""


def _line(side: str, place: int, holds: str) -> str:
    """Return the steps to `holds`: whether the centre is on the proved side of one line."""
    return f"""
    rise_{side}_{place} = M_{side}_{place} * T
    line_{side}_{place} = K_{side}_{place} + rise_{side}_{place}
    {holds} = R {SIDES[side]} line_{side}_{place}
"""


_HOLDS = {"beyond": "exterior", "within": "interior", "under": "is_under", "above": "is_above"}
"""The name of the truth value that the comparison with each kind of line gives."""

_JOINED = {"beyond": "or", "within": "or", "under": "and", "above": "and"}
"""How the truth values of two lines are joined: one line is enough to be clear, a chord needs both."""


def _one_and_two(
    names: tuple[str, str], inputs: tuple[str, ...], place: str, border: Callable[[str, int, str], str], answers: str
) -> tuple[Program, Program]:
    """Return the program that tests one border for each side, number 0, and the program that tests two, 1 and 2.

    `place` has the steps from a centre to its place, `border` returns those of the comparison with one border, and
    `answers` has those from the comparisons to the answer.
    """
    one = program_of(names[0], inputs, place, *(border(side, 0, holds) for side, holds in _HOLDS.items()), answers)
    two = program_of(
        names[1],
        inputs,
        place,
        *(border(side, number, f"{holds}_{number}") for side, holds in _HOLDS.items() for number in (1, 2)),
        *(f"{holds} = {holds}_1 {_JOINED[side]} {holds}_2" for side, holds in _HOLDS.items()),
        answers,
    )
    return one, two


ONE_LINE, TWO_LINES = _one_and_two(
    ("one-line", "two-lines"), ("x", "y", "z", "reach", *LINE_CONSTANTS), _IN_REACH, _line, _LINE_ANSWERS
)
"""The programs from x, y, z and the scene's constants to `exterior`, `interior` and `decided`, and to whether a
one-sided question is decided (`exterior_decided`, `interior_decided`), where R_plus_T < CAP. With two lines a row costs
more, and fewer rows are left."""

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

_ACROSS = """
    p = alpha * alpha
    q = b * b
    q_mu = q * mu
    across = p - q_mu                   # b² (A − μ)
    across_terms = p + q_mu
    across_error = u_8 * across_terms
    across_least = across - across_error
"""

_WITHIN_SLOPE = """
    s = gamma * gamma
    t = d * d
    t_mu = t * mu
    along = s + t_mu                    # d² (B + μ)
    M = across_least / along
    M_least = less * M
"""

TANGENT_WITHIN = program_of(
    "tangent-within",
    ("alpha", "gamma", "b", "d", "mu", "u_8", "less"),
    _ACROSS,
    """
    mu_minus_one = mu - 1
    product = across_least * mu_minus_one
    K = product / mu                    # b² (A − μ)(1 − 1/μ)
    K_least = less * K
""",
    _WITHIN_SLOPE,
)

TANGENT_HIGH = program_of(
    "tangent-high",
    ("alpha", "gamma", "b", "d", "mu", "u_8", "more", "less"),
    _ACROSS,
    """
    across_most = across + across_error
    one_minus_mu = 1 - mu
    product = across_most * one_minus_mu
    fall = product / mu                 # b² (A − μ)(1 − μ)/μ
    fall_most = more * fall
""",
    _WITHIN_SLOPE,
)
"""The program from sizes and μ in (0, 1) to K = −fall_most and M_least of a half plane R < K + M T that proves interior
positions, where across_least > 0."""

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

BASIS = ("r1_x", "r1_y", "r2_x", "r2_y", "r2_z", "r3_x", "r3_y", "r3_z")
PLANE_CONSTANTS = tuple(f"{part}_{side}_{place}" for side in SIDES for place in PLACES for part in "aKM")

SPACE_CONSTANTS = {
    "unit": U,
    "more_than": 1 + 2.0**-40,
    "lost": 2.0**-1000,
    "least_ratio": 2.0**-20,
    "greatest_ratio": 2.0**20,
    "greatest_zeta": 2.0**-10,
}

_COMPONENTS = """
    xx = x * x
    yy = y * y
    zz = z * z
    radius = xx + yy
    distance = radius + zz
    x1 = r1_x * x
    y1 = r1_y * y
    c1 = x1 + y1
    x2 = r2_x * x
    y2 = r2_y * y
    xy2 = x2 + y2
    z2 = r2_z * z
    c2 = xy2 + z2
    x3 = r3_x * x
    y3 = r3_y * y
    xy3 = x3 + y3
    z3 = r3_z * z
    c3 = xy3 + z3
    P1 = c1 * c1
    P2 = c2 * c2
    Q = c3 * c3
    in_reach = Q <= reach
"""
"""The steps from a centre to the squares P1, P2, Q of its components, and to whether Q is in reach."""


def _plane(side: str, place: int, holds: str) -> str:
    """Return the steps to `holds`: whether the centre is on the proved side of one plane."""
    return f"""
    part_{side}_{place} = a_{side}_{place} * P2
    place_{side}_{place} = P1 + part_{side}_{place}
    rise_{side}_{place} = M_{side}_{place} * Q
    line_{side}_{place} = K_{side}_{place} + rise_{side}_{place}
    {holds} = place_{side}_{place} {SIDES[side]} line_{side}_{place}
"""


ONE_PLANE, TWO_PLANES = _one_and_two(
    ("one-plane", "two-planes"), ("x", "y", "z", "reach", *BASIS, *PLANE_CONSTANTS), _COMPONENTS, _plane, _ANSWERS
)
"""The programs from x, y, z and the scene's constants to `exterior`, `interior`, `decided`, where `distance` < CAP."""

PIECE = program_of(
    "piece",
    ("x", "y", "z", "u", "v", "w", "K", "M", "side", "u_8"),
    _PLANE,
    """
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
"""The program from a centre, its change, a line and its side to `here`, `slope`, `bend`, valid where `size` < CAP."""


FLOAT32_U = 2.0**-23
FLOAT32_MARGIN = 16 * FLOAT32_U
FLOAT32_LESS = 1 - FLOAT32_MARGIN
FLOAT32_TINY = 2.0**-80
FLOAT32_CAP = 2.0**100
LEAST_REACH, GREATEST_REACH = 2.0**-60, 2.0**60
FLOAT32_GREATEST_SLOPE = 2.0**40

PLANE = program_of("plane", ("x", "y", "z"), _PLANE)
"""The program from a centre to R and T."""

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
"""The program from R and T to `exterior`, `interior`, `decided`, where T ≤ FLOAT32_LESS reach and R < FLOAT32_CAP."""
