"""The program for one pair in plain Python, where each operation costs as much as a comparison or a call.

It is `certified` with a cheaper bound, the one that the formula object counts (derivation/rounding.py): a computed
value is off by at most γ_k M, M being the sum of its terms' sizes, without any of their cancellation. k is 7 for c2,
11 for c1 and 42 for 3Δ (tests/kernel/test_programs.py asks); the constants below leave a unit or more for the second
order, for the rounding of M and for squares that underflow. For 3Δ, M = 4 H1 H3 + H2² with H1 = M2² + 3 M1,
H2 = M2 M1 + 9 AB and H3 = M1² + 3 M2 AB is at most 32 (M2 M1)²: multiplied out, the difference has no negative term.
What it leaves open, or what lies outside c² > a > 1, goes to the integers.

Range. b, d, A and B in 2^±100 and P + Q < FARTHEST = 2²⁰⁰ are asked for, as in `certified` and for its reason:
M2 < 2²⁰¹ and M1 < 2³⁰¹, so (M2 M1)² < 2¹⁰⁰⁴, and 3Δ, at most 32 times that, does not overflow either.
"""

from __future__ import annotations

from hypcheck.derivation.coefficient_listings import HESSIAN_DISCRIMINANT, TABLE_2
from hypcheck.derivation.listing import program_of
from hypcheck.kernel.programs.certified import SLACK, U
from hypcheck.pairs import COLUMNS

CONSTANTS = {"u_8": 8 * U * SLACK, "u_12": 12 * U * SLACK, "u_1536": 48 * 32 * U * SLACK}

SINGLE = program_of(
    "single",
    (*COLUMNS, *CONSTANTS),
    TABLE_2,
    HESSIAN_DISCRIMINANT,
    """
    P_plus_Q = P + Q
    A_plus_B = A + B
    sizes_2 = A_plus_B + 1
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
""",
)

RESULTS = ("A", "B", "BB", "P_plus_Q", "c1", "e1", "c2", "e2", "delta_3", "E")
"""What a kernel takes from it: delta_3, c1 and c2 with their error bounds E, e1 and e2, and what the range asks of."""
