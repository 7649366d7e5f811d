"""An entry of the ledger and its evidence, and the paper's statements about pairs as conditions on a point.

An entry says what became of one claim of the paper, and what the verdict rests on. The statements about pairs are
those of the paper, as printed and as repaired.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from hypcheck.derivation.chain_book import chains, proved
from hypcheck.derivation.decisions import decisions
from hypcheck.derivation.formulas import Formula
from hypcheck.derivation.links import known
from hypcheck.derivation.proofs import proofs_of
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger.leaning import LeaningWitness
from hypcheck.paper.ledger.points import (
    Condition,
    PointFacts,
    PointSearch,
    PointWitness,
    Statement,
    counterexample,
    witness,
)
from hypcheck.proofs.build import proves

PROVED, DEFINITION, MISPRINT, FALSE, NOT_CHECKABLE = VERDICTS = (
    "proved",
    "definition",
    "misprint",
    "false",
    "not checkable",
)

HOLDS = "right − left = 0"
"""Why a displayed formula is proved."""

KINDS = ("identity", "chain", "programs", "search", "count", "exhaustive", "coq", "text")
"""What evidence can be: equal expressions, a chain of links, proved programs, a search of pairs, counted steps, all of
finitely many cases, theorems of the Coq sources, two places of the paper's text compared by reading."""

_PROVED_BY = {"identity": "sympy", "chain": "sympy", "programs": "sympy", "exhaustive": "exhaustive", "coq": "Coq"}


@dataclass(frozen=True)
class Evidence:
    """One reason for a verdict, in a sentence without a full stop, and whether it was found to hold just now."""

    kind: str
    text: str
    holds: bool
    witnesses: tuple[PointWitness, ...] = ()
    chain: str = ""
    leaning: tuple[LeaningWitness, ...] = ()


@dataclass(frozen=True)
class LedgerEntry:
    """One numbered statement of the paper.

    `number` is how the paper numbers it, `section` where it stands there, `statement` what it says in a few words.
    `verdict` is one of VERDICTS; `why` one line; `follows` what it means for someone who uses it. `correction` is the
    statement put right, where something is wrong and can be; `printed` a formula's own text; `grounds` finds what the
    verdict rests on. `coq` names the theorems that say the same, "File.theorem" of hypcheck/proofs.
    `harmless` says where a false statement does no harm.
    """

    number: str
    section: str
    statement: str
    verdict: str
    why: str
    follows: str
    grounds: Callable[[], tuple[Evidence, ...]] = tuple
    correction: str = ""
    printed: str = ""
    coq: tuple[str, ...] = ()
    harmless: str = ""

    @cached_property
    def evidence(self) -> tuple[Evidence, ...]:
        """What the verdict rests on, looked for when it is asked for."""
        return (*self.grounds(), *map(by_coq, self.coq))

    @property
    def proved_by(self) -> tuple[str, ...]:
        """By what the verdict is proved: Coq, sympy, exhaustive, witness. A search that finds nothing is no proof.

        A definition needs none.
        """
        if self.verdict == DEFINITION:
            return ()
        found = {_PROVED_BY.get(evidence.kind, "") for evidence in self.evidence}
        if any(evidence.witnesses or evidence.leaning for evidence in self.evidence):
            found.add("witness")
        return tuple(word for word in ("Coq", "sympy", "exhaustive", "witness") if word in found)

    @property
    def confirmed(self) -> bool:
        """Whether the evidence bears the verdict out; a verdict without any says that nothing can be checked."""
        if self.verdict == NOT_CHECKABLE:
            return not self.evidence
        return bool(self.evidence) and all(evidence.holds for evidence in self.evidence)


def by_chain(name: str) -> Evidence:
    """That a chain of the derivation holds, with all it needs."""
    links = len(chains()[name].links)
    return Evidence("chain", f"{links} links of “{name}” hold", proved(name), chain=name)


def by_identity(text: str) -> Evidence:
    """That one of the derivation's own identities holds, by its sentence."""
    return Evidence("identity", text, known(text).holds)


def by_coq(theorem: str) -> Evidence:
    """That a Coq file states a theorem, "File.theorem", and leaves nothing unproved; `make prove` has Coq check it."""
    file, _, name = theorem.partition(".")
    return Evidence("coq", f"{name} in proofs/{file}.v, which `make prove` checks", proves(file, name))


def by_programs(*formulas: Formula) -> Evidence:
    """That programs compute and decide what they must."""
    proofs = [proof for formula in formulas for proof in proofs_of(formula)]
    names = ", ".join(formula.name for formula in formulas)
    text = f"{len(proofs)} proofs of the program{'s' * (len(formulas) > 1)} {names}"
    return Evidence("programs", text, bool(proofs) and all(proof.holds for proof in proofs))


def without_counterexample(statement: Statement) -> Evidence:
    """That no point of the whole space contradicts the statement."""
    search = counterexample(statement)
    return Evidence(
        "search", f"no counterexample among {search.tried:,} pairs", search.found is None and search.tried > 0
    )


def harmless_where(statement: Statement, where: Condition) -> Evidence:
    """That no point at which `where` holds contradicts a statement that is false elsewhere."""
    evidence = without_counterexample(replace(statement, where=lambda facts: statement.where(facts) and where(facts)))
    return replace(evidence, text=f"harmless there: {evidence.text}")


def with_counterexample(*statements: Statement) -> Evidence:
    """That each statement is false: the simplest point which contradicts it, its position certified."""
    searches = [(statement, counterexample(statement)) for statement in statements]
    return _found([(search, f"contradicts “{statement.text}”") for statement, search in searches])


def _found(searches: list[tuple[PointSearch, str]]) -> Evidence:
    witnesses = tuple(witness(search.found, shows) for search, shows in searches if search.found is not None)
    tried = [search.tried for search, _ in searches]
    holds = len(witnesses) == len(searches) > 0 and all(each.holds for each in witnesses)
    text = "; ".join(described(each.facts) for each in witnesses) or f"nothing found among {sum(tried):,} pairs"
    return Evidence("search", text, holds, witnesses)


def described(facts: PointFacts) -> str:
    """A point, its position and its numbers: "a = 1, c = 2, C = (5/2, 0, 0): exterior, Δ = 0, c2 = −33/4, c1 = 18"."""
    point = facts.point
    return _minus(
        f"a = {point.a}, c = {point.c}, C = ({point.r}, 0, {point.z}): {facts.position.label}, Δ = {facts.delta}, c2 = "
        f"{facts.c2}, c1 = {facts.c1}"
    )


def _minus(text: str) -> str:
    return text.replace("-", "−")


def tall(facts: PointFacts) -> bool:
    """(γ/d)² ≥ α/b, the regime of Proposition 3."""
    return facts.B >= facts.point.a


def wide(facts: PointFacts) -> bool:
    """α/b ≥ 1, the regime of Proposition 5 and of Procedures 2.a and 2.b."""
    return facts.point.a >= 1


def very_tall(facts: PointFacts) -> bool:
    """(γ/d)² > (α/b)² + 1, where c2 < 0 for every centre."""
    return facts.B > facts.A + 1


def off_the_waist(facts: PointFacts) -> bool:
    """z0 ≠ 0, where there is no ring."""
    return facts.Q != 0


def exterior(facts: PointFacts) -> bool:
    """Whether the spheroid is exterior."""
    return facts.position is Position.EXTERIOR


def interior(facts: PointFacts) -> bool:
    """Whether the spheroid is interior."""
    return facts.position is Position.INTERIOR


def contact(facts: PointFacts) -> bool:
    """Whether there is contact."""
    return facts.position is Position.CONTACT


def three_positive(facts: PointFacts) -> bool:
    """The sign pattern that Proposition 3 asks for beside Δ > 0."""
    return facts.c2 < 0 and facts.c1 > 0


def printed_interior(facts: PointFacts) -> bool:
    """The sign pattern that Proposition 5 asks for beside Δ > 0."""
    return (facts.c2 > 0 and facts.c1 != 0) or (facts.c2 < 0 and facts.c1 < 0)


def ring(facts: PointFacts) -> bool:
    """The exterior positions with Δ = 0: Q = 0, g'(B) = 0 and A < B²."""
    return facts.Q == 0 and facts.slope_at_B == 0 and facts.A < facts.B**2


def rule_of_all_sizes(facts: PointFacts) -> int:
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


def _proposition_5_1(text: str, zero: Callable[[PointFacts], bool]) -> Statement:
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
