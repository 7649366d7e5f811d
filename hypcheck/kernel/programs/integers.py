"""The program of the last stage: N = b² d² times the coefficients of g, and what the rule for all regimes asks of them.

Nothing is divided, so integers stay integers; lengths may be in one unit for α, b, x, y and in another for γ, d, z.
n2, n1 and −n0 = p s are N c2, N c1 and N c0's size; delta is 3 N⁴ Δ, slope_at_B is N t² g'(B), slope_at_A N q² g'(−A).
"""

from __future__ import annotations

from hypcheck.derivation.program import Argument, Program, needed, program_of
from hypcheck.geometry.pair import COLUMNS

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

FLOAT64_BITS = 2098
"""Bits of the largest float64 in units of the smallest: 2¹⁰²⁴ / 2⁻¹⁰⁷⁴."""


def bits_counted(program: Program, of_inputs: int = FLOAT64_BITS) -> dict[str, int]:
    """For every step the bits that its size cannot exceed, where each input has at most `of_inputs` bits.

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
            raise ValueError(f"program {program.name}: step {step.name}: {step.operation} is no operation on integers")
    return bits


def limb_products(program: Program, wanted: tuple[str, ...], of_inputs: int = FLOAT64_BITS, limb: int = 64) -> int:
    """The most products of two limbs that the steps which lead to `wanted` take, by the method of school."""
    bits = bits_counted(program, of_inputs)

    def limbs(argument: Argument) -> int:
        return -(-(bits[argument] if isinstance(argument, str) else abs(argument).bit_length()) // limb)

    products = (step.arguments for step in needed(program, wanted) if step.operation == "mul")
    return sum(limbs(left) * limbs(right) for left, right in products)


WORST = ("delta", "slope_at_B", "ring_excess")
"""What the rule asks of a row at most: where there is no ring it is less."""
