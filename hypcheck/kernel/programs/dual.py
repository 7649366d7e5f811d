"""The programs that decide one pair of any sizes by the dual form: a λ proves clear, and the tangent there contact.

A = (α/b)², B = (γ/d)², P = (x² + y²)/b² and Q = z²/d²; c0, c1, c2 are the coefficients of the cubic g. φ(λ) = Pλ/(A+λ)
− Qλ/(B−λ) − λ − 1 has the sign of g in (−A, B) (derivation/listings.py): the pair is exterior exactly where φ > 0
somewhere in (0, B), interior where φ > 0 somewhere in (−A, 0), and φ(0) = −1. It is concave, as φ'' = −2PA/(A+λ)³ −
2QB/(B−λ)³. So a λ with φ(λ) > 0 proves clear, and its tangent bounds φ in the whole interval:

    φ ≤ φ(λ) + max(φ'(λ) (B−λ), −φ'(λ) (A+λ)),   φ' = PA/(A+λ)² − QB/(B−λ)² − 1.

Where that is below 0, the pair is in contact. Where φ(λ) > −1 = φ(0), a concave φ is below −1 on the other side of 0;
so |λ| takes the place of the length beyond 0. The pair is also in contact where a point of the hyperboloid lies inside
the spheroid: the one at the centre's height, at the distance √R from the axis in units of b, with R = A (1 + Q/B), if
|√P − √R| < 1.

The two programs differ in how they find λ = B − v. Where φ' = 0, v + m v/√(v² + QB) = A + B with m = √(PA). The left
side grows and is concave, so Newton's steps from below never pass the root; both m and m v/√(QB) bound the middle term
from above, so A + B − m and (A+B) √(QB) / (√(QB) + m) are below the root. DUAL takes steps from the larger one.
LOCAL_MAXIMUM takes fewer from the local maximum of the cubic g, (−c2 − √(c2² − 3c1))/3. The proof (_proof) holds for
any λ: a bad one makes the answer 2, but no answer wrong.

Bounds. u = 2⁻⁵², twice the unit roundoff, for every rounding mode. λ is a float, and exact. The rounding factors are 3
in A, B and Q and 4 in P. The program tests that V = B − λ and W = A + λ are above 2⁻²⁸ of B and A, so their relative
errors are at most ρ = (4B/V + 2) u and (4A/W + 2) u, below 2⁻²¹. Pλ/W then has (4 + 2) u + ρ, and sums at most 3u of
each of their terms: with 1 + |λ|, and one u to spare for underflow,

    |φ̂ − φ| ≤ e = u ((16 + 8A/W) |Pλ/W| + (16 + 8B/V) |Qλ/V| + 4 (1 + |λ|)),
    |φ̂' − φ'| ≤ e' = u ((24 + 12A/W) PA/W² + (24 + 12B/V) QB/V² + 4),

as PA/W² has (4 + 3 + 3) u + 2ρ, and sums 2u of each term. √P has 3 factors and √R 7, so that 16u (√P + √R) bounds the
error of their difference. SLACK, 1 + 2⁻²⁰, covers what the bounds and the factors V and W are off by.

Range: that of CERTIFIED, for its reasons; b, d, A and B in 2^±100 and P + Q < 2²⁰⁰. Nothing overflows: PA/W² < 2⁵⁵⁶. A
square of a coordinate that underflows changes φ by less than 2⁻⁵⁹⁰ and φ' by less than 2⁻⁴⁶⁰; e and e' exceed 2⁻⁵⁰.
"""

from __future__ import annotations

from hypcheck.derivation.listings import CENTRE, SCALED_SIZES, TABLE_2
from hypcheck.derivation.program import program_of
from hypcheck.geometry.pair import COLUMNS
from hypcheck.kernel.programs.certified import CONSTANTS as CERTIFIED_CONSTANTS
from hypcheck.kernel.programs.certified import SLACK, USABLE, U

STEPS = 8
"""How many steps of Newton's method DUAL makes."""

STEPS_FROM_MAXIMUM = 3
"""How many steps of Newton's method LOCAL_MAXIMUM makes."""

CONSTANTS = {
    "u": U * SLACK,
    "u_4": 4 * U * SLACK,
    "u_16": 16 * U * SLACK,
    "slack": SLACK,
    "margin": 2.0**-27,
    "least_margin": 2.0**-28,
    **{name: CERTIFIED_CONSTANTS[name] for name in ("least", "greatest", "farthest")},
}
"""The inputs of both programs beside the seven columns, by name."""

_ENDS = """
    S = A + B
    PA = P * A
    QB = Q * B
    m = sqrt PA
    m_QB = m * QB
    v_least = B * margin
"""

_START = """
    c = sqrt QB
    S_c = S * c
    c_plus_m = c + m
    c_plus_m_plus = c_plus_m + least
    v_flat = S_c / c_plus_m_plus
    v_steep = S - m
    steep_above = v_steep > v_flat
    v_larger = steep_above ? v_steep : v_flat
    start_inside = v_larger > v_least
    v_0 = start_inside ? v_larger : v_least
"""
"""The steps to the first v of DUAL."""

_LOCAL_MAXIMUM = """
    c2_squared = c2 * c2
    three_c1 = 3 * c1
    h1 = c2_squared - three_c1
    has_maximum = h1 > 0
    h1_used = has_maximum ? h1 : 0
    root = sqrt h1_used
    minus_c2 = - c2
    c2_negative = c2 < 0
    root_sum = minus_c2 + root
    divisor = c2_negative ? root_sum : 1
    from_c1 = c1 / divisor
    root_difference = minus_c2 - root
    from_c2 = root_difference / 3
    lambda_m = c2_negative ? from_c1 : from_c2
    v_m = B - lambda_m
    v_m_inside = v_m > v_least
    v_0 = v_m_inside ? v_m : v_least
"""
"""The steps to the first v of LOCAL_MAXIMUM, from the local maximum of g."""


def _newton(step: int) -> str:
    """Return the steps of one of Newton's steps, from v_`step` to the next v, for v + m v/√(v² + QB) = S = A + B."""
    return f"""
    vv_{step} = v_{step} * v_{step}
    square_{step} = vv_{step} + QB
    root_{step} = sqrt square_{step}
    share_{step} = v_{step} / root_{step}
    middle_{step} = m * share_{step}
    sum_{step} = v_{step} + middle_{step}
    excess_{step} = sum_{step} - S
    cube_{step} = square_{step} * root_{step}
    bend_{step} = m_QB / cube_{step}
    slope_{step} = 1 + bend_{step}
    change_{step} = excess_{step} / slope_{step}
    moved_{step} = v_{step} - change_{step}
    inside_{step} = moved_{step} > v_least
    v_{step + 1} = inside_{step} ? moved_{step} : v_least
"""


def _proof(last: str) -> str:
    """Return the steps from the last v to the answer."""
    return f"""
    lambda_found = B - {last}
    A_margin = A * margin
    lambda_least = A_margin - A
    lambda_inside = lambda_found > lambda_least
    lambda_ = lambda_inside ? lambda_found : lambda_least
    V = B - lambda_
    W = A + lambda_
    V_least = B * least_margin
    W_least = A * least_margin
    V_usable = V > V_least
    W_usable = W > W_least
    between_poles = V_usable and W_usable
    in_range = usable and between_poles
    B_V = B / V
    A_W = A / W
    V_factor_half = 2 + B_V
    W_factor_half = 2 + A_W
    P_lambda = P * lambda_
    P_term = P_lambda / W
    Q_lambda = Q * lambda_
    Q_term = Q_lambda / V
    P_term_minus_Q_term = P_term - Q_term
    one_plus_lambda = 1 + lambda_
    phi = P_term_minus_Q_term - one_plus_lambda
    size_P_term = abs P_term
    size_Q_term = abs Q_term
    size_lambda = abs lambda_
    P_error = size_P_term * W_factor_half
    Q_error = size_Q_term * V_factor_half
    PQ_error = P_error + Q_error
    PQ_error_8 = 8 * PQ_error
    one_plus_size = 1 + size_lambda
    one_plus_size_4 = 4 * one_plus_size
    error_in_u = PQ_error_8 + one_plus_size_4
    e = u * error_in_u
    WW = W * W
    P_slope = PA / WW
    VV = V * V
    Q_slope = QB / VV
    P_slope_minus_Q_slope = P_slope - Q_slope
    phi_slope = P_slope_minus_Q_slope - 1
    P_slope_error = P_slope * W_factor_half
    Q_slope_error = Q_slope * V_factor_half
    PQ_slope_error = P_slope_error + Q_slope_error
    PQ_slope_error_12 = 12 * PQ_slope_error
    u_PQ_slope_error = u * PQ_slope_error_12
    slope_error = u_PQ_slope_error + u_4
    steepest_up = phi_slope + slope_error
    steepest_down = slope_error - phi_slope
    positive = lambda_ > 0
    negative = lambda_ < 0
    gain = phi + 1
    twice_e = 2 * e
    gains = gain > twice_e
    only_above_0 = gains and positive
    only_below_0 = gains and negative
    V_reach = only_below_0 ? size_lambda : V
    W_reach = only_above_0 ? size_lambda : W
    rise_to_B = steepest_up * V_reach
    rise_to_A = steepest_down * W_reach
    to_B_larger = rise_to_B > rise_to_A
    rise = to_B_larger ? rise_to_B : rise_to_A
    e_plus_rise = e + rise
    above = slack * e_plus_rise
    minus_above = - above
    below_zero = phi < minus_above
    Q_over_B = Q / B
    one_plus_Q_over_B = 1 + Q_over_B
    R = A * one_plus_Q_over_B
    root_P = sqrt P
    root_R = sqrt R
    gap = root_P - root_R
    size_gap = abs gap
    roots_sum = root_P + root_R
    gap_error = u_16 * roots_sum
    gap_at_most = size_gap + gap_error
    point_inside = gap_at_most < 1
    proved_contact = below_zero or point_inside
    proved_clear = phi > e
    clear = proved_clear and in_range
    exterior = clear and positive
    interior = clear and negative
    either = exterior or interior
    contact = proved_contact and in_range
    decided = either or contact
"""


_INPUTS = (*COLUMNS, *CONSTANTS)

DUAL = program_of(
    "dual-certified",
    _INPUTS,
    SCALED_SIZES,
    CENTRE,
    USABLE,
    _ENDS,
    _START,
    *map(_newton, range(STEPS)),
    _proof(f"v_{STEPS}"),
)
"""The program from a row and CONSTANTS to `exterior`, `interior` and `decided`; decided and neither is contact."""

LOCAL_MAXIMUM = program_of(
    "local-maximum-certified",
    _INPUTS,
    TABLE_2,
    USABLE,
    _ENDS,
    _LOCAL_MAXIMUM,
    *map(_newton, range(STEPS_FROM_MAXIMUM)),
    _proof(f"v_{STEPS_FROM_MAXIMUM}"),
)
"""The same, with steps that begin at the local maximum of g."""
