"""Listings that the formulas share: from the seven numbers to A, B, P, Q, the coefficients of g and a discriminant.

A = (α/b)², B = (γ/d)², P = (x0² + y0²)/b², Q = (z0/d)², and g(λ) = λ³ + c2 λ² + c1 λ + c0. Sums are taken from left to
right. A subexpression that is printed twice is computed once: it would round to the same value.
"""

from __future__ import annotations

SCALED_SIZES = """
    alpha_over_b = alpha / b
    A = alpha_over_b * alpha_over_b
    gamma_over_d = gamma / d
    B = gamma_over_d * gamma_over_d
"""

SIZES = (
    SCALED_SIZES
    + """
    AB = A * B
    c0 = - AB
"""
)

CENTRE = """
    xx = x * x
    yy = y * y
    rr = xx + yy
    bb = b * b
    P = rr / bb
    z_over_d = z / d
    Q = z_over_d * z_over_d
"""

# Table 2 prints C ← c0 + A − B before the loop, and in it c1 ← C + B × P − A × Q and c2 ← A − B + 1 − P − Q.
TABLE_2 = (
    SIZES
    + """
    c0_plus_A = c0 + A
    C = c0_plus_A - B
"""
    + CENTRE
    + """
    BP = B * P
    C_plus_BP = C + BP
    AQ = A * Q
    c1 = C_plus_BP - AQ
    A_minus_B = A - B
    K = A_minus_B + 1
    K_minus_P = K - P
    c2 = K_minus_P - Q
"""
)

# Equation (14): x0 and y0 are divided by b one by one, and each has a product with (γ/d)² of its own.
EQUATION_14 = (
    SIZES
    + """
    x_over_b = x / b
    xx = x_over_b * x_over_b
    y_over_b = y / b
    yy = y_over_b * y_over_b
    z_over_d = z / d
    zz = z_over_d * z_over_d
    c0_plus_A = c0 + A
    C = c0_plus_A - B
    Bxx = B * xx
    C_plus_Bxx = C + Bxx
    Byy = B * yy
    C_plus_Bxx_Byy = C_plus_Bxx + Byy
    Azz = A * zz
    c1 = C_plus_Bxx_Byy - Azz
    A_minus_B = A - B
    K = A_minus_B + 1
    K_minus_xx = K - xx
    K_minus_xx_yy = K_minus_xx - yy
    c2 = K_minus_xx_yy - zz
"""
)

# With E = (P − A) − 1: c2 = −(E + (B + Q)) and c1 = A (1 − Q) + B E. The one cancellation, in E, is in both
# coefficients the same, so its roundings act as a small change of P alone would.
SHARED_CANCELLATION = (
    SIZES
    + CENTRE
    + """
    P_minus_A = P - A
    E = P_minus_A - 1
    B_plus_Q = B + Q
    minus_c2 = E + B_plus_Q
    c2 = - minus_c2
    one_minus_Q = 1 - Q
    A_part = A * one_minus_Q
    B_part = B * E
    c1 = A_part + B_part
"""
)

# Table 2 prints Δ ← −4 × c2³ × c0 + (c2 × c1)² + 18 × c2 × c1 × c0 − 4 × c1³ − 27 × c0².
TABLE_2_DISCRIMINANT = """
    c2_squared = c2 * c2
    c2_cubed = c2_squared * c2
    c2_cubed_4 = -4 * c2_cubed
    term_1 = c2_cubed_4 * c0
    c2c1 = c2 * c1
    term_2 = c2c1 * c2c1
    sum_2 = term_1 + term_2
    c2_18 = 18 * c2
    c2c1_18 = c2_18 * c1
    term_3 = c2c1_18 * c0
    sum_3 = sum_2 + term_3
    c1_squared = c1 * c1
    c1_cubed = c1_squared * c1
    term_4 = 4 * c1_cubed
    sum_4 = sum_3 - term_4
    c0_squared = c0 * c0
    term_5 = 27 * c0_squared
    delta = sum_4 - term_5
"""

# 3Δ = 4 h1 h3 − h2², with the coefficients of the Hessian of the cubic.
HESSIAN_DISCRIMINANT = """
    c2_squared = c2 * c2
    three_c1 = 3 * c1
    h1 = c2_squared - three_c1
    c2c1 = c2 * c1
    nine_c0 = 9 * c0
    h2 = c2c1 - nine_c0
    c1_squared = c1 * c1
    c2c0 = c2 * c0
    three_c2c0 = 3 * c2c0
    h3 = c1_squared - three_c2c0
    h1h3 = h1 * h3
    h1h3_4 = 4 * h1h3
    h2_squared = h2 * h2
    delta_3 = h1h3_4 - h2_squared
"""


def equation_13(c0: str = "c0", suffix: str = "") -> str:
    """Δ as equation (13) prints it, of c0, c1 and c2; the suffix ends every name but c0's, so that it can be repeated.

    Δ = −4 c2³ c0 + c2² c1² + 18 c2 c1 c0 − 4 c1³ − 27 c0²
    """
    end = suffix
    return f"""
    c2_squared{end} = c2{end} * c2{end}
    c2_cubed{end} = c2_squared{end} * c2{end}
    c2_cubed_4{end} = -4 * c2_cubed{end}
    term_1{end} = c2_cubed_4{end} * {c0}
    c1_squared{end} = c1{end} * c1{end}
    term_2{end} = c2_squared{end} * c1_squared{end}
    sum_2{end} = term_1{end} + term_2{end}
    c2_18{end} = 18 * c2{end}
    c2c1_18{end} = c2_18{end} * c1{end}
    term_3{end} = c2c1_18{end} * {c0}
    sum_3{end} = sum_2{end} + term_3{end}
    c1_cubed{end} = c1_squared{end} * c1{end}
    term_4{end} = 4 * c1_cubed{end}
    sum_4{end} = sum_3{end} - term_4{end}
    c0_squared{end} = {c0} * {c0}
    term_5{end} = 27 * c0_squared{end}
    delta{end} = sum_4{end} - term_5{end}
"""
