"""The stage of tilted rows over chunks, in buffers that the caller keeps.

Printed by `python -m hypcheck.kernel.printing.modules`. Change the programs, not this.
"""

# ruff: noqa: E741, PLR0915

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


TILTED_FORM_BUFFERS = (14, 0)
"""How many buffers of numbers and of truth values tilted_form needs."""


def tilted_form(
    alpha: Floats,
    gamma: Floats,
    b: Floats,
    d: Floats,
    x: Floats,
    y: Floats,
    z: Floats,
    axis_x: Floats,
    axis_y: Floats,
    axis_z: Floats,
    numbers: Sequence[Floats],
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats, Floats]:
    """p, s, t, k0, k1, m, radius, height, cross_squared, level of "tilted-values"; they lie in the buffers."""
    n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12, n13 = numbers
    np.divide(1.0, b, n0)  # r = 1 / b
    np.multiply(alpha, n0, n1)  # alpha_r = alpha * r
    np.multiply(n1, n1, n1)  # p = alpha_r * alpha_r
    np.multiply(gamma, n0, n2)  # gamma_r = gamma * r
    np.multiply(n2, n2, n2)  # s = gamma_r * gamma_r
    np.multiply(d, n0, n3)  # d_r = d * r
    np.multiply(n3, n3, n3)  # t = d_r * d_r
    np.multiply(x, n0, n4)  # x_r = x * r
    np.multiply(y, n0, n5)  # y_r = y * r
    np.multiply(z, n0, n0)  # z_r = z * r
    np.multiply(axis_x, axis_x, n6)  # axis_xx = axis_x * axis_x
    np.multiply(axis_y, axis_y, n7)  # axis_yy = axis_y * axis_y
    np.add(n6, n7, n7)  # level = axis_xx + axis_yy
    np.multiply(axis_z, axis_z, n6)  # upward = axis_z * axis_z
    np.add(n7, n6, n8)  # w = level + upward
    np.divide(n7, n8, n9)  # h = level / w
    np.divide(n6, n8, n6)  # c = upward / w
    np.multiply(axis_x, n5, n10)  # x_y = axis_x * y_r
    np.multiply(axis_y, n4, n11)  # y_x = axis_y * x_r
    np.subtract(n10, n11, n11)  # cross = x_y - y_x
    np.multiply(axis_x, n4, n10)  # x_x = axis_x * x_r
    np.multiply(axis_y, n5, n12)  # y_y = axis_y * y_r
    np.multiply(axis_z, n0, n13)  # z_z = axis_z * z_r
    np.add(n10, n12, n12)  # along_level = x_x + y_y
    np.add(n12, n13, n13)  # along_axis = along_level + z_z
    np.multiply(n11, n11, n11)  # cross_squared = cross * cross
    np.multiply(n13, n13, n13)  # axis_squared = along_axis * along_axis
    np.divide(n13, n8, n8)  # axis_part = axis_squared / w
    np.multiply(n4, n4, n4)  # xx = x_r * x_r
    np.multiply(n5, n5, n5)  # yy = y_r * y_r
    np.add(n4, n5, n5)  # radius = xx + yy
    np.multiply(n0, n0, n0)  # height = z_r * z_r
    np.add(n5, n0, n4)  # distance = radius + height
    np.subtract(n3, 1.0, n13)  # t_1 = t - 1
    np.multiply(n3, n4, n4)  # t_distance = t * distance
    np.multiply(n13, n8, n8)  # t_1_axis = t_1 * axis_part
    np.subtract(n4, n8, n8)  # m = t_distance - t_1_axis
    np.multiply(n1, n2, n4)  # k0 = p * s
    np.multiply(n3, n9, n13)  # t_h = t * h
    np.add(n13, n6, n13)  # along = t_h + c
    np.multiply(n3, n6, n6)  # t_c = t * c
    np.add(n6, n9, n9)  # across = t_c + h
    np.multiply(n2, n13, n13)  # s_along = s * along
    np.multiply(n1, n9, n9)  # p_across = p * across
    np.subtract(n13, n9, n9)  # k1 = s_along - p_across
    return n1, n2, n3, n4, n9, n8, n5, n0, n11, n7


TILTED_BUFFERS = (26, 15)
"""How many buffers of numbers and of truth values tilted needs."""


def tilted(
    alpha: Floats,
    gamma: Floats,
    b: Floats,
    d: Floats,
    x: Floats,
    y: Floats,
    z: Floats,
    axis_x: Floats,
    axis_y: Floats,
    axis_z: Floats,
    l: Floats,
    constants: Mapping[str, float],
    numbers: Sequence[Floats],
    truths: Sequence[Mask],
) -> tuple[Mask, Mask, Mask]:
    """exterior, interior, decided of "tilted"; they lie in the buffers."""
    u_p_l = constants["u_p_l"]
    u_k = constants["u_k"]
    u_d_l = constants["u_d_l"]
    u_F = constants["u_F"]
    u_psi = constants["u_psi"]
    less_sure = constants["less_sure"]
    least_b = constants["least_b"]
    greatest_b = constants["greatest_b"]
    least_square = constants["least_square"]
    greatest_square = constants["greatest_square"]
    farthest_square = constants["farthest_square"]
    least_axis = constants["least_axis"]
    greatest_axis = constants["greatest_axis"]
    greatest_l = constants["greatest_l"]
    n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12, n13, n14, n15, n16, n17, n18, n19 = numbers[0:20]
    n20, n21, n22, n23, n24, n25 = numbers[20:26]
    t0, t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13, t14 = truths
    np.divide(1.0, b, n0)  # r = 1 / b
    np.multiply(alpha, n0, n1)  # alpha_r = alpha * r
    np.multiply(n1, n1, n1)  # p = alpha_r * alpha_r
    np.multiply(gamma, n0, n2)  # gamma_r = gamma * r
    np.multiply(n2, n2, n2)  # s = gamma_r * gamma_r
    np.multiply(d, n0, n3)  # d_r = d * r
    np.multiply(n3, n3, n3)  # t = d_r * d_r
    np.multiply(x, n0, n4)  # x_r = x * r
    np.multiply(y, n0, n5)  # y_r = y * r
    np.multiply(z, n0, n0)  # z_r = z * r
    np.multiply(axis_x, axis_x, n6)  # axis_xx = axis_x * axis_x
    np.multiply(axis_y, axis_y, n7)  # axis_yy = axis_y * axis_y
    np.add(n6, n7, n7)  # level = axis_xx + axis_yy
    np.multiply(axis_z, axis_z, n6)  # upward = axis_z * axis_z
    np.add(n7, n6, n8)  # w = level + upward
    np.divide(n7, n8, n7)  # h = level / w
    np.divide(n6, n8, n6)  # c = upward / w
    np.multiply(axis_x, n5, n9)  # x_y = axis_x * y_r
    np.multiply(axis_y, n4, n10)  # y_x = axis_y * x_r
    np.subtract(n9, n10, n10)  # cross = x_y - y_x
    np.multiply(axis_x, n4, n9)  # x_x = axis_x * x_r
    np.multiply(axis_y, n5, n11)  # y_y = axis_y * y_r
    np.multiply(axis_z, n0, n12)  # z_z = axis_z * z_r
    np.add(n9, n11, n11)  # along_level = x_x + y_y
    np.add(n11, n12, n12)  # along_axis = along_level + z_z
    np.multiply(n10, n10, n10)  # cross_squared = cross * cross
    np.divide(n10, n8, n10)  # cross_part = cross_squared / w
    np.multiply(n12, n12, n12)  # axis_squared = along_axis * along_axis
    np.divide(n12, n8, n12)  # axis_part = axis_squared / w
    np.multiply(n4, n4, n4)  # xx = x_r * x_r
    np.multiply(n5, n5, n5)  # yy = y_r * y_r
    np.add(n4, n5, n5)  # radius = xx + yy
    np.multiply(n0, n0, n0)  # height = z_r * z_r
    np.add(n5, n0, n4)  # distance = radius + height
    np.subtract(n3, 1.0, n11)  # t_1 = t - 1
    np.add(n2, n1, n9)  # s_p = s + p
    np.multiply(n11, n9, n9)  # t_1_s_p = t_1 * s_p
    np.multiply(n9, n10, n10)  # E = t_1_s_p * cross_part
    np.multiply(n2, n5, n5)  # s_radius = s * radius
    np.multiply(n1, n0, n0)  # p_height = p * height
    np.subtract(n5, n0, n0)  # G = s_radius - p_height
    np.multiply(n3, n4, n5)  # t_distance = t * distance
    np.multiply(n11, n12, n12)  # t_1_axis = t_1 * axis_part
    np.subtract(n5, n12, n12)  # m = t_distance - t_1_axis
    np.multiply(n1, n2, n5)  # k0 = p * s
    np.multiply(n3, n7, n11)  # t_h = t * h
    np.add(n11, n6, n11)  # along = t_h + c
    np.multiply(n3, n6, n6)  # t_c = t * c
    np.add(n6, n7, n7)  # across = t_c + h
    np.multiply(n2, n11, n11)  # s_along = s * along
    np.multiply(n1, n7, n7)  # p_across = p * across
    np.subtract(n11, n7, n7)  # k1 = s_along - p_across
    np.add(n1, l, n6)  # p_l = p + l
    np.multiply(n3, l, n9)  # t_l = t * l
    np.subtract(n7, n9, n7)  # k1_tl = k1 - t_l
    np.multiply(n7, l, n13)  # k1_tl_l = k1_tl * l
    np.add(n5, n13, n13)  # k = k0 + k1_tl_l
    np.multiply(n12, l, n5)  # m_l = m * l
    np.subtract(n0, n5, n5)  # g = G - m_l
    np.multiply(n10, l, n0)  # E_l = E * l
    np.multiply(n6, n5, n14)  # p_l_g = p_l * g
    np.add(n0, n14, n14)  # N = E_l + p_l_g
    np.multiply(l, n14, n0)  # l_N = l * N
    np.multiply(n6, n13, n15)  # d_l = p_l * k
    np.add(1.0, l, n16)  # one_l = 1 + l
    np.multiply(n16, n15, n16)  # one_l_d = one_l * d_l
    np.subtract(n0, n16, n16)  # F = l_N - one_l_d
    np.multiply(n6, n12, n12)  # p_l_m = p_l * m
    np.add(n10, n5, n5)  # E_g = E + g
    np.subtract(n5, n12, n12)  # N_slope = E_g - p_l_m
    np.subtract(n7, n9, n9)  # k_slope = k1_tl - t_l
    np.multiply(n6, n9, n9)  # p_l_k_slope = p_l * k_slope
    np.add(n13, n9, n9)  # d_slope = k + p_l_k_slope
    np.multiply(l, n12, n12)  # l_N_slope = l * N_slope
    np.add(n14, n12, n12)  # N_both = N + l_N_slope
    np.subtract(n12, n15, n12)  # N_both_d = N_both - d_l
    np.multiply(n15, n12, n12)  # gain = d_l * N_both_d
    np.multiply(n0, n9, n9)  # loss = l_N * d_slope
    np.subtract(n12, n9, n9)  # psi = gain - loss
    np.absolute(x, n12)  # magnitude_x = abs x
    np.absolute(y, n0)  # magnitude_y = abs y
    np.absolute(z, n14)  # magnitude_z = abs z
    np.absolute(axis_x, n7)  # magnitude_axis_x = abs axis_x
    np.absolute(axis_y, n5)  # magnitude_axis_y = abs axis_y
    np.absolute(axis_z, n10)  # magnitude_axis_z = abs axis_z
    np.absolute(l, n17)  # magnitude_l = abs l
    np.divide(1.0, b, n18)  # magnitude_r = 1 / b
    np.multiply(alpha, n18, n19)  # magnitude_alpha_r = alpha * magnitude_r
    np.multiply(n19, n19, n19)  # magnitude_p = magnitude_alpha_r * magnitude_alpha_r
    np.multiply(gamma, n18, n20)  # magnitude_gamma_r = gamma * magnitude_r
    np.multiply(n20, n20, n20)  # magnitude_s = magnitude_gamma_r * magnitude_gamma_r
    np.multiply(d, n18, n21)  # magnitude_d_r = d * magnitude_r
    np.multiply(n21, n21, n21)  # magnitude_t = magnitude_d_r * magnitude_d_r
    np.multiply(n12, n18, n12)  # magnitude_x_r = magnitude_x * magnitude_r
    np.multiply(n0, n18, n0)  # magnitude_y_r = magnitude_y * magnitude_r
    np.multiply(n14, n18, n18)  # magnitude_z_r = magnitude_z * magnitude_r
    np.multiply(n7, n7, n14)  # magnitude_axis_xx = magnitude_axis_x * magnitude_axis_x
    np.multiply(n5, n5, n22)  # magnitude_axis_yy = magnitude_axis_y * magnitude_axis_y
    np.add(n14, n22, n22)  # magnitude_level = magnitude_axis_xx + magnitude_axis_yy
    np.multiply(n10, n10, n14)  # magnitude_upward = magnitude_axis_z * magnitude_axis_z
    np.add(n22, n14, n23)  # magnitude_w = magnitude_level + magnitude_upward
    np.divide(n22, n23, n22)  # magnitude_h = magnitude_level / magnitude_w
    np.divide(n14, n23, n14)  # magnitude_c = magnitude_upward / magnitude_w
    np.multiply(n7, n0, n24)  # magnitude_x_y = magnitude_axis_x * magnitude_y_r
    np.multiply(n5, n12, n25)  # magnitude_y_x = magnitude_axis_y * magnitude_x_r
    np.add(n24, n25, n25)  # magnitude_cross = magnitude_x_y + magnitude_y_x
    np.multiply(n7, n12, n7)  # magnitude_x_x = magnitude_axis_x * magnitude_x_r
    np.multiply(n5, n0, n5)  # magnitude_y_y = magnitude_axis_y * magnitude_y_r
    np.multiply(n10, n18, n10)  # magnitude_z_z = magnitude_axis_z * magnitude_z_r
    np.add(n7, n5, n5)  # magnitude_along_level = magnitude_x_x + magnitude_y_y
    np.add(n5, n10, n10)  # magnitude_along_axis = magnitude_along_level + magnitude_z_z
    np.multiply(n25, n25, n25)  # magnitude_cross_squared = magnitude_cross * magnitude_cross
    np.divide(n25, n23, n25)  # magnitude_cross_part = magnitude_cross_squared / magnitude_w
    np.multiply(n10, n10, n10)  # magnitude_axis_squared = magnitude_along_axis * magnitude_along_axis
    np.divide(n10, n23, n23)  # magnitude_axis_part = magnitude_axis_squared / magnitude_w
    np.multiply(n12, n12, n12)  # magnitude_xx = magnitude_x_r * magnitude_x_r
    np.multiply(n0, n0, n0)  # magnitude_yy = magnitude_y_r * magnitude_y_r
    np.add(n12, n0, n0)  # magnitude_radius = magnitude_xx + magnitude_yy
    np.multiply(n18, n18, n18)  # magnitude_height = magnitude_z_r * magnitude_z_r
    np.add(n0, n18, n12)  # magnitude_distance = magnitude_radius + magnitude_height
    np.add(n21, 1.0, n10)  # magnitude_t_1 = magnitude_t + 1
    np.add(n20, n19, n5)  # magnitude_s_p = magnitude_s + magnitude_p
    np.multiply(n10, n5, n5)  # magnitude_t_1_s_p = magnitude_t_1 * magnitude_s_p
    np.multiply(n5, n25, n25)  # magnitude_E = magnitude_t_1_s_p * magnitude_cross_part
    np.multiply(n20, n0, n0)  # magnitude_s_radius = magnitude_s * magnitude_radius
    np.multiply(n19, n18, n18)  # magnitude_p_height = magnitude_p * magnitude_height
    np.add(n0, n18, n18)  # magnitude_G = magnitude_s_radius + magnitude_p_height
    np.multiply(n21, n12, n12)  # magnitude_t_distance = magnitude_t * magnitude_distance
    np.multiply(n10, n23, n23)  # magnitude_t_1_axis = magnitude_t_1 * magnitude_axis_part
    np.add(n12, n23, n23)  # magnitude_m = magnitude_t_distance + magnitude_t_1_axis
    np.multiply(n19, n20, n12)  # magnitude_k0 = magnitude_p * magnitude_s
    np.multiply(n21, n22, n10)  # magnitude_t_h = magnitude_t * magnitude_h
    np.add(n10, n14, n10)  # magnitude_along = magnitude_t_h + magnitude_c
    np.multiply(n21, n14, n14)  # magnitude_t_c = magnitude_t * magnitude_c
    np.add(n14, n22, n22)  # magnitude_across = magnitude_t_c + magnitude_h
    np.multiply(n20, n10, n10)  # magnitude_s_along = magnitude_s * magnitude_along
    np.multiply(n19, n22, n22)  # magnitude_p_across = magnitude_p * magnitude_across
    np.add(n10, n22, n22)  # magnitude_k1 = magnitude_s_along + magnitude_p_across
    np.add(n19, n17, n19)  # magnitude_p_l = magnitude_p + magnitude_l
    np.multiply(n21, n17, n21)  # magnitude_t_l = magnitude_t * magnitude_l
    np.add(n22, n21, n22)  # magnitude_k1_tl = magnitude_k1 + magnitude_t_l
    np.multiply(n22, n17, n10)  # magnitude_k1_tl_l = magnitude_k1_tl * magnitude_l
    np.add(n12, n10, n10)  # magnitude_k = magnitude_k0 + magnitude_k1_tl_l
    np.multiply(n23, n17, n12)  # magnitude_m_l = magnitude_m * magnitude_l
    np.add(n18, n12, n12)  # magnitude_g = magnitude_G + magnitude_m_l
    np.multiply(n25, n17, n18)  # magnitude_E_l = magnitude_E * magnitude_l
    np.multiply(n19, n12, n20)  # magnitude_p_l_g = magnitude_p_l * magnitude_g
    np.add(n18, n20, n20)  # magnitude_N = magnitude_E_l + magnitude_p_l_g
    np.multiply(n17, n20, n18)  # magnitude_l_N = magnitude_l * magnitude_N
    np.multiply(n19, n10, n14)  # magnitude_d_l = magnitude_p_l * magnitude_k
    np.add(1.0, n17, n0)  # magnitude_one_l = 1 + magnitude_l
    np.multiply(n0, n14, n0)  # magnitude_one_l_d = magnitude_one_l * magnitude_d_l
    np.add(n18, n0, n0)  # magnitude_F = magnitude_l_N + magnitude_one_l_d
    np.multiply(n19, n23, n23)  # magnitude_p_l_m = magnitude_p_l * magnitude_m
    np.add(n25, n12, n12)  # magnitude_E_g = magnitude_E + magnitude_g
    np.add(n12, n23, n23)  # magnitude_N_slope = magnitude_E_g + magnitude_p_l_m
    np.add(n22, n21, n21)  # magnitude_k_slope = magnitude_k1_tl + magnitude_t_l
    np.multiply(n19, n21, n21)  # magnitude_p_l_k_slope = magnitude_p_l * magnitude_k_slope
    np.add(n10, n21, n21)  # magnitude_d_slope = magnitude_k + magnitude_p_l_k_slope
    np.multiply(n17, n23, n23)  # magnitude_l_N_slope = magnitude_l * magnitude_N_slope
    np.add(n20, n23, n23)  # magnitude_N_both = magnitude_N + magnitude_l_N_slope
    np.add(n23, n14, n23)  # magnitude_N_both_d = magnitude_N_both + magnitude_d_l
    np.multiply(n14, n23, n23)  # magnitude_gain = magnitude_d_l * magnitude_N_both_d
    np.multiply(n18, n21, n21)  # magnitude_loss = magnitude_l_N * magnitude_d_slope
    np.add(n23, n21, n21)  # magnitude_psi = magnitude_gain + magnitude_loss
    np.multiply(u_p_l, n19, n19)  # e_pl = u_p_l * magnitude_p_l
    np.multiply(u_k, n10, n10)  # e_k = u_k * magnitude_k
    np.multiply(u_d_l, n14, n14)  # e_d = u_d_l * magnitude_d_l
    np.multiply(u_F, n0, n0)  # e_F = u_F * magnitude_F
    np.multiply(u_psi, n21, n21)  # e_psi = u_psi * magnitude_psi
    np.greater(alpha, 0.0, t0)  # alpha_positive = alpha > 0
    np.greater(gamma, 0.0, t1)  # gamma_positive = gamma > 0
    np.greater(d, 0.0, t2)  # d_positive = d > 0
    np.greater(b, least_b, t3)  # b_not_small = b > least_b
    np.less(b, greatest_b, t4)  # b_not_large = b < greatest_b
    np.greater(n1, least_square, t5)  # p_not_small = p > least_square
    np.less(n1, greatest_square, t6)  # p_not_large = p < greatest_square
    np.greater(n2, least_square, t7)  # s_not_small = s > least_square
    np.less(n2, greatest_square, t8)  # s_not_large = s < greatest_square
    np.greater(n3, least_square, t9)  # t_not_small = t > least_square
    np.less(n3, greatest_square, t10)  # t_not_large = t < greatest_square
    np.greater(n8, least_axis, t11)  # w_not_small = w > least_axis
    np.less(n8, greatest_axis, t12)  # w_not_large = w < greatest_axis
    np.less(n4, farthest_square, t13)  # not_too_far = distance < farthest_square
    np.absolute(l, n4)  # size_l = abs l
    np.less(n4, greatest_l, t14)  # l_usable = size_l < greatest_l
    np.logical_and(t3, t4, t4)  # b_usable = b_not_small and b_not_large
    np.logical_and(t5, t6, t6)  # p_usable = p_not_small and p_not_large
    np.logical_and(t7, t8, t8)  # s_usable = s_not_small and s_not_large
    np.logical_and(t9, t10, t10)  # t_usable = t_not_small and t_not_large
    np.logical_and(t11, t12, t12)  # w_usable = w_not_small and w_not_large
    np.logical_and(t6, t8, t8)  # ps_usable = p_usable and s_usable
    np.logical_and(t4, t10, t10)  # bt_usable = b_usable and t_usable
    np.logical_and(t0, t1, t1)  # radial_positive = alpha_positive and gamma_positive
    np.logical_and(t1, t2, t2)  # all_positive = radial_positive and d_positive
    np.logical_and(t8, t10, t10)  # squares_usable = ps_usable and bt_usable
    np.logical_and(t10, t2, t2)  # sizes_usable = squares_usable and all_positive
    np.logical_and(t13, t14, t14)  # place_usable = not_too_far and l_usable
    np.logical_and(t12, t14, t14)  # rest_usable = w_usable and place_usable
    np.logical_and(t2, t14, t14)  # usable = sizes_usable and rest_usable
    np.greater(n13, n10, t2)  # before_B_and_A2 = k > e_k
    np.greater(n6, n19, t12)  # before_A1 = p_l > e_pl
    np.logical_and(t2, t12, t12)  # between_poles = before_B_and_A2 and before_A1
    np.logical_and(t14, t12, t12)  # inside = usable and between_poles
    np.greater(n16, n0, t14)  # phi_positive = F > e_F
    np.logical_and(t14, t12, t14)  # clear = phi_positive and inside
    np.greater(l, 0.0, t2)  # on_side_of_B = l > 0
    np.less(l, 0.0, t13)  # on_side_of_A = l < 0
    np.logical_and(t14, t2, t2)  # exterior = clear and on_side_of_B
    np.logical_and(t14, t13, t13)  # interior = clear and on_side_of_A
    np.negative(n16, n16)  # minus_F = - F
    np.subtract(n16, n0, n0)  # minus_F_least = minus_F - e_F
    np.greater(n0, 0.0, t10)  # phi_negative = minus_F_least > 0
    np.subtract(n15, n14, n14)  # d_least = d_l - e_d
    np.multiply(n0, n14, n14)  # room = minus_F_least * d_least
    np.multiply(less_sure, n14, n14)  # room_least = less_sure * room
    np.absolute(n9, n9)  # size_psi = abs psi
    np.add(n9, n21, n21)  # psi_most = size_psi + e_psi
    np.divide(n11, n3, n3)  # B_most = s_along / t
    np.add(n1, n3, n3)  # width = p + B_most
    np.multiply(n21, n3, n3)  # slope_most = psi_most * width
    np.less(n3, n14, t8)  # below_tangent = slope_most < room_least
    np.logical_and(t8, t10, t10)  # below = below_tangent and phi_negative
    np.logical_and(t10, t12, t12)  # contact = below and inside
    np.logical_or(t14, t12, t12)  # decided = clear or contact
    return t2, t13, t12
