"""The programs of the stage that proves a tangency, in whole numbers of fixed width (docs/kernel.md, "A tangency").

With D = b d and K = α γ, a row touches where there are whole numbers M and e of one sign with M e = D K,
n2 = −(2 D M + e²) and n1 = M² + 2 K e. TANGENCY has their sizes, and `inner` says that both are negative: r1, r2 and r3
are what the equations are off by; the rooms and `beyond`, which must not be negative, say that the double root lies
between the poles and is no ring. WAIST is the rule in the plane z = 0, where g is B − λ times −(λ² − w λ + A) and W is
b² w; `size` is that of W.

In C a length is a word, what has degree 2 is NARROW, and all else twice as wide: what may be negative is in two's
complement. That each number fits is proved in Coq (StageFour.v).
"""

from __future__ import annotations

from collections.abc import Mapping

from hypcheck.derivation.program import Program, Step, cut, needed, program_of, steps_of
from hypcheck.geometry.pair import COLUMNS
from hypcheck.kernel.programs.integers import INTEGERS

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

_SQUARES = ("p", "q", "s", "t", "xx", "yy", "R", "S", "p_2", "q_2")
_SUMS = ("p_plus_q", "p_q_R", "s_plus_S", "t_minus_s", "t_s_S", "R_minus_q", "R_less_q", "W", "opposite", "W_p_2")
NARROW = frozenset((*_SQUARES, *_SUMS, "D", "K", "M", "e", "size"))
"""Of degree 2 in the lengths."""

SIGNED = frozenset(("p_q_R", "t_s_S", "R_minus_q", "W"))
"""Factors that may be negative."""

BEFORE = ("D_K", "n2", "inner")
EQUATIONS = ("r1", "r2")
LAST = ("r3", "room_within", "beyond", "room_without")
"""What the parts of TANGENCY are asked for, in the order of the C."""


def statements_of(program: Program, wanted: tuple[str, ...], known: tuple[str, ...] = (), *, short: bool) -> list[str]:
    """The steps in C that the wanted names need, less those for the known ones; `short` for lengths below 2²³."""
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
