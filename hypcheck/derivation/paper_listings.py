"""Listings of the paper's section 3: the rotors of Procedures 2.a and 2.b, and the three roots of g in numbers.

Procedures 2.a and 2.b have four rotors on arms of length l about the centre of a quadcopter. The rotors' spheroids have
semi-axes b_s, b_s, d_s; `cosine` and `sine` are those of g1. Since g_i = g1 + (i−1)π/2, with T1 = cos g1 − sin g1 and
T2 = cos g1 + sin g1 the pairs (T1(g_i), T2(g_i)) of equation (15) are (T1, T2), (−T2, T1), (−T1, −T2) and (T2, −T1).
Changing a sign rounds nothing, so T1 x0 + T2 y0 and T1 y0 − T2 x0 serve all four.

The roots of g: the paper compares itself in section 3.1 with [13], which looks at their signs "instead of computing
only the coefficients, which implies to evaluate trigonometric functions when Δ > 0" (the text of [13] was not
consulted). Two ways to compute roots are written down: the trigonometric one, and a sweep of a general root finder.
"""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.derivation.listings import H1, SIZES, equation_13, proposition_5

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
    """Return the listing of equation (21) for a rotor.

    c1(g_i) = (α/b_s)² B1 + (γ/d_s)² (B2 − 1 + C(g_i)) and c2(g_i) = (α/b_s)² + B1 − B2 − C(g_i).
    """
    return f"""
    reach_g{rotor} = B2_minus_1 + C_g{rotor}
    B_s_reach_g{rotor} = B_s * reach_g{rotor}
    c1_g{rotor} = A_s_B1 + B_s_reach_g{rotor}
    c2_g{rotor} = A_s_B1_B2 - C_g{rotor}
"""


def rotors_decided(answer: str, test: Callable[[str], str] = proposition_5, inside: str = "inside") -> str:
    """Return the listing of Procedure 2.a: `answer` is true unless Δ(g_i) ≤ 0 for some rotor, or a rotor is not inside.

    `test` returns, for the suffix of a rotor, the listing that computes the step by the name `inside`; as printed that
    is Proposition 5.
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


# With λ = t − c2/3 the cubic is t³ − (h1/3) t − w/27, h1 = c2² − 3 c1, w = 9 c1 c2 − 2 c2³ − 27 c0; 27 Δ = 4 h1³ − w².
# Where Δ > 0 its roots are t = (2/3) √h1 cos(θ + 2kπ/3) with cos 3θ = w/(2 h1 √h1). arccos(−1/2) is a third of a turn.
TRIGONOMETRIC = (
    H1
    + """
    nine_c1 = 9 * c1
    two_c2_squared = 2 * c2_squared
    nine_c1_less = nine_c1 - two_c2_squared
    w_of_c2 = nine_c1_less * c2
    c0_27 = 27 * c0
    w = w_of_c2 - c0_27
    h1_squared = h1 * h1
    h1_cubed = h1_squared * h1
    h1_cubed_4 = 4 * h1_cubed
    w_squared = w * w
    delta_27 = h1_cubed_4 - w_squared
    root = sqrt h1
    two_root = 2 * root
    cubed_root = two_root * h1
    cosine_of_three = w / cubed_root
    three_theta = arccos cosine_of_three
    theta = three_theta / 3
    minus_half = -1 / 2
    third_of_turn = arccos minus_half
    theta_2 = theta + third_of_turn
    theta_3 = theta - third_of_turn
    cosine_1 = cos theta
    cosine_2 = cos theta_2
    cosine_3 = cos theta_3
    t_1 = two_root * cosine_1
    t_2 = two_root * cosine_2
    t_3 = two_root * cosine_3
    three_r1 = t_1 - c2
    three_r2 = t_2 - c2
    three_r3 = t_3 - c2
    r1 = three_r1 / 3
    r2 = three_r2 / 3
    r3 = three_r3 / 3
    distinct = delta_27 > 0
    r1_positive = r1 > 0
    r2_positive = r2 > 0
    r3_positive = r3 > 0
    r12_positive = r1_positive and r2_positive
    all_positive = r12_positive and r3_positive
    valid = distinct and all_positive
"""
)


def correction(root: int, others: tuple[int, int]) -> str:
    """Return the listing of Weierstrass's correction of an approximation z to one root, in its two real parts.

    The correction is g(z)/((z − z')(z − z'')), where z' and z'' are the approximations to the `others` and
    g(z) = ((z + c2) z + c1) z + c0. The next approximation, new, is z minus the correction.
    """
    x, y = here = f"x{root}", f"y{root}"
    (first, second), end = others, f"_{root}"
    return (
        f"a{end} = {x} + c2\n"
        + _complex_product(f"square{end}", (f"a{end}", y), here)
        + f"square_and_c1{end} = square{end}_re + c1\n"
        + _complex_product(f"cube{end}", (f"square_and_c1{end}", f"square{end}_im"), here)
        + f"""
    g_re{end} = cube{end}_re + c0
    dx_first{end} = {x} - x{first}
    dy_first{end} = {y} - y{first}
    dx_second{end} = {x} - x{second}
    dy_second{end} = {y} - y{second}
"""
        + _complex_product(f"d{end}", (f"dx_first{end}", f"dy_first{end}"), (f"dx_second{end}", f"dy_second{end}"))
        + f"minus_d_im{end} = - d{end}_im\n"
        + _complex_product(f"top{end}", (f"g_re{end}", f"cube{end}_im"), (f"d{end}_re", f"minus_d_im{end}"))
        + f"""
    d_re_squared{end} = d{end}_re * d{end}_re
    d_im_squared{end} = d{end}_im * d{end}_im
    norm{end} = d_re_squared{end} + d_im_squared{end}
    step_re{end} = top{end}_re / norm{end}
    step_im{end} = top{end}_im / norm{end}
    new_{x} = {x} - step_re{end}
    new_{y} = {y} - step_im{end}
"""
    )


def _complex_product(name: str, first: tuple[str, str], second: tuple[str, str]) -> str:
    """Return the listing of a product of two complex numbers.

    The name of its real part ends in _re and that of its imaginary part in _im. `first` and `second` are the names of
    these parts of the factors.
    """
    (a, b), (c, d) = first, second
    return f"""
    {name}_ac = {a} * {c}
    {name}_bd = {b} * {d}
    {name}_re = {name}_ac - {name}_bd
    {name}_ad = {a} * {d}
    {name}_bc = {b} * {c}
    {name}_im = {name}_ad + {name}_bc
"""


WEIERSTRASS_SWEEP = correction(1, (2, 3)) + correction(2, (1, 3)) + correction(3, (1, 2))
