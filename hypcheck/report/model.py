"""The totals of a record: each oracle, each implementation, each measured method with its errors, times and memory.

Every report starts here, so that all reports count in the same way.
"""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from msgspec import UNSET

from hypcheck.record import Record
from hypcheck.record.lines import (
    FindingLine,
    GroupLine,
    NotStartedLine,
    OracleLine,
    TimingLine,
    UnavailableLine,
    WrongAnswer,
)
from hypcheck.record.lines import ImplementationLine as Tested
from hypcheck.record.measurements import (
    AccuracyLine,
    MemoryLine,
    MethodLine,
    NoiseLine,
    Octave,
    PlacesLine,
    SpeedLine,
    StabilityLine,
    WorkloadLine,
)
from hypcheck.runs.judge import Status

EXACT_ORACLE = "exact"
"""The oracle that the others are compared with; it can fail only by a certificate that the check refuses."""

REFUSED = "certificate refused"
"""The stage of an answer whose certificate is refused: undecided and disagreeing in the record, a disagreement here."""

SubjectKey = tuple[str, "str | None"]
"""A name and a SPEC: two implementations may have the same name."""

PASSAGE = "passage"
"""The question about the way between two positions."""

REFERENCE = "plain numpy formula"
"""The contender whose time every other is divided by."""


@dataclass(frozen=True, slots=True)
class OracleTotal:
    """The answers of one oracle about all families: asked = agreed + undecided + disagreements.

    stages: its answers by the part of it that gave them.
    seconds: its time, over all processes.
    unavailable: why it could not be asked; None if it was.
    """

    name: str
    asked: int
    agreed: int
    undecided: int
    disagreements: int
    stages: dict[str, int]
    seconds: float
    unavailable: str | None = None


@dataclass(frozen=True, slots=True)
class ImplementationTotal:
    """An implementation that was judged, and the group lines about it, one for each family."""

    name: str
    spec: str
    title: str
    question: str
    precision: str
    exact: bool
    groups: tuple[GroupLine, ...]

    @property
    def gated(self) -> bool:
        """Whether it is under test, so that its wrong answers fail the run."""
        return self.groups[0].tested

    @property
    def asked(self) -> int:
        """The cases that it was asked, without skipped ones."""
        return sum(group.asked for group in self.groups)

    @property
    def statuses(self) -> dict[str, int]:
        """How its cases ended, skipped ones included, in the order of judge.Status."""
        return in_order(sum((Counter(group.counts) for group in self.groups), Counter()))

    @property
    def mistakes(self) -> dict[str, int]:
        """Its wrong and tolerated answers by the kind of mistake."""
        total: Counter[str] = sum((Counter(group.mistakes) for group in self.groups), Counter())
        return dict(sorted(total.items()))

    @property
    def worst(self) -> WrongAnswer | None:
        """The recorded case with the greatest backward error; the first of equals."""
        return worst_case([case for group in self.groups for case in group.worst])


@dataclass(frozen=True, slots=True)
class UnderTest:
    """A gated implementation as a whole: its name in reports, and the implementation line about it.

    `groups` are the lines about its families; none if it could not be started.
    """

    name: str
    line: Tested | NotStartedLine
    groups: tuple[GroupLine, ...]


@dataclass(frozen=True, slots=True)
class TimingTotal:
    """Nanoseconds a row: the median of the rounds, the least and the greatest.

    `ratio` is the median over the rounds of its time by the reference's in the same round, `ratio_range` the least and
    the greatest; None without a reference.
    """

    name: str
    title: str
    workload: str
    rows: int
    median_ns: float
    least_ns: float
    greatest_ns: float
    ratio: float | None
    ratio_range: tuple[float, float] | None


def in_order(counts: Counter[str]) -> dict[str, int]:
    """Counts by status in the order of judge.Status; statuses of later versions last."""
    order = [status.value for status in Status]
    names = sorted(counts, key=lambda name: (order.index(name) if name in order else len(order), name))
    return {name: counts[name] for name in names if counts[name]}


def oracle_totals(record: Record) -> list[OracleTotal]:
    """A total for each oracle: those that were asked, then those that could not be asked."""
    by_name: dict[str, list[OracleLine]] = {}
    for line in record.of(OracleLine):
        by_name.setdefault(line.oracle, []).append(line)
    names = sorted(by_name, key=lambda name: (name != EXACT_ORACLE, -sum(line.asked for line in by_name[name])))
    asked = [_oracle_total(name, by_name[name]) for name in names]
    missing = [OracleTotal(line.oracle, 0, 0, 0, 0, {}, 0.0, str(line.reason)) for line in record.of(UnavailableLine)]
    return asked + missing


def _oracle_total(name: str, lines: list[OracleLine]) -> OracleTotal:
    stages: Counter[str] = sum((Counter(line.stages) for line in lines), Counter())
    asked, disagreements = sum(line.asked for line in lines), sum(line.disagreeing for line in lines)
    undecided = sum(line.undecided for line in lines) - stages[REFUSED]
    agreed = asked - undecided - disagreements
    seconds = sum(line.seconds for line in lines)
    return OracleTotal(name, asked, agreed, undecided, disagreements, dict(sorted(stages.items())), seconds)


def unlisted(finding: FindingLine) -> bool:
    """Whether a formula errs within its stated regimes, and this is no known finding."""
    return bool(finding.inside) and finding.reason is None


def explanation(finding: FindingLine) -> str:
    """Why a formula errs, as far as it is known."""
    if finding.reason is not None:
        return str(finding.reason)
    cause = f"cause: {finding.cause}"
    return f"not a known finding; {cause}" if unlisted(finding) else f"it claims nothing here; {cause}"


def implementations(record: Record) -> list[ImplementationTotal]:
    """Every implementation in the order of the record, exact ones first."""
    names = names_in(record)
    by_subject: dict[SubjectKey, list[GroupLine]] = {}
    for line in record.of(GroupLine):
        by_subject.setdefault(subject_of(line), []).append(line)
    found = [_implementation(names[subject], lines) for subject, lines in by_subject.items()]
    return sorted(found, key=lambda each: not each.exact)


def under_test(record: Record) -> list[UnderTest]:
    """Every gated implementation in the order of the record, those that could not be started included."""
    names, groups = names_in(record), record.of(GroupLine)
    return [
        UnderTest(
            names[subject_of(line)], line, tuple(group for group in groups if subject_of(group) == subject_of(line))
        )
        for line in _tested(record)
    ]


def _tested(record: Record) -> list[Tested | NotStartedLine]:
    return [line for line in record.lines if isinstance(line, (Tested, NotStartedLine))]


def subject_of(line: GroupLine | Tested | NotStartedLine) -> SubjectKey:
    """The implementation that a line is about: its declared name, and its spec if it has one."""
    name = line.method if isinstance(line, GroupLine) else line.name
    return name, line.spec or None


def names_in(record: Record) -> dict[SubjectKey, str]:
    """The name of each implementation in reports: the declared one, with the spec if others have the same name."""
    subjects = dict.fromkeys(map(subject_of, [*record.of(GroupLine), *_tested(record)]))
    alike = Counter(name for name, _ in subjects)
    return {(name, spec): name if alike[name] == 1 else f"{name} ({spec})" for name, spec in subjects}


def _implementation(name: str, lines: list[GroupLine]) -> ImplementationTotal:
    first = lines[0]
    return ImplementationTotal(
        name=name,
        spec=first.spec or f"builtin:{name}",  # a line without a spec is about a built-in method
        title=first.title,
        question=first.question,
        precision=first.precision,
        exact=first.exact,
        groups=tuple(lines),
    )


def worst_case(cases: list[WrongAnswer]) -> WrongAnswer | None:
    """The case with the greatest backward error; the first of equals, None if there is none."""
    return max(cases, key=lambda case: float(case.backward_error_u), default=None)


def worst_error_u(case: WrongAnswer | None) -> float:
    """The backward error of worst_case in units u; 0 if no answer was wrong."""
    return 0.0 if case is None else float(case.backward_error_u)


def timing_totals(record: Record) -> list[TimingTotal]:
    """Every contender in the order of the record."""
    lines = record.of(TimingLine)
    references = {line.workload: line.samples_ns for line in lines if line.name == REFERENCE}
    return [_timing_total(line, references.get(line.workload)) for line in lines]


def _timing_total(line: TimingLine, reference: list[float] | None) -> TimingTotal:
    samples: list[float] = line.samples_ns
    pairs: Any = zip(samples, reference or (), strict=False)
    ratios = [sample / other for sample, other in pairs if other > 0]
    return TimingTotal(
        name=line.name,
        title=line.title,
        workload=line.workload,
        rows=line.rows,
        median_ns=line.median_ns,
        least_ns=min(samples),
        greatest_ns=max(samples),
        ratio=statistics.median(ratios) if ratios else None,
        ratio_range=(min(ratios), max(ratios)) if ratios else None,
    )


def drawn_way(each: ImplementationTotal) -> WrongAnswer | None:
    """The worst answer about a way of an upright spheroid, which can be drawn in the half plane; None without any."""
    if each.question != PASSAGE or not each.gated:
        return None
    return worst_case([case for group in each.groups for case in group.worst if case.axis is UNSET])


BATCH, SINGLE, BUILD = "batch", "single", "build"

PRINCIPAL = "near-contact"
"""The workload that has cases at every distance."""

LEAST_NS = 0.01
"""The time that a benchmark records if a call took no longer than an empty one: the true time is not known."""

NEAREST = 2.0**-75
"""The value of `reliable_above` that a benchmark records for a method that is wrong only at exact tangencies."""

TIERS = ("C", "numpy", "python", "FCL", "foreign")
"""The languages of methods, the fastest first; only methods of one tier compare as algorithms."""


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredMethod:
    """A method and its lines: errors by workload, times by workload and mode, memory."""

    name: str
    line: MethodLine
    accuracy: Mapping[str, AccuracyLine]
    speed: Mapping[tuple[str, str], SpeedLine]
    memory: MemoryLine | None

    @property
    def tier(self) -> str:
        """The language that it is written in."""
        return str(self.line.tier)

    @property
    def exact(self) -> bool:
        """Whether it promises never to be wrong."""
        return bool(self.line.exact)

    @property
    def asked(self) -> int:
        """The number of judged answers, on all workloads."""
        return sum(line.asked for line in self.accuracy.values())

    @property
    def wrong(self) -> int:
        """The number of wrong answers, on all workloads."""
        return sum(line.wrong for line in self.accuracy.values())

    @property
    def never_wrong(self) -> bool:
        """Whether it promises to be exact, and was right about every row."""
        return self.exact and self.asked > 0 and self.reliable_above == 0

    @property
    def reliable_above(self) -> float:
        """The distance above which at most 1 answer in 1000 is wrong or missing, on every workload."""
        return max((float(line.reliable_above) for line in self.accuracy.values()), default=math.inf)

    def ratio(self, workload: str, mode: str = BATCH) -> float | None:
        """Its time divided by that of the reference method; None if it was not timed or not compared."""
        line = self.speed.get((workload, mode))
        return None if line is None or line.ratio is None or lost(line) else float(line.ratio)


def lost(line: SpeedLine) -> bool:
    """Whether a speed line has no time, because a call took no longer than an empty one."""
    return float(line.median_ns) <= LEAST_NS


def measured_methods(record: Record) -> list[MeasuredMethod]:
    """Every method of a benchmark in the order of the record."""
    accuracy: dict[str, dict[str, AccuracyLine]] = {}
    speed: dict[str, dict[tuple[str, str], SpeedLine]] = {}
    for line in record.of(AccuracyLine):
        accuracy.setdefault(line.method, {})[line.workload] = line
    for time in record.of(SpeedLine):
        speed.setdefault(time.method, {})[time.workload, time.mode] = time
    memory = {line.method: line for line in record.of(MemoryLine)}
    return [
        MeasuredMethod(name, line, accuracy.get(name, {}), speed.get(name, {}), memory.get(name))
        for line in record.of(MethodLine)
        for name in (line.method,)
    ]


@dataclass(frozen=True, slots=True)
class WayTotal:
    """A method for ways: its answers on all workloads together, and the time of a way on the principal one.

    typical: half of the wrong answers need about this change of the spheroid's size at least; 0 without any.
    worst: the greatest such change, of those that were measured exactly.
    """

    name: str
    tier: str
    exact: bool
    asked: int
    missed: int
    false: int
    abstained: int
    typical: float
    worst: float
    time_ns: float | None
    ratio: float | None
    ratio_ci95: tuple[float, float] | None

    def share(self, part: int) -> float:
        """The share that these are of all ways asked."""
        return part / self.asked


def way_totals(record: Record) -> list[WayTotal]:
    """Every method that answers about ways and was judged, in the order of the record."""
    where = principal(record), BATCH
    return [
        _way_total(each, each.speed.get(where))
        for each in measured_methods(record)
        if each.line.question == PASSAGE and each.asked
    ]


def _way_total(each: MeasuredMethod, speed: SpeedLine | None) -> WayTotal:
    lines = each.accuracy.values()
    timed = speed if speed is not None and not lost(speed) else None
    return WayTotal(
        name=each.name,
        tier=each.tier,
        exact=each.exact,
        asked=each.asked,
        missed=sum(line.false_clear for line in lines),
        false=sum(line.false_contact for line in lines),
        abstained=sum(line.abstained for line in lines),
        typical=_median_size([octave for line in lines for octave in line.octaves]),
        worst=max((float(case.flip_distance) for line in lines for case in line.worst), default=0.0),
        time_ns=None if timed is None else float(timed.median_ns),
        ratio=None if timed is None else timed.ratio,
        ratio_ci95=None if timed is None else timed.ratio_ci95,
    )


def _median_size(octaves: Sequence[Octave]) -> float:
    """The lower end of the octave in which the median of the wrong answers lies; 0 without any, or of tangencies."""
    wrong = sorted((float(exponent), number) for exponent, _, number in octaves if number)
    left = sum(number for _, number in wrong) / 2
    for exponent, number in wrong:
        left -= number
        if left <= 0:
            return float(2.0**exponent)
    return 0.0


def workloads(record: Record) -> dict[str, WorkloadLine]:
    """The workloads by name, in the order of the record, also those that are measured but not described."""
    found = {line.workload: line for line in record.of(WorkloadLine)}
    judged, timed = record.of(AccuracyLine), record.of(SpeedLine)
    for name in [*(line.workload for line in judged), *(line.workload for line in timed)]:
        found.setdefault(name, WorkloadLine(workload=name, title=name, text="", rows=0, seed=0))
    return found


def principal(record: Record) -> str:
    """The workload that has cases at every distance from contact; the first one if it was not measured."""
    known = workloads(record)
    return PRINCIPAL if PRINCIPAL in known else next(iter(known), "")


def reference(record: Record) -> str | None:
    """The name of the reference method, if the record has one."""
    named = record.header.options.get("reference")
    return None if named is None else str(named)


def noise_floor(record: Record, workload: str, mode: str) -> float | None:
    """The relative difference below which two times of this run count as equal."""
    floors = [line.floor for line in record.of(NoiseLine) if (line.workload, line.mode) == (workload, mode)]
    return float(floors[0]) if floors else None


def stability_title(line: StabilityLine) -> str:
    """The name of a method with the precision that it was measured in."""
    return line.method if line.method.endswith(line.precision) else f"{line.method}, {line.precision}"


def is_unstable(line: StabilityLine) -> bool:
    """Whether a method was wrong at any of the sizes of a stability line."""
    return any(wrong for *_, wrong in line.bins)


def is_wrong_somewhere(line: PlacesLine) -> bool:
    """Whether a method was wrong at any grid point of a places line, in which "." is right."""
    return any(set(text) - {"."} for text in line.wrong)
