"""The times and the memory of a benchmark's methods, with their intervals and the noise of the run."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Memory, Refused, Speed, Unmeasured
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Figures,
    Paragraph,
    Section,
    Table,
    bullets,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.measured import lost, measured, noise_floor, workloads
from hypcheck.report.text import counted, figure, with_interval

_TIMES = prose(
    "Medians over interleaved rounds in fresh processes, with 95 % intervals. A ratio is of times in the same round, to"
    " the run's reference; over 1 is slower. *Noise* is what one method differs from itself by: a smaller difference is"
    " none. Absolute times do not carry over to another machine, ratios mostly do."
)
_MEMORY = "The growth of a fresh process's peak resident memory while it answers a batch."


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of these."""
    refused = [(Code(line.method), f" on {line.workload}, {line.mode}: {line.reason}") for line in record.of(Refused)]
    unmeasured = [
        (Code(line.method), f" on {line.workload}, {line.mode}: {line.reason}") for line in record.of(Unmeasured)
    ]
    if record.of(Speed) or refused or unmeasured:
        blocks: list[Block] = [Paragraph(_TIMES)]
        if refused:
            blocks += [Paragraph("Not timed, because its answers were not what they must be:"), bullets(refused)]
        if unmeasured:
            blocks += [
                Paragraph("Not to be timed here, which fails nothing and holds nobody to a baseline:"),
                bullets(unmeasured),
            ]
        yield Section("Run times", (*blocks, Figures("speeds"), _times(record)))
    if record.of(Memory):
        yield Section("Memory", (Paragraph(_MEMORY), _memory(record)))


def _times(record: Record) -> Table:
    numbers = map(number, ("ratio", "ns a query", "queries a second", "noise", "rows"))
    columns: tuple[Column | str, ...] = ("method", "workload", "mode", *numbers, "timed by")
    titles = {name: str(line.title) for name, line in workloads(record).items()}
    rows = [
        (Cell(Code(each.name)), Cell(titles[line.workload]), Cell(line.mode), *_time(record, line))
        for each in measured(record)
        for line in each.speed.values()
    ]
    return table("run times", columns, rows)


def _time(record: Record, line: Speed) -> tuple[Cell, ...]:
    floor = noise_floor(record, line.workload, line.mode)
    median, ratio = float(line.median_ns), line.ratio
    interval = line.ratio_ci95
    if lost(line):
        return (Cell("–"), Cell("no more than an empty call"), Cell("–"), _noise(floor), *_how(line))
    return (
        Cell("–") if ratio is None else Cell(with_interval(ratio, interval), ratio),
        Cell(with_interval(median, line.ci95_ns), median),
        Cell(figure(1e9 / median), 1e9 / median) if median > 0 else Cell("–"),
        _noise(floor),
        *_how(line),
    )


def _noise(floor: float | None) -> Cell:
    return Cell("–") if floor is None else Cell(f"± {figure(100 * floor)} %", floor)


def _how(line: Speed) -> tuple[Cell, Cell]:
    dropped = f", {counted(line.dropped, 'impossible sample')} dropped" if line.dropped else ""
    return count(line.rows), Cell(f"{line.timed_by}{dropped}")


def _memory(record: Record) -> Table:
    columns: tuple[Column | str, ...] = ("method", number("rows"), number("growth, MB"), number("bytes a row"))
    rows = [
        (
            Cell(Code(line.method)),
            count(line.rows),
            Cell(figure(line.peak_bytes / 1e6), line.peak_bytes),
            Cell(figure(line.peak_bytes / max(1, line.rows)), line.peak_bytes / max(1, line.rows)),
        )
        for line in record.of(Memory)
    ]
    return table("memory", columns, rows)
