"""Listings that formulas share: A, B, P and Q of the seven numbers, coefficients of g, discriminants, decisions.

A = (α/b)², B = (γ/d)², P = (x0² + y0²)/b², Q = (z0/d)², and g(λ) = λ³ + c2 λ² + c1 λ + c0. Sums are taken from left to
right. A subexpression that is printed twice is computed once: it would round to the same value.

Why the rules hold. g(−A) = −AP(A+B) ≤ 0, g(0) = −AB < 0, g(B) = −BQ(A+B) ≤ 0 and g grows without bound, so one root is
at least B, and the other two are complex or lie together in one of (−∞, −A], [−A, 0), (0, B], [B, ∞). The spheroid is
exterior exactly where g > 0 somewhere in (0, B), interior where g > 0 somewhere in (−A, 0), else in contact.

Why `all_regimes` holds. Δ > 0 means three simple roots. They are all positive exactly if c2 < 0 and c1 > 0 (Descartes,
c0 < 0). If so, the pair is exterior unless no root is below B; and no root is below B exactly if c2 < −3B (their sum
exceeds 3B) and g'(B) > 0. (If there are roots r1 < r2 ≤ B, then B is beyond the first critical point of g; g'(B) > 0
puts it beyond the second, hence beyond the inflection −c2/3, which contradicts c2 < −3B.) If they are not all positive,
two are negative, and the pair is interior unless both are ≤ −A; by the same argument both are > −A, or one is −A and
one above, exactly if c2 < 3A and g'(−A) > 0.

Δ = 0 with a double root m and a simple root s: g = (λ−m)²(λ−s). Contact, unless g > 0 somewhere in (0, B), that is
s < B; then g(B) ≤ 0 leaves only m = B, so Q = 0 and g'(B) = 0, and s = AB/m² = A/B < B reads A < B². Conversely
these three give m = B and 0 < s < B: the ring of exterior positions with Δ = 0. In (−A, 0) g > 0 would ask for
s < 0, but s = AB/m² > 0; with a triple root λ³ = AB, so g < 0 below it and it is ≥ B. Δ < 0: the one real root
is ≥ B and g < 0 below it: contact.
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

H1 = """
    c2_squared = c2 * c2
    three_c1 = 3 * c1
    h1 = c2_squared - three_c1
"""

# 3Δ = 4 h1 h3 − h2², with the coefficients of the Hessian of the cubic.
HESSIAN_DISCRIMINANT = (
    H1
    + """
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
)


def equation_13(c0: str = "c0", suffix: str = "") -> str:
    """Return the listing of Δ of c0, c1 and c2 as equation (13) prints it.

    Δ = −4 c2³ c0 + c2² c1² + 18 c2 c1 c0 − 4 c1³ − 27 c0². Every name but that of c0 ends in `suffix`, so that one
    program can contain the listing several times.
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


# Procedure 1 and Table 2: valid ← (Δ > 0) and (c2 < 0) and (c1 > 0).
PROPOSITION_3 = """
    distinct = delta > 0
    c2_negative = c2 < 0
    c1_positive = c1 > 0
    distinct_and_c2 = distinct and c2_negative
    valid = distinct_and_c2 and c1_positive
"""

POSITION = """
    not_exterior = interior ? -1 : 0
    position = exterior ? 1 : not_exterior
"""


def all_regimes(discriminant: str) -> str:
    """Return the listing of the position from c1, c2, A, B, Q and a positive multiple of Δ, for all sizes.

    `discriminant` is the name of that multiple. The proof stands at the head of this module.
    """
    return (
        f"""
    distinct = {discriminant} > 0
    c2_negative = c2 < 0
    c1_positive = c1 > 0
    all_positive = c2_negative and c1_positive
    two_c2 = 2 * c2
    three_B = 3 * B
    chord_at_B = three_B + two_c2
    rise_at_B = chord_at_B * B
    slope_at_B = rise_at_B + c1         # g'(B)
    minus_three_B = - three_B
    sum_beyond_B = c2 < minus_three_B
    rises_at_B = slope_at_B > 0
    none_below_B = sum_beyond_B and rises_at_B
    some_below_B = not none_below_B
    positive_pair = distinct and all_positive
    pair_below_B = positive_pair and some_below_B
    at_waist = Q == 0
    flat_at_B = slope_at_B == 0
    BB = B * B
    simple_below_B = A < BB
    double_at_B = at_waist and flat_at_B
    ring = double_at_B and simple_below_B
    exterior = pair_below_B or ring
    some_negative = not all_positive
    negative_pair = distinct and some_negative
    three_A = 3 * A
    sum_above_minus_A = c2 < three_A
    chord_at_minus_A = three_A - two_c2
    rise_at_minus_A = chord_at_minus_A * A
    slope_at_minus_A = rise_at_minus_A + c1     # g'(−A)
    rises_at_minus_A = slope_at_minus_A > 0
    pair_above_minus_A = sum_above_minus_A and rises_at_minus_A
    interior = negative_pair and pair_above_minus_A
"""
        + POSITION
    )


def _side_of(at: str, clear: str) -> str:
    """Return the listing of the position from the λ by the name `at`, if the condition `clear` holds.

    It is exterior between 0 and B, interior between −A and 0, and else contact.
    """
    return (
        f"""
    minus_A = - A
    positive = {at} > 0
    below_B = {at} < B
    between_0_and_B = positive and below_B
    exterior = {clear} and between_0_and_B
    negative = {at} < 0
    above_minus_A = {at} > minus_A
    between_minus_A_and_0 = negative and above_minus_A
    interior = {clear} and between_minus_A_and_0
"""
        + POSITION
    )


# If g > 0 somewhere in (0, B) or (−A, 0), at whose ends g ≤ 0, then g has a local maximum there; a cubic has one, at
# λm = (−c2 − √h1)/3 with h1 = c2² − 3 c1 > 0. Where c2 < 0 the numerator cancels, and λm = c1/(−c2 + √h1) does not.
LOCAL_MAXIMUM = (
    H1
    + """
    root = sqrt h1
    minus_c2 = - c2
    root_sum = minus_c2 + root
    from_c1 = c1 / root_sum
    root_difference = minus_c2 - root
    from_c2 = root_difference / 3
    c2_negative = c2 < 0
    lambda_m = c2_negative ? from_c1 : from_c2
    g_2 = lambda_m + c2
    g_2_lambda = g_2 * lambda_m
    g_1 = g_2_lambda + c1
    g_1_lambda = g_1 * lambda_m
    g_m = g_1_lambda + c0               # g(λm)
    has_maximum = h1 > 0
    above_zero = g_m > 0
    clear = has_maximum and above_zero
"""
    + _side_of("lambda_m", "clear")
)

# φ(λ) = Pλ/(A+λ) − Qλ/(B−λ) − (1+λ), and g = (A+λ)(B−λ)φ, so φ and g have one sign in (−A, B).
DUAL = """
    P_lambda = P * lambda_
    A_plus_lambda = A + lambda_
    P_term = P_lambda / A_plus_lambda
    Q_lambda = Q * lambda_
    B_minus_lambda = B - lambda_
    Q_term = Q_lambda / B_minus_lambda
    P_term_minus_Q_term = P_term - Q_term
    one_plus_lambda = 1 + lambda_
    phi = P_term_minus_Q_term - one_plus_lambda
    above_zero = phi > 0
""" + _side_of("lambda_", "above_zero")


def proposition_5(suffix: str = "") -> str:
    """Return the listing of `inside`, the condition of Procedures 2.a and 2.b for Δ > 0.

    The condition is [c2 > 0; c1 ≠ 0] or [c2 < 0; c1 < 0].
    """
    end = suffix
    return f"""
    c2_positive{end} = c2{end} > 0
    c1_nonzero{end} = c1{end} != 0
    first{end} = c2_positive{end} and c1_nonzero{end}
    c2_negative{end} = c2{end} < 0
    c1_negative{end} = c1{end} < 0
    second{end} = c2_negative{end} and c1_negative{end}
    inside{end} = first{end} or second{end}
"""


def not_all_positive(suffix: str = "") -> str:
    """Return the listing of `some_negative`, which the corrected Proposition 5 requires in addition to Δ > 0.

    It is: not (c2 < 0 and c1 > 0).
    """
    end = suffix
    return f"""
    c2_negative{end} = c2{end} < 0
    c1_positive{end} = c1{end} > 0
    all_positive{end} = c2_negative{end} and c1_positive{end}
    some_negative{end} = not all_positive{end}
"""


# "if Δ ≤ 0 then non-valid, else …": as printed, so a Δ that is NaN goes to the else branch.
ONE_SPHEROID = (
    """
    touching = delta <= 0
    apart = not touching
"""
    + proposition_5()
    + """
    valid = apart and inside
"""
)
