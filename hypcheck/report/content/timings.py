"""How long the fast path takes beside others, in a run of verify."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.content.blocks import Cell, Code, Column, Paragraph, Section, count, joined, number, table
from hypcheck.report.digest import REFERENCE, TimingTotal, timing_totals
from hypcheck.report.text import figure


def sections(record: Record) -> Iterator[Section]:
    """The section; none where nothing was timed."""
    totals = timing_totals(record)
    if not totals:
        return
    workloads = joined([Code(name) for name in dict.fromkeys(total.workload for total in totals)])
    how = (
        ", in one process, in interleaved rounds on the machine below. The ratio is the time by that of the"
        f" {REFERENCE} in the same round, median of the rounds: below 1 is faster. Absolute figures do not carry over"
        " to another machine."
    )
    said = ("On ", workloads, how)
    numbers = map(number, ("rows", "ns a row, median", "least to greatest", "time ratio"))
    columns: tuple[Column | str, ...] = ("contender", "what it is", *numbers)
    yield Section("Timings", (Paragraph(said), table("timings", columns, [_row(total) for total in totals])))


def _row(total: TimingTotal) -> tuple[Cell, ...]:
    return (
        Cell(total.name),
        Cell(total.title),
        count(total.rows),
        Cell(figure(total.median_ns), total.median_ns),
        Cell(f"{figure(total.least_ns)} to {figure(total.greatest_ns)}", total.greatest_ns),
        Cell("–") if total.ratio is None else Cell(figure(total.ratio), total.ratio),
    )
