"""The line stage and the certified stage over chunks of rows, in buffers that the caller keeps.

Printed by `python -m hypcheck.kernel.printing.modules`. Change the programs, not this.
"""

# ruff: noqa: PLR0915

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Singles = NDArray[np.float32]


PLANE_BUFFERS = (2, 0)
"""How many buffers of numbers and of truth values plane needs."""


def plane(
    x: Floats,
    y: Floats,
    z: Floats,
    numbers: Sequence[Singles],
) -> tuple[Singles, Singles]:
    """R, T of "plane"; they lie in the buffers."""
    n0, n1 = numbers
    np.copyto(n0, x, casting="same_kind")
    np.multiply(n0, n0, n0)  # xx = x * x
    np.copyto(n1, y, casting="same_kind")
    np.multiply(n1, n1, n1)  # yy = y * y
    np.add(n0, n1, n1)  # R = xx + yy
    np.copyto(n0, z, casting="same_kind")
    np.multiply(n0, n0, n0)  # T = z * z
    return n1, n0


PARALLEL_LINES_BUFFERS = (1, 4)
"""How many buffers of numbers and of truth values parallel_lines needs."""


def parallel_lines(
    R: Singles,
    T: Singles,
    constants: Mapping[str, float],
    numbers: Sequence[Singles],
    truths: Sequence[Mask],
) -> tuple[Mask, Mask, Mask]:
    """exterior, interior, decided of "parallel-lines"; they lie in the buffers."""
    M_outer = constants["M_outer"]
    K_beyond = constants["K_beyond"]
    K_under = constants["K_under"]
    M_inner = constants["M_inner"]
    K_within = constants["K_within"]
    K_above = constants["K_above"]
    (n0,) = numbers
    t0, t1, t2, t3 = truths
    np.multiply(M_outer, T, n0)  # rise_outer = M_outer * T
    np.subtract(R, n0, n0)  # outer = R - rise_outer
    np.greater(n0, K_beyond, t0)  # exterior = outer > K_beyond
    np.less(n0, K_under, t1)  # is_under = outer < K_under
    np.multiply(M_inner, T, n0)  # rise_inner = M_inner * T
    np.subtract(R, n0, n0)  # inner = R - rise_inner
    np.less(n0, K_within, t2)  # interior = inner < K_within
    np.greater_equal(n0, K_above, t3)  # is_above = inner >= K_above
    np.logical_and(t1, t3, t3)  # contact = is_under and is_above
    np.logical_or(t0, t2, t1)  # clear = exterior or interior
    np.logical_or(t1, t3, t3)  # decided = clear or contact
    return t0, t2, t3


TWO_LINES_BUFFERS = (4, 9)
"""How many buffers of numbers and of truth values two_lines needs."""


def two_lines(
    x: Floats,
    y: Floats,
    z: Floats,
    constants: Mapping[str, float],
    numbers: Sequence[Floats],
    truths: Sequence[Mask],
) -> tuple[Floats, Mask, Mask, Mask]:
    """R_plus_T, exterior, interior, decided of "two-lines"; they lie in the buffers."""
    reach = constants["reach"]
    K_beyond_1 = constants["K_beyond_1"]
    M_beyond_1 = constants["M_beyond_1"]
    K_beyond_2 = constants["K_beyond_2"]
    M_beyond_2 = constants["M_beyond_2"]
    K_within_1 = constants["K_within_1"]
    M_within_1 = constants["M_within_1"]
    K_within_2 = constants["K_within_2"]
    M_within_2 = constants["M_within_2"]
    K_under_1 = constants["K_under_1"]
    M_under_1 = constants["M_under_1"]
    K_under_2 = constants["K_under_2"]
    M_under_2 = constants["M_under_2"]
    K_above_1 = constants["K_above_1"]
    M_above_1 = constants["M_above_1"]
    K_above_2 = constants["K_above_2"]
    M_above_2 = constants["M_above_2"]
    n0, n1, n2, n3 = numbers
    t0, t1, t2, t3, t4, t5, t6, t7, t8 = truths
    np.multiply(x, x, n0)  # xx = x * x
    np.multiply(y, y, n1)  # yy = y * y
    np.add(n0, n1, n1)  # R = xx + yy
    np.multiply(z, z, n0)  # T = z * z
    np.add(n1, n0, n2)  # R_plus_T = R + T
    np.less_equal(n0, reach, t0)  # in_reach = T <= reach
    np.multiply(M_beyond_1, n0, n3)  # rise_beyond_1 = M_beyond_1 * T
    np.add(K_beyond_1, n3, n3)  # line_beyond_1 = K_beyond_1 + rise_beyond_1
    np.greater(n1, n3, t1)  # exterior_1 = R > line_beyond_1
    np.multiply(M_beyond_2, n0, n3)  # rise_beyond_2 = M_beyond_2 * T
    np.add(K_beyond_2, n3, n3)  # line_beyond_2 = K_beyond_2 + rise_beyond_2
    np.greater(n1, n3, t2)  # exterior_2 = R > line_beyond_2
    np.multiply(M_within_1, n0, n3)  # rise_within_1 = M_within_1 * T
    np.add(K_within_1, n3, n3)  # line_within_1 = K_within_1 + rise_within_1
    np.less(n1, n3, t3)  # interior_1 = R < line_within_1
    np.multiply(M_within_2, n0, n3)  # rise_within_2 = M_within_2 * T
    np.add(K_within_2, n3, n3)  # line_within_2 = K_within_2 + rise_within_2
    np.less(n1, n3, t4)  # interior_2 = R < line_within_2
    np.multiply(M_under_1, n0, n3)  # rise_under_1 = M_under_1 * T
    np.add(K_under_1, n3, n3)  # line_under_1 = K_under_1 + rise_under_1
    np.less(n1, n3, t5)  # is_under_1 = R < line_under_1
    np.multiply(M_under_2, n0, n3)  # rise_under_2 = M_under_2 * T
    np.add(K_under_2, n3, n3)  # line_under_2 = K_under_2 + rise_under_2
    np.less(n1, n3, t6)  # is_under_2 = R < line_under_2
    np.multiply(M_above_1, n0, n3)  # rise_above_1 = M_above_1 * T
    np.add(K_above_1, n3, n3)  # line_above_1 = K_above_1 + rise_above_1
    np.greater_equal(n1, n3, t7)  # is_above_1 = R >= line_above_1
    np.multiply(M_above_2, n0, n0)  # rise_above_2 = M_above_2 * T
    np.add(K_above_2, n0, n0)  # line_above_2 = K_above_2 + rise_above_2
    np.greater_equal(n1, n0, t8)  # is_above_2 = R >= line_above_2
    np.logical_or(t1, t2, t2)  # exterior = exterior_1 or exterior_2
    np.logical_or(t3, t4, t4)  # interior = interior_1 or interior_2
    np.logical_and(t5, t6, t6)  # is_under = is_under_1 and is_under_2
    np.logical_and(t7, t8, t8)  # is_above = is_above_1 and is_above_2
    np.logical_and(t6, t8, t8)  # contact_in_reach = is_under and is_above
    np.logical_and(t8, t0, t0)  # contact = contact_in_reach and in_reach
    np.logical_or(t2, t4, t8)  # clear = exterior or interior
    np.logical_or(t8, t0, t0)  # decided = clear or contact
    return n2, t2, t4, t0


CERTIFIED_BUFFERS = (19, 15)
"""How many buffers of numbers and of truth values certified needs."""


def certified(
    alpha: Floats,
    gamma: Floats,
    b: Floats,
    d: Floats,
    x: Floats,
    y: Floats,
    z: Floats,
    constants: Mapping[str, float],
    numbers: Sequence[Floats],
    truths: Sequence[Mask],
) -> tuple[Mask, Mask, Mask]:
    """exterior, interior, decided of "certified"; they lie in the buffers."""
    u_4 = constants["u_4"]
    u_8 = constants["u_8"]
    u_12 = constants["u_12"]
    u_16 = constants["u_16"]
    slack = constants["slack"]
    least = constants["least"]
    greatest = constants["greatest"]
    farthest = constants["farthest"]
    n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12, n13, n14, n15, n16, n17, n18 = numbers
    t0, t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14 = truths
    np.divide(alpha, b, n0)  # alpha_over_b = alpha / b
    np.multiply(n0, n0, n0)  # A = alpha_over_b * alpha_over_b
    np.divide(gamma, d, n1)  # gamma_over_d = gamma / d
    np.multiply(n1, n1, n1)  # B = gamma_over_d * gamma_over_d
    np.multiply(n0, n1, n2)  # AB = A * B
    np.negative(n2, n3)  # c0 = - AB
    np.add(n3, n0, n4)  # c0_plus_A = c0 + A
    np.subtract(n4, n1, n4)  # C = c0_plus_A - B
    np.multiply(x, x, n5)  # xx = x * x
    np.multiply(y, y, n6)  # yy = y * y
    np.add(n5, n6, n6)  # rr = xx + yy
    np.multiply(b, b, n5)  # bb = b * b
    np.divide(n6, n5, n5)  # P = rr / bb
    np.divide(z, d, n6)  # z_over_d = z / d
    np.multiply(n6, n6, n6)  # Q = z_over_d * z_over_d
    np.multiply(n1, n5, n7)  # BP = B * P
    np.add(n4, n7, n4)  # C_plus_BP = C + BP
    np.multiply(n0, n6, n8)  # AQ = A * Q
    np.subtract(n4, n8, n4)  # c1 = C_plus_BP - AQ
    np.subtract(n0, n1, n9)  # A_minus_B = A - B
    np.add(n9, 1.0, n9)  # K = A_minus_B + 1
    np.subtract(n9, n5, n9)  # K_minus_P = K - P
    np.subtract(n9, n6, n9)  # c2 = K_minus_P - Q
    np.multiply(n9, n9, n10)  # c2_squared = c2 * c2
    np.multiply(3.0, n4, n11)  # three_c1 = 3 * c1
    np.subtract(n10, n11, n11)  # h1 = c2_squared - three_c1
    np.multiply(n9, n4, n10)  # c2c1 = c2 * c1
    np.multiply(9.0, n3, n12)  # nine_c0 = 9 * c0
    np.subtract(n10, n12, n12)  # h2 = c2c1 - nine_c0
    np.multiply(n4, n4, n10)  # c1_squared = c1 * c1
    np.multiply(n9, n3, n3)  # c2c0 = c2 * c0
    np.multiply(3.0, n3, n3)  # three_c2c0 = 3 * c2c0
    np.subtract(n10, n3, n3)  # h3 = c1_squared - three_c2c0
    np.multiply(n11, n3, n10)  # h1h3 = h1 * h3
    np.multiply(4.0, n10, n10)  # h1h3_4 = 4 * h1h3
    np.multiply(n12, n12, n13)  # h2_squared = h2 * h2
    np.subtract(n10, n13, n13)  # delta_3 = h1h3_4 - h2_squared
    np.greater(alpha, 0.0, t0)  # alpha_usable = alpha > 0
    np.greater(gamma, 0.0, t1)  # gamma_usable = gamma > 0
    np.greater(b, least, t2)  # b_not_small = b > least
    np.less(b, greatest, t3)  # b_not_large = b < greatest
    np.greater(d, least, t4)  # d_not_small = d > least
    np.less(d, greatest, t5)  # d_not_large = d < greatest
    np.greater(n0, least, t6)  # A_not_small = A > least
    np.less(n0, greatest, t7)  # A_not_large = A < greatest
    np.greater(n1, least, t8)  # B_not_small = B > least
    np.less(n1, greatest, t9)  # B_not_large = B < greatest
    np.add(n5, n6, n6)  # P_plus_Q = P + Q
    np.less(n6, farthest, t10)  # not_too_far = P_plus_Q < farthest
    np.logical_and(t0, t1, t1)  # positive_radial = alpha_usable and gamma_usable
    np.logical_and(t2, t3, t3)  # b_usable = b_not_small and b_not_large
    np.logical_and(t4, t5, t5)  # d_usable = d_not_small and d_not_large
    np.logical_and(t6, t7, t7)  # A_usable = A_not_small and A_not_large
    np.logical_and(t8, t9, t9)  # B_usable = B_not_small and B_not_large
    np.logical_and(t3, t7, t7)  # radial_usable = b_usable and A_usable
    np.logical_and(t5, t9, t9)  # axial_usable = d_usable and B_usable
    np.logical_and(t7, t9, t9)  # ratios_usable = radial_usable and axial_usable
    np.logical_and(t1, t9, t9)  # sizes_usable = positive_radial and ratios_usable
    np.logical_and(t9, t10, t10)  # usable = sizes_usable and not_too_far
    np.add(n0, n1, n5)  # A_plus_B = A + B
    np.add(n5, n2, n10)  # sizes_1 = A_plus_B + AB
    np.add(n7, n8, n8)  # BP_plus_AQ = BP + AQ
    np.add(n10, n8, n8)  # terms_1 = sizes_1 + BP_plus_AQ
    np.add(n5, 1.0, n5)  # sizes_2 = A_plus_B + 1
    np.add(n5, n6, n6)  # terms_2 = sizes_2 + P_plus_Q
    np.multiply(u_12, n8, n8)  # e1 = u_12 * terms_1
    np.multiply(u_8, n6, n6)  # e2 = u_8 * terms_2
    np.multiply(u_8, n2, n5)  # e0 = u_8 * AB
    np.add(n2, n5, n2)  # m0 = AB + e0
    np.absolute(n4, n10)  # size_c1 = abs c1
    np.add(n10, n8, n10)  # m1 = size_c1 + e1
    np.absolute(n9, n7)  # size_c2 = abs c2
    np.add(n7, n6, n7)  # m2 = size_c2 + e2
    np.multiply(u_4, n2, n14)  # u_m0 = u_4 * m0
    np.add(n5, n14, n14)  # f0 = e0 + u_m0
    np.multiply(u_4, n10, n5)  # u_m1 = u_4 * m1
    np.add(n8, n5, n15)  # f1 = e1 + u_m1
    np.multiply(u_4, n7, n16)  # u_m2 = u_4 * m2
    np.multiply(2.0, n6, n17)  # twice_e2 = 2 * e2
    np.add(n17, n16, n16)  # f2 = twice_e2 + u_m2
    np.multiply(n7, n16, n16)  # m2_f2 = m2 * f2
    np.multiply(3.0, n15, n18)  # thrice_f1 = 3 * f1
    np.add(n16, n18, n18)  # E1 = m2_f2 + thrice_f1
    np.multiply(n7, n15, n15)  # m2_f1 = m2 * f1
    np.multiply(n10, n6, n16)  # m1_e2 = m1 * e2
    np.add(n15, n16, n16)  # cross_21 = m2_f1 + m1_e2
    np.multiply(9.0, n14, n15)  # ninefold_f0 = 9 * f0
    np.add(n16, n15, n15)  # E2 = cross_21 + ninefold_f0
    np.multiply(2.0, n8, n16)  # twice_e1 = 2 * e1
    np.add(n16, n5, n5)  # f3 = twice_e1 + u_m1
    np.multiply(n10, n5, n5)  # m1_f3 = m1 * f3
    np.multiply(n7, n14, n14)  # m2_f0 = m2 * f0
    np.multiply(n2, n6, n2)  # m0_e2 = m0 * e2
    np.add(n14, n2, n2)  # cross_20 = m2_f0 + m0_e2
    np.multiply(3.0, n2, n2)  # thrice_cross_20 = 3 * cross_20
    np.add(n5, n2, n2)  # E3 = m1_f3 + thrice_cross_20
    np.absolute(n11, n11)  # size_h1 = abs h1
    np.add(n11, n18, n11)  # a1 = size_h1 + E1
    np.absolute(n12, n12)  # size_h2 = abs h2
    np.add(n12, n15, n12)  # a2 = size_h2 + E2
    np.absolute(n3, n3)  # size_h3 = abs h3
    np.add(n3, n2, n3)  # a3 = size_h3 + E3
    np.multiply(u_4, n3, n5)  # u_a3 = u_4 * a3
    np.add(n2, n5, n5)  # F3 = E3 + u_a3
    np.multiply(n11, n5, n5)  # a1_F3 = a1 * F3
    np.multiply(n3, n18, n18)  # a3_E1 = a3 * E1
    np.add(n5, n18, n18)  # cross_13 = a1_F3 + a3_E1
    np.multiply(4.0, n18, n18)  # fourfold_cross_13 = 4 * cross_13
    np.multiply(u_4, n12, n5)  # u_a2 = u_4 * a2
    np.multiply(2.0, n15, n15)  # twice_E2 = 2 * E2
    np.add(n15, n5, n5)  # F2 = twice_E2 + u_a2
    np.multiply(n12, n5, n5)  # a2_F2 = a2 * F2
    np.add(n18, n5, n5)  # E_sum = fourfold_cross_13 + a2_F2
    np.multiply(slack, n5, n5)  # E = slack * E_sum
    np.negative(n5, n18)  # minus_E = - E
    np.multiply(2.0, n9, n12)  # two_c2 = 2 * c2
    np.multiply(2.0, n7, n15)  # twice_m2 = 2 * m2
    np.multiply(3.0, n1, n3)  # thrice_B = 3 * B
    np.add(n3, n12, n11)  # chord_B = thrice_B + two_c2
    np.multiply(n11, n1, n11)  # rise_B = chord_B * B
    np.add(n11, n4, n11)  # slope_B = rise_B + c1
    np.add(n3, n9, n2)  # offset_B = thrice_B + c2
    np.add(n3, n15, n3)  # size_chord_B = thrice_B + twice_m2
    np.multiply(n3, n1, n3)  # size_rise_B = size_chord_B * B
    np.add(n3, n10, n3)  # size_slope_B = size_rise_B + m1
    np.multiply(u_16, n3, n3)  # u_slope_B = u_16 * size_slope_B
    np.multiply(n17, n1, n14)  # carried_B = twice_e2 * B
    np.add(n14, n8, n14)  # carried_1_B = carried_B + e1
    np.add(n14, n3, n3)  # error_B = carried_1_B + u_slope_B
    np.multiply(slack, n3, n3)  # bound_B = slack * error_B
    np.negative(n3, n14)  # below_B = - bound_B
    np.add(n1, n7, n1)  # size_offset_B = B + m2
    np.multiply(u_16, n1, n1)  # u_offset_B = u_16 * size_offset_B
    np.add(n6, n1, n1)  # offset_error_B = e2 + u_offset_B
    np.multiply(slack, n1, n1)  # offset_bound_B = slack * offset_error_B
    np.negative(n1, n16)  # offset_below_B = - offset_bound_B
    np.greater(n11, n3, t9)  # rises_B = slope_B > bound_B
    np.less(n11, n14, t1)  # falls_B = slope_B < below_B
    np.greater(n2, n1, t7)  # inflection_inside_B = offset_B > offset_bound_B
    np.less(n2, n16, t5)  # inflection_beyond_B = offset_B < offset_below_B
    np.multiply(3.0, n0, n16)  # thrice_A = 3 * A
    np.subtract(n16, n12, n12)  # chord_A = thrice_A - two_c2
    np.multiply(n12, n0, n12)  # rise_A = chord_A * A
    np.add(n12, n4, n12)  # slope_A = rise_A + c1
    np.subtract(n16, n9, n2)  # offset_A = thrice_A - c2
    np.add(n16, n15, n15)  # size_chord_A = thrice_A + twice_m2
    np.multiply(n15, n0, n15)  # size_rise_A = size_chord_A * A
    np.add(n15, n10, n10)  # size_slope_A = size_rise_A + m1
    np.multiply(u_16, n10, n10)  # u_slope_A = u_16 * size_slope_A
    np.multiply(n17, n0, n17)  # carried_A = twice_e2 * A
    np.add(n17, n8, n17)  # carried_1_A = carried_A + e1
    np.add(n17, n10, n10)  # error_A = carried_1_A + u_slope_A
    np.multiply(slack, n10, n10)  # bound_A = slack * error_A
    np.negative(n10, n17)  # below_A = - bound_A
    np.add(n0, n7, n7)  # size_offset_A = A + m2
    np.multiply(u_16, n7, n7)  # u_offset_A = u_16 * size_offset_A
    np.add(n6, n7, n7)  # offset_error_A = e2 + u_offset_A
    np.multiply(slack, n7, n7)  # offset_bound_A = slack * offset_error_A
    np.negative(n7, n0)  # offset_below_A = - offset_bound_A
    np.greater(n12, n10, t3)  # rises_A = slope_A > bound_A
    np.less(n12, n17, t8)  # falls_A = slope_A < below_A
    np.greater(n2, n7, t6)  # inflection_inside_A = offset_A > offset_bound_A
    np.less(n2, n0, t4)  # inflection_beyond_A = offset_A < offset_below_A
    np.negative(n8, n0)  # minus_e1 = - e1
    np.negative(n6, n2)  # minus_e2 = - e2
    np.greater(n13, n5, t2)  # distinct = delta_3 > E
    np.less(n13, n18, t0)  # one_root = delta_3 < minus_E
    np.greater(n4, n8, t11)  # c1_positive = c1 > e1
    np.less(n4, n0, t12)  # c1_negative = c1 < minus_e1
    np.greater(n9, n6, t13)  # c2_positive = c2 > e2
    np.less(n9, n2, t14)  # c2_negative = c2 < minus_e2
    np.logical_and(t2, t10, t2)  # three_roots = distinct and usable
    np.logical_and(t14, t11, t11)  # falling_then_rising = c2_negative and c1_positive
    np.logical_and(t2, t11, t11)  # all_positive = three_roots and falling_then_rising
    np.logical_or(t13, t12, t12)  # some_sign_differs = c2_positive or c1_negative
    np.logical_and(t2, t12, t12)  # two_negative = three_roots and some_sign_differs
    np.logical_or(t7, t1, t1)  # some_below_B = inflection_inside_B or falls_B
    np.logical_and(t5, t9, t9)  # none_below_B = inflection_beyond_B and rises_B
    np.logical_and(t6, t3, t3)  # both_above_A = inflection_inside_A and rises_A
    np.logical_or(t4, t8, t8)  # none_above_A = inflection_beyond_A or falls_A
    np.logical_and(t11, t1, t1)  # exterior = all_positive and some_below_B
    np.logical_and(t12, t3, t3)  # interior = two_negative and both_above_A
    np.logical_and(t0, t10, t10)  # crossing = one_root and usable
    np.logical_and(t11, t9, t9)  # groove = all_positive and none_below_B
    np.logical_and(t12, t8, t8)  # throat = two_negative and none_above_A
    np.logical_or(t9, t8, t8)  # several_curves = groove or throat
    np.logical_or(t10, t8, t8)  # contact = crossing or several_curves
    np.logical_or(t1, t3, t10)  # clear = exterior or interior
    np.logical_or(t10, t8, t8)  # decided = clear or contact
    return t1, t3, t8
