"""The paper's statements about pairs, and what they become when repaired, as conditions on the facts of a point."""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.derivation.decisions import decisions
from hypcheck.pairs import Position
from hypcheck.paper.ledger.facts import Facts
from hypcheck.paper.ledger.search import Statement


def tall(facts: Facts) -> bool:
    """(γ/d)² ≥ α/b, the regime of Proposition 3."""
    return facts.B >= facts.point.a


def wide(facts: Facts) -> bool:
    """α/b ≥ 1, the regime of Proposition 5 and of Procedures 2.a and 2.b."""
    return facts.point.a >= 1


def very_tall(facts: Facts) -> bool:
    """(γ/d)² > (α/b)² + 1, where c2 < 0 for every centre."""
    return facts.B > facts.A + 1


def off_the_waist(facts: Facts) -> bool:
    """z0 ≠ 0, where there is no ring."""
    return facts.Q != 0


def exterior(facts: Facts) -> bool:
    """Whether the spheroid is exterior."""
    return facts.position is Position.EXTERIOR


def interior(facts: Facts) -> bool:
    """Whether the spheroid is interior."""
    return facts.position is Position.INTERIOR


def contact(facts: Facts) -> bool:
    """Whether there is contact."""
    return facts.position is Position.CONTACT


def three_positive(facts: Facts) -> bool:
    """The sign pattern that Proposition 3 asks for beside Δ > 0."""
    return facts.c2 < 0 and facts.c1 > 0


def printed_interior(facts: Facts) -> bool:
    """The sign pattern that Proposition 5 asks for beside Δ > 0."""
    return (facts.c2 > 0 and facts.c1 != 0) or (facts.c2 < 0 and facts.c1 < 0)


def ring(facts: Facts) -> bool:
    """The exterior positions with Δ = 0: Q = 0, g'(B) = 0 and A < B²."""
    return facts.Q == 0 and facts.slope_at_B == 0 and facts.A < facts.B**2


def rule_of_all_sizes(facts: Facts) -> int:
    """The position by the rule that the program "coefficients" is proved to decide by."""
    (decision,) = decisions("coefficients")
    numbers = (facts.delta, facts.c1, facts.c2, facts.A, facts.B, facts.Q, facts.slope_at_B, facts.slope_at_minus_A)
    return decision.rule(*numbers)


PROPOSITION_3_1 = Statement(
    "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0",
    tall,
    lambda facts: exterior(facts) == (facts.delta > 0 and three_positive(facts)),
)
PROPOSITION_3_2 = Statement("Δ ≤ 0 ⟹ contact", tall, lambda facts: facts.delta > 0 or contact(facts))
THREE_POSITIVE_ROOTS = Statement(
    "exterior ⟺ g has three different positive roots",
    tall,
    lambda facts: exterior(facts) == (facts.delta > 0 and facts.negative_roots == 0),
)
ALL_POSITIVE = Statement(
    "c2 < 0 and c1 > 0 ⟺ all real roots of g are positive",
    tall,
    lambda facts: three_positive(facts) == (facts.negative_roots == 0),
)
REMARK_4 = Statement(
    "two different negative roots ⟹ contact or interior",
    tall,
    lambda facts: not (facts.delta > 0 and facts.negative_roots == 2) or not exterior(facts),
)


def _proposition_5_1(text: str, zero: Callable[[Facts], bool]) -> Statement:
    """The printed statement, tried on the pairs where one of the coefficients is 0."""
    return Statement(
        text,
        lambda facts: facts.point.a > 1 and zero(facts),
        lambda facts: interior(facts) == (facts.delta > 0 and printed_interior(facts)),
    )


_5_1 = "interior ⟺ Δ > 0 and [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0]"
PROPOSITION_5_1 = _proposition_5_1(_5_1, lambda _: True)
PROPOSITION_5_1_WITH_C2 = _proposition_5_1(f"{_5_1}, for c2 = 0", lambda facts: facts.c2 == 0)
PROPOSITION_5_1_WITH_C1 = _proposition_5_1(f"{_5_1}, for c1 = 0", lambda facts: facts.c1 == 0)
PROPOSITION_5_2 = Statement(
    "Δ ≤ 0 ⟹ contact", lambda facts: facts.point.a > 1, lambda facts: facts.delta > 0 or contact(facts)
)
REMARK_6 = Statement(
    "three different positive roots ⟹ contact or exterior",
    wide,
    lambda facts: not (facts.delta > 0 and facts.negative_roots == 0) or not interior(facts),
)
REPAIRED_3 = Statement(
    "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring; Δ ≤ 0 ⟹ contact or the ring",
    tall,
    lambda facts: (
        exterior(facts) == ((facts.delta > 0 and three_positive(facts)) or ring(facts))
        and (facts.delta > 0 or contact(facts) or ring(facts))
    ),
)
REPAIRED_5 = Statement(
    "interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0); Δ ≤ 0 ⟹ contact or the ring",
    wide,
    lambda facts: (
        interior(facts) == (facts.delta > 0 and not three_positive(facts))
        and (facts.delta > 0 or contact(facts) or ring(facts))
    ),
)
ALL_SIZES = Statement(
    "the position is that of the coefficient rule for all sizes",
    lambda _: True,
    lambda facts: rule_of_all_sizes(facts) == facts.position,
)
