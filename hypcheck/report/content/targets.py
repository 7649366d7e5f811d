"""What a benchmark was held to: the paper's claims of cost, the kernels' targets, an earlier run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hypcheck.record import Record
from hypcheck.record.fields import Interval
from hypcheck.record.measurements import Comparison, Cost, Kernel
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Item,
    Paragraph,
    Section,
    Strong,
    Table,
    bullets,
    number,
    prose,
    table,
)
from hypcheck.report.text import figure, with_interval

_TONES = {"does not hold": "bad", "slower": "bad", "holds": "good", "faster": "good"}
_BASELINE = prose(
    "Ratios to the run's reference, here and in the baseline; *change* is their quotient with its 95 % interval."
    " *Slower* is what exceeds what is allowed even at the interval's lower end; *inconclusive*, what the noise does"
    " not let tell. In brackets are verdicts that are only shown: they are about methods that nobody asked to be held"
    " to the baseline, and decide nothing."
)


def baseline(record: Record) -> Iterator[Section]:
    """The comparison with an earlier run, which stands behind what failed; none where there is no baseline."""
    if record.of(Comparison):
        yield Section("Against the baseline", (Paragraph(_BASELINE), _baseline(record.of(Comparison))))


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of the others."""
    if record.of(Cost):
        yield Section("The paper's claims of cost", tuple(_claims(record)))
    if record.of(Kernel):
        yield Section("The kernels' targets", (_kernels(record.of(Kernel)),))


def _interval(value: float, ends: Interval | None) -> Cell:
    return Cell(with_interval(value, ends), value)


def _baseline(lines: list[Comparison]) -> Table:
    numbers = map(number, ("before", "after", "change", "allowed"))
    columns: tuple[Column | str, ...] = ("method", "workload", "mode", *numbers, "verdict")
    order = ["slower", "inconclusive", "faster", "same"]
    ranked = sorted(lines, key=lambda line: (not line.gates, order.index(line.verdict)))
    rows = [
        (
            Cell(Code(line.method)),
            Cell(line.workload),
            Cell(line.mode),
            Cell(figure(line.before), line.before),
            Cell(figure(line.after), line.after),
            _interval(line.change, line.ci95),
            Cell(figure(line.allowed), line.allowed),
            _verdict(line),
        )
        for line in ranked
    ]
    return table("against the baseline", columns, rows)


def _verdict(line: Comparison) -> Cell:
    verdict = line.verdict
    return Cell(verdict, tone=_TONES.get(verdict, "")) if line.gates else Cell(f"({verdict})")


def claims(record: Record) -> dict[str, list[Cost]]:
    """The claims of cost with their lines, one for each scene."""
    found: dict[str, list[Cost]] = {}
    for line in record.of(Cost):
        found.setdefault(line.claim, []).append(line)
    return found


def told(record: Record) -> Iterator[Section]:
    """The claims with what was measured of them, without the table of what was compared."""
    items = [
        Item(claim, tuple((Strong(line.verdict), f", {line.scene}. {line.says}") for line in lines))
        for claim, lines in claims(record).items()
    ]
    if items:
        yield Section("The paper's claims of cost", (bullets(items),))


def _claims(record: Record) -> Iterator[Block]:
    for claim, lines in claims(record).items():
        yield Paragraph(Strong(claim))
        rows = [
            (Cell(line.scene), Cell(Strong(line.verdict), tone=_TONES.get(line.verdict, "")), line.says)
            for line in lines
        ]
        yield table("what was measured of a claim", ("scene", "verdict", "what was measured"), rows)
        columns: tuple[Column | str, ...] = ("scene", "compared", *map(number, ("ratio", "ns")), "operations")
        yield table("what was compared", columns, [row for line in lines for row in _compared(line)])


def _compared(line: Cost) -> Iterator[tuple[Cell, ...]]:
    for each in line.compared:
        yield (
            Cell(line.scene),
            Cell(each.name),
            Cell("–") if each.ratio is None else _interval(each.ratio, each.ratio_ci95),
            Cell("–") if each.median_ns is None else Cell(figure(each.median_ns), each.median_ns),
            Cell(_operations(each.operations)),
        )


def _operations(counts: Mapping[str, int] | None) -> str:
    return "" if counts is None else ", ".join(f"{number_} {name}" for name, number_ in counts.items())


def _kernels(lines: list[Kernel]) -> Table:
    columns: tuple[Column | str, ...] = ("kernel", "target", *map(number, ("wanted", "measured")), "met", "which says")
    rows = [
        (
            Cell(line.name),
            Cell(line.target),
            Cell(figure(line.wanted), line.wanted),
            _interval(line.measured, line.ci95),
            Cell("yes", tone="good") if line.met else Cell(Strong("no"), tone="bad"),
            Cell(line.says),
        )
        for line in sorted(lines, key=lambda line: bool(line.met))
    ]
    return table("targets of the kernels", columns, rows)
