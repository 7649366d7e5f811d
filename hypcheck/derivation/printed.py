"""Which of the paper's displayed formulas hold, and what is wrong with those that do not."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import groupby

from hypcheck.derivation.differences import difference, repair
from hypcheck.derivation.plain_text import plain
from hypcheck.derivation.printed_equations import Claim, printed_claims


@dataclass(frozen=True)
class EquationCheck:
    """A numbered formula of the paper, held against the derivation.

    `number` is the paper's, or "A.n" for the n-th unnumbered display of Appendix A (a, b: its first and second
    equality). `verdict` is "holds", "misprint" (one term or factor changed in one place makes it right) or "false".
    `statement` is the text as printed; `finding` is a sentence computed from the difference; `correction` is the
    formula put right, in sympy's order of terms, and empty where nothing is wrong.
    """

    number: str
    holds: bool
    verdict: str
    statement: str
    finding: str
    correction: str


@cache
def check_equations() -> tuple[EquationCheck, ...]:
    """The check of every displayed formula, in the paper's order."""
    return tuple(check(tuple(claims)) for _, claims in groupby(printed_claims(), key=lambda claim: claim.number))


def check(claims: tuple[Claim, ...]) -> EquationCheck:
    """The check of one number, of the claims printed under it."""
    repairs = []
    for claim in claims:
        left = claim.statement.partition("=")[0].strip()
        for printed, derived in claim.pairs:
            if difference(printed.subs(claim.meanings), derived) != 0:
                found = repair(printed, derived, claim.meanings)
                repairs.append((left, found))
    statement = "; ".join(claim.statement for claim in claims)
    if not repairs:
        return EquationCheck(claims[0].number, True, "holds", statement, "right − left = 0", "")
    return EquationCheck(
        number=claims[0].number,
        holds=False,
        verdict="misprint" if all(found.one_place for _, found in repairs) else "false",
        statement=statement,
        finding="; ".join(found.finding for _, found in repairs),
        correction="; ".join(f"{left} = {plain(found.corrected)}" for left, found in repairs),
    )
