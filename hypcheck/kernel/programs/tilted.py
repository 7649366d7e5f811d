"""The program of the stage that decides tilted spheroids in floats: any multiplier l, and what it proves.

A multiplier l is an argument λ of the dual function φ. With lengths in units of b and the axis v, the quartic of
programs/integers.py, which defines E, G, m, k0 and k1, is F = φ d at λ = l, where

    d = (p + l) k,   k = k0 + l k1 − t l²,   φ = l N/d − 1 − l,   N = l E + (p + l)(G − l m),

p, s, t are the squares of α/b, γ/b, d/b. The dual function is concave between its poles −min(A1, A2) and B, with
φ(0) = −1. Where p + l > 0 and k > 0, l lies between them. There φ > 0 proves the side of l. φ < 0 proves contact when
the tangent of φ at l stays below 0 between the poles, as a concave function lies below its tangents:

    φ'(l) = psi/d²,   psi = d (N + l N' − d) − l N d',   B ≤ s along/t,   min(A1, A2) ≤ p,

so |psi| (p + s along/t) < −F d suffices (along = t h + c, with h and c the squares of the axis' sine and cosine; B has
that value where the spheroid is upright). No step relies on l being the best choice: a bad one decides less.

Bounds (u = 2⁻⁵², which covers every rounding mode). derivation/rounding.py counts the rounding factors of p + l, k, d,
F and psi, and makes their magnitudes M, the sums of their terms' sizes; these steps are part of the program. Each value
is within (count + 2) u·SLACK of M: one unit for the second order, one for underflow (below); SLACK is the magnitudes'
own rounding, less than 100 factors each.

Range. The program tests that b is in 2^±300, p, s, t in 2^±54, |C|²/b² < 2¹⁰⁸, |v|² in 2^±100, |l| < 2⁶⁰. Then d <
2²³⁰, N < 2²⁸³ and psi < 2⁵¹⁷ with their magnitudes, and nothing overflows. M of p + l is at least 2⁻⁵⁴, of k, d, F and
psi at least 2⁻¹⁰⁸, 2⁻¹⁶², 2⁻¹⁶² and 2⁻³²⁴; an underflow, less than 2⁻¹⁰²¹, times what it can be multiplied by,
2⁵¹⁷⁺¹⁰⁰, is below u·M each. An overflow before, of x/b or |v|², is detected: the number is not below its limit in any
rounding mode, nor is NaN.
"""

from __future__ import annotations

from collections.abc import Mapping

from hypcheck.derivation.program import Program, Step, needed, program_of, steps_of
from hypcheck.derivation.rounding import ErrorCounts, relative_error_counts
from hypcheck.geometry.pair import SIZES, TILTED_COLUMNS
from hypcheck.kernel.programs.certified import SLACK, U

ROW = TILTED_COLUMNS

SQUARES = """
    r = 1 / b
    alpha_r = alpha * r
    p = alpha_r * alpha_r
    gamma_r = gamma * r
    s = gamma_r * gamma_r
    d_r = d * r
    t = d_r * d_r
"""
"""The steps to p, s, t, the squares of α, γ and d in units of b."""

K1 = """
    t_h = t * h
    along = t_h + c
    t_c = t * c
    across = t_c + h
    s_along = s * along
    p_across = p * across
    k1 = s_along - p_across
"""
"""The steps to k1, from the squares h and c of the sine and cosine of the angle between the axes."""

FORM = f"""
    {SQUARES}
    x_r = x * r
    y_r = y * r
    z_r = z * r
    axis_xx = axis_x * axis_x
    axis_yy = axis_y * axis_y
    level = axis_xx + axis_yy
    upward = axis_z * axis_z
    w = level + upward
    h = level / w
    c = upward / w
    x_y = axis_x * y_r
    y_x = axis_y * x_r
    cross = x_y - y_x
    x_x = axis_x * x_r
    y_y = axis_y * y_r
    z_z = axis_z * z_r
    along_level = x_x + y_y
    along_axis = along_level + z_z
    cross_squared = cross * cross
    cross_part = cross_squared / w
    axis_squared = along_axis * along_axis
    axis_part = axis_squared / w
    xx = x_r * x_r
    yy = y_r * y_r
    radius = xx + yy
    height = z_r * z_r
    distance = radius + height
    t_1 = t - 1
    s_p = s + p
    t_1_s_p = t_1 * s_p
    E = t_1_s_p * cross_part
    s_radius = s * radius
    p_height = p * height
    G = s_radius - p_height
    t_distance = t * distance
    t_1_axis = t_1 * axis_part
    m = t_distance - t_1_axis
    k0 = p * s
    {K1}
"""
"""The steps from a row to the numbers of F that do not depend on l."""

AT_MULTIPLIER = """
    p_l = p + l
    t_l = t * l
    k1_tl = k1 - t_l
    k1_tl_l = k1_tl * l
    k = k0 + k1_tl_l
    m_l = m * l
    g = G - m_l
    E_l = E * l
    p_l_g = p_l * g
    N = E_l + p_l_g
    l_N = l * N
    d_l = p_l * k
    one_l = 1 + l
    one_l_d = one_l * d_l
    F = l_N - one_l_d
    p_l_m = p_l * m
    E_g = E + g
    N_slope = E_g - p_l_m
    k_slope = k1_tl - t_l
    p_l_k_slope = p_l * k_slope
    d_slope = k + p_l_k_slope
    l_N_slope = l * N_slope
    N_both = N + l_N_slope
    N_both_d = N_both - d_l
    gain = d_l * N_both_d
    loss = l_N * d_slope
    psi = gain - loss
"""
"""The steps from these numbers and l to F, d, k, p + l and psi."""

VALUES = program_of("tilted-values", (*ROW, "l"), FORM, AT_MULTIPLIER)
"""The program from a row and l to F, d, k, p + l and psi."""

BEFORE = tuple(step.name for step in steps_of(FORM))
"""The names that are computed before a multiplier is chosen."""

BOUNDED = {"p_l": "e_pl", "k": "e_k", "d_l": "e_d", "F": "e_F", "psi": "e_psi"}
"""The names whose errors are bounded, each with the name of its bound."""


def counted() -> ErrorCounts:
    """Count the rounding factors of the bounded values, and make their magnitudes."""
    return relative_error_counts(VALUES, BOUNDED, positive=SIZES)


CONSTANTS = {
    "u_p_l": 8 * U * SLACK,
    "u_k": 28 * U * SLACK,
    "u_d_l": 36 * U * SLACK,
    "u_F": 40 * U * SLACK,
    "u_psi": 72 * U * SLACK,
    "less_sure": 1 - 2.0**-20,
    "least_b": 2.0**-300,
    "greatest_b": 2.0**300,
    "least_square": 2.0**-54,
    "greatest_square": 2.0**54,
    "farthest_square": 2.0**108,
    "least_axis": 2.0**-100,
    "greatest_axis": 2.0**100,
    "greatest_l": 2.0**60,
}
"""The inputs of TILTED beside the row and l, by name."""


def in_range(axes: tuple[str, ...], near: str, joined: str, axes_usable: str, is_near: str) -> str:
    """Return the steps to `inside`: every number is in its range, and l is between the poles.

    `axes` names the squares of the axes' lengths. `near` has the steps that compare the centre with its limit, `joined`
    those that combine comparisons to the names `axes_usable` and `is_near`.
    """
    limits = {"b": ("least_b", "greatest_b"), **dict.fromkeys("pst", ("least_square", "greatest_square"))}
    limits |= dict.fromkeys(axes, ("least_axis", "greatest_axis"))
    within = [
        f"{name}_not_small = {name} > {least}\n{name}_not_large = {name} < {greatest}"
        for name, (least, greatest) in limits.items()
    ]
    usable = [f"{name}_usable = {name}_not_small and {name}_not_large" for name in limits]
    return "\n".join(
        (
            *(f"{name}_positive = {name} > 0" for name in ("alpha", "gamma", "d")),
            *within,
            near,
            "size_l = abs l",
            "l_usable = size_l < greatest_l",
            *usable,
            "ps_usable = p_usable and s_usable",
            "bt_usable = b_usable and t_usable",
            joined,
            f"""
            radial_positive = alpha_positive and gamma_positive
            all_positive = radial_positive and d_positive
            squares_usable = ps_usable and bt_usable
            sizes_usable = squares_usable and all_positive
            place_usable = {is_near} and l_usable
            rest_usable = {axes_usable} and place_usable
            usable = sizes_usable and rest_usable
            before_B_and_A2 = k > e_k
            before_A1 = p_l > e_pl
            between_poles = before_B_and_A2 and before_A1
            inside = usable and between_poles
            """,
        )
    )


SIDES = """
    clear = phi_positive and inside
    on_side_of_B = l > 0
    on_side_of_A = l < 0
    exterior = clear and on_side_of_B
    interior = clear and on_side_of_A
    minus_F = - F
    minus_F_least = minus_F - e_F
    phi_negative = minus_F_least > 0
    d_least = d_l - e_d
"""
"""The steps from `phi_positive` and `inside` to the side of a clear spheroid, and to whether φ < 0 is proved."""

_DECISION = f"""
    {in_range(("w",), "not_too_far = distance < farthest_square", "", "w_usable", "not_too_far")}
    phi_positive = F > e_F
    {SIDES}
    room = minus_F_least * d_least
    room_least = less_sure * room
    size_psi = abs psi
    psi_most = size_psi + e_psi
    B_most = s_along / t
    width = p + B_most
    slope_most = psi_most * width
    below_tangent = slope_most < room_least
    below = below_tangent and phi_negative
    contact = below and inside
    decided = clear or contact
"""


def certificate(
    name: str, values: Program, inputs: tuple[str, ...], counts: ErrorCounts, bounded: Mapping[str, str], decision: str
) -> Program:
    """Return the program that computes `values`, the counted magnitudes, the bounds of `bounded`, and the decision."""
    magnitudes = {of: str(magnitude) for of, magnitude in counts.magnitudes.items()}
    bounds = [Step(error, "mul", (f"u_{of}", magnitudes[of])) for of, error in bounded.items()]
    before = (*values.steps, *needed(counts.program, tuple(magnitudes.values())), *bounds)
    known = dict.fromkeys((*inputs, *(step.name for step in before)))
    return Program(name, inputs, (*before, *program_of("", tuple(known), decision).steps))


TILTED = certificate("tilted", VALUES, (*ROW, "l", *CONSTANTS), counted(), BOUNDED, _DECISION)
"""The program from a row, any l and CONSTANTS to `exterior`, `interior`, `decided`; decided and neither is contact."""
