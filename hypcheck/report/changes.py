"""What changed from one record to another: statuses by family, worst errors, errors by workload, ratios of times.

Times themselves are never compared: the records may be of two machines, and of one machine on two days. A ratio is of
two methods within one run, and its interval says how well that run knew it.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from hypcheck.record import Record
from hypcheck.record.lines import Group
from hypcheck.record.measurements import Accuracy, Speed
from hypcheck.report.digest import implementations, timing_totals, worst_case, worst_error_u
from hypcheck.report.text import listed

Key = TypeVar("Key", bound=Hashable)

Interval = tuple[float, float]

FASTER, SLOWER, UNCLEAR = "faster", "slower", "no difference shown"


@dataclass(frozen=True, slots=True)
class StatusChange:
    """A family of an implementation whose cases ended otherwise."""

    implementation: str
    family: str
    before: Mapping[str, int]
    after: Mapping[str, int]
    worst_before_u: float
    worst_after_u: float

    @property
    def worse(self) -> bool:
        """Whether more of the cases ended other than right, or one by a greater error."""
        return _bad(self.after) > _bad(self.before) or self.worst_after_u > self.worst_before_u


@dataclass(frozen=True, slots=True)
class AccuracyChange:
    """A method that errs otherwise on a workload: [wrong, asked] and the flip distance above which it is reliable."""

    method: str
    workload: str
    before: tuple[int, int]
    after: tuple[int, int]
    reliable_before: float
    reliable_after: float


@dataclass(frozen=True, slots=True)
class RatioChange:
    """A method's time by that of its run's reference, before and after, with their intervals."""

    method: str
    workload: str
    mode: str
    before: float
    before_interval: Interval | None
    after: float
    after_interval: Interval | None

    @property
    def verdict(self) -> str:
        """FASTER or SLOWER where the intervals are apart, UNCLEAR where they are not or are not known."""
        if self.before_interval is None or self.after_interval is None:
            return UNCLEAR
        if self.after_interval[1] < self.before_interval[0]:
            return FASTER
        return SLOWER if self.after_interval[0] > self.before_interval[1] else UNCLEAR


def _bad(counts: Mapping[str, int]) -> float:
    """The share of cases asked that did not end right."""
    asked = sum(number for status, number in counts.items() if status != "skipped")
    return 1 - counts.get("right", 0) / asked if asked else 0.0


def status_changes(before: Record, after: Record) -> list[StatusChange]:
    """Families of both records whose counts by status or worst errors are not the same; first what got worse."""
    found = []
    for (name, family), (old, new) in _shared(_groups(before), _groups(after)):
        errors = [worst_error_u(worst_case(group.worst)) for group in (old, new)]
        change = StatusChange(name, family, old.counts, new.counts, *errors)
        all_right = set(change.before) == set(change.after) == {"right"}
        if not all_right and (change.before, errors[0]) != (change.after, errors[1]):
            found.append(change)
    return sorted(found, key=lambda change: not change.worse)


def _groups(record: Record) -> dict[tuple[str, str], Group]:
    return {(each.name, group.family): group for each in implementations(record) for group in each.groups}


def accuracy_changes(before: Record, after: Record) -> list[AccuracyChange]:
    """Methods of both records that err otherwise on a workload."""
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
        for line in record.of(Speed)
        if line.ratio is not None
    }
    timed = {(each.name, each.workload, "batch"): (each.ratio, each.ratio_range) for each in timing_totals(record)}
    return {**measured, **{key: (ratio, spread) for key, (ratio, spread) in timed.items() if ratio is not None}}


def _accuracies(record: Record) -> dict[tuple[str, str], Accuracy]:
    return {(line.method, line.workload): line for line in record.of(Accuracy)}


def in_one_alone(before: Record, after: Record) -> Iterator[str]:
    """Sentences about the implementations and methods, and the families of shared ones, that one record lacks."""
    old, new = _groups(before), _groups(after)
    measured = [{line.method for line in record.of(Accuracy)} for record in (before, after)]
    for mine, others, which in ((old, new, "the other record"), (new, old, "this record")):
        names, other_names = {name for name, _ in mine}, {name for name, _ in others}
        alone = [*(name for name, _ in mine if name not in other_names)]
        alone += sorted(measured[mine is new] - measured[mine is old])
        families = {family for name, family in {*mine} - {*others} if name in names & other_names}
        for noun, found in (("methods", list(dict.fromkeys(alone))), ("families", sorted(families))):
            if found:
                yield f"{noun} in {which} alone: {listed(found)}"


def conditions(before: Record, after: Record) -> Iterator[str]:
    """Sentences about what else is not the same, so that nobody takes it for a change of the methods."""
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
    """Every key of either with its two values, None where it is not."""
    return [(key, (before.get(key), after.get(key))) for key in dict.fromkeys([*before, *after])]


def _shared(before: Mapping[Key, Any], after: Mapping[Key, Any]) -> list[tuple[Key, tuple[Any, Any]]]:
    return [(key, (before[key], after[key])) for key in before if key in after]
