"""Changes between two records: statuses by family, worst errors, errors by workload, ratios of times.

Times themselves are never compared, since the records may be of two machines, or of two days. A ratio compares two
methods within one run, and its interval gives the accuracy of that run's measurement.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.lines import GroupLine
from hypcheck.record.measurements import AccuracyLine, SpeedLine
from hypcheck.report import document
from hypcheck.report.document import measured
from hypcheck.report.messages import figure, listed
from hypcheck.report.model import implementations, timing_totals, worst_u
from hypcheck.report.verdict import verdict

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

Interval = tuple[float, float]

Ratio = tuple[float, Interval | None]
"""The ratio of a method's time to that of its run's reference, and its interval where it has one."""

FASTER, SLOWER, UNCLEAR = "faster", "slower", "no difference shown"


@dataclass(frozen=True, slots=True)
class StatusChange:
    """A family of an implementation with changed statuses or errors: its lines before and after."""

    implementation: str
    before: GroupLine
    after: GroupLine

    @property
    def family(self) -> str:
        """The name of the family."""
        return self.after.family

    @property
    def worse(self) -> bool:
        """Whether the share of cases that are not right, or the worst error, is greater."""
        return _bad(self.after) > _bad(self.before) or worst_u(self.after) > worst_u(self.before)


@dataclass(frozen=True, slots=True)
class AccuracyChange:
    """A method whose errors on a workload changed: its lines before and after."""

    before: AccuracyLine
    after: AccuracyLine


@dataclass(frozen=True, slots=True)
class RatioChange:
    """A method's ratio before and after."""

    method: str
    workload: str
    mode: str
    before: Ratio
    after: Ratio

    @property
    def verdict(self) -> str:
        """FASTER or SLOWER if the intervals are disjoint, UNCLEAR if they overlap or are not known."""
        before, after = self.before[1], self.after[1]
        if before is None or after is None:
            return UNCLEAR
        if after[1] < before[0]:
            return FASTER
        return SLOWER if after[0] > before[1] else UNCLEAR


def _bad(group: GroupLine) -> float:
    """Return the share of tested cases that are not right."""
    tested = sum(cases for status, cases in group.counts.items() if status != "skipped")
    return 1 - group.counts.get("right", 0) / tested if tested else 0.0


def status_changes(before: Record, after: Record) -> list[StatusChange]:
    """Return the families of both records whose counts by status or worst errors differ, worse families first."""
    changed = []
    for (name, _), (old, new) in _shared(_groups(before), _groups(after)):
        all_right = set(old.counts) == set(new.counts) == {"right"}
        if not all_right and (old.counts, worst_u(old)) != (new.counts, worst_u(new)):
            changed.append(StatusChange(name, old, new))
    return sorted(changed, key=lambda change: not change.worse)


def _groups(record: Record) -> dict[tuple[str, str], GroupLine]:
    """Return the group lines of a record by the implementation's name in reports and the family."""
    return {
        (implementation.name, group.family): group
        for implementation in implementations(record)
        for group in implementation.groups
    }


def accuracy_changes(before: Record, after: Record) -> list[AccuracyChange]:
    """Return the methods of both records whose errors on a workload differ."""
    pairs = (pair for _, pair in _shared(_accuracies(before), _accuracies(after)))
    return [AccuracyChange(old, new) for old, new in pairs if _errors(old) != _errors(new)]


def _errors(line: AccuracyLine) -> tuple[int, int, float]:
    """Return what is compared about two lines: wrong answers, all answers, and where the errors end."""
    return line.wrong, line.asked, line.reliable_above


def ratio_changes(before: Record, after: Record) -> list[RatioChange]:
    """Return every ratio that both records have: slower methods first, then faster ones, then unclear ones."""
    ratios = [RatioChange(*key, *pair) for key, pair in _shared(_ratios(before), _ratios(after))]
    return sorted(ratios, key=lambda change: [SLOWER, FASTER, UNCLEAR].index(change.verdict))


def _ratios(record: Record) -> dict[tuple[str, str, str], Ratio]:
    """Return the ratios of a record by method, workload and mode: those of a benchmark, and those of a verification."""
    measured = {
        (line.method, line.workload, line.mode): (line.ratio, line.ratio_ci95)
        for line in record.of(SpeedLine)
        if line.ratio is not None
    }
    timed = {
        (total.name, total.workload, "batch"): (total.ratio, total.ratio_range)
        for total in timing_totals(record)
        if total.ratio is not None
    }
    return {**measured, **timed}


def _accuracies(record: Record) -> dict[tuple[str, str], AccuracyLine]:
    """Return the accuracy lines of a record by method and workload."""
    return {(line.method, line.workload): line for line in record.of(AccuracyLine)}


def only_in_one(before: Record, after: Record) -> Iterator[str]:
    """Yield sentences about implementations and methods that one record lacks, and about families of shared ones."""
    old, new = _groups(before), _groups(after)
    measured = [{line.method for line in record.of(AccuracyLine)} for record in (before, after)]
    for mine, others, which in ((old, new, "the other record"), (new, old, "this record")):
        names, other_names = {name for name, _ in mine}, {name for name, _ in others}
        alone = [*(name for name, _ in mine if name not in other_names)]
        alone += sorted(measured[mine is new] - measured[mine is old])
        families = {family for name, family in {*mine} - {*others} if name in names & other_names}
        for noun, missing in (("methods", list(dict.fromkeys(alone))), ("families", sorted(families))):
            if missing:
                yield f"{noun} in {which} alone: {listed(missing)}"


def conditions(before: Record, after: Record) -> Iterator[str]:
    """Yield sentences about other differences between the runs, which may explain changes of the methods."""
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
    """Yield the keys whose values differ, with both values; "none" stands for a missing value."""
    for name in dict.fromkeys([*before, *after]):
        old, new = before.get(name), after.get(name)
        if old != new:
            yield name, "none" if old is None else old, "none" if new is None else new


def _shared(before: Mapping[Key, Value], after: Mapping[Key, Value]) -> list[tuple[Key, tuple[Value, Value]]]:
    """Return the keys that both have, each with its two values."""
    return [(key, (before[key], after[key])) for key in before if key in after]


MOST_CONDITIONS = 3
"""The most differences between the conditions of two runs that are listed in sentences."""


def change_facts(record: Record, against: Record) -> Iterator[str]:
    """Yield sentences about the changes against another record; they name the most important of each kind."""
    yield f"against the run of {against.header.started}, which ended: {verdict(against).sentence}"
    statuses, ratios = status_changes(against, record), ratio_changes(against, record)
    accuracies = accuracy_changes(against, record)
    worse = [f"{change.implementation} on {change.family}" for change in statuses if change.worse]
    yield f"  statuses: {counted(len(statuses), 'family of a method', 'families of methods')} changed" + (
        f", worse: {listed(worse)}" if worse else ""
    )
    if accuracies:
        changed = [f"{change.after.method} on {change.after.workload}" for change in accuracies]
        yield f"  errors: {listed(changed)} changed"
    for which in (SLOWER, FASTER):
        named = [f"{ratio.method} ({ratio.workload}, {ratio.mode})" for ratio in ratios if ratio.verdict == which]
        if named:
            yield f"  {which}, by ratio: {listed(named)}"
    others = [*conditions(against, record), *only_in_one(against, record)]
    yield from (f"  {difference}" for difference in others[:MOST_CONDITIONS])
    if len(others) > MOST_CONDITIONS:
        yield f"  and {counted(len(others) - MOST_CONDITIONS, 'more difference')} between the runs themselves"


_RATIOS = document.prose(
    "A ratio is a method's time by that of its run's reference; over 1 is slower. In brackets its interval, at 95 %, or"
    " the least and the greatest of a verification's rounds. Two ratios differ where their intervals are apart. Times"
    " themselves are not compared."
)


def change_section(record: Record, against: Record) -> document.Section:
    """Make the section about the changes; it has a sentence instead of tables if no case ended otherwise."""
    statuses, accuracies = status_changes(against, record), accuracy_changes(against, record)
    ratios = ratio_changes(against, record)
    began = against.header.started
    blocks: list[document.Block] = [
        document.Paragraph(f"Against the run of {began}, which ended: {verdict(against).sentence}"),
        document.bullets(
            [f"{difference}." for difference in (*conditions(against, record), *only_in_one(against, record))]
        ),
    ]
    if statuses:
        blocks.append(document.table_of("changed statuses", statuses, _STATUS_CELLS))
    if accuracies:
        blocks.append(document.table_of("changed errors", accuracies, _ERROR_CELLS))
    if not statuses and not accuracies:
        blocks.append(document.Paragraph("No case ended otherwise."))
    if ratios:
        blocks += [document.Paragraph(_RATIOS), document.table_of("ratios of times", ratios, _RATIO_CELLS)]
    return document.Section("What changed", tuple(blocks))


def _counts(group: GroupLine) -> str:
    """Return the counts of a family by status as a text; "nothing" if there are none."""
    return listed([f"{cases:,} {status}" for status, cases in group.counts.items()]) or "nothing"


_STATUS_CELLS: document.Cells[StatusChange] = {
    "implementation": lambda change: document.Code(change.implementation),
    "family": lambda change: document.Code(change.family),
    "before": lambda change: _counts(change.before),
    "after": lambda change: document.TableCell(_counts(change.after), tone="bad" if change.worse else ""),
    "# worst before, u": lambda change: measured(worst_u(change.before)),
    "# worst after, u": lambda change: measured(worst_u(change.after)),
}

_ERROR_CELLS: document.Cells[AccuracyChange] = {
    "method": lambda change: document.Code(change.after.method),
    "workload": lambda change: change.after.workload,
    "# wrong before": lambda change: document.ratio_of(change.before.wrong, change.before.asked),
    "# wrong after": lambda change: document.ratio_of(change.after.wrong, change.after.asked),
    "# reliable above, before": lambda change: measured(change.before.reliable_above),
    "# reliable above, after": lambda change: measured(change.after.reliable_above),
}


def _factor(change: RatioChange) -> document.TableCell:
    """Make the cell with the new ratio divided by the old one."""
    factor = change.after[0] / change.before[0] if change.before[0] else 0.0
    return document.TableCell(f"× {figure(factor)}" if factor else document.MISSING, factor)


_RATIO_CELLS: document.Cells[RatioChange] = {
    "method": lambda change: document.Code(change.method),
    "workload": lambda change: change.workload,
    "mode": lambda change: change.mode,
    "# ratio before": lambda change: measured(*change.before),
    "# ratio after": lambda change: measured(*change.after),
    "# change": _factor,
    "verdict": lambda change: document.TableCell(
        change.verdict, tone={SLOWER: "bad", FASTER: "good"}.get(change.verdict, "")
    ),
}
