"""What changed against another record."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hypcheck.record import Record
from hypcheck.report.changes import (
    FASTER,
    SLOWER,
    AccuracyChange,
    RatioChange,
    StatusChange,
    accuracy_changes,
    conditions,
    in_one_alone,
    ratio_changes,
    status_changes,
)
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Paragraph,
    Section,
    Table,
    bullets,
    number,
    prose,
    table,
)
from hypcheck.report.text import figure, listed, with_interval
from hypcheck.report.verdict import verdict

_RATIOS = prose(
    "A ratio is a method's time by that of its run's reference; over 1 is slower. In brackets its interval, at 95 %, or"
    " the least and the greatest of a verification's rounds. Two ratios differ where their intervals are apart. Times"
    " themselves are not compared."
)


def sections(record: Record, against: Record) -> Iterator[Section]:
    """The section; it is there whenever another record is, and says so where nothing changed."""
    statuses, accuracies = status_changes(against, record), accuracy_changes(against, record)
    ratios = ratio_changes(against, record)
    began = against.header.started
    blocks: list[Block] = [
        Paragraph(f"Against the run of {began}, which ended: {verdict(against).sentence}"),
        bullets([f"{each}." for each in (*conditions(against, record), *in_one_alone(against, record))]),
    ]
    if statuses:
        blocks.append(_statuses(statuses))
    if accuracies:
        blocks.append(_accuracies(accuracies))
    if not statuses and not accuracies:
        blocks.append(Paragraph("No case ended otherwise."))
    if ratios:
        blocks += [Paragraph(_RATIOS), _ratios(ratios)]
    yield Section("What changed", tuple(blocks))


def _statuses(changes: list[StatusChange]) -> Table:
    columns = ("implementation", "family", "before", "after", number("worst before, u"), number("worst after, u"))
    return table("changed statuses", columns, [_status_row(change) for change in changes])


def _status_row(change: StatusChange) -> tuple[Cell, ...]:
    return (
        Cell(Code(change.implementation)),
        Cell(Code(change.family)),
        Cell(_counts(change.before)),
        Cell(_counts(change.after), tone="bad" if change.worse else ""),
        Cell(figure(change.worst_before_u), change.worst_before_u),
        Cell(figure(change.worst_after_u), change.worst_after_u),
    )


def _counts(counts: Mapping[str, int]) -> str:
    return listed([f"{number:,} {status}" for status, number in counts.items()]) or "nothing"


def _accuracies(changes: list[AccuracyChange]) -> Table:
    numbers = map(number, ("wrong before", "wrong after", "reliable above, before", "reliable above, after"))
    columns: tuple[Column | str, ...] = ("method", "workload", *numbers)
    return table("changed errors", columns, [_accuracy_row(change) for change in changes])


def _accuracy_row(change: AccuracyChange) -> tuple[Cell, ...]:
    shares = [Cell(f"{wrong:,} of {asked:,}", wrong / max(1, asked)) for wrong, asked in (change.before, change.after)]
    reliable = [Cell(figure(each), each) for each in (change.reliable_before, change.reliable_after)]
    return (Cell(Code(change.method)), Cell(change.workload), *shares, *reliable)


def _ratios(changes: list[RatioChange]) -> Table:
    numbers = map(number, ("ratio before", "ratio after", "change"))
    columns: tuple[Column | str, ...] = ("method", "workload", "mode", *numbers, "verdict")
    return table("ratios of times", columns, [_ratio_row(change) for change in changes])


def _ratio_row(change: RatioChange) -> tuple[Cell, ...]:
    factor = change.after / change.before if change.before else 0.0
    tone = {SLOWER: "bad", FASTER: "good"}.get(change.verdict, "")
    return (
        Cell(Code(change.method)),
        Cell(change.workload),
        Cell(change.mode),
        Cell(with_interval(change.before, change.before_interval), change.before),
        Cell(with_interval(change.after, change.after_interval), change.after),
        Cell(f"× {figure(factor)}" if factor else "–", factor),
        Cell(change.verdict, tone=tone),
    )
