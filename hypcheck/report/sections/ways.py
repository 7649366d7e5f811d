"""The section about methods for ways: missed contacts, false contacts and abstentions beside what a way costs."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.document import (
    Code,
    Figures,
    Paragraph,
    Section,
    TableBlock,
    TableCell,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.measured import WayTotal, principal, reference, way_totals, workloads
from hypcheck.report.messages import figure, with_interval

_WAYS = prose(
    "A *missed contact* (dangerous) is a way that was called clear and has contact; a *false contact* closes a way that"
    " is clear. Counts are of all workloads together; a slow method is asked fewer ways. A wrong answer is measured by"
    " the change of b and d that makes it right: half of the wrong answers need at least what stands under *wrong by*,"
    " about, and *worst* is the greatest that was found (∞: no change below 100 % is enough, as where the centre goes"
    " through the surface). Times are medians of a way in a batch."
)
FRONT = Figures("front", "missed contacts and false contacts against the time of a way", "front.svg")


def way_sections(record: Record) -> Iterator[Section]:
    """The comparison of methods for ways; none if the benchmark is about positions."""
    totals = way_totals(record)
    if totals:
        yield Section("Missed and false contacts against time", (Paragraph(_WAYS), FRONT, _table(record, totals)))


def _table(record: Record, totals: list[WayTotal]) -> TableBlock:
    where = workloads(record)[principal(record)].title
    time = number("µs a way", hint=f"on the workload: {where}")
    by = number("ratio", hint=f"to the time of {reference(record)}")
    counts = map(
        number, ("ways", "missed contacts", "share", "false contacts", "share", "cannot say", "wrong by", "worst")
    )
    return table("missed and false contacts", ("method", *counts, time, by), [_row(each) for each in totals])


def _row(each: WayTotal) -> tuple[TableCell, ...]:
    time = None if each.time_ns is None else each.time_ns / 1000
    return (
        TableCell(Code(each.name)),
        count(each.asked),
        count(each.missed, bad=True),
        _share(each, each.missed),
        count(each.false),
        _share(each, each.false),
        count(each.abstained),
        _size(each, each.typical),
        _size(each, each.worst),
        TableCell("–") if time is None else TableCell(figure(time), time),
        TableCell("–") if each.ratio is None else TableCell(with_interval(each.ratio, each.ratio_ci95), each.ratio),
    )


def _size(each: WayTotal, size: float) -> TableCell:
    if not each.missed and not each.false:
        return TableCell("·", 0.0)
    return TableCell(f"{figure(100 * size)} %" if size < math.inf else "∞", size)


def _share(each: WayTotal, part: int) -> TableCell:
    return TableCell(f"{figure(100 * each.share(part))} %", each.share(part))
