"""An entry of the ledger: the verdict on one claim of the paper, and the evidence for it."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from hypcheck.derivation.chain_book import chains, proved
from hypcheck.derivation.formulas import Formula
from hypcheck.derivation.links import known, printed
from hypcheck.derivation.proofs import proofs_of
from hypcheck.paper.ledger import points
from hypcheck.proofs.build import proves

PROVED, DEFINITION, MISPRINT, FALSE, QUESTION, NOT_CHECKABLE = VERDICTS = (
    "proved",
    "definition",
    "misprint",
    "false",
    "question",
    "not checkable",
)

HOLDS = "right − left = 0"
"""The reason for which a displayed formula counts as proved."""

KINDS = ("identity", "chain", "programs", "search", "count", "exhaustive", "coq", "text")
"""The kinds of evidence: equal expressions, a chain of links, proved programs, a search of pairs, counted steps, all of
finitely many cases, theorems of the Coq sources, two places of the paper's text compared by reading."""

_PROVED_BY = {"identity": "sympy", "chain": "sympy", "programs": "sympy", "exhaustive": "exhaustive", "coq": "Coq"}


@dataclass(frozen=True)
class Evidence:
    """One reason for a verdict, in a sentence without a full stop, and whether it holds in this run."""

    kind: str
    text: str
    holds: bool
    witnesses: tuple[points.PointWitness, ...] = ()
    chain: str = ""
    tilted: tuple[points.TiltedWitness, ...] = ()


@dataclass(frozen=True)
class LedgerEntry:
    """One numbered statement of the paper.

    `number` is the paper's number, `section` the section there, `statement` a short form of the claim. `verdict` is one
    of VERDICTS; `why` is one line; `follows` is the consequence for a user. `correction` is the corrected statement, if
    it is wrong and can be corrected; `printed` is a formula's text; `grounds` computes the evidence. `harmless` says
    where a false statement does no harm. `faults` names the faults of claims.toml that make it false: statements that
    are false for the same reason share a fault.
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
    harmless: str = ""
    faults: tuple[str, ...] = ()

    @cached_property
    def evidence(self) -> tuple[Evidence, ...]:
        """The evidence for the verdict, computed at the first access."""
        return self.grounds()

    @property
    def proved_by(self) -> tuple[str, ...]:
        """The means by which the verdict is proved: Coq, sympy, exhaustive, witness.

        A search that finds nothing proves nothing. A definition needs no proof.
        """
        if self.verdict == DEFINITION:
            return ()
        means = {_PROVED_BY.get(evidence.kind, "") for evidence in self.evidence}
        if any(evidence.witnesses or evidence.tilted for evidence in self.evidence):
            means.add("witness")
        return tuple(word for word in ("Coq", "sympy", "exhaustive", "witness") if word in means)

    @property
    def confirmed(self) -> bool:
        """Whether the evidence supports the verdict; a verdict without evidence says that nothing can be checked."""
        if self.verdict == NOT_CHECKABLE:
            return not self.evidence
        return bool(self.evidence) and all(evidence.holds for evidence in self.evidence)


def by_chain(name: str) -> Evidence:
    """Return evidence that a chain of the derivation holds, with all chains that it needs."""
    links = len(chains()[name].links)
    return Evidence("chain", f"{name}: {links} links hold", proved(name), chain=name)


def by_identity(text: str) -> Evidence:
    """Return evidence that one of the derivation's own identities holds, by its sentence."""
    return Evidence("identity", text, known(text).holds)


def by_printed(text: str) -> Evidence:
    """Return evidence that the displayed formulas whose numbers the text names hold as printed: "(7) and (8) hold"."""
    parts = (part for number in re.findall(r"\((\d+)\)", text) for part in printed(number))
    return Evidence("identity", text, all(part.holds for part in parts))


def by_reading(text: str) -> Evidence:
    """Return evidence that two places of the paper's text were compared by reading."""
    return Evidence("text", text, holds=True)


def by_coq(theorem: str) -> Evidence:
    """Return evidence that a Coq file has a complete theorem, "File.theorem"; `make prove` checks it."""
    file, _, name = theorem.partition(".")
    return Evidence("coq", f"{name} in proofs/{file}.v, which `make prove` checks", proves(file, name))


def by_programs(*formulas: Formula) -> Evidence:
    """Return evidence that programs compute the right values and decisions."""
    proofs = [proof for formula in formulas for proof in proofs_of(formula)]
    names = ", ".join(formula.name for formula in formulas)
    text = f"{len(proofs)} proofs of the program{'s' * (len(formulas) > 1)} {names}"
    return Evidence("programs", text, bool(proofs) and all(proof.holds for proof in proofs))


def without_counterexample(statement: points.Statement) -> Evidence:
    """Return evidence that no point of the whole space contradicts the statement."""
    search = points.counterexample(statement)
    return Evidence(
        "search", f"no counterexample among {search.tried:,} pairs", search.found is None and search.tried > 0
    )


def harmless_where(statement: points.Statement, where: points.Condition) -> Evidence:
    """Return evidence that a false statement holds at all points at which `where` holds."""
    evidence = without_counterexample(replace(statement, where=lambda facts: statement.where(facts) and where(facts)))
    return replace(evidence, text=f"harmless there: {evidence.text}")


def with_counterexample(*statements: points.Statement) -> Evidence:
    """Return evidence that each statement is false: the simplest counterexample, with a certified position."""
    searches = [(statement, points.counterexample(statement)) for statement in statements]
    return _found([(search, f"contradicts: {statement.text}") for statement, search in searches])


def _found(searches: list[tuple[points.Search[points.PointFacts], str]]) -> Evidence:
    """Return the witnesses of searches as evidence. It holds if every search found a point and all witnesses hold."""
    witnesses = tuple(points.witness(search.found, shows) for search, shows in searches if search.found is not None)
    tried = [search.tried for search, _ in searches]
    holds = len(witnesses) == len(searches) > 0 and all(witness.holds for witness in witnesses)
    text = "; ".join(described(witness.facts) for witness in witnesses) or f"nothing found among {sum(tried):,} pairs"
    return Evidence("search", text, holds, witnesses)


def described(facts: points.PointFacts) -> str:
    """Return a point, its position and its numbers as text.

    An example is "a = 1, c = 2, C = (5/2, 0, 0): exterior, Δ = 0, c2 = −33/4, c1 = 18".
    """
    point = facts.point
    text = f"a = {point.a}, c = {point.c}, C = ({point.r}, 0, {point.z}): {facts.position.label}, {signs(facts)}"
    return text.replace("-", "−")


def signs(facts: points.PointFacts) -> str:
    """Return the numbers whose signs the propositions test, as text: "Δ = 0, c2 = −33/4, c1 = 18"."""
    return f"Δ = {facts.delta}, c2 = {facts.c2}, c1 = {facts.c1}".replace("-", "−")
