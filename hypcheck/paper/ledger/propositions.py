"""The ledger's lines about Theorem 1, the remarks and the propositions."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import chain

from hypcheck.derivation.links import known, printed
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger import entry
from hypcheck.paper.ledger.entry import (
    FALSE,
    NOT_CHECKABLE,
    PROVED,
    Evidence,
    LedgerEntry,
    by_chain,
    by_identity,
    harmless_where,
    with_counterexample,
    without_counterexample,
)
from hypcheck.paper.ledger.points import SquaredRatios, coefficients
from hypcheck.proofs.build import pattern_table
from hypcheck.truth.kinds import Kind
from hypcheck.truth.roots import PATTERNS, RootPlace, admissible, pattern_of


def propositions() -> tuple[LedgerEntry, ...]:
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


def _theorem_1() -> LedgerEntry:
    return LedgerEntry(
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


def _known_root() -> LedgerEntry:
    return LedgerEntry(
        "after (12)",
        "2",
        "−a² is a root of f, and the other roots are those of g",
        PROVED,
        "f is (a² + λ)·g(λ) times a constant",
        "three roots, or three coefficients, decide; the fourth root is always there",
        lambda: (by_identity("det(λH + S) = (A + λ)·g(λ)/(A²·B)"),),
    )


def _remark_2() -> LedgerEntry:
    product = "Δ is the product of the squared differences of the roots"
    return LedgerEntry(
        "Remark 2",
        "2",
        "(13) is the discriminant and (14) the coefficients",
        PROVED,
        product,
        "Δ > 0 means three different real roots",
        lambda: (Evidence("identity", product, known(product).holds and _holds("13", "14")),),
    )


def _of_reference_10() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Tables 1–3 of [10]",
            "2",
            "the positions by patterns of roots",
            NOT_CHECKABLE,
            "the text of [10] was not consulted",
            "the patterns are re-derived instead (docs/mathematics.md) and serve as an oracle of `hypcheck verify`",
        ),
        LedgerEntry(
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
    "Below": RootPlace.BELOW,
    "AtMinusA": RootPlace.AT_MINUS_A,
    "Inner": RootPlace.INNER,
    "Outer": RootPlace.OUTER,
    "AtB": RootPlace.AT_B,
    "Above": RootPlace.ABOVE,
}


def _meaning(kind: Kind) -> str:
    """What Coq calls the position of a kind."""
    side = {Position.EXTERIOR: "Outside", Position.INTERIOR: "Inside"}
    if kind.limit_of is not None:
        return f"Touches{side[kind.limit_of]}"
    return f"Clear{side[kind.position]}" if kind.position in side else "Crosses"


OFF_THE_WAIST = "wherever z0 ≠ 0: the ring lies in the plane of the waist"
VERY_TALL = (
    "where (γ/d)² > (α/b)² + 1: c2 < 0 then, and c1 = 0 leaves no negative root; the paper's tower is such, with "
    "14,082 against 65 for the body and 126,736 against 401 for a rotor"
)

_RING_FOLLOWS = "the ring: clear positions in the plane of the waist are refused; a phantom contact in floats around it"


def _proposition_3_1() -> LedgerEntry:
    return LedgerEntry(
        "Proposition 3.1",
        "2",
        "(γ/d)² ≥ α/b: exterior ⟺ Δ > 0, c2 < 0, c1 > 0",
        FALSE,
        "“⟸” is proved; “⟹” fails on the ring z0 = 0, r² = (c² + 1)(a² + c²)/c², c² > a, and nowhere else",
        _RING_FOLLOWS,
        lambda: (
            with_counterexample(entry.PROPOSITION_3_1),
            by_chain("Proposition 3, repaired"),
            without_counterexample(entry.REPAIRED_3),
            harmless_where(entry.PROPOSITION_3_1, entry.off_the_waist),
        ),
        "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring: z0 = 0, g'(B) = 0 and A < B²",
        harmless=OFF_THE_WAIST,
    )


def _proposition_3_2() -> LedgerEntry:
    return LedgerEntry(
        "Proposition 3.2",
        "2",
        "(γ/d)² ≥ α/b: Δ ≤ 0 ⟹ contact",
        FALSE,
        "on the ring g has the double root B below which it is positive: Δ = 0, and no contact",
        "Δ ≤ 0 is no proof of contact; ask for the ring as well",
        lambda: (
            with_counterexample(entry.PROPOSITION_3_2),
            by_chain("Proposition 3, repaired"),
            without_counterexample(entry.REPAIRED_3),
            harmless_where(entry.PROPOSITION_3_2, entry.off_the_waist),
        ),
        "Δ ≤ 0 ⟹ contact or the ring",
        harmless=OFF_THE_WAIST,
    )


def _proof_of_3() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Proposition 3, proof: roots",
            "2",
            "exterior ⟺ g has three different positive roots",
            FALSE,
            "on the ring two of the three positive roots are one",
            _RING_FOLLOWS,
            lambda: (
                with_counterexample(entry.THREE_POSITIVE_ROOTS),
                by_chain("Proposition 3, repaired"),
                harmless_where(entry.THREE_POSITIVE_ROOTS, entry.off_the_waist),
            ),
            "exterior ⟺ g has three different positive roots, or the double root B above a simple one",
            harmless=OFF_THE_WAIST,
        ),
        LedgerEntry(
            "Proposition 3, proof: signs",
            "2",
            "c2 < 0 and c1 > 0 ⟺ all real roots of g are positive",
            FALSE,
            "“⟸” fails where two roots are complex",
            "ask for Δ > 0 first",
            lambda: (
                with_counterexample(entry.ALL_POSITIVE),
                by_chain("Proposition 3, repaired"),
                harmless_where(entry.ALL_POSITIVE, lambda facts: facts.delta > 0),
            ),
            "if Δ > 0: c2 < 0 and c1 > 0 ⟺ all roots of g are positive",
            harmless="where Δ > 0, and the proof uses it nowhere else",
        ),
    )


def _remark_4() -> LedgerEntry:
    return LedgerEntry(
        "Remark 4",
        "2",
        "(γ/d)² ≥ α/b: two negative roots mean contact or interior, and no function of g alone tells which",
        PROVED,
        "exterior has no negative root, and two pairs with the same g, one interior and one in contact, are found",
        "for α/b < 1 compare with A as well: interior ⟺ also c2 < 3A and g'(−A) > 0",
        lambda: (
            by_chain("Proposition 3, repaired"),
            without_counterexample(entry.REMARK_4),
            _same_cubic(REMARK_4, Position.INTERIOR, lambda pair: pair.B**2 >= pair.A),
            by_chain("all sizes"),
        ),
    )


REMARK_4 = (
    (SquaredRatios("1", "3", "9/32", "175/32"), SquaredRatios("2/5", "15/2", "147/1580", "44/79")),
    ("-3/4", "-1/2", "8"),
)
REMARK_6 = (
    (SquaredRatios("12/5", "5/2", "1683/245", "3/98"), SquaredRatios("12", "1/2", "91/5", "3/10")),
    ("1", "2", "3"),
)
"""Two pairs each, the first in the clear and the second in contact, and the roots of the g that both have."""


def _same_cubic(
    case: tuple[tuple[SquaredRatios, SquaredRatios], tuple[str, str, str]],
    clear: Position,
    regime: Callable[[SquaredRatios], bool],
) -> Evidence:
    """Two pairs of a regime with the same g, one in the clear and one in contact: no function of g tells which."""
    pairs, roots = case
    first, second, third = map(Fraction, roots)
    expected = (-(first + second + third), first * second + first * third + second * third, -first * second * third)
    holds = all(regime(pair) and coefficients(pair) == expected for pair in pairs)
    positions = tuple(_position_by_roots(first, second, pair) for pair in pairs)
    told = "; ".join(f"{pair}: {position.label}" for pair, position in zip(pairs, positions, strict=True))
    text = f"g = (λ − {first})(λ − {second})(λ − {third}) for {told}".replace("− -", "+ ").replace("-", "−")
    return Evidence("identity", text, holds and positions == (clear, Position.CONTACT))


def _position_by_roots(low: Fraction, high: Fraction, pair: SquaredRatios) -> Position:
    """The position of a pair whose g has these two least roots: g > 0 between them, and above the third.

    The third is at least B, so only these matter (docs/mathematics.md, "The rule that needs no hypothesis").
    """
    if max(low, Fraction(0)) < min(high, pair.B):
        return Position.EXTERIOR
    return Position.INTERIOR if max(low, -pair.A) < min(high, Fraction(0)) else Position.CONTACT


def _proposition_5_1() -> LedgerEntry:
    return LedgerEntry(
        "Proposition 5.1",
        "2",
        "α/b > 1: interior ⟺ Δ > 0 and [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0]",
        FALSE,
        "“⟸” is proved; “⟹” drops the interior positions with c2 = 0 > c1 and with c1 = 0 < c2, and no others",
        "valid movements are refused where a coefficient vanishes; ask for not (c2 < 0 and c1 > 0) instead",
        lambda: (
            with_counterexample(entry.PROPOSITION_5_1_WITH_C2, entry.PROPOSITION_5_1_WITH_C1),
            by_chain("Proposition 5, repaired"),
            without_counterexample(entry.REPAIRED_5),
            harmless_where(entry.PROPOSITION_5_1, entry.very_tall),
        ),
        "for α/b ≥ 1: interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0)",
        harmless=VERY_TALL,
    )


def _proposition_5_2() -> LedgerEntry:
    return LedgerEntry(
        "Proposition 5.2",
        "2",
        "α/b > 1: Δ ≤ 0 ⟹ contact",
        FALSE,
        "the ring again, which is exterior with Δ = 0 for every α/b; interior positions all have Δ > 0",
        "for a flight inside the hyperboloid Δ ≤ 0 does mean “not interior”, at α/b = 1 too",
        lambda: (
            with_counterexample(entry.PROPOSITION_5_2),
            by_chain("Proposition 5, repaired"),
            without_counterexample(entry.REPAIRED_5),
            harmless_where(entry.PROPOSITION_5_2, lambda facts: not entry.exterior(facts)),
        ),
        "for α/b ≥ 1: Δ ≤ 0 ⟹ contact or the ring",
        harmless="inside the hyperboloid: the ring is outside, and no procedure of section 3.2 or 4 flies there",
    )


def _remark_6() -> LedgerEntry:
    return LedgerEntry(
        "Remark 6",
        "2",
        "α/b ≥ 1: three positive roots mean contact or exterior, and no function of g alone tells which",
        PROVED,
        "interior has two negative roots, and two pairs with the same g, one exterior and one in contact, are found",
        "for (γ/d)² < α/b Procedure 1 calls such contact valid; compare with B as well: not (c2 < −3B and g'(B) > 0)",
        lambda: (
            by_chain("Proposition 5, repaired"),
            without_counterexample(entry.REMARK_6),
            _same_cubic(REMARK_6, Position.EXTERIOR, lambda pair: pair.A >= 1),
            by_chain("all sizes"),
        ),
    )
