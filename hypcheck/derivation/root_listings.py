"""Listings of the roots' way: g's three roots in numbers, of which the paper's section 3.1 asks for the signs.

The paper compares itself with [13], which looks at the roots "instead of computing only the coefficients, which implies
to evaluate trigonometric functions when Δ > 0" (the text of [13] was not consulted). Two ways are written down: the
trigonometric one, which is that, and a sweep of a general root finder.
"""

from __future__ import annotations

# With λ = t − c2/3 the cubic is t³ − (h1/3) t − w/27, h1 = c2² − 3 c1, w = 9 c1 c2 − 2 c2³ − 27 c0; 27 Δ = 4 h1³ − w².
# Where Δ > 0 its roots are t = (2/3) √h1 cos(θ + 2kπ/3) with cos 3θ = w/(2 h1 √h1). arccos(−1/2) is a third of a turn.
TRIGONOMETRIC = """
    c2_squared = c2 * c2
    three_c1 = 3 * c1
    h1 = c2_squared - three_c1
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


def correction(root: int, others: tuple[int, int]) -> str:
    """Weierstrass's correction of an approximation z to one root, g(z)/((z − z')(z − z'')), in two real parts.

    The next approximation, new, is z less the correction.
    """
    first, second = others
    name = f"_{root}"
    return f"""
    a{name} = x{root} + c2
    ax{name} = a{name} * x{root}
    yy{name} = y{root} * y{root}
    square_re{name} = ax{name} - yy{name}
    square_re_c1{name} = square_re{name} + c1
    ay{name} = a{name} * y{root}
    xy{name} = x{root} * y{root}
    square_im{name} = ay{name} + xy{name}
    g_xx{name} = square_re_c1{name} * x{root}
    g_yy{name} = square_im{name} * y{root}
    g_re_less{name} = g_xx{name} - g_yy{name}
    g_re{name} = g_re_less{name} + c0
    g_xy{name} = square_re_c1{name} * y{root}
    g_yx{name} = square_im{name} * x{root}
    g_im{name} = g_xy{name} + g_yx{name}
    dx_first{name} = x{root} - x{first}
    dy_first{name} = y{root} - y{first}
    dx_second{name} = x{root} - x{second}
    dy_second{name} = y{root} - y{second}
    dxx{name} = dx_first{name} * dx_second{name}
    dyy{name} = dy_first{name} * dy_second{name}
    d_re{name} = dxx{name} - dyy{name}
    dxy{name} = dx_first{name} * dy_second{name}
    dyx{name} = dy_first{name} * dx_second{name}
    d_im{name} = dxy{name} + dyx{name}
    d_re_squared{name} = d_re{name} * d_re{name}
    d_im_squared{name} = d_im{name} * d_im{name}
    norm{name} = d_re_squared{name} + d_im_squared{name}
    top_rr{name} = g_re{name} * d_re{name}
    top_ii{name} = g_im{name} * d_im{name}
    top_re{name} = top_rr{name} + top_ii{name}
    top_ir{name} = g_im{name} * d_re{name}
    top_ri{name} = g_re{name} * d_im{name}
    top_im{name} = top_ir{name} - top_ri{name}
    step_re{name} = top_re{name} / norm{name}
    step_im{name} = top_im{name} / norm{name}
    new_x{root} = x{root} - step_re{name}
    new_y{root} = y{root} - step_im{name}
"""


WEIERSTRASS_SWEEP = correction(1, (2, 3)) + correction(2, (1, 3)) + correction(3, (1, 2))
