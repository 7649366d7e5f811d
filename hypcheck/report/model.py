"""The totals of a verification: each oracle, each implementation, each contender that was timed.

Every report of a verification uses these totals, and every report of a benchmark the totals of measured.py, so that all
reports count in the same way.
"""

from __future__ import annotations

import statistics
from collections import Counter
from dataclasses import dataclass
from typing import Any

from msgspec import UNSET

from hypcheck.record import Record
from hypcheck.record.lines import (
    EquationLine,
    FindingLine,
    GroupLine,
    NotStartedLine,
    OracleLine,
    TimingLine,
    UnavailableLine,
    WrongAnswer,
)
from hypcheck.record.lines import ImplementationLine as Tested
from hypcheck.runs.judge import Status

EXACT_ORACLE = "exact"
"""The oracle that the others are compared with; it can fail only by a certificate that the check refuses."""

REFUSED = "certificate refused"
"""The stage of an answer whose certificate is refused. The record counts it as undecided and as disagreeing.

The totals here count it as a disagreement alone.
"""

SubjectKey = tuple[str, "str | None"]
"""A name and a SPEC: two implementations may have the same name."""

PASSAGE = "passage"
"""The question whether there is contact on a sweep."""

REFERENCE = "plain numpy formula"
"""The contender that is the reference: the time of every other one is divided by its time."""


@dataclass(frozen=True, slots=True)
class OracleTotal:
    """The answers of one oracle about all families; asked = agreed + undecided + disagreements.

    stages: its answers by the part of the oracle that gave them. seconds: its time, over all processes. unavailable:
    the reason why it could not be used; None if it was used.
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
class CasesTotal:
    """The cases of one implementation, by its name in reports: the group lines about its families, and their sums."""

    name: str
    groups: tuple[GroupLine, ...]

    @property
    def asked(self) -> int:
        """The number of tested cases, without skipped ones."""
        return sum(group.asked for group in self.groups)

    @property
    def skipped(self) -> int:
        """The number of skipped cases."""
        return sum(group.skipped for group in self.groups)

    @property
    def judged(self) -> int:
        """The number of tested cases without those that it answered with "cannot say"."""
        return sum(group.judged for group in self.groups)

    @property
    def statuses(self) -> dict[str, int]:
        """The counts of its cases by status, skipped ones included, in the order of judge.Status."""
        return in_order(sum((Counter(group.counts) for group in self.groups), Counter()))

    @property
    def fresh(self) -> int | None:
        """The number of tested cases that were not known before the run; None if the record does not have it."""
        counts = [group.fresh for group in self.groups if group.fresh is not UNSET]
        return sum(counts) if counts else None

    @property
    def not_asked(self) -> dict[str, int]:
        """The number of skipped cases by reason; groups of older records, which have no reasons, are left out."""
        return dict(sum((Counter(group.not_asked or {}) for group in self.groups), Counter()))

    @property
    def mistakes(self) -> dict[str, int]:
        """The number of wrong and tolerated answers by the kind of mistake."""
        total: Counter[str] = sum((Counter(group.mistakes) for group in self.groups), Counter())
        return dict(sorted(total.items()))

    @property
    def answers(self) -> dict[str, dict[str, int]]:
        """The number of rows by the truth, then by the answer; empty in records before 1.10.0."""
        total: dict[str, Counter[str]] = {}
        for group in self.groups:
            for truth, counts in (group.answers or {}).items():
                total.setdefault(truth, Counter()).update(counts)
        return {truth: dict(counts) for truth, counts in total.items()}

    @property
    def worst(self) -> WrongAnswer | None:
        """The recorded case with the greatest backward error; the first of equal ones."""
        return worst_case([case for group in self.groups for case in group.worst])


@dataclass(frozen=True, slots=True)
class ImplementationTotal(CasesTotal):
    """An implementation that was judged. `whole` is the line about it; None if it is a built-in method."""

    spec: str
    title: str
    question: str
    precision: str
    exact: bool
    whole: Tested | None

    @property
    def gated(self) -> bool:
        """Whether it is under test, so that its wrong answers fail the run."""
        return self.groups[0].tested


@dataclass(frozen=True, slots=True)
class UnderTest(CasesTotal):
    """A gated implementation, and the line about it; it has no cases if it could not be started."""

    line: Tested | NotStartedLine

    @property
    def started(self) -> Tested | None:
        """Its line; None if it could not be started."""
        return self.line if isinstance(self.line, Tested) else None

    @property
    def trouble(self) -> str | None:
        """Why it could not be started; None if it was started."""
        return self.line.trouble if isinstance(self.line, NotStartedLine) else None


@dataclass(frozen=True, slots=True)
class TimingTotal:
    """Nanoseconds per row: the median, the least and the greatest of the rounds.

    `ratio` is the median over the rounds of its time divided by the reference's time in the same round; `ratio_range`
    is the least and the greatest; None without a reference.
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
    """Return counts by status in the order of judge.Status; statuses of later versions come last."""
    order = [status.value for status in Status]
    names = sorted(counts, key=lambda name: (order.index(name) if name in order else len(order), name))
    return {name: counts[name] for name in names if counts[name]}


def oracle_totals(record: Record) -> list[OracleTotal]:
    """Return a total for each oracle: first the used oracles, then the unavailable ones."""
    by_name: dict[str, list[OracleLine]] = {}
    for line in record.of(OracleLine):
        by_name.setdefault(line.oracle, []).append(line)
    names = sorted(by_name, key=lambda name: (name != EXACT_ORACLE, -sum(line.asked for line in by_name[name])))
    totals = [_oracle_total(name, by_name[name]) for name in names]
    missing = [OracleTotal(line.oracle, 0, 0, 0, 0, {}, 0.0, line.reason) for line in record.of(UnavailableLine)]
    return totals + missing


def _oracle_total(name: str, lines: list[OracleLine]) -> OracleTotal:
    """Add up the lines of one oracle. An answer whose certificate is refused counts as a disagreement alone."""
    stages: Counter[str] = sum((Counter(line.stages) for line in lines), Counter())
    cases, disagreements = sum(line.asked for line in lines), sum(line.disagreeing for line in lines)
    undecided = sum(line.undecided for line in lines) - stages[REFUSED]
    agreed = cases - undecided - disagreements
    seconds = sum(line.seconds for line in lines)
    return OracleTotal(name, cases, agreed, undecided, disagreements, dict(sorted(stages.items())), seconds)


def equations(record: Record) -> dict[str, list[str]]:
    """Return the numbers of the paper's displayed formulas, by the verdict of the derivation."""
    numbers: dict[str, list[str]] = {"holds": [], "misprint": [], "false": []}
    for line in record.of(EquationLine):
        numbers[line.verdict].append(line.number)
    return numbers


def unlisted(finding: FindingLine) -> bool:
    """Decide whether a formula errs within its stated regimes, and the finding is not a known one."""
    return finding.inside and finding.reason is None


def explanation(finding: FindingLine) -> str:
    """Return the known reason why a formula errs; else its cause, and whether the formula claims to be right here."""
    if finding.reason is not None:
        return finding.reason
    cause = f"cause: {finding.cause}"
    return f"not a known finding; {cause}" if unlisted(finding) else f"it claims nothing here; {cause}"


def implementations(record: Record) -> list[ImplementationTotal]:
    """Return every implementation in the order of the record, exact ones first."""
    names, wholes = names_in(record), {subject_of(line): line for line in record.of(Tested)}
    by_subject: dict[SubjectKey, list[GroupLine]] = {}
    for line in record.of(GroupLine):
        by_subject.setdefault(subject_of(line), []).append(line)
    totals = [_implementation(names[subject], lines, wholes.get(subject)) for subject, lines in by_subject.items()]
    return sorted(totals, key=lambda total: not total.exact)


def under_test(record: Record) -> list[UnderTest]:
    """Return every gated implementation in the order of the record, with those that could not be started."""
    names, groups = names_in(record), record.of(GroupLine)
    return [
        UnderTest(
            names[subject_of(line)], tuple(group for group in groups if subject_of(group) == subject_of(line)), line
        )
        for line in _tested(record)
    ]


def _tested(record: Record) -> list[Tested | NotStartedLine]:
    """Return the lines about gated implementations, started or not."""
    return [line for line in record.lines if isinstance(line, (Tested, NotStartedLine))]


def subject_of(line: GroupLine | Tested | NotStartedLine) -> SubjectKey:
    """Return the implementation of a line: its declared name, and its spec if it has one."""
    name = line.method if isinstance(line, GroupLine) else line.name
    return name, line.spec or None


def names_in(record: Record) -> dict[SubjectKey, str]:
    """Return the name of each implementation in reports: the declared name, with the spec if others have that name."""
    subjects = dict.fromkeys(map(subject_of, [*record.of(GroupLine), *_tested(record)]))
    alike = Counter(name for name, _ in subjects)
    return {(name, spec): name if alike[name] == 1 else f"{name} ({spec})" for name, spec in subjects}


def _implementation(name: str, lines: list[GroupLine], whole: Tested | None) -> ImplementationTotal:
    """Collect the group lines of an implementation; `whole` is the line about it, if it is under test."""
    first = lines[0]
    return ImplementationTotal(
        name=name,
        spec=first.spec or f"builtin:{name}",  # a line without a spec is about a built-in method
        title=first.title,
        question=first.question,
        precision=first.precision,
        exact=first.exact,
        groups=tuple(lines),
        whole=whole,
    )


def worst_case(cases: list[WrongAnswer]) -> WrongAnswer | None:
    """Return the case with the greatest backward error, the first of equal ones; None if there is no case."""
    return max(cases, key=lambda case: case.backward_error_u, default=None)


def worst_error_u(case: WrongAnswer | None) -> float:
    """Return the backward error of a worst case in units u; 0 if there is no case, since no answer was wrong."""
    return 0.0 if case is None else case.backward_error_u


def worst_u(group: GroupLine) -> float:
    """Return the greatest backward error of a family in units u; 0 if no answer was wrong."""
    return worst_error_u(worst_case(group.worst))


def timing_totals(record: Record) -> list[TimingTotal]:
    """Return the times of every contender in the order of the record."""
    lines = record.of(TimingLine)
    references = {line.workload: line.samples_ns for line in lines if line.name == REFERENCE}
    return [_timing_total(line, references.get(line.workload)) for line in lines]


def _timing_total(line: TimingLine, reference: list[float] | None) -> TimingTotal:
    """Sum up the times of a contender; `reference` are the reference's times in the same rounds, if it was timed."""
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


def drawn_sweep(implementation: ImplementationTotal) -> WrongAnswer | None:
    """Return the worst wrong answer about a sweep of an upright spheroid, which a picture can show; None if none."""
    if implementation.question != PASSAGE or not implementation.gated:
        return None
    return worst_case([case for group in implementation.groups for case in group.worst if case.axis is UNSET])
