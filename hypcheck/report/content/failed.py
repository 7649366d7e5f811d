"""What failed the run: every failure with its case and the command that shows it."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.content.blocks import Bullets, Code, Either, Section, Strong, Table, Text, bullets, table
from hypcheck.report.failure import Failure
from hypcheck.report.text import counted
from hypcheck.report.verdict import failures

LISTED = 50
"""Failures that a text shows one by one."""

IN_TABLE = 1000
"""Failures in the page's table; junit.xml and summary.json have all."""


def sections(record: Record) -> Iterator[Section]:
    """The section; none where nothing failed."""
    found = failures(record)
    if found:
        yield Section("What failed", (Either(page=_table(found), text=_list(found)),))


def _list(found: list[Failure]) -> Bullets:
    items: list[Text] = []
    for failure in found[:LISTED]:
        place: Text = (" (", Code(failure.place), ")") if failure.place else ""
        case: Text = (" Case ", Code(failure.case), place, ": ", Code(failure.replay or "")) if failure.case else ""
        items.append((Strong((failure.subject, ", ", failure.group)), ": ", failure.message, ".", case))
    return bullets([*items, *_rest(len(found) - LISTED)])


def _table(found: list[Failure]) -> Table:
    """With the commands that show them, where there are any."""
    columns, replays = ("which", "where", "what happened"), any(failure.replay for failure in found)
    rows = [(*_row(failure), *([Code(failure.replay or "")] if replays else [])) for failure in found[:IN_TABLE]]
    rest = [("", "", text, *([""] if replays else [])) for text in _rest(len(found) - IN_TABLE)]
    return table("failures", (*columns, *(["look at it with"] if replays else [])), [*rows, *rest])


def _row(failure: Failure) -> tuple[Text, ...]:
    place: Text = (" (", Code(failure.place), ")") if failure.place else ""
    return Code(failure.name), failure.group, (failure.message, place)


def _rest(left_out: int) -> list[Text]:
    if left_out <= 0:
        return []
    files = (Code("junit.xml"), " and ", Code("summary.json"))
    return [(f"… and {counted(left_out, 'more failure')}; ", *files, " list them all.")]
