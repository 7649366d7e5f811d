"""What was found about the paper: its equations, the proofs of its formulas, and what they get wrong exactly."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.lines import Equation, Finding, Proof
from hypcheck.report.content.blocks import (
    Cell,
    Code,
    Item,
    Paragraph,
    Section,
    Strong,
    bullets,
    joined,
    number,
    prose,
    table,
)
from hypcheck.report.digest import explanation, unlisted
from hypcheck.report.text import from_hex, short_row

_PROOFS = prose(
    "Each formula is a program of single steps. What its steps must equal was derived in symbols, and its decision was "
    "compared with its rule for every combination of signs. `derivation` are the identities that the rules rest on."
)
_FINDINGS = prose(
    "Evaluated in exact rationals, so that no rounding is to blame. *Inside* its stated regimes a formula claims to be "
    "right; *outside* them it does not: the table shows what comes of not checking."
)


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of these."""
    equations, proofs, found = record.of(Equation), record.of(Proof), record.of(Finding)
    if equations:
        yield _equations(equations)
    if proofs:
        yield _proofs(proofs)
    if found:
        yield _findings(found)


def _equations(lines: list[Equation]) -> Section:
    holding = [f"({line.number})" for line in lines if line.holds]
    items = [
        Item(
            (Strong(f"({line.number})"), f" {line.verdict}: {line.finding}."),
            (("printed: ", Code(line.statement)), ("derived: ", Code(line.correction))),
        )
        for line in lines
        if not line.holds
    ]
    named = f": {', '.join(holding)}." if holding else "."
    said = f"Each displayed formula was compared with the derivation: {len(holding)} of {len(lines)} hold{named}"
    return Section("The paper's equations", (Paragraph(said), bullets(items)))


def _proofs(lines: list[Proof]) -> Section:
    by_formula: dict[str, list[bool]] = {}
    for line in lines:
        by_formula.setdefault(line.formula, []).append(line.holds)
    rows = [
        (Code(name), Cell(str(sum(holds)), sum(holds)), Cell(str(len(holds)), len(holds)))
        for name, holds in by_formula.items()
    ]
    proved = table("proofs", ("formula", number("proved"), number("to be shown")), rows)
    return Section("The proofs", (Paragraph(_PROOFS), proved))


def _findings(lines: list[Finding]) -> Section:
    """Inside the stated regimes first: there a formula breaks its own word. Formulas with one witness share a line."""
    alike: dict[tuple[object, ...], list[Finding]] = {}
    for line in sorted(lines, key=lambda line: not line.inside):
        key = (line.inside, line.family, line.cause, line.first_case, line.wrong, line.asked, line.reason)
        alike.setdefault(key, []).append(line)
    columns = (
        "formula",
        "family",
        "stated regimes",
        number("wrong"),
        "why",
        "first witness, to six digits",
        "its case",
    )
    found = table("mathematical findings", columns, [_finding(group) for group in alike.values()])
    return Section("Mathematical findings", (Paragraph(_FINDINGS), found))


def _finding(group: list[Finding]) -> tuple[Cell, ...]:
    line = group[0]
    why = explanation(line)
    row = from_hex(line.first_row)
    return (
        Cell(joined([Code(each.formula) for each in group])),
        Cell(Code(line.family)),
        Cell(Strong("inside") if line.inside else "outside"),
        Cell(f"{line.wrong:,} of {line.asked:,}", line.wrong / max(1, line.asked)),
        Cell(Strong(why), tone="bad") if unlisted(line) else Cell(why),
        Cell(short_row(row)),
        Cell(Code(line.first_case)),
    )
