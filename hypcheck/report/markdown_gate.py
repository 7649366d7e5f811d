"""The part of report.md about gated implementations as wholes: what each declares, and as what it was judged."""

from __future__ import annotations

from hypcheck.record import Record
from hypcheck.report.claims import domain
from hypcheck.report.digest import UnderTest, under_test
from hypcheck.report.markup import bullets, code, table, text
from hypcheck.report.text import counted

_NONE = "–"


def sections(record: Record) -> list[str]:
    """The lines of the section; none where nothing was gated."""
    found = under_test(record)
    if not found:
        return []
    head = ("", "", "question", "precision", "domain", "language", "version")
    started = [each for each in found if each.line["started"]]
    rows = [row for each in started for row in _rows(each)]
    return [
        "## Implementations under test",
        "",
        *(table(head, rows) if rows else []),
        *bullets(_said(each) for each in found),
    ]


def _rows(tested: UnderTest) -> list[tuple[str, ...]]:
    """What it declares, and what it was judged as: options of the command line stand for what it declares."""
    declared, used = tested.line["declared"], tested.line["used"]
    names = {"declared": code(tested.name), "judged as": ""}
    return [
        (
            names[what],
            what,
            text(description["question"]),
            text(description["precision"]),
            text(domain(description["domain"])),
            text(description["language"]) or _NONE,
            text(description["version"]) or _NONE,
        )
        for what, description in (("declared", declared), ("judged as", used))
    ]


def _said(tested: UnderTest) -> str:
    line = tested.line
    name = f"{code(tested.name)}, {code(line['spec'])}"
    if not line["started"]:
        return f"{name}, was not started: {text(line['trouble'])}."
    again = line["again"]
    troubles = "".join(f" {text(trouble)}." for trouble in line["troubles"])
    return (
        f"{name}: {counted(again['asked'], 'case')} asked again in another order, in other batches and in a fresh"
        f" process; {again['within']:,} answered otherwise within the tolerance, {again['beyond']:,} beyond it."
        f" {counted(line['restarts'], 'restart')}.{troubles}"
    )
