"""The known mathematical findings: what the paper's procedures get wrong even in exact arithmetic, and why.

The list bites both ways in a complete run: a finding that is not listed and a listed one that no longer occurs both
fail it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib import resources

from hypcheck import toml
from hypcheck.record.lines import Finding

FILE = "known_findings.toml"


@dataclass(frozen=True, slots=True)
class Known:
    """An expected finding: the formula errs inside its stated regimes for this cause, on these families at least."""

    formula: str
    cause: str
    families: tuple[str, ...]
    reason: str


def known_findings() -> tuple[Known, ...]:
    """The shipped list."""
    text = resources.files("hypcheck.verify").joinpath(FILE).read_text(encoding="utf-8")
    entries = toml.parsed(text, FILE)["finding"]
    return tuple(Known(each["formula"], each["cause"], tuple(each["families"]), each["reason"]) for each in entries)


def reason_for(finding: Finding, known: Iterable[Known]) -> str | None:
    """The listed reason of a finding; None for an unknown one, and where the formula claims nothing."""
    if not finding.inside:
        return None
    matching = (each.reason for each in known if (each.formula, each.cause) == (finding.formula, finding.cause))
    return next(matching, None)


def drift(found: Sequence[Finding], known: Sequence[Known], *, complete: bool) -> list[str]:
    """How the findings differ from the known ones, a sentence each.

    Errors inside the stated regimes whose cause is not listed; and, in a complete run, listed ones that did not occur.
    """
    unknown = [each for each in found if each.inside and reason_for(each, known) is None]
    sentences = [
        f"{each.formula} errs on {each.family} inside its stated regimes (cause: {each.cause}), which is not a known "
        f"finding; see {each.first_case}"
        for each in unknown
    ]
    seen = {(each.formula, each.cause, each.family) for each in found if each.inside}
    listed = [(each.formula, each.cause, family) for each in known for family in each.families] if complete else []
    sentences += [
        f"{formula} no longer errs on {family} (cause: {cause}), but is listed as a known finding"
        for formula, cause, family in listed
        if (formula, cause, family) not in seen
    ]
    return sentences
