(** The programs from which the C is printed, as listings that Steps.v reads. Printed itself, by

        python -m hypcheck.kernel.printing.coq *)

Require Import String.
From Hypcheck Require Import Steps.
Open Scope string_scope.

Definition single := steps_of "
alpha_over_b = alpha / b; A = alpha_over_b * alpha_over_b; gamma_over_d = gamma / d; B = gamma_over_d * gamma_over_d;
AB = A * B; c0 = - AB; c0_plus_A = c0 + A; C = c0_plus_A - B; xx = x * x; yy = y * y; rr = xx + yy; bb = b * b; P = rr
/ bb; z_over_d = z / d; Q = z_over_d * z_over_d; BP = B * P; C_plus_BP = C + BP; AQ = A * Q; c1 = C_plus_BP - AQ;
A_minus_B = A - B; K = A_minus_B + 1; K_minus_P = K - P; c2 = K_minus_P - Q; c2_squared = c2 * c2; three_c1 = 3 * c1;
h1 = c2_squared - three_c1; c2c1 = c2 * c1; nine_c0 = 9 * c0; h2 = c2c1 - nine_c0; c1_squared = c1 * c1; c2c0 = c2 *
c0; three_c2c0 = 3 * c2c0; h3 = c1_squared - three_c2c0; h1h3 = h1 * h3; h1h3_4 = 4 * h1h3; h2_squared = h2 * h2;
delta_3 = h1h3_4 - h2_squared; P_plus_Q = P + Q; A_plus_B = A + B; sizes_2 = A_plus_B + 1; M2 = sizes_2 + P_plus_Q;
BP_plus_AQ = BP + AQ; sizes_1 = A_plus_B + AB; M1 = sizes_1 + BP_plus_AQ; product = M2 * M1; product_squared = product
* product; E = u_1536 * product_squared; e1 = u_12 * M1; e2 = u_8 * M2; BB = B * B;".

Definition certified := steps_of "
alpha_over_b = alpha / b; A = alpha_over_b * alpha_over_b; gamma_over_d = gamma / d; B = gamma_over_d * gamma_over_d;
AB = A * B; c0 = - AB; c0_plus_A = c0 + A; C = c0_plus_A - B; xx = x * x; yy = y * y; rr = xx + yy; bb = b * b; P = rr
/ bb; z_over_d = z / d; Q = z_over_d * z_over_d; BP = B * P; C_plus_BP = C + BP; AQ = A * Q; c1 = C_plus_BP - AQ;
A_minus_B = A - B; K = A_minus_B + 1; K_minus_P = K - P; c2 = K_minus_P - Q; c2_squared = c2 * c2; three_c1 = 3 * c1;
h1 = c2_squared - three_c1; c2c1 = c2 * c1; nine_c0 = 9 * c0; h2 = c2c1 - nine_c0; c1_squared = c1 * c1; c2c0 = c2 *
c0; three_c2c0 = 3 * c2c0; h3 = c1_squared - three_c2c0; h1h3 = h1 * h3; h1h3_4 = 4 * h1h3; h2_squared = h2 * h2;
delta_3 = h1h3_4 - h2_squared; alpha_usable = alpha > 0; gamma_usable = gamma > 0; b_not_small = b > least;
b_not_large = b < greatest; d_not_small = d > least; d_not_large = d < greatest; A_not_small = A > least; A_not_large
= A < greatest; B_not_small = B > least; B_not_large = B < greatest; P_plus_Q = P + Q; not_too_far = P_plus_Q <
farthest; positive_radial = alpha_usable and gamma_usable; b_usable = b_not_small and b_not_large; d_usable =
d_not_small and d_not_large; A_usable = A_not_small and A_not_large; B_usable = B_not_small and B_not_large;
radial_usable = b_usable and A_usable; axial_usable = d_usable and B_usable; ratios_usable = radial_usable and
axial_usable; sizes_usable = positive_radial and ratios_usable; usable = sizes_usable and not_too_far; A_plus_B = A +
B; sizes_1 = A_plus_B + AB; BP_plus_AQ = BP + AQ; terms_1 = sizes_1 + BP_plus_AQ; sizes_2 = A_plus_B + 1; terms_2 =
sizes_2 + P_plus_Q; e1 = u_12 * terms_1; e2 = u_8 * terms_2; e0 = u_8 * AB; m0 = AB + e0; size_c1 = abs c1; m1 =
size_c1 + e1; size_c2 = abs c2; m2 = size_c2 + e2; u_m0 = u_4 * m0; f0 = e0 + u_m0; u_m1 = u_4 * m1; f1 = e1 + u_m1;
u_m2 = u_4 * m2; twice_e2 = 2 * e2; f2 = twice_e2 + u_m2; m2_f2 = m2 * f2; thrice_f1 = 3 * f1; E1 = m2_f2 + thrice_f1;
m2_f1 = m2 * f1; m1_e2 = m1 * e2; cross_21 = m2_f1 + m1_e2; ninefold_f0 = 9 * f0; E2 = cross_21 + ninefold_f0;
twice_e1 = 2 * e1; f3 = twice_e1 + u_m1; m1_f3 = m1 * f3; m2_f0 = m2 * f0; m0_e2 = m0 * e2; cross_20 = m2_f0 + m0_e2;
thrice_cross_20 = 3 * cross_20; E3 = m1_f3 + thrice_cross_20; size_h1 = abs h1; a1 = size_h1 + E1; size_h2 = abs h2;
a2 = size_h2 + E2; size_h3 = abs h3; a3 = size_h3 + E3; u_a3 = u_4 * a3; F3 = E3 + u_a3; a1_F3 = a1 * F3; a3_E1 = a3 *
E1; cross_13 = a1_F3 + a3_E1; fourfold_cross_13 = 4 * cross_13; u_a2 = u_4 * a2; twice_E2 = 2 * E2; F2 = twice_E2 +
u_a2; a2_F2 = a2 * F2; E_sum = fourfold_cross_13 + a2_F2; E = slack * E_sum; minus_E = - E; two_c2 = 2 * c2; twice_m2
= 2 * m2; thrice_B = 3 * B; chord_B = thrice_B + two_c2; rise_B = chord_B * B; slope_B = rise_B + c1; offset_B =
thrice_B + c2; size_chord_B = thrice_B + twice_m2; size_rise_B = size_chord_B * B; size_slope_B = size_rise_B + m1;
u_slope_B = u_16 * size_slope_B; carried_B = twice_e2 * B; carried_1_B = carried_B + e1; error_B = carried_1_B +
u_slope_B; bound_B = slack * error_B; below_B = - bound_B; size_offset_B = B + m2; u_offset_B = u_16 * size_offset_B;
offset_error_B = e2 + u_offset_B; offset_bound_B = slack * offset_error_B; offset_below_B = - offset_bound_B; rises_B
= slope_B > bound_B; falls_B = slope_B < below_B; inflection_inside_B = offset_B > offset_bound_B; inflection_beyond_B
= offset_B < offset_below_B; thrice_A = 3 * A; chord_A = thrice_A - two_c2; rise_A = chord_A * A; slope_A = rise_A +
c1; offset_A = thrice_A - c2; size_chord_A = thrice_A + twice_m2; size_rise_A = size_chord_A * A; size_slope_A =
size_rise_A + m1; u_slope_A = u_16 * size_slope_A; carried_A = twice_e2 * A; carried_1_A = carried_A + e1; error_A =
carried_1_A + u_slope_A; bound_A = slack * error_A; below_A = - bound_A; size_offset_A = A + m2; u_offset_A = u_16 *
size_offset_A; offset_error_A = e2 + u_offset_A; offset_bound_A = slack * offset_error_A; offset_below_A = -
offset_bound_A; rises_A = slope_A > bound_A; falls_A = slope_A < below_A; inflection_inside_A = offset_A >
offset_bound_A; inflection_beyond_A = offset_A < offset_below_A; minus_e1 = - e1; minus_e2 = - e2; distinct = delta_3
> E; one_root = delta_3 < minus_E; c1_positive = c1 > e1; c1_negative = c1 < minus_e1; c2_positive = c2 > e2;
c2_negative = c2 < minus_e2; three_roots = distinct and usable; falling_then_rising = c2_negative and c1_positive;
all_positive = three_roots and falling_then_rising; some_sign_differs = c2_positive or c1_negative; two_negative =
three_roots and some_sign_differs; some_below_B = inflection_inside_B or falls_B; none_below_B = inflection_beyond_B
and rises_B; both_above_A = inflection_inside_A and rises_A; none_above_A = inflection_beyond_A or falls_A; exterior =
all_positive and some_below_B; interior = two_negative and both_above_A; crossing = one_root and usable; groove =
all_positive and none_below_B; throat = two_negative and none_above_A; several_curves = groove or throat; contact =
crossing or several_curves; clear = exterior or interior; decided = clear or contact;".

Definition fixed_terms := steps_of "
R = xx + yy; p_plus_q = p + q; p_q_R = p_plus_q - R; radial_2 = p_q_R * whole_t; s_plus_S = s + S; axial_2 = s_plus_S
* whole_q; t_minus_s = t - s; t_s_S = t_minus_s - S; axial_1 = t_s_S * p; R_minus_q = R - q; radial_1 = R_minus_q * s;
n1 = axial_1 + radial_1; N = whole_q * whole_t; ps = whole_p * whole_s; p_t = p * whole_t; s_t = s * whole_t; q_s = s
* whole_q; p_q = p * whole_q;".

Definition fixed_discriminant := steps_of "
n2_n2 = n2 * n2; N_n1 = N * n1; N_n1_3 = 3 * N_n1; h1 = n2_n2 - N_n1_3; n2_n1 = n2 * n1; N_ps = N * ps; N_ps_9 = 9 *
N_ps; h2 = n2_n1 + N_ps_9; n1_n1 = n1 * n1; n2_ps = n2 * ps; n2_ps_3 = 3 * n2_ps; h3 = n1_n1 + n2_ps_3; h1_h3 = h1 *
h3; h1_h3_4 = 4 * h1_h3; h2_h2 = h2 * h2; delta = h1_h3_4 - h2_h2; n2_h1 = n2 * h1; n2_h1_2 = 2 * n2_h1; N_h2 = N *
h2; N_h2_3 = 3 * N_h2; middle = n2_h1_2 - N_h2_3;".

Definition fixed_poles := steps_of "
q_s_3 = 3 * q_s; offset_at_B = q_s_3 + n2; p_t_q_s = p_t + q_s; t_plus_s = t + s; rise_at_B = p_t_q_s * t_plus_s;
q_s_2 = 2 * q_s; p_t_q_s_2 = p_t + q_s_2; axial_fall = p_t_q_s_2 * S; radial_fall = s_t * R; rise_less_axial =
rise_at_B - axial_fall; slope_at_B = rise_less_axial - radial_fall; p_t_3 = 3 * p_t; offset_at_A = p_t_3 - n2; p_t_2 =
2 * p_t; p_t_2_q_s = p_t_2 + q_s; radial_rise = p_t_2_q_s * R; axial_rise = p_q * S; p_less_q = p - q; width_at_A =
p_less_q * p_t_q_s; rise_at_A = radial_rise + axial_rise; slope_at_A = rise_at_A + width_at_A;".

Definition tangency := steps_of "
p = alpha * alpha; q = b * b; s = gamma * gamma; t = d * d; xx = x * x; yy = y * y; R = xx + yy; S = z * z; p_plus_q =
p + q; p_q_R = p_plus_q - R; s_plus_S = s + S; radial_2 = p_q_R * t; axial_2 = s_plus_S * q; n2 = radial_2 - axial_2;
t_minus_s = t - s; t_s_S = t_minus_s - S; R_minus_q = R - q; axial_1 = t_s_S * p; radial_1 = R_minus_q * s; n1 =
axial_1 + radial_1; inner = about < 0; D = b * d; K = alpha * gamma; D_K = D * K; M_e = M * e; e_e = e * e; D_M = D *
M; r1 = D_K - M_e; n2_e_e = n2 + e_e; D_M_2 = D_M + D_M; r2_outer = n2_e_e + D_M_2; r2_inner = n2_e_e - D_M_2; r2 =
inner ? r2_inner : r2_outer; K_e = K * e; M_M = M * M; M_M_n1 = M_M - n1; K_e_2 = K_e + K_e; r3_outer = M_M_n1 +
K_e_2; r3_inner = M_M_n1 - K_e_2; r3 = inner ? r3_inner : r3_outer; p_D = p * D; M_q = M * q; room_within = p_D - M_q;
beyond = e_e - D_M; s_D = s * D; M_t = M * t; room_without = s_D - M_t;".

Definition waist := steps_of "
p = alpha * alpha; q = b * b; xx = x * x; yy = y * y; R = xx + yy; R_less_q = R - q; W = R_less_q - p; p_plus_q = p +
q; opposite = p_plus_q - R; p_2 = p + p; q_2 = q + q; four_A = p_2 * q_2; square = size * size; excess = four_A -
square; W_p_2 = W + p_2; s = gamma * gamma; t = d * d; q_2_s = q_2 * s; W_t = W * t; room = q_2_s - W_t;".

Definition integers := steps_of "
p = alpha * alpha; q = b * b; s = gamma * gamma; t = d * d; xx = x * x; yy = y * y; R = xx + yy; S = z * z; N = q * t;
p_plus_q = p + q; p_q_R = p_plus_q - R; s_plus_S = s + S; radial_2 = p_q_R * t; axial_2 = s_plus_S * q; n2 = radial_2
- axial_2; t_minus_s = t - s; t_s_S = t_minus_s - S; R_minus_q = R - q; axial_1 = t_s_S * p; radial_1 = R_minus_q * s;
n1 = axial_1 + radial_1; ps = p * s; n2_n2 = n2 * n2; N_n1 = N * n1; N_n1_3 = 3 * N_n1; h1 = n2_n2 - N_n1_3; n2_n1 =
n2 * n1; N_ps = N * ps; N_ps_9 = 9 * N_ps; h2 = n2_n1 + N_ps_9; n1_n1 = n1 * n1; n2_ps = n2 * ps; n2_ps_3 = 3 * n2_ps;
h3 = n1_n1 + n2_ps_3; h1_h3 = h1 * h3; h1_h3_4 = 4 * h1_h3; h2_h2 = h2 * h2; delta = h1_h3_4 - h2_h2; N_s = N * s;
N_s_3 = 3 * N_s; n2_t = n2 * t; offset_at_B = N_s_3 + n2_t; offset_and_n2_t = offset_at_B + n2_t; rise_at_B =
offset_and_n2_t * s; n1_t = n1 * t; n1_tt = n1_t * t; slope_at_B = rise_at_B + n1_tt; N_p = N * p; N_p_3 = 3 * N_p;
n2_q = n2 * q; offset_at_A = N_p_3 - n2_q; offset_less_n2_q = offset_at_A - n2_q; rise_at_A = offset_less_n2_q * p;
n1_q = n1 * q; n1_qq = n1_q * q; slope_at_A = rise_at_A + n1_qq; p_t = p * t; p_tt = p_t * t; q_s = q * s; q_ss = q_s
* s; ring_excess = q_ss - p_tt;".

Definition one_line := steps_of "
xx = x * x; yy = y * y; R = xx + yy; T = z * z; R_plus_T = R + T; in_reach = T <= reach; rise_beyond_0 = M_beyond_0 *
T; line_beyond_0 = K_beyond_0 + rise_beyond_0; exterior = R > line_beyond_0; rise_within_0 = M_within_0 * T;
line_within_0 = K_within_0 + rise_within_0; interior = R < line_within_0; rise_under_0 = M_under_0 * T; line_under_0 =
K_under_0 + rise_under_0; is_under = R < line_under_0; rise_above_0 = M_above_0 * T; line_above_0 = K_above_0 +
rise_above_0; is_above = R >= line_above_0; contact_in_reach = is_under and is_above; contact = contact_in_reach and
in_reach; clear = exterior or interior; decided = clear or contact; not_exterior = is_under and in_reach;
exterior_decided = exterior or not_exterior; not_interior = is_above and in_reach; interior_decided = interior or
not_interior;".

Definition two_lines := steps_of "
xx = x * x; yy = y * y; R = xx + yy; T = z * z; R_plus_T = R + T; in_reach = T <= reach; rise_beyond_1 = M_beyond_1 *
T; line_beyond_1 = K_beyond_1 + rise_beyond_1; exterior_1 = R > line_beyond_1; rise_beyond_2 = M_beyond_2 * T;
line_beyond_2 = K_beyond_2 + rise_beyond_2; exterior_2 = R > line_beyond_2; rise_within_1 = M_within_1 * T;
line_within_1 = K_within_1 + rise_within_1; interior_1 = R < line_within_1; rise_within_2 = M_within_2 * T;
line_within_2 = K_within_2 + rise_within_2; interior_2 = R < line_within_2; rise_under_1 = M_under_1 * T; line_under_1
= K_under_1 + rise_under_1; is_under_1 = R < line_under_1; rise_under_2 = M_under_2 * T; line_under_2 = K_under_2 +
rise_under_2; is_under_2 = R < line_under_2; rise_above_1 = M_above_1 * T; line_above_1 = K_above_1 + rise_above_1;
is_above_1 = R >= line_above_1; rise_above_2 = M_above_2 * T; line_above_2 = K_above_2 + rise_above_2; is_above_2 = R
>= line_above_2; exterior = exterior_1 or exterior_2; interior = interior_1 or interior_2; is_under = is_under_1 and
is_under_2; is_above = is_above_1 and is_above_2; contact_in_reach = is_under and is_above; contact = contact_in_reach
and in_reach; clear = exterior or interior; decided = clear or contact; not_exterior = is_under and in_reach;
exterior_decided = exterior or not_exterior; not_interior = is_above and in_reach; interior_decided = interior or
not_interior;".

Definition tangent_beyond := steps_of "
p = alpha * alpha; q = b * b; q_lambda = q * lambda_; across = p + q_lambda; one_plus_lambda = 1 + lambda_; product =
across * one_plus_lambda; K = product / lambda_; K_most = more * K; s = gamma * gamma; t = d * d; t_lambda = t *
lambda_; gap = s - t_lambda; gap_terms = s + t_lambda; gap_error = u_8 * gap_terms; gap_least = gap - gap_error; M =
across / gap_least; M_most = more * M;".

Definition tangent_within := steps_of "
p = alpha * alpha; q = b * b; q_mu = q * mu; across = p - q_mu; across_terms = p + q_mu; across_error = u_8 *
across_terms; across_least = across - across_error; mu_minus_one = mu - 1; product = across_least * mu_minus_one; K =
product / mu; K_least = less * K; s = gamma * gamma; t = d * d; t_mu = t * mu; along = s + t_mu; M = across_least /
along; M_least = less * M;".

Definition tangent_high := steps_of "
p = alpha * alpha; q = b * b; q_mu = q * mu; across = p - q_mu; across_terms = p + q_mu; across_error = u_8 *
across_terms; across_least = across - across_error; across_most = across + across_error; one_minus_mu = 1 - mu;
product = across_most * one_minus_mu; fall = product / mu; fall_most = more * fall; s = gamma * gamma; t = d * d; t_mu
= t * mu; along = s + t_mu; M = across_least / along; M_least = less * M;".

Definition chord := steps_of "
rise_0 = M * T_0; line_0 = K + rise_0; rise_1 = M * T_1; line_1 = K + rise_1; lowered_0 = less * R_0; lowered_1 = less
* R_1; raised_0 = more * R_0; raised_1 = more * R_1; below_0 = line_0 <= lowered_0; below_1 = line_1 <= lowered_1;
above_0 = line_0 >= raised_0; above_1 = line_1 >= raised_1; below = below_0 and below_1; above = above_0 and above_1;".

Definition piece := steps_of "
xx = x * x; yy = y * y; R = xx + yy; T = z * z; rise = M * T; line = K + rise; gap = R - line; size_K = abs K;
size_line = size_K + rise; size_here = R + size_line; error_here = u_8 * size_here; side_gap = side * gap; here =
side_gap - error_here; xu = x * u; yv = y * v; R_slope = xu + yv; zw = z * w; rise_slope = M * zw; gap_slope = R_slope
- rise_slope; size_xu = abs xu; size_yv = abs yv; size_R_slope = size_xu + size_yv; size_rise_slope = abs rise_slope;
size_slope = size_R_slope + size_rise_slope; error_slope = u_8 * size_slope; side_gap_slope = side * gap_slope; slope
= side_gap_slope - error_slope; uu = u * u; vv = v * v; R_bend = uu + vv; ww = w * w; rise_bend = M * ww; gap_bend =
R_bend - rise_bend; size_bend = R_bend + rise_bend; error_bend = u_8 * size_bend; side_gap_bend = side * gap_bend;
bend = side_gap_bend - error_bend; size_ends = size_here + size_bend; size = size_ends + size_slope;".

Definition tilted_quartic := steps_of "
p = alpha * alpha; q = b * b; s = gamma * gamma; t = d * d; axis_xx = axis_x * axis_x; axis_yy = axis_y * axis_y;
level = axis_xx + axis_yy; upward = axis_z * axis_z; w = level + upward; xx = x * x; yy = y * y; radius = xx + yy;
height = z * z; distance = radius + height; axis_x_y = axis_x * y; axis_y_x = axis_y * x; cross = axis_x_y - axis_y_x;
axis_x_x = axis_x * x; axis_y_y = axis_y * y; axis_z_z = axis_z * z; along_level = axis_x_x + axis_y_y; along =
along_level + axis_z_z; t_minus_q = t - q; s_plus_p = s + p; scale_E = t_minus_q * s_plus_p; cross_cross = cross *
cross; E = scale_E * cross_cross; s_radius = s * radius; p_height = p * height; slope = s_radius - p_height; G = w *
slope; tw = t * w; tw_distance = tw * distance; along_along = along * along; along_part = t_minus_q * along_along; m =
tw_distance - along_part; ps = p * s; k0 = ps * w; t_level = t * level; q_upward = q * upward; along_z = t_level +
q_upward; t_upward = t * upward; q_level = q * level; across_z = t_upward + q_level; s_along_z = s * along_z;
p_across_z = p * across_z; k1 = s_along_z - p_across_z; k2 = q * tw; p_plus_q = p + q; minus_f0 = p * k0; G_k1 = G -
k1; p_G_k1 = p * G_k1; pq_k0 = p_plus_q * k0; f1 = p_G_k1 - pq_k0; G_k0 = G - k0; q_G_k0 = q * G_k0; k2_m = k2 - m;
p_k2_m = p * k2_m; pq_k1 = p_plus_q * k1; E_q = E + q_G_k0; E_q_p = E_q + p_k2_m; f2 = E_q_p - pq_k1; m_k1 = m + k1;
q_m_k1 = q * m_k1; pq_k2 = p_plus_q * k2; f3 = pq_k2 - q_m_k1; f4 = q * k2;".

Definition tilted_invariants := steps_of "
f2_f2 = f2 * f2; f3_f1 = f3 * f1; f4_f0 = f4 * minus_f0; thrice_f3_f1 = 3 * f3_f1; twelvefold_f4_f0 = 12 * f4_f0;
two_terms = f2_f2 - thrice_f3_f1; I = two_terms - twelvefold_f4_f0; ninefold_f3_f1 = 9 * f3_f1; many_f4_f0 = 72 *
f4_f0; twice_f2_f2 = 2 * f2_f2; one_factor = ninefold_f3_f1 - many_f4_f0; factor = one_factor - twice_f2_f2; middle =
f2 * factor; f3_f3 = f3 * f3; f0_f3_f3 = minus_f0 * f3_f3; f1_f1 = f1 * f1; f4_f1_f1 = f4 * f1_f1; ends = f0_f3_f3 -
f4_f1_f1; many_ends = 27 * ends; J = middle + many_ends;".

Definition tilted_discriminant := steps_of "
I_I = I * I; I_I_I = I_I * I; fourfold_I = 4 * I_I_I; J_J = J * J; delta = fourfold_I - J_J;".

Definition tilted := steps_of "
r = 1 / b; alpha_r = alpha * r; p = alpha_r * alpha_r; gamma_r = gamma * r; s = gamma_r * gamma_r; d_r = d * r; t =
d_r * d_r; x_r = x * r; y_r = y * r; z_r = z * r; axis_xx = axis_x * axis_x; axis_yy = axis_y * axis_y; level =
axis_xx + axis_yy; upward = axis_z * axis_z; w = level + upward; h = level / w; c = upward / w; x_y = axis_x * y_r;
y_x = axis_y * x_r; cross = x_y - y_x; x_x = axis_x * x_r; y_y = axis_y * y_r; z_z = axis_z * z_r; along_level = x_x +
y_y; along_axis = along_level + z_z; cross_squared = cross * cross; cross_part = cross_squared / w; axis_squared =
along_axis * along_axis; axis_part = axis_squared / w; xx = x_r * x_r; yy = y_r * y_r; radius = xx + yy; height = z_r
* z_r; distance = radius + height; t_1 = t - 1; s_p = s + p; t_1_s_p = t_1 * s_p; E = t_1_s_p * cross_part; s_radius =
s * radius; p_height = p * height; G = s_radius - p_height; t_distance = t * distance; t_1_axis = t_1 * axis_part; m =
t_distance - t_1_axis; k0 = p * s; t_h = t * h; along = t_h + c; t_c = t * c; across = t_c + h; s_along = s * along;
p_across = p * across; k1 = s_along - p_across; p_l = p + l; t_l = t * l; k1_tl = k1 - t_l; k1_tl_l = k1_tl * l; k =
k0 + k1_tl_l; m_l = m * l; g = G - m_l; E_l = E * l; p_l_g = p_l * g; N = E_l + p_l_g; l_N = l * N; d_l = p_l * k;
one_l = 1 + l; one_l_d = one_l * d_l; F = l_N - one_l_d; p_l_m = p_l * m; E_g = E + g; N_slope = E_g - p_l_m; k_slope
= k1_tl - t_l; p_l_k_slope = p_l * k_slope; d_slope = k + p_l_k_slope; l_N_slope = l * N_slope; N_both = N +
l_N_slope; N_both_d = N_both - d_l; gain = d_l * N_both_d; loss = l_N * d_slope; psi = gain - loss; magnitude_x = abs
x; magnitude_y = abs y; magnitude_z = abs z; magnitude_axis_x = abs axis_x; magnitude_axis_y = abs axis_y;
magnitude_axis_z = abs axis_z; magnitude_l = abs l; magnitude_r = 1 / b; magnitude_alpha_r = alpha * magnitude_r;
magnitude_p = magnitude_alpha_r * magnitude_alpha_r; magnitude_gamma_r = gamma * magnitude_r; magnitude_s =
magnitude_gamma_r * magnitude_gamma_r; magnitude_d_r = d * magnitude_r; magnitude_t = magnitude_d_r * magnitude_d_r;
magnitude_x_r = magnitude_x * magnitude_r; magnitude_y_r = magnitude_y * magnitude_r; magnitude_z_r = magnitude_z *
magnitude_r; magnitude_axis_xx = magnitude_axis_x * magnitude_axis_x; magnitude_axis_yy = magnitude_axis_y *
magnitude_axis_y; magnitude_level = magnitude_axis_xx + magnitude_axis_yy; magnitude_upward = magnitude_axis_z *
magnitude_axis_z; magnitude_w = magnitude_level + magnitude_upward; magnitude_h = magnitude_level / magnitude_w;
magnitude_c = magnitude_upward / magnitude_w; magnitude_x_y = magnitude_axis_x * magnitude_y_r; magnitude_y_x =
magnitude_axis_y * magnitude_x_r; magnitude_cross = magnitude_x_y + magnitude_y_x; magnitude_x_x = magnitude_axis_x *
magnitude_x_r; magnitude_y_y = magnitude_axis_y * magnitude_y_r; magnitude_z_z = magnitude_axis_z * magnitude_z_r;
magnitude_along_level = magnitude_x_x + magnitude_y_y; magnitude_along_axis = magnitude_along_level + magnitude_z_z;
magnitude_cross_squared = magnitude_cross * magnitude_cross; magnitude_cross_part = magnitude_cross_squared /
magnitude_w; magnitude_axis_squared = magnitude_along_axis * magnitude_along_axis; magnitude_axis_part =
magnitude_axis_squared / magnitude_w; magnitude_xx = magnitude_x_r * magnitude_x_r; magnitude_yy = magnitude_y_r *
magnitude_y_r; magnitude_radius = magnitude_xx + magnitude_yy; magnitude_height = magnitude_z_r * magnitude_z_r;
magnitude_distance = magnitude_radius + magnitude_height; magnitude_t_1 = magnitude_t + 1; magnitude_s_p = magnitude_s
+ magnitude_p; magnitude_t_1_s_p = magnitude_t_1 * magnitude_s_p; magnitude_E = magnitude_t_1_s_p *
magnitude_cross_part; magnitude_s_radius = magnitude_s * magnitude_radius; magnitude_p_height = magnitude_p *
magnitude_height; magnitude_G = magnitude_s_radius + magnitude_p_height; magnitude_t_distance = magnitude_t *
magnitude_distance; magnitude_t_1_axis = magnitude_t_1 * magnitude_axis_part; magnitude_m = magnitude_t_distance +
magnitude_t_1_axis; magnitude_k0 = magnitude_p * magnitude_s; magnitude_t_h = magnitude_t * magnitude_h;
magnitude_along = magnitude_t_h + magnitude_c; magnitude_t_c = magnitude_t * magnitude_c; magnitude_across =
magnitude_t_c + magnitude_h; magnitude_s_along = magnitude_s * magnitude_along; magnitude_p_across = magnitude_p *
magnitude_across; magnitude_k1 = magnitude_s_along + magnitude_p_across; magnitude_p_l = magnitude_p + magnitude_l;
magnitude_t_l = magnitude_t * magnitude_l; magnitude_k1_tl = magnitude_k1 + magnitude_t_l; magnitude_k1_tl_l =
magnitude_k1_tl * magnitude_l; magnitude_k = magnitude_k0 + magnitude_k1_tl_l; magnitude_m_l = magnitude_m *
magnitude_l; magnitude_g = magnitude_G + magnitude_m_l; magnitude_E_l = magnitude_E * magnitude_l; magnitude_p_l_g =
magnitude_p_l * magnitude_g; magnitude_N = magnitude_E_l + magnitude_p_l_g; magnitude_l_N = magnitude_l * magnitude_N;
magnitude_d_l = magnitude_p_l * magnitude_k; magnitude_one_l = 1 + magnitude_l; magnitude_one_l_d = magnitude_one_l *
magnitude_d_l; magnitude_F = magnitude_l_N + magnitude_one_l_d; magnitude_p_l_m = magnitude_p_l * magnitude_m;
magnitude_E_g = magnitude_E + magnitude_g; magnitude_N_slope = magnitude_E_g + magnitude_p_l_m; magnitude_k_slope =
magnitude_k1_tl + magnitude_t_l; magnitude_p_l_k_slope = magnitude_p_l * magnitude_k_slope; magnitude_d_slope =
magnitude_k + magnitude_p_l_k_slope; magnitude_l_N_slope = magnitude_l * magnitude_N_slope; magnitude_N_both =
magnitude_N + magnitude_l_N_slope; magnitude_N_both_d = magnitude_N_both + magnitude_d_l; magnitude_gain =
magnitude_d_l * magnitude_N_both_d; magnitude_loss = magnitude_l_N * magnitude_d_slope; magnitude_psi = magnitude_gain
+ magnitude_loss; e_pl = u_p_l * magnitude_p_l; e_k = u_k * magnitude_k; e_d = u_d_l * magnitude_d_l; e_F = u_F *
magnitude_F; e_psi = u_psi * magnitude_psi; alpha_positive = alpha > 0; gamma_positive = gamma > 0; d_positive = d >
0; b_not_small = b > least_b; b_not_large = b < greatest_b; p_not_small = p > least_square; p_not_large = p <
greatest_square; s_not_small = s > least_square; s_not_large = s < greatest_square; t_not_small = t > least_square;
t_not_large = t < greatest_square; w_not_small = w > least_axis; w_not_large = w < greatest_axis; not_too_far =
distance < farthest_square; size_l = abs l; l_usable = size_l < greatest_l; b_usable = b_not_small and b_not_large;
p_usable = p_not_small and p_not_large; s_usable = s_not_small and s_not_large; t_usable = t_not_small and
t_not_large; w_usable = w_not_small and w_not_large; ps_usable = p_usable and s_usable; bt_usable = b_usable and
t_usable; radial_positive = alpha_positive and gamma_positive; all_positive = radial_positive and d_positive;
squares_usable = ps_usable and bt_usable; sizes_usable = squares_usable and all_positive; place_usable = not_too_far
and l_usable; rest_usable = w_usable and place_usable; usable = sizes_usable and rest_usable; before_B_and_A2 = k >
e_k; before_A1 = p_l > e_pl; between_poles = before_B_and_A2 and before_A1; inside = usable and between_poles;
phi_positive = F > e_F; clear = phi_positive and inside; on_side_of_B = l > 0; on_side_of_A = l < 0; exterior = clear
and on_side_of_B; interior = clear and on_side_of_A; minus_F = - F; minus_F_least = minus_F - e_F; phi_negative =
minus_F_least > 0; d_least = d_l - e_d; room = minus_F_least * d_least; room_least = less_sure * room; size_psi = abs
psi; psi_most = size_psi + e_psi; B_most = s_along / t; width = p + B_most; slope_most = psi_most * width;
below_tangent = slope_most < room_least; below = below_tangent and phi_negative; contact = below and inside; decided =
clear or contact;".

Definition one_plane := steps_of "
xx = x * x; yy = y * y; zz = z * z; radius = xx + yy; distance = radius + zz; x1 = r1_x * x; y1 = r1_y * y; c1 = x1 +
y1; x2 = r2_x * x; y2 = r2_y * y; xy2 = x2 + y2; z2 = r2_z * z; c2 = xy2 + z2; x3 = r3_x * x; y3 = r3_y * y; xy3 = x3
+ y3; z3 = r3_z * z; c3 = xy3 + z3; P1 = c1 * c1; P2 = c2 * c2; Q = c3 * c3; in_reach = Q <= reach; part_beyond_0 =
a_beyond_0 * P2; place_beyond_0 = P1 + part_beyond_0; rise_beyond_0 = M_beyond_0 * Q; line_beyond_0 = K_beyond_0 +
rise_beyond_0; exterior = place_beyond_0 > line_beyond_0; part_within_0 = a_within_0 * P2; place_within_0 = P1 +
part_within_0; rise_within_0 = M_within_0 * Q; line_within_0 = K_within_0 + rise_within_0; interior = place_within_0 <
line_within_0; part_under_0 = a_under_0 * P2; place_under_0 = P1 + part_under_0; rise_under_0 = M_under_0 * Q;
line_under_0 = K_under_0 + rise_under_0; is_under = place_under_0 < line_under_0; part_above_0 = a_above_0 * P2;
place_above_0 = P1 + part_above_0; rise_above_0 = M_above_0 * Q; line_above_0 = K_above_0 + rise_above_0; is_above =
place_above_0 >= line_above_0; contact_in_reach = is_under and is_above; contact = contact_in_reach and in_reach;
clear = exterior or interior; decided = clear or contact;".

Definition two_planes := steps_of "
xx = x * x; yy = y * y; zz = z * z; radius = xx + yy; distance = radius + zz; x1 = r1_x * x; y1 = r1_y * y; c1 = x1 +
y1; x2 = r2_x * x; y2 = r2_y * y; xy2 = x2 + y2; z2 = r2_z * z; c2 = xy2 + z2; x3 = r3_x * x; y3 = r3_y * y; xy3 = x3
+ y3; z3 = r3_z * z; c3 = xy3 + z3; P1 = c1 * c1; P2 = c2 * c2; Q = c3 * c3; in_reach = Q <= reach; part_beyond_1 =
a_beyond_1 * P2; place_beyond_1 = P1 + part_beyond_1; rise_beyond_1 = M_beyond_1 * Q; line_beyond_1 = K_beyond_1 +
rise_beyond_1; exterior_1 = place_beyond_1 > line_beyond_1; part_beyond_2 = a_beyond_2 * P2; place_beyond_2 = P1 +
part_beyond_2; rise_beyond_2 = M_beyond_2 * Q; line_beyond_2 = K_beyond_2 + rise_beyond_2; exterior_2 = place_beyond_2
> line_beyond_2; part_within_1 = a_within_1 * P2; place_within_1 = P1 + part_within_1; rise_within_1 = M_within_1 * Q;
line_within_1 = K_within_1 + rise_within_1; interior_1 = place_within_1 < line_within_1; part_within_2 = a_within_2 *
P2; place_within_2 = P1 + part_within_2; rise_within_2 = M_within_2 * Q; line_within_2 = K_within_2 + rise_within_2;
interior_2 = place_within_2 < line_within_2; part_under_1 = a_under_1 * P2; place_under_1 = P1 + part_under_1;
rise_under_1 = M_under_1 * Q; line_under_1 = K_under_1 + rise_under_1; is_under_1 = place_under_1 < line_under_1;
part_under_2 = a_under_2 * P2; place_under_2 = P1 + part_under_2; rise_under_2 = M_under_2 * Q; line_under_2 =
K_under_2 + rise_under_2; is_under_2 = place_under_2 < line_under_2; part_above_1 = a_above_1 * P2; place_above_1 = P1
+ part_above_1; rise_above_1 = M_above_1 * Q; line_above_1 = K_above_1 + rise_above_1; is_above_1 = place_above_1 >=
line_above_1; part_above_2 = a_above_2 * P2; place_above_2 = P1 + part_above_2; rise_above_2 = M_above_2 * Q;
line_above_2 = K_above_2 + rise_above_2; is_above_2 = place_above_2 >= line_above_2; exterior = exterior_1 or
exterior_2; interior = interior_1 or interior_2; is_under = is_under_1 and is_under_2; is_above = is_above_1 and
is_above_2; contact_in_reach = is_under and is_above; contact = contact_in_reach and in_reach; clear = exterior or
interior; decided = clear or contact;".
