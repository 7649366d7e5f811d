"""The ledger's lines about Theorem 1, the remarks and the propositions."""

from __future__ import annotations

from itertools import chain

from hypcheck.derivation.links import known, printed
from hypcheck.pairs import Position
from hypcheck.paper.ledger import statements as say
from hypcheck.paper.ledger.entry import (
    FALSE,
    NOT_CHECKABLE,
    PROVED,
    Entry,
    Evidence,
    by_chain,
    with_counterexample,
    with_examples,
    without_counterexample,
)
from hypcheck.paper.ledger.facts import Facts
from hypcheck.paper.ledger.search import Condition, first
from hypcheck.proofs.build import pattern_table
from hypcheck.truth.kinds import Kind
from hypcheck.truth.roots_patterns import PATTERNS, Place, admissible, pattern_of


def propositions() -> tuple[Entry, ...]:
    """Section 2's statements, in its order."""
    return (
        _theorem_1(),
        _known_root(),
        _remark_2(),
        *_of_reference_10(),
        _proposition_3_1(),
        _proposition_3_2(),
        *_proof_of_3(),
        _remark_4(),
        _proposition_5_1(),
        _proposition_5_2(),
        _remark_6(),
    )


def _theorem_1() -> Entry:
    return Entry(
        "Theorem 1",
        "2",
        "spheroid and hyperboloid touch as sphere and scaled hyperboloid do",
        PROVED,
        "a one-to-one linear map takes the two equations into each other, values inside and outside included",
        "seven numbers become four; the position too stays the same, not contact alone",
        lambda: (by_chain("Theorem 1"), Evidence("identity", "(7), (8) and (10) hold", _holds("7", "8", "10"))),
    )


def _holds(*numbers: str) -> bool:
    return all(part.holds for number in numbers for part in printed(number))


def _known_root() -> Entry:
    factor = known("det(λH + S) = (A + λ)·g(λ)/(A²·B)")
    return Entry(
        "after (12)",
        "2",
        "−a² is a root of f, and the other roots are those of g",
        PROVED,
        "f is (a² + λ)·g(λ) times a constant",
        "three roots, or three coefficients, decide; the fourth root is always there",
        lambda: (Evidence("identity", factor.text, factor.holds),),
    )


def _remark_2() -> Entry:
    product = known("Δ is the product of the squared differences of the roots")
    return Entry(
        "Remark 2",
        "2",
        "(13) is the discriminant and (14) the coefficients",
        PROVED,
        product.text,
        "Δ > 0 means three different real roots",
        lambda: (Evidence("identity", product.text, product.holds and _holds("13", "14")),),
    )


def _of_reference_10() -> tuple[Entry, ...]:
    return (
        Entry(
            "Tables 1–3 of [10]",
            "2",
            "the positions by patterns of roots",
            NOT_CHECKABLE,
            "the text of [10] was not consulted",
            "the patterns are re-derived instead (docs/mathematics.md) and serve as an oracle of `hypcheck verify`",
        ),
        Entry(
            "Tables 1–3 of [10], re-derived",
            "2",
            "the table of root patterns has every pattern that can occur, and no other",
            PROVED,
            "the signs of g at −A, 0, B and ±∞ allow these patterns alone",
            "the places of the roots against −A, 0 and B decide every pair",
            _table_of_patterns,
        ),
    )


def _table_of_patterns() -> tuple[Evidence, Evidence]:
    """That the typed table has the patterns that signs allow, each once, and that Coq's table is the same."""
    listed = sorted(chain.from_iterable(PATTERNS.values()))
    allowed = sorted(admissible())
    wrong = sorted(set(listed) ^ set(allowed)) or (["a pattern twice"] if listed != allowed else [])
    text = f"{len(listed)} patterns are listed, the {len(allowed)} that can occur"
    ours = {(kind.value, _meaning(kind), pattern) for kind, patterns in PATTERNS.items() for pattern in patterns}
    coqs = [
        (kind, meaning, pattern_of((_PLACES[place], count) for place, count in roots))
        for kind, meaning, roots in pattern_table()
    ]
    return (
        Evidence("exhaustive", f"the table is wrong in {', '.join(wrong)}" if wrong else text, not wrong),
        Evidence("coq", "proofs/RootPatterns.v has the same rows", len(coqs) == len(ours) and set(coqs) == ours),
    )


_PLACES = {
    "Below": Place.BELOW,
    "AtMinusA": Place.AT_MINUS_A,
    "Inner": Place.INNER,
    "Outer": Place.OUTER,
    "AtB": Place.AT_B,
    "Above": Place.ABOVE,
}


def _meaning(kind: Kind) -> str:
    """What Coq calls the position of a kind."""
    side = {Position.EXTERIOR: "Outside", Position.INTERIOR: "Inside"}
    if kind.limit_of is not None:
        return f"Touches{side[kind.limit_of]}"
    return f"Clear{side[kind.position]}" if kind.position in side else "Crosses"


_RING_FOLLOWS = "the ring: clear positions in the plane of the waist are refused; a phantom contact in floats around it"


def _proposition_3_1() -> Entry:
    return Entry(
        "Proposition 3.1",
        "2",
        "(γ/d)² ≥ α/b: exterior ⟺ Δ > 0, c2 < 0, c1 > 0",
        FALSE,
        "“⟸” is proved; “⟹” fails on the ring z0 = 0, r² = (c² + 1)(a² + c²)/c², c² > a, and nowhere else",
        _RING_FOLLOWS,
        lambda: (
            with_counterexample(say.PROPOSITION_3_1),
            by_chain("Proposition 3, repaired"),
            without_counterexample(say.REPAIRED_3),
        ),
        "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring: z0 = 0, g'(B) = 0 and A < B²",
    )


def _proposition_3_2() -> Entry:
    return Entry(
        "Proposition 3.2",
        "2",
        "(γ/d)² ≥ α/b: Δ ≤ 0 ⟹ contact",
        FALSE,
        "on the ring g has the double root B below which it is positive: Δ = 0, and no contact",
        "Δ ≤ 0 is no proof of contact; ask for the ring as well",
        lambda: (
            with_counterexample(say.PROPOSITION_3_2),
            by_chain("Proposition 3, repaired"),
            without_counterexample(say.REPAIRED_3),
        ),
        "Δ ≤ 0 ⟹ contact or the ring",
    )


def _proof_of_3() -> tuple[Entry, ...]:
    return (
        Entry(
            "Proposition 3, proof: roots",
            "2",
            "exterior ⟺ g has three different positive roots",
            FALSE,
            "on the ring two of the three positive roots are one",
            _RING_FOLLOWS,
            lambda: (with_counterexample(say.THREE_POSITIVE_ROOTS), by_chain("Proposition 3, repaired")),
            "exterior ⟺ g has three different positive roots, or the double root B above a simple one",
        ),
        Entry(
            "Proposition 3, proof: signs",
            "2",
            "c2 < 0 and c1 > 0 ⟺ all real roots of g are positive",
            FALSE,
            "“⟸” fails where two roots are complex",
            "harmless: it is used where Δ > 0, and there it holds",
            lambda: (with_counterexample(say.ALL_POSITIVE), by_chain("Proposition 3, repaired")),
            "if Δ > 0: c2 < 0 and c1 > 0 ⟺ all roots of g are positive",
        ),
    )


def _remark_4() -> Entry:
    return Entry(
        "Remark 4",
        "2",
        "(γ/d)² ≥ α/b: two negative roots mean contact or interior, and signs do not tell which",
        PROVED,
        f"exterior has no negative root; {_TWO_PAIRS}",
        "for α/b < 1 compare with A as well: interior ⟺ also c2 < 3A and g'(−A) > 0",
        lambda: (
            by_chain("Proposition 3, repaired"),
            without_counterexample(say.REMARK_4),
            _undecided(lambda facts: say.tall(facts) and facts.delta > 0 and facts.negative_roots == 2, say.interior),
            by_chain("all sizes"),
        ),
    )


_TWO_PAIRS = "two pairs with the same signs of Δ, c2, c1 and different positions are found"


def _undecided(pattern: Condition, clear: Condition) -> Evidence:
    """Two pairs of one pattern of roots with the same signs of Δ, c2 and c1: one in the clear, one in contact."""
    one = first(lambda facts: pattern(facts) and clear(facts))
    other = first(lambda facts: pattern(facts) and say.contact(facts) and _same_signs(facts, one.found))
    return with_examples((one, "a pair in the clear"), (other, "a pair in contact, with the same signs"))


def _same_signs(facts: Facts, other: Facts | None) -> bool:
    """Whether Δ, c2 and c1 have the same signs at two points."""
    if other is None:
        return False
    pairs = ((facts.delta, other.delta), (facts.c2, other.c2), (facts.c1, other.c1))
    return all((one > 0, one < 0) == (two > 0, two < 0) for one, two in pairs)


def _proposition_5_1() -> Entry:
    return Entry(
        "Proposition 5.1",
        "2",
        "α/b > 1: interior ⟺ Δ > 0 and [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0]",
        FALSE,
        "“⟸” is proved; “⟹” drops the interior positions with c2 = 0 > c1 and with c1 = 0 < c2, and no others",
        "valid movements are refused where a coefficient vanishes; ask for not (c2 < 0 and c1 > 0) instead",
        lambda: (
            with_counterexample(say.PROPOSITION_5_1_WITH_C2, say.PROPOSITION_5_1_WITH_C1),
            by_chain("Proposition 5, repaired"),
            without_counterexample(say.REPAIRED_5),
        ),
        "for α/b ≥ 1: interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0)",
    )


def _proposition_5_2() -> Entry:
    return Entry(
        "Proposition 5.2",
        "2",
        "α/b > 1: Δ ≤ 0 ⟹ contact",
        FALSE,
        "the ring again, which is exterior with Δ = 0 for every α/b; interior positions all have Δ > 0",
        "harmless for who flies inside: Δ ≤ 0 does mean “not interior”, at α/b = 1 too",
        lambda: (
            with_counterexample(say.PROPOSITION_5_2),
            by_chain("Proposition 5, repaired"),
            without_counterexample(say.REPAIRED_5),
        ),
        "for α/b ≥ 1: Δ ≤ 0 ⟹ contact or the ring",
    )


def _remark_6() -> Entry:
    return Entry(
        "Remark 6",
        "2",
        "α/b ≥ 1: three positive roots mean contact or exterior, and signs do not tell which",
        PROVED,
        f"interior has two negative roots; {_TWO_PAIRS}",
        "for (γ/d)² < α/b Procedure 1 calls such contact valid; compare with B as well: not (c2 < −3B and g'(B) > 0)",
        lambda: (
            by_chain("Proposition 5, repaired"),
            without_counterexample(say.REMARK_6),
            _undecided(lambda facts: say.wide(facts) and facts.delta > 0 and facts.negative_roots == 0, say.exterior),
            by_chain("all sizes"),
        ),
    )
