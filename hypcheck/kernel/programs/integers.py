"""The programs of the last stage, in whole numbers: nothing is divided, so integers stay integers.

**Upright.** INTEGERS computes the coefficients of the cubic g times N = b² d², and the numbers whose signs the rule for
all regimes reads (docs/mathematics.md). p, q, s, t are the squares of α, b, γ, d; A = p/q and B = s/t. Lengths may be
in one unit for α, b, x, y and in another for γ, d, z. n2 and n1 are N c2 and N c1, and ps is −N c0; delta is 3 N⁴ Δ,
slope_at_B is N t² g'(B), slope_at_A is N q² g'(−A).

**A tilted axis.** QUARTIC computes the coefficients of the pair's quartic F. With w the square of the axis' length,

    F(λ) = λ (λ E + (p + qλ)(G − λ m)) − (1 + λ)(p + qλ)(k0 + k1 λ − k2 λ²) = f4 λ⁴ + f3 λ³ + f2 λ² + f1 λ + f0

is p² q² s t w det(S + λH), as tests/kernel/test_tilted_integers.py checks. Lengths have one unit, the axis another.
`minus_f0` is −f0, as f0 is negative. `delta` is 27 times the discriminant of F.

**A tangency**, in whole numbers of fixed width (docs/kernel.md, "A tangency"). With D = b d and K = α γ, a row touches
where there are whole numbers M and e of one sign with M e = D K, n2 = −(2 D M + e²) and n1 = M² + 2 K e. The inputs M
and e of TANGENCY are their sizes, and `inner` says that both are negative. r1, r2 and r3 are the differences between
the two sides of these equations. `room_within`, `room_without` and `beyond` must not be negative: then the double root
lies between the poles, and it is not a ring. WAIST is the rule in the plane z = 0, where g is B − λ times
−(λ² − w λ + A), and W is b² w; its input `size` is |W|. In C a length is one word, numbers of degree 2 are NARROW, and
all others are twice as wide; numbers that may be negative are in two's complement. Coq proves that each number fits
(StageFour.v).
"""

from __future__ import annotations

from collections.abc import Mapping

from hypcheck.derivation.program import Argument, Program, Step, cut, needed, program_of, steps_of
from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS

INTEGERS = program_of(
    "integers",
    COLUMNS,
    """
    p = alpha * alpha
    q = b * b
    s = gamma * gamma
    t = d * d
    xx = x * x
    yy = y * y
    R = xx + yy
    S = z * z
    N = q * t
    p_plus_q = p + q
    p_q_R = p_plus_q - R
    s_plus_S = s + S
    radial_2 = p_q_R * t
    axial_2 = s_plus_S * q
    n2 = radial_2 - axial_2
    t_minus_s = t - s
    t_s_S = t_minus_s - S
    R_minus_q = R - q
    axial_1 = t_s_S * p
    radial_1 = R_minus_q * s
    n1 = axial_1 + radial_1
    ps = p * s
    n2_n2 = n2 * n2
    N_n1 = N * n1
    N_n1_3 = 3 * N_n1
    h1 = n2_n2 - N_n1_3
    n2_n1 = n2 * n1
    N_ps = N * ps
    N_ps_9 = 9 * N_ps
    h2 = n2_n1 + N_ps_9
    n1_n1 = n1 * n1
    n2_ps = n2 * ps
    n2_ps_3 = 3 * n2_ps
    h3 = n1_n1 + n2_ps_3
    h1_h3 = h1 * h3
    h1_h3_4 = 4 * h1_h3
    h2_h2 = h2 * h2
    delta = h1_h3_4 - h2_h2
    N_s = N * s
    N_s_3 = 3 * N_s
    n2_t = n2 * t
    offset_at_B = N_s_3 + n2_t
    offset_and_n2_t = offset_at_B + n2_t
    rise_at_B = offset_and_n2_t * s
    n1_t = n1 * t
    n1_tt = n1_t * t
    slope_at_B = rise_at_B + n1_tt
    N_p = N * p
    N_p_3 = 3 * N_p
    n2_q = n2 * q
    offset_at_A = N_p_3 - n2_q
    offset_less_n2_q = offset_at_A - n2_q
    rise_at_A = offset_less_n2_q * p
    n1_q = n1 * q
    n1_qq = n1_q * q
    slope_at_A = rise_at_A + n1_qq
    p_t = p * t
    p_tt = p_t * t
    q_s = q * s
    q_ss = q_s * s
    ring_excess = q_ss - p_tt
""",
)
"""The program from an upright row to the coefficients of g times N, delta, and slopes and offsets at the poles."""

QUARTIC = program_of(
    "tilted-quartic",
    TILTED_COLUMNS,
    """
    p = alpha * alpha
    q = b * b
    s = gamma * gamma
    t = d * d
    axis_xx = axis_x * axis_x
    axis_yy = axis_y * axis_y
    level = axis_xx + axis_yy
    upward = axis_z * axis_z
    w = level + upward
    xx = x * x
    yy = y * y
    radius = xx + yy
    height = z * z
    distance = radius + height
    axis_x_y = axis_x * y
    axis_y_x = axis_y * x
    cross = axis_x_y - axis_y_x
    axis_x_x = axis_x * x
    axis_y_y = axis_y * y
    axis_z_z = axis_z * z
    along_level = axis_x_x + axis_y_y
    along = along_level + axis_z_z
    t_minus_q = t - q
    s_plus_p = s + p
    scale_E = t_minus_q * s_plus_p
    cross_cross = cross * cross
    E = scale_E * cross_cross
    s_radius = s * radius
    p_height = p * height
    slope = s_radius - p_height
    G = w * slope
    tw = t * w
    tw_distance = tw * distance
    along_along = along * along
    along_part = t_minus_q * along_along
    m = tw_distance - along_part
    ps = p * s
    k0 = ps * w
    t_level = t * level
    q_upward = q * upward
    along_z = t_level + q_upward
    t_upward = t * upward
    q_level = q * level
    across_z = t_upward + q_level
    s_along_z = s * along_z
    p_across_z = p * across_z
    k1 = s_along_z - p_across_z
    k2 = q * tw
    p_plus_q = p + q
    minus_f0 = p * k0
    G_k1 = G - k1
    p_G_k1 = p * G_k1
    pq_k0 = p_plus_q * k0
    f1 = p_G_k1 - pq_k0
    G_k0 = G - k0
    q_G_k0 = q * G_k0
    k2_m = k2 - m
    p_k2_m = p * k2_m
    pq_k1 = p_plus_q * k1
    E_q = E + q_G_k0
    E_q_p = E_q + p_k2_m
    f2 = E_q_p - pq_k1
    m_k1 = m + k1
    q_m_k1 = q * m_k1
    pq_k2 = p_plus_q * k2
    f3 = pq_k2 - q_m_k1
    f4 = q * k2
""",
)
"""The program from a tilted row to the coefficients of F."""

COEFFICIENTS = ("minus_f0", "f1", "f2", "f3", "f4")

INVARIANTS = program_of(
    "tilted-invariants",
    COEFFICIENTS,
    """
    f2_f2 = f2 * f2
    f3_f1 = f3 * f1
    f4_f0 = f4 * minus_f0
    thrice_f3_f1 = 3 * f3_f1
    twelvefold_f4_f0 = 12 * f4_f0
    two_terms = f2_f2 - thrice_f3_f1
    I = two_terms - twelvefold_f4_f0
    ninefold_f3_f1 = 9 * f3_f1
    many_f4_f0 = 72 * f4_f0
    twice_f2_f2 = 2 * f2_f2
    one_factor = ninefold_f3_f1 - many_f4_f0
    factor = one_factor - twice_f2_f2
    middle = f2 * factor
    f3_f3 = f3 * f3
    f0_f3_f3 = minus_f0 * f3_f3
    f1_f1 = f1 * f1
    f4_f1_f1 = f4 * f1_f1
    ends = f0_f3_f3 - f4_f1_f1
    many_ends = 27 * ends
    J = middle + many_ends
""",
)
"""The program to I = 12 f4 f0 − 3 f3 f1 + f2² and J = 72 f4 f2 f0 + 9 f3 f2 f1 − 27 f4 f1² − 27 f0 f3² − 2 f2³."""

DISCRIMINANT = program_of(
    "tilted-discriminant",
    ("I", "J"),
    """
    I_I = I * I
    I_I_I = I_I * I
    fourfold_I = 4 * I_I_I
    J_J = J * J
    delta = fourfold_I - J_J
""",
)
"""The program from I and J to delta, 27 times the discriminant of F."""

FLOAT64_BITS = 2098
"""The bits of the largest float64 as a multiple of the smallest: 2¹⁰²⁴ / 2⁻¹⁰⁷⁴ = 2²⁰⁹⁸."""


def bits_counted(program: Program, of_inputs: int = FLOAT64_BITS) -> dict[str, int]:
    """Return for every step how many bits its size has at most, if each input has at most `of_inputs` bits.

    A product has no more bits than its factors together, a sum at most one more than the longer term. Raises
    ValueError for any other operation.
    """
    bits = dict.fromkeys(program.inputs, of_inputs)

    def of(argument: Argument) -> int:
        return bits[argument] if isinstance(argument, str) else abs(argument).bit_length()

    for step in program.steps:
        counts = [of(argument) for argument in step.arguments]
        if step.operation == "mul":
            bits[step.name] = sum(counts)
        elif step.operation in {"add", "sub"}:
            bits[step.name] = max(counts) + 1
        else:
            raise ValueError(
                f"program {program.name}: step {step.name}: {step.operation} is not an operation on integers"
            )
    return bits


def integer_statements(
    program: Program, wanted: tuple[str, ...], phrases: Mapping[str, str], known: tuple[str, ...] = ()
) -> list[str]:
    """Return a statement for each step that the wanted names need and the known names do not.

    `phrases` has texts for str.format for the operations add, sub and mul, and for scale, the product with an integer.
    They contain {name}, the arguments {0} and {1}, the {bits} that are counted, and {limbs}: how many limbs of 32 bits
    hold these, and two more.
    """
    bits, before = bits_counted(program), needed(program, known)
    return [
        phrases["scale" if isinstance(step.arguments[0], int) else step.operation].format(
            *step.arguments, name=step.name, bits=bits[step.name], limbs=-(-bits[step.name] // 32) + 2
        )
        for step in needed(program, wanted)
        if step not in before
    ]


TANGENCY = Program(
    "tangency",
    (*COLUMNS, "M", "e", "about"),
    cut(INTEGERS, COLUMNS, ("n2", "n1")).steps
    + steps_of("""
    inner = about < 0
    D = b * d
    K = alpha * gamma
    D_K = D * K
    M_e = M * e
    e_e = e * e
    D_M = D * M
    r1 = D_K - M_e
    n2_e_e = n2 + e_e
    D_M_2 = D_M + D_M
    r2_outer = n2_e_e + D_M_2
    r2_inner = n2_e_e - D_M_2
    r2 = inner ? r2_inner : r2_outer
    K_e = K * e
    M_M = M * M
    M_M_n1 = M_M - n1
    K_e_2 = K_e + K_e
    r3_outer = M_M_n1 + K_e_2
    r3_inner = M_M_n1 - K_e_2
    r3 = inner ? r3_inner : r3_outer
    p_D = p * D
    M_q = M * q
    room_within = p_D - M_q
    beyond = e_e - D_M
    s_D = s * D
    M_t = M * t
    room_without = s_D - M_t
"""),
)
"""The program that checks M and e for a row: it touches if r1 = r2 = r3 = 0 and no room is negative."""

WAIST = program_of(
    "waist",
    (*COLUMNS, "size"),
    """
    p = alpha * alpha
    q = b * b
    xx = x * x
    yy = y * y
    R = xx + yy
    R_less_q = R - q
    W = R_less_q - p
    p_plus_q = p + q
    opposite = p_plus_q - R
    p_2 = p + p
    q_2 = q + q
    four_A = p_2 * q_2
    square = size * size
    excess = four_A - square
    W_p_2 = W + p_2
    s = gamma * gamma
    t = d * d
    q_2_s = q_2 * s
    W_t = W * t
    room = q_2_s - W_t
""",
)
"""The program of the rule for rows with z = 0."""

_SQUARES = ("p", "q", "s", "t", "xx", "yy", "R", "S", "p_2", "q_2")
_SUMS = ("p_plus_q", "p_q_R", "s_plus_S", "t_minus_s", "t_s_S", "R_minus_q", "R_less_q", "W", "opposite", "W_p_2")
NARROW = frozenset((*_SQUARES, *_SUMS, "D", "K", "M", "e", "size"))
"""The numbers of degree 2 in the lengths, and M, e and `size`: in C they are half as wide as all others."""

SIGNED = frozenset(("p_q_R", "t_s_S", "R_minus_q", "W"))
"""Factors that may be negative."""

BEFORE = ("D_K", "n2", "inner")
EQUATIONS = ("r1", "r2")
LAST = ("r3", "room_within", "beyond", "room_without")
"""The results that the C code needs from each of the three parts of TANGENCY, in the order of the code."""


def statements_of(program: Program, wanted: tuple[str, ...], known: tuple[str, ...] = (), *, short: bool) -> list[str]:
    """Return the C statements of the steps that the wanted names need and the known names do not.

    `short` is for lengths below 2²³: a number of degree 2 then takes one word.
    """
    before = needed(program, known)
    return [_statement(step, _SHORT if short else _LONG) for step in needed(program, wanted) if step not in before]


_LONG = {
    "narrow": "hc_fixed",
    "wide": "hc_long",
    "lengths": "hc_fixed_full({0}, {1})",
    "narrow add": "hc_fixed_plus({0}, {1})",
    "narrow sub": "hc_fixed_minus({0}, {1})",
    "wide mul": "hc_long_product({0}, {1})",
    "signed mul": "hc_long_signed_product({0}, {1})",
    "wide add": "hc_long_sum({0}, {1}, 0)",
    "wide sub": "hc_long_sum({0}, {1}, 1)",
}
_SHORT = {
    "narrow": "uint64_t",
    "wide": "hc_fixed",
    "lengths": "{0} * {1}",
    "narrow add": "{0} + {1}",
    "narrow sub": "{0} - {1}",
    "wide mul": "hc_fixed_full({0}, {1})",
    "signed mul": "hc_fixed_full_signed({0}, {1})",
    "wide add": "hc_fixed_plus({0}, {1})",
    "wide sub": "hc_fixed_minus({0}, {1})",
}


def _statement(step: Step, spelling: Mapping[str, str]) -> str:
    """Return a step as a statement of C, in the types of the spelling."""
    names = tuple(map(str, step.arguments))
    if step.operation == "lt":
        return f"const int {step.name} = {names[0]} < {names[1]};"
    width = "narrow" if step.name in NARROW else "wide"
    if step.operation == "select":
        value = "{0} ? {1} : {2}"
    elif step.operation != "mul":
        value = spelling[f"{width} {step.operation}"]
    elif width == "narrow":
        value = spelling["lengths"]
    else:
        value = spelling["signed mul" if SIGNED.intersection(names) else "wide mul"]
        names = tuple(sorted(names, key=lambda name: name not in SIGNED))
    return f"const {spelling[width]} {step.name} = {value.format(*names)};"
