"""What changed from one record to another: statuses by family, worst errors, errors by workload, ratios of times.

Times themselves are never compared, since the records may be of two machines, or of two days. A ratio compares two
methods within one run, and its interval says how exactly that run measured it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from hypcheck.record import Record
from hypcheck.record.lines import GroupLine
from hypcheck.record.measurements import AccuracyLine, SpeedLine
from hypcheck.report.document import (
    Block,
    Code,
    Column,
    Paragraph,
    Section,
    TableBlock,
    TableCell,
    bullets,
    number,
    prose,
    table,
)
from hypcheck.report.messages import figure, listed, with_interval
from hypcheck.report.model import implementations, timing_totals, worst_case, worst_error_u
from hypcheck.report.verdict import verdict

Key = TypeVar("Key", bound=Hashable)

Interval = tuple[float, float]

FASTER, SLOWER, UNCLEAR = "faster", "slower", "no difference shown"


@dataclass(frozen=True, slots=True)
class StatusChange:
    """A family of an implementation whose cases ended differently."""

    implementation: str
    family: str
    before: Mapping[str, int]
    after: Mapping[str, int]
    worst_before_u: float
    worst_after_u: float

    @property
    def worse(self) -> bool:
        """Whether more cases ended other than right, or the worst error is greater."""
        return _bad(self.after) > _bad(self.before) or self.worst_after_u > self.worst_before_u


@dataclass(frozen=True, slots=True)
class AccuracyChange:
    """A method whose errors changed on a workload: [wrong, asked], and the distance above which it is reliable."""

    method: str
    workload: str
    before: tuple[int, int]
    after: tuple[int, int]
    reliable_before: float
    reliable_after: float


@dataclass(frozen=True, slots=True)
class RatioChange:
    """The ratio of a method's time to that of its run's reference, before and after, with intervals."""

    method: str
    workload: str
    mode: str
    before: float
    before_interval: Interval | None
    after: float
    after_interval: Interval | None

    @property
    def verdict(self) -> str:
        """FASTER or SLOWER if the intervals are apart, UNCLEAR if they overlap or are not known."""
        if self.before_interval is None or self.after_interval is None:
            return UNCLEAR
        if self.after_interval[1] < self.before_interval[0]:
            return FASTER
        return SLOWER if self.after_interval[0] > self.before_interval[1] else UNCLEAR


def _bad(counts: Mapping[str, int]) -> float:
    """The share of asked cases that did not end right."""
    asked = sum(number for status, number in counts.items() if status != "skipped")
    return 1 - counts.get("right", 0) / asked if asked else 0.0


def status_changes(before: Record, after: Record) -> list[StatusChange]:
    """Families of both records whose counts by status or worst errors differ; those that got worse first."""
    found = []
    for (name, family), (old, new) in _shared(_groups(before), _groups(after)):
        errors = [worst_error_u(worst_case(group.worst)) for group in (old, new)]
        change = StatusChange(name, family, old.counts, new.counts, *errors)
        all_right = set(change.before) == set(change.after) == {"right"}
        if not all_right and (change.before, errors[0]) != (change.after, errors[1]):
            found.append(change)
    return sorted(found, key=lambda change: not change.worse)


def _groups(record: Record) -> dict[tuple[str, str], GroupLine]:
    return {(each.name, group.family): group for each in implementations(record) for group in each.groups}


def accuracy_changes(before: Record, after: Record) -> list[AccuracyChange]:
    """Methods of both records whose errors on a workload differ."""
    found = []
    for key, (old, new) in _shared(_accuracies(before), _accuracies(after)):
        change = AccuracyChange(
            *key,
            (old.wrong, old.asked),
            (new.wrong, new.asked),
            float(old.reliable_above),
            float(new.reliable_above),
        )
        if change.before != change.after or change.reliable_before != change.reliable_after:
            found.append(change)
    return found


def ratio_changes(before: Record, after: Record) -> list[RatioChange]:
    """Every method that both records have timed against their reference, those with a difference first."""
    pairs = _shared(_ratios(before), _ratios(after))
    found = [RatioChange(*key, old[0], old[1], new[0], new[1]) for key, (old, new) in pairs]
    return sorted(found, key=lambda change: [SLOWER, FASTER, UNCLEAR].index(change.verdict))


def _ratios(record: Record) -> dict[tuple[str, str, str], tuple[float, Interval | None]]:
    measured = {
        (line.method, line.workload, line.mode): (line.ratio, line.ratio_ci95)
        for line in record.of(SpeedLine)
        if line.ratio is not None
    }
    timed = {(each.name, each.workload, "batch"): (each.ratio, each.ratio_range) for each in timing_totals(record)}
    return {**measured, **{key: (ratio, spread) for key, (ratio, spread) in timed.items() if ratio is not None}}


def _accuracies(record: Record) -> dict[tuple[str, str], AccuracyLine]:
    return {(line.method, line.workload): line for line in record.of(AccuracyLine)}


def only_in_one(before: Record, after: Record) -> Iterator[str]:
    """Sentences about the implementations and methods, and the families of shared ones, that one record lacks."""
    old, new = _groups(before), _groups(after)
    measured = [{line.method for line in record.of(AccuracyLine)} for record in (before, after)]
    for mine, others, which in ((old, new, "the other record"), (new, old, "this record")):
        names, other_names = {name for name, _ in mine}, {name for name, _ in others}
        alone = [*(name for name, _ in mine if name not in other_names)]
        alone += sorted(measured[mine is new] - measured[mine is old])
        families = {family for name, family in {*mine} - {*others} if name in names & other_names}
        for noun, found in (("methods", list(dict.fromkeys(alone))), ("families", sorted(families))):
            if found:
                yield f"{noun} in {which} alone: {listed(found)}"


def conditions(before: Record, after: Record) -> Iterator[str]:
    """Sentences about other differences of the runs, which may explain changes of the methods."""
    for name in ("processor", "architecture", "system", "cores"):
        old, new = (getattr(record.header.machine, name) for record in (before, after))
        if old != new:
            yield f"another machine: {name} {old}, now {new}"
    for name, old, new in _differing(before.header.versions, after.header.versions):
        yield f"{name} {old}, now {new}"
    for name, old, new in _differing(before.header.options, after.header.options):
        yield f"option {name} {old}, now {new}"
    if before.header.hypcheck != after.header.hypcheck:
        yield f"hypcheck {before.header.hypcheck}, now {after.header.hypcheck}"
    for record, which in ((before, "the other record"), (after, "this record")):
        if record.footer is None:
            yield f"{which} is truncated: what it lacks was not asked"


def _differing(before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[tuple[str, object, object]]:
    for name, (old, new) in _both(before, after):
        if old != new:
            yield name, "none" if old is None else old, "none" if new is None else new


def _both(before: Mapping[Key, Any], after: Mapping[Key, Any]) -> list[tuple[Key, tuple[Any, Any]]]:
    """Every key of either with its two values, None for a missing one."""
    return [(key, (before.get(key), after.get(key))) for key in dict.fromkeys([*before, *after])]


def _shared(before: Mapping[Key, Any], after: Mapping[Key, Any]) -> list[tuple[Key, tuple[Any, Any]]]:
    return [(key, (before[key], after[key])) for key in before if key in after]


_RATIOS = prose(
    "A ratio is a method's time by that of its run's reference; over 1 is slower. In brackets its interval, at 95 %, or"
    " the least and the greatest of a verification's rounds. Two ratios differ where their intervals are apart. Times"
    " themselves are not compared."
)


def change_sections(record: Record, against: Record) -> Iterator[Section]:
    """The changes as a section; if nothing changed, it says so."""
    statuses, accuracies = status_changes(against, record), accuracy_changes(against, record)
    ratios = ratio_changes(against, record)
    began = against.header.started
    blocks: list[Block] = [
        Paragraph(f"Against the run of {began}, which ended: {verdict(against).sentence}"),
        bullets([f"{each}." for each in (*conditions(against, record), *only_in_one(against, record))]),
    ]
    if statuses:
        blocks.append(_status_table(statuses))
    if accuracies:
        blocks.append(_accuracy_table(accuracies))
    if not statuses and not accuracies:
        blocks.append(Paragraph("No case ended otherwise."))
    if ratios:
        blocks += [Paragraph(_RATIOS), _ratio_table(ratios)]
    yield Section("What changed", tuple(blocks))


def _status_table(changes: list[StatusChange]) -> TableBlock:
    columns = ("implementation", "family", "before", "after", number("worst before, u"), number("worst after, u"))
    return table("changed statuses", columns, [_status_row(change) for change in changes])


def _status_row(change: StatusChange) -> tuple[TableCell, ...]:
    return (
        TableCell(Code(change.implementation)),
        TableCell(Code(change.family)),
        TableCell(_counts(change.before)),
        TableCell(_counts(change.after), tone="bad" if change.worse else ""),
        TableCell(figure(change.worst_before_u), change.worst_before_u),
        TableCell(figure(change.worst_after_u), change.worst_after_u),
    )


def _counts(counts: Mapping[str, int]) -> str:
    return listed([f"{number:,} {status}" for status, number in counts.items()]) or "nothing"


def _accuracy_table(changes: list[AccuracyChange]) -> TableBlock:
    numbers = map(number, ("wrong before", "wrong after", "reliable above, before", "reliable above, after"))
    return table("changed errors", ("method", "workload", *numbers), [_accuracy_row(change) for change in changes])


def _accuracy_row(change: AccuracyChange) -> tuple[TableCell, ...]:
    shares = [
        TableCell(f"{wrong:,} of {asked:,}", wrong / max(1, asked)) for wrong, asked in (change.before, change.after)
    ]
    reliable = [TableCell(figure(each), each) for each in (change.reliable_before, change.reliable_after)]
    return (TableCell(Code(change.method)), TableCell(change.workload), *shares, *reliable)


def _ratio_table(changes: list[RatioChange]) -> TableBlock:
    numbers = map(number, ("ratio before", "ratio after", "change"))
    columns: tuple[Column | str, ...] = ("method", "workload", "mode", *numbers, "verdict")
    return table("ratios of times", columns, [_ratio_row(change) for change in changes])


def _ratio_row(change: RatioChange) -> tuple[TableCell, ...]:
    factor = change.after / change.before if change.before else 0.0
    tone = {SLOWER: "bad", FASTER: "good"}.get(change.verdict, "")
    return (
        TableCell(Code(change.method)),
        TableCell(change.workload),
        TableCell(change.mode),
        TableCell(with_interval(change.before, change.before_interval), change.before),
        TableCell(with_interval(change.after, change.after_interval), change.after),
        TableCell(f"× {figure(factor)}" if factor else "–", factor),
        TableCell(change.verdict, tone=tone),
    )
