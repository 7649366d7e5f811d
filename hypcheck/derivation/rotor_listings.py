"""Listings of Procedures 2.a and 2.b: four rotors on arms of length l about the centre of a quadcopter.

The rotors' spheroids have semi-axes b_s, b_s, d_s; `cosine` and `sine` are those of g1. Since g_i = g1 + (i−1)π/2, with
T1 = cos g1 − sin g1 and T2 = cos g1 + sin g1 the pairs (T1(g_i), T2(g_i)) of equation (15) are (T1, T2), (−T2, T1),
(−T1, −T2) and (T2, −T1). Changing a sign rounds nothing, so T1 x0 + T2 y0 and T1 y0 − T2 x0 serve all four.
"""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.derivation.coefficient_listings import SIZES, equation_13
from hypcheck.derivation.decision_listings import proposition_5

ROTORS = (1, 2, 3, 4)

# Equations (19) and (20). C(g_i) = l√2 (T1(g_i) x0 + T2(g_i) y0)/b_s² is C_i below.
SHARED_BY_ROTORS = """
    alpha_over_b_s = alpha / b_s
    A_s = alpha_over_b_s * alpha_over_b_s
    gamma_over_d_s = gamma / d_s
    B_s = gamma_over_d_s * gamma_over_d_s
    AB_s = A_s * B_s
    c0_s = - AB_s
    T1 = cosine - sine
    T2 = cosine + sine
    T1_x = T1 * x
    T2_y = T2 * y
    along = T1_x + T2_y
    T1_y = T1 * y
    T2_x = T2 * x
    across = T1_y - T2_x
    root_two = sqrt 2
    arm = l * root_two
    b_s_squared = b_s * b_s
    arm_along = arm * along
    C_g1 = arm_along / b_s_squared
    arm_across = arm * across
    C_g2 = arm_across / b_s_squared
    C_g3 = - C_g1
    C_g4 = - C_g2
    one_minus_B_s = 1 - B_s
    z_over_d_s = z / d_s
    zz_s = z_over_d_s * z_over_d_s
    B1 = one_minus_B_s - zz_s
    x_squared = x * x
    y_squared = y * y
    r_squared = x_squared + y_squared
    l_squared = l * l
    r_squared_l_squared = r_squared + l_squared
    B2 = r_squared_l_squared / b_s_squared
    A_s_B1 = A_s * B1
    B2_minus_1 = B2 - 1
    A_s_plus_B1 = A_s + B1
    A_s_B1_B2 = A_s_plus_B1 - B2
"""


def equation_21(rotor: int) -> str:
    """c1(g_i) = (α/b_s)² B1 + (γ/d_s)² (B2 − 1 + C(g_i)) and c2(g_i) = (α/b_s)² + B1 − B2 − C(g_i)."""
    return f"""
    reach_g{rotor} = B2_minus_1 + C_g{rotor}
    B_s_reach_g{rotor} = B_s * reach_g{rotor}
    c1_g{rotor} = A_s_B1 + B_s_reach_g{rotor}
    c2_g{rotor} = A_s_B1_B2 - C_g{rotor}
"""


def rotors_decided(answer: str, test: Callable[[str], str] = proposition_5, inside: str = "inside") -> str:
    """Procedure 2.a: `answer` is true unless Δ(g_i) ≤ 0 for some rotor, or a rotor is not inside.

    `test` lists for a suffix the steps that decide the step called `inside`; as printed those of Proposition 5.
    """
    coefficients = "".join(
        equation_21(rotor) + equation_13(c0="c0_s", suffix=f"_g{rotor}") + f"touching_g{rotor} = delta_g{rotor} <= 0\n"
        for rotor in ROTORS
    )
    tests = "".join(test(f"_g{rotor}") for rotor in ROTORS)
    return (
        SHARED_BY_ROTORS
        + coefficients
        + tests
        + f"""
    touching_g12 = touching_g1 or touching_g2
    touching_123 = touching_g12 or touching_g3
    some_touching = touching_123 or touching_g4
    none_touching = not some_touching
    inside_12 = {inside}_g1 and {inside}_g2
    inside_123 = inside_12 and {inside}_g3
    all_inside = inside_123 and {inside}_g4
    {answer} = none_touching and all_inside
"""
    )


# One rotor's spheroid on its own: b_s, d_s are b, d, and l = 0, which makes C(g_i) = 0. Adding 0 rounds nothing.
ONE_ROTOR = (
    SIZES
    + """
    one_minus_B = 1 - B
    z_over_d = z / d
    zz = z_over_d * z_over_d
    B1 = one_minus_B - zz
    x_squared = x * x
    y_squared = y * y
    r_squared = x_squared + y_squared
    bb = b * b
    B2 = r_squared / bb
    A_B1 = A * B1
    B2_minus_1 = B2 - 1
    B_reach = B * B2_minus_1
    c1 = A_B1 + B_reach
    A_plus_B1 = A + B1
    c2 = A_plus_B1 - B2
"""
)
