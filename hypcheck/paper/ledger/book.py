"""The whole ledger in order, and every sentence of the paper with the entries that judge it.

claims.toml has the statements, the verdicts and what each rests on. sentences.txt has a line for each sentence: its
section, its first words, and the entries that judge it or a reason of REASONS. A displayed formula belongs to the
sentence that introduces it. The lines of a table, and its caption, are a sentence each. Headings, key words, the
acknowledgment and the references are left out: they state nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache
from importlib import resources
from typing import Any

import msgspec

from hypcheck import toml
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, ROOTS_TRIGONOMETRIC
from hypcheck.derivation.printed_equations import EquationCheck, check_equations
from hypcheck.errors import InputError
from hypcheck.paper.ledger import checks, counts, statements
from hypcheck.paper.ledger.entry import (
    MISPRINT,
    Evidence,
    LedgerEntry,
    by_chain,
    by_coq,
    by_identity,
    by_printed,
    by_programs,
    by_reading,
    harmless_where,
    with_counterexample,
    without_counterexample,
)
from hypcheck.paper.ledger.points import Condition, Statement
from hypcheck.paper.ledger.statements import errs


class Claim(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A claim of the paper in the form of claims.toml: the fields of LedgerEntry, and the names of its `evidence`."""

    number: str
    section: str
    statement: str
    verdict: str
    follows: str
    why: str = ""
    correction: str = ""
    harmless: str = ""
    faults: tuple[str, ...] = ()
    evidence: tuple[str, ...] = ()


@cache
def claims() -> dict[str, Claim]:
    """Return the claims by number, in the ledger's order."""
    return {claim.number: claim for claim in msgspec.convert(_content()["claim"], list[Claim])}


@cache
def faults() -> dict[str, str]:
    """Return the faults behind false statements, in order, by the names that claims use; the faults are independent."""
    return msgspec.convert(_content()["fault"], dict[str, str])


def _content() -> dict[str, Any]:
    return toml.shipped("hypcheck.paper.ledger", "claims.toml")


def _text(name: str) -> str:
    return resources.files("hypcheck.paper.ledger").joinpath(name).read_text(encoding="utf-8")


@cache
def entries() -> tuple[LedgerEntry, ...]:
    """Return every entry, in order."""
    formulas = {_in_brackets(checked.number): checked for checked in check_equations()}
    return tuple(equation(formulas[number]) if number in formulas else statement(number) for number in claims())


def statement(number: str) -> LedgerEntry:
    """Return the entry of a statement in words. Raises KeyError if there is none."""
    claim = claims()[number]
    why, follows, correction = (_filled_in(text) for text in (claim.why, claim.follows, claim.correction))
    return LedgerEntry(
        claim.number,
        claim.section,
        claim.statement,
        claim.verdict,
        why,
        follows,
        lambda: tuple(map(_evidence, claim.evidence)),
        correction,
        harmless=claim.harmless,
        faults=claim.faults,
    )


def equation(checked: EquationCheck) -> LedgerEntry:
    """Return the entry of one formula; its expected verdict is confirmed if the check gives the same verdict."""
    entry = statement(_in_brackets(checked.number))
    expected = "misprint" if entry.verdict == MISPRINT else "holds"
    evidence = Evidence("identity", checked.finding, checked.verdict == expected)
    return replace(
        entry,
        why=entry.why + checked.finding,
        grounds=lambda: (evidence, *entry.grounds()),
        correction=checked.correction,
        printed=checked.statement,
    )


def _in_brackets(number: str) -> str:
    """Return a formula's number in the form of the ledger: (12), but A.2b without brackets."""
    return number if number.startswith("A") else f"({number})"


def _filled_in(text: str) -> str:
    """Replace names in braces by their numbers."""
    return text.format_map(counts.figures()) if "{" in text else text


_PROGRAMS = {**FORMULAS, **REPAIRED, ROOTS_TRIGONOMETRIC.name: ROOTS_TRIGONOMETRIC}


def _statements(names: str) -> list[Statement]:
    """Return the statements of statements.py by these names, which commas separate."""
    return [getattr(statements, name) for name in names.split(", ")]


def _harmless(what: str) -> Evidence:
    """Return the evidence of the text "STATEMENT where CONDITION": the false statement holds under the condition."""
    name, _, where = what.partition(" where ")
    condition: Condition = getattr(statements, where)
    return harmless_where(getattr(statements, name), condition)


def _errs(what: str) -> Evidence:
    """Return the evidence of the text "PROGRAM about STATEMENTS": the program errs where the statements are false."""
    program, _, about = what.partition(" about ")
    return errs(program, *_statements(about))


def _check(name: str) -> Evidence:
    """Return the evidence of the check by that name, a function of checks.py, counts.py or statements.py."""
    module = next(module for module in (checks, counts, statements) if hasattr(module, name))
    found: Callable[[], Evidence] = getattr(module, name)
    return found()


_GROUNDS: dict[str, Callable[[str], Evidence]] = {
    "printed": by_printed,
    "chain": by_chain,
    "identity": by_identity,
    "programs": lambda names: by_programs(*(_PROGRAMS[name] for name in names.split(", "))),
    "text": by_reading,
    "coq": by_coq,
    "counterexample": lambda names: with_counterexample(*_statements(names)),
    "none": lambda name: without_counterexample(*_statements(name)),
    "harmless": _harmless,
    "errs": _errs,
    "check": _check,
}
"""For each kind of evidence in claims.toml the function that makes it; the comment there describes the kinds."""


def _evidence(line: str) -> Evidence:
    """Return the evidence that a line "KIND: …" of claims.toml describes."""
    kind, _, what = line.partition(": ")
    return _GROUNDS[kind](what)


def entries_of(claim: str) -> tuple[LedgerEntry, ...]:
    """Return the entries of one number; "Proposition 3" has several. Raises InputError if there is none."""
    claimed = _plain(claim)
    matching = tuple(entry for entry in entries() if _is_of(_plain(entry.number), claimed))
    if not matching:
        raise InputError(f"there is no claim {claim!r} in the ledger; {_advice(claimed)}")
    return matching


def _plain(number: str) -> str:
    """Return a claim's number in a normal form, which is the same for "(12)", "eq. 12" and "12"."""
    bare = re.sub(r"[()§]", " ", number.lower()).strip()
    bare = re.sub(r"^(equation|eq\.?|appendix)\s*(?=[\da])", "", bare)
    bare = re.sub(r"^prop(\.|\s)\s*", "proposition ", bare)
    return " ".join(bare.split())


def _is_of(number: str, claimed: str) -> bool:
    """Decide whether a number is the claimed one or a part of it: "proposition 3.1" is a part of "proposition 3"."""
    return number == claimed or bool(claimed and re.match(re.escape(claimed) + r"[.,:]\s?", number))


def _advice(claimed: str) -> str:
    """Return a suggestion for a claim's number that does not exist: a similar one, or examples."""
    numbers = {_plain(entry.number): entry.number for entry in entries()}
    near = get_close_matches(claimed, numbers, n=1)
    if near:
        return f"did you mean {numbers[near[0]]!r}?"
    return "give an equation's number such as 12, or Proposition 3, Remark 4, Table 2, A.2b"


def faults_with_entries() -> tuple[tuple[str, str, tuple[str, ...]], ...]:
    """Return each fault: its name, what it is, and the numbers of the statements that it makes false."""
    return tuple(
        (name, what, tuple(entry.number for entry in entries() if name in entry.faults))
        for name, what in faults().items()
    )


REASONS = {
    "announces": "says what the paper or a part of it does, not that something is so",
    "survey": "speaks of other work, or of the world at large, and gives nothing to check it by",
    "notation": "gives a name to something",
    "choice": "states a choice of the authors: a model, a rule or a size",
    "proposal": "says what could be done, not that it is so",
}
"""The reasons why no entry of the ledger judges a sentence: a word for each, and its meaning."""


@dataclass(frozen=True)
class Sentence:
    """A sentence of the paper: its section and its first words.

    `rows` are the numbers of the ledger's entries that judge it. If there are none, `reason` is a word of REASONS, else
    it is "".
    """

    section: str
    words: str
    rows: tuple[str, ...]
    reason: str


@cache
def sentences() -> tuple[Sentence, ...]:
    """Return all sentences, in the paper's order."""
    return tuple(map(_sentence, _text("sentences.txt").splitlines()))


def _sentence(line: str) -> Sentence:
    """Read a line of sentences.txt."""
    section, words, judged = line.split(" | ")
    if judged.startswith("="):
        return Sentence(section, words, (), judged[1:])
    return Sentence(section, words, tuple(judged.split(" & ")), "")


def coverage() -> str:
    """Return a text with the number of sentences that the ledger judges, and the reasons for the others."""
    every = sentences()
    without = [sentence.reason for sentence in every if sentence.reason]
    counted = ", ".join(f"{without.count(word)} {word} ({meaning})" for word, meaning in REASONS.items())
    return (
        f"The paper has {len(every)} sentences, its tables' lines and captions counted in; "
        f"{len(every) - len(without)} have a row or several, and {len(without)} have none, for a reason: {counted}."
    )
