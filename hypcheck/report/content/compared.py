"""What a benchmark compared: its methods, its workloads, and what was not there."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Absent, Compiler, Method, Workload
from hypcheck.report.content.blocks import Block, Cell, Code, Column, Section, Strong, bullets, table
from hypcheck.report.measured import measured


def sections(record: Record) -> Iterator[Section]:
    """The section; none where nothing was measured."""
    found = measured(record)
    if not found:
        return
    columns: tuple[Column | str, ...] = ("method", "what it is", "tier", "precision", "question", "exact", "remarks")
    rows = [
        (
            Cell(Code(each.name)),
            Cell(each.line.title),
            Cell(each.tier),
            Cell(each.line.precision),
            Cell(each.line.question),
            Cell("yes" if each.exact else ""),
            Cell("; ".join(_remarks(each.line))),
        )
        for each in found
    ]
    items = [
        (Strong(line.title), f" ({line.rows:,} rows, seed {line.seed}): {line.text}") for line in record.of(Workload)
    ]
    missing = [f"Not there: {line.what}: {line.reason}." for line in record.of(Absent)]
    compiled = [f"Compiled with {line.program} {line.version}: {' '.join(line.flags)}." for line in record.of(Compiler)]
    blocks: list[Block] = [table("methods", columns, rows), bullets([*items, *compiled, *missing])]
    yield Section("What was compared", tuple(blocks))


def _remarks(line: Method) -> Iterator[str]:
    if line.amortised:
        yield f"its mesh is {line.amortised}".replace("is build", "is built")
    if line.accuracy_only:
        yield "not timed"
    if line.note:
        yield str(line.note)
