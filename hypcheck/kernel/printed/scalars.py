"""Programs over Python's floats: one pair, and the constants of a scene's half planes.

Printed by `python -m hypcheck.kernel.printing.modules`. Change the programs, not this.
"""

# ruff: noqa: PLR0915

from __future__ import annotations

LEAST = 2.0**-100
GREATEST = 2.0**100
FARTHEST = 2.0**200
"""Where the bounds of `single` hold: b, d, A and B lie between, and P + Q is below FARTHEST."""

SLACK = 1.0000009536743164  # 1 + 2**-20


def single(alpha: float, gamma: float, b: float, d: float, x: float, y: float, z: float) -> tuple[float, ...]:
    """A, B, BB, P_plus_Q, c1, e1, c2, e2, delta_3, E of the program "single"."""
    u_8 = 1.776358533466145e-15  # 0x1.0000100000000p-49
    u_12 = 2.6645378001992175e-15  # 0x1.8000180000000p-49
    u_1536 = 3.4106083842549983e-13  # 0x1.8000180000000p-42
    alpha_over_b = alpha / b
    A = alpha_over_b * alpha_over_b
    gamma_over_d = gamma / d
    B = gamma_over_d * gamma_over_d
    AB = A * B
    c0 = -AB
    c0_plus_A = c0 + A
    C = c0_plus_A - B
    xx = x * x
    yy = y * y
    rr = xx + yy
    bb = b * b
    P = rr / bb
    z_over_d = z / d
    Q = z_over_d * z_over_d
    BP = B * P
    C_plus_BP = C + BP
    AQ = A * Q
    c1 = C_plus_BP - AQ
    A_minus_B = A - B
    K = A_minus_B + 1.0
    K_minus_P = K - P
    c2 = K_minus_P - Q
    c2_squared = c2 * c2
    three_c1 = 3.0 * c1
    h1 = c2_squared - three_c1
    c2c1 = c2 * c1
    nine_c0 = 9.0 * c0
    h2 = c2c1 - nine_c0
    c1_squared = c1 * c1
    c2c0 = c2 * c0
    three_c2c0 = 3.0 * c2c0
    h3 = c1_squared - three_c2c0
    h1h3 = h1 * h3
    h1h3_4 = 4.0 * h1h3
    h2_squared = h2 * h2
    delta_3 = h1h3_4 - h2_squared
    P_plus_Q = P + Q
    A_plus_B = A + B
    sizes_2 = A_plus_B + 1.0
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
    return A, B, BB, P_plus_Q, c1, e1, c2, e2, delta_3, E


def tangent_beyond(alpha: float, gamma: float, b: float, d: float, lambda_: float) -> tuple[float, ...]:
    """K_most, M_most, gap_least of the program "tangent-beyond"."""
    u_8 = 1.7763568394002505e-15  # 0x1.0000000000000p-49
    more = 1.000000000000007  # 0x1.0000000000020p+0
    p = alpha * alpha
    q = b * b
    q_lambda = q * lambda_
    across = p + q_lambda
    one_plus_lambda = 1.0 + lambda_
    product = across * one_plus_lambda
    K = product / lambda_
    K_most = more * K
    s = gamma * gamma
    t = d * d
    t_lambda = t * lambda_
    gap = s - t_lambda
    gap_terms = s + t_lambda
    gap_error = u_8 * gap_terms
    gap_least = gap - gap_error
    M = across / gap_least
    M_most = more * M
    return K_most, M_most, gap_least


def tangent_within(alpha: float, gamma: float, b: float, d: float, mu: float) -> tuple[float, ...]:
    """K_least, M_least, across_least of the program "tangent-within"."""
    u_8 = 1.7763568394002505e-15  # 0x1.0000000000000p-49
    less = 0.9999999999999929  # 0x1.fffffffffffc0p-1
    p = alpha * alpha
    q = b * b
    q_mu = q * mu
    across = p - q_mu
    across_terms = p + q_mu
    across_error = u_8 * across_terms
    across_least = across - across_error
    mu_minus_one = mu - 1.0
    product = across_least * mu_minus_one
    K = product / mu
    K_least = less * K
    s = gamma * gamma
    t = d * d
    t_mu = t * mu
    along = s + t_mu
    M = across_least / along
    M_least = less * M
    return K_least, M_least, across_least


def chord(K: float, M: float, T_0: float, R_0: float, T_1: float, R_1: float) -> tuple[bool, ...]:
    """below, above of the program "chord"."""
    more = 1.000000000000007  # 0x1.0000000000020p+0
    less = 0.9999999999999929  # 0x1.fffffffffffc0p-1
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
    return below, above
