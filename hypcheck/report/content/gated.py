"""Gated implementations as wholes: what each declares, and as what it was judged."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.lines import Implementation, NotStarted
from hypcheck.report.claims import domain
from hypcheck.report.content.blocks import Code, Section, Text, bullets, table
from hypcheck.report.digest import UnderTest, under_test
from hypcheck.report.text import counted

_NONE = "–"


def sections(record: Record) -> Iterator[Section]:
    """The section; none where nothing was gated."""
    found = under_test(record)
    if not found:
        return
    head = ("", "", "question", "precision", "domain", "language", "version")
    rows = [row for each in found if isinstance(each.line, Implementation) for row in _rows(each.name, each.line)]
    declared = [table("implementations under test", head, rows)] if rows else []
    yield Section("Implementations under test", (*declared, bullets([_said(each) for each in found])))


def _rows(name: str, line: Implementation) -> list[tuple[Text, ...]]:
    """What it declares, and what it was judged as: options of the command line stand for what it declares."""
    names: dict[str, Text] = {"declared": Code(name), "judged as": ""}
    return [
        (
            names[what],
            what,
            description.question,
            description.precision,
            domain(description.domain),
            description.language or _NONE,
            description.version or _NONE,
        )
        for what, description in (("declared", line.declared), ("judged as", line.used))
    ]


def _said(tested: UnderTest) -> Text:
    line = tested.line
    name: Text = (Code(tested.name), ", ", Code(line.spec))
    if isinstance(line, NotStarted):
        return (name, f", was not started: {line.trouble}.")
    again = line.again
    troubles = "".join(f" {trouble}." for trouble in line.troubles)
    excused = sum(group.counts.get("excused", 0) for group in tested.groups)
    known = f" {counted(excused, 'case')} excused as known failures." if excused else ""
    said = (
        f": {counted(again.asked, 'case')} asked again in another order, in other batches and in a fresh process;"
        f" {again.within:,} answered otherwise within the tolerance, {again.beyond:,} beyond it."
        f" {counted(line.restarts, 'restart')}.{known}{troubles}"
    )
    return (name, said)
