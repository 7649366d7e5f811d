"""The programs of the second stage: a position where an error bound proves it, for rows of any sizes and for one pair.

CERTIFIED has a running error bound. u = 2⁻⁵² here: twice the unit roundoff, so that every bound holds in each rounding
mode and not only in "to nearest".

Notation. A = (α/b)², B = (γ/d)², P = (x² + y²)/b², Q = z²/d². c0, c1, c2 are the coefficients of the cubic g, and Δ is
its discriminant. ĉ is a computed number, c the exact one.

Coefficients. derivation/rounding.py counts the rounding factors (tests/kernel/test_programs.py checks them): at most 7
in c0 = −AB, 11 in a term of c1, 7 in a term of c2. With one unit more for the second order,

    |ĉ0 − c0| ≤ e0 = 8u AB,   |ĉ1 − c1| ≤ e1 = 12u (AB + A + B + BP + AQ),   |ĉ2 − c2| ≤ e2 = 8u (A + B + 1 + P + Q).

Discriminant. With mᵢ = |ĉᵢ| + eᵢ, which bounds |cᵢ| too, and |x̂ŷ − xy| ≤ |x̂| e_y + |y| e_x:

    h1 = c2² − 3c1     E1 = 2 m2 e2 + 3 e1 + 4u (m2² + 3 m1)
    h2 = c2 c1 − 9c0   E2 = m2 e1 + m1 e2 + 9 e0 + 4u (m2 m1 + 9 m0)
    h3 = c1² − 3c2c0   E3 = 2 m1 e1 + 3 (m2 e0 + m0 e2) + 4u (m1² + 3 m2 m0)
    3Δ = 4 h1 h3 − h2²  with aᵢ = |ĥᵢ| + Eᵢ:  E = 4 (a1 E3 + a3 E1) + 2 a2 E2 + 4u (4 a1 a3 + a2²)

(at most three roundings an expression, so 4u). The program factors these sums so that they need fewer products.

Slopes, by the same count (10 factors in a term at most): g'(B) = (3B + 2c2) B + c1 within 2B e2 + e1 +
16u (3B² + 2 m2 B + m1), likewise g'(−A); 3B + c2 and 3A − c2 within e2 + 16u (B + m2) and e2 + 16u (A + m2).

The bounds are rounded themselves, by less than 2⁻⁴⁰ of their value: they are sums and products of positive numbers, of
fewer than 100 factors (1 ± u) each. SLACK = 1 + 2⁻²⁰ covers that.

Range. The program tests that b, d, A and B are in 2^±100, and that P + Q < FARTHEST = 2²⁰⁰. So α and γ lie in 2^±151,
and no size, A, B or AB over- or underflows. Nothing that follows from P and Q overflows: with M2 = A + B + 1 + P + Q <
2²⁰¹ and M1 = AB + A + B + BP + AQ < 2³⁰¹, the values and their bounds are m2 < 2²⁰², m1 < 2³⁰², m0 < 2²⁰¹, a1 < 2⁴⁰⁷,
a2 < 2⁵⁰⁷ and a3 < 2⁶⁰⁷, so 4 a1 a3 + a2² < 2¹⁰¹⁷, and the slopes stay below 2³⁰⁴.

P + Q must be tested: what overflows is infinite or NaN in round to nearest, and every comparison that decides is
false; but rounded down or towards zero it is the largest finite number, and a difference of two such numbers means
nothing. The test itself is safe in every mode: x² + y² overflows to 2¹⁰²³ at least, hence P ≥ 2⁸²² as b² < 2²⁰⁰,
and Q likewise; infinity and NaN are not below FARTHEST.

Underflow. A centre coordinate whose square underflows (or is flushed to zero) changes P and Q by 2^-1021/2^-200 at most
and c1, c2 by less than 2⁻⁷⁰⁰. e1 ≥ 12u AB > 2⁻²⁴⁹ and e2 ≥ 8u contain that many times over in the unit that they have
to spare. E1 ≥ 3 e1, E2 ≥ 9 e0 > 2⁻²⁴⁹ and E3 ≥ 3 m0 e2 > 2⁻²⁴⁹ exceed every underflow in h1, h2, h3 (2⁻¹⁰²¹ times a
small factor), hence E, which contains a1 E3, a3 E1 and a2 E2, what these do to Δ.

SINGLE is for one pair in plain Python, where each operation costs as much as a comparison or a call. It is CERTIFIED
with a cheaper bound, the one that derivation/rounding.py counts: a computed value is off by at most γ_k M, M being the
sum of its terms' sizes, without any of their cancellation. k is 7 for c2, 11 for c1 and 42 for 3Δ
(tests/kernel/test_programs.py checks them); the constants below leave a unit or more for the second order, for the
rounding of M and for squares that underflow. For 3Δ, M = 4 H1 H3 + H2² with H1 = M2² + 3 M1, H2 = M2 M1 + 9 AB and H3 =
M1² + 3 M2 AB is at most 32 (M2 M1)²: multiplied out, the difference has no negative term. Rows that it leaves
undecided, or with sizes outside c² > a > 1 (a = α/b, c = γ/d), go to the integers. Its range is that of CERTIFIED, for
the same reason: M2 < 2²⁰¹ and M1 < 2³⁰¹, so (M2 M1)² < 2¹⁰⁰⁴, and 3Δ, at most 32 times that, does not overflow either.
"""

from __future__ import annotations

from hypcheck.derivation.listings import HESSIAN_DISCRIMINANT, TABLE_2
from hypcheck.derivation.program import program_of
from hypcheck.geometry.pair import COLUMNS

U = 2.0**-52
SLACK = 1 + 2.0**-20

CONSTANTS = {
    "u_4": 4 * U * SLACK,
    "u_8": 8 * U * SLACK,
    "u_12": 12 * U * SLACK,
    "u_16": 16 * U * SLACK,
    "slack": SLACK,
    "least": 2.0**-100,
    "greatest": 2.0**100,
    "farthest": 2.0**200,
}
"""The inputs of CERTIFIED beside the seven columns, by name."""

USABLE = """
    alpha_usable = alpha > 0
    gamma_usable = gamma > 0
    b_not_small = b > least
    b_not_large = b < greatest
    d_not_small = d > least
    d_not_large = d < greatest
    A_not_small = A > least
    A_not_large = A < greatest
    B_not_small = B > least
    B_not_large = B < greatest
    P_plus_Q = P + Q
    not_too_far = P_plus_Q < farthest
    positive_radial = alpha_usable and gamma_usable
    b_usable = b_not_small and b_not_large
    d_usable = d_not_small and d_not_large
    A_usable = A_not_small and A_not_large
    B_usable = B_not_small and B_not_large
    radial_usable = b_usable and A_usable
    axial_usable = d_usable and B_usable
    ratios_usable = radial_usable and axial_usable
    sizes_usable = positive_radial and ratios_usable
    usable = sizes_usable and not_too_far
"""
"""The steps to `usable`: all numbers are in the range for which the bounds hold."""

_COEFFICIENT_BOUNDS = """
    A_plus_B = A + B
    sizes_1 = A_plus_B + AB
    BP_plus_AQ = BP + AQ
    terms_1 = sizes_1 + BP_plus_AQ
    sizes_2 = A_plus_B + 1
    terms_2 = sizes_2 + P_plus_Q
    e1 = u_12 * terms_1
    e2 = u_8 * terms_2
    e0 = u_8 * AB
    m0 = AB + e0
    size_c1 = abs c1
    m1 = size_c1 + e1
    size_c2 = abs c2
    m2 = size_c2 + e2
"""
"""The steps to the error bounds e0, e1, e2 of the coefficients, and to bounds m0, m1, m2 of their sizes."""

# E1 = m2 (2 e2 + 4u m2) + 3 (e1 + 4u m1), E2 = m2 (e1 + 4u m1) + m1 e2 + 9 (e0 + 4u m0),
# E3 = m1 (2 e1 + 4u m1) + 3 (m2 (e0 + 4u m0) + m0 e2), E = 4 (a1 (E3 + 4u a3) + a3 E1) + a2 (2 E2 + 4u a2).
_DISCRIMINANT_BOUND = """
    u_m0 = u_4 * m0
    f0 = e0 + u_m0
    u_m1 = u_4 * m1
    f1 = e1 + u_m1
    u_m2 = u_4 * m2
    twice_e2 = 2 * e2
    f2 = twice_e2 + u_m2
    m2_f2 = m2 * f2
    thrice_f1 = 3 * f1
    E1 = m2_f2 + thrice_f1
    m2_f1 = m2 * f1
    m1_e2 = m1 * e2
    cross_21 = m2_f1 + m1_e2
    ninefold_f0 = 9 * f0
    E2 = cross_21 + ninefold_f0
    twice_e1 = 2 * e1
    f3 = twice_e1 + u_m1
    m1_f3 = m1 * f3
    m2_f0 = m2 * f0
    m0_e2 = m0 * e2
    cross_20 = m2_f0 + m0_e2
    thrice_cross_20 = 3 * cross_20
    E3 = m1_f3 + thrice_cross_20
    size_h1 = abs h1
    a1 = size_h1 + E1
    size_h2 = abs h2
    a2 = size_h2 + E2
    size_h3 = abs h3
    a3 = size_h3 + E3
    u_a3 = u_4 * a3
    F3 = E3 + u_a3
    a1_F3 = a1 * F3
    a3_E1 = a3 * E1
    cross_13 = a1_F3 + a3_E1
    fourfold_cross_13 = 4 * cross_13
    u_a2 = u_4 * a2
    twice_E2 = 2 * E2
    F2 = twice_E2 + u_a2
    a2_F2 = a2 * F2
    E_sum = fourfold_cross_13 + a2_F2
    E = slack * E_sum
    minus_E = - E
"""
"""The steps to E, the error bound of 3Δ."""


def _slope(pole: str, sign: str, tag: str) -> str:
    """Return the steps to g' at a pole and to the offset 3 |pole| ± c2, with their error bounds and comparisons.

    `sign` is that of c2, and `tag` ends the names of the steps.
    """
    return f"""
    thrice_{tag} = 3 * {pole}
    chord_{tag} = thrice_{tag} {sign} two_c2
    rise_{tag} = chord_{tag} * {pole}
    slope_{tag} = rise_{tag} + c1
    offset_{tag} = thrice_{tag} {sign} c2
    size_chord_{tag} = thrice_{tag} + twice_m2
    size_rise_{tag} = size_chord_{tag} * {pole}
    size_slope_{tag} = size_rise_{tag} + m1
    u_slope_{tag} = u_16 * size_slope_{tag}
    carried_{tag} = twice_e2 * {pole}
    carried_1_{tag} = carried_{tag} + e1
    error_{tag} = carried_1_{tag} + u_slope_{tag}
    bound_{tag} = slack * error_{tag}
    below_{tag} = - bound_{tag}
    size_offset_{tag} = {pole} + m2
    u_offset_{tag} = u_16 * size_offset_{tag}
    offset_error_{tag} = e2 + u_offset_{tag}
    offset_bound_{tag} = slack * offset_error_{tag}
    offset_below_{tag} = - offset_bound_{tag}
    rises_{tag} = slope_{tag} > bound_{tag}
    falls_{tag} = slope_{tag} < below_{tag}
    inflection_inside_{tag} = offset_{tag} > offset_bound_{tag}
    inflection_beyond_{tag} = offset_{tag} < offset_below_{tag}
"""


# The rule of decision_listings.all_regimes without its ring, which floats cannot prove. e1 and e2 are exceeded by more
# than the bounds' own rounding where c1 and c2 are compared, since u_8 and u_12 contain SLACK.
_DECISION = """
    minus_e1 = - e1
    minus_e2 = - e2
    distinct = delta_3 > E
    one_root = delta_3 < minus_E
    c1_positive = c1 > e1
    c1_negative = c1 < minus_e1
    c2_positive = c2 > e2
    c2_negative = c2 < minus_e2
    three_roots = distinct and usable
    falling_then_rising = c2_negative and c1_positive
    all_positive = three_roots and falling_then_rising
    some_sign_differs = c2_positive or c1_negative
    two_negative = three_roots and some_sign_differs
    some_below_B = inflection_inside_B or falls_B
    none_below_B = inflection_beyond_B and rises_B
    both_above_A = inflection_inside_A and rises_A
    none_above_A = inflection_beyond_A or falls_A
    exterior = all_positive and some_below_B
    interior = two_negative and both_above_A
    crossing = one_root and usable
    groove = all_positive and none_below_B
    throat = two_negative and none_above_A
    several_curves = groove or throat
    contact = crossing or several_curves
    clear = exterior or interior
    decided = clear or contact
"""

CERTIFIED = program_of(
    "certified",
    (*COLUMNS, *CONSTANTS),
    TABLE_2,
    HESSIAN_DISCRIMINANT,
    USABLE,
    _COEFFICIENT_BOUNDS,
    _DISCRIMINANT_BOUND,
    "two_c2 = 2 * c2",
    "twice_m2 = 2 * m2",
    _slope("B", "+", "B"),
    _slope("A", "-", "A"),
    _DECISION,
)
"""The program from a row and CONSTANTS to `exterior`, `interior` and `decided`; decided and neither is contact."""


SINGLE_CONSTANTS = {"u_8": 8 * U * SLACK, "u_12": 12 * U * SLACK, "u_1536": 48 * 32 * U * SLACK}

SINGLE = program_of(
    "single",
    (*COLUMNS, *SINGLE_CONSTANTS),
    TABLE_2,
    HESSIAN_DISCRIMINANT,
    """
    P_plus_Q = P + Q
    A_plus_B = A + B
    sizes_2 = A_plus_B + 1
    M2 = sizes_2 + P_plus_Q
    BP_plus_AQ = BP + AQ
    sizes_1 = A_plus_B + AB
    M1 = sizes_1 + BP_plus_AQ
    product = M2 * M1
    product_squared = product * product
    E = u_1536 * product_squared
    e1 = u_12 * M1
    e2 = u_8 * M2
    BB = B * B
""",
)
"""The program for one pair, from a row to the names of SINGLE_RESULTS."""

SINGLE_RESULTS = ("A", "B", "BB", "P_plus_Q", "c1", "e1", "c2", "e2", "delta_3", "E")
"""The results of SINGLE: delta_3, c1, c2 with their error bounds E, e1, e2, and the numbers whose range is tested."""
