"""Searching the space of small points for counterexamples and examples, and proving what was found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hypcheck.paper.ledger.facts import Facts
from hypcheck.paper.ledger.strata import facts_in_order
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.prove import prove

Condition = Callable[[Facts], bool]


@dataclass(frozen=True)
class Statement:
    """A claim about every pair for which `where` holds: that `says` holds. `text` is the claim in words."""

    text: str
    where: Condition
    says: Condition


@dataclass(frozen=True, slots=True)
class Witness:
    """One point, with a certificate of its position; `shows` says in words what it shows."""

    facts: Facts
    certificate: Certificate
    shows: str

    @property
    def holds(self) -> bool:
        """Whether the certificate proves the position that the facts name, by rational arithmetic of its own."""
        claimed = self.certificate.position is self.facts.position
        return claimed and check_certificate(self.facts.point.pair, self.certificate)


@dataclass(frozen=True, slots=True)
class Search:
    """What came of a search: how many points of the regime were tried, and the first that was looked for, if any."""

    tried: int
    found: Facts | None


def counterexample(statement: Statement) -> Search:
    """The simplest point of the space at which the statement is false."""
    return first(lambda facts: statement.where(facts) and not statement.says(facts), statement.where)


def first(wanted: Condition, where: Condition = lambda _: True) -> Search:
    """The simplest point that is wanted; `tried` counts the points up to there for which `where` holds."""
    tried = 0
    for facts in facts_in_order():
        tried += where(facts)
        if wanted(facts):
            return Search(tried, facts)
    return Search(tried, None)


def witness(facts: Facts, shows: str) -> Witness:
    """The point with a certificate of its position."""
    return Witness(facts, prove(facts.point.pair), shows)
