"""summary.json: the totals of a run for programs; its schema is schemas/summary-1.5.0.json beside this file."""

from __future__ import annotations

import json
from typing import Annotated, Any

from msgspec import UNSET, Meta, UnsetType
from msgspec.structs import replace

from hypcheck.record import Record, fields
from hypcheck.record.lines import (
    CauseLine,
    DomainPart,
    DriftLine,
    FindingLine,
    GroupLine,
    ProofLine,
    Retest,
    SettingsPart,
    WrongAnswer,
)
from hypcheck.report import model
from hypcheck.report.measured import MeasuredMethod, measured_methods
from hypcheck.report.model import implementations, unlisted, worst_case
from hypcheck.report.verdict import failures, verdict

SCHEMA = "1.5.0"

Fields = dict[str, Any]

Distance = Annotated[
    fields.Unsigned,
    Meta(description="The distance to the other answer above which at most 1 answer in 1000 is wrong; 0: none is."),
]
Units = Annotated[fields.Unsigned, Meta(description="A backward error in units u of the declared precision.")]
CaseId = Annotated[str | None, Meta(description="Its case id; null: no answer was wrong.")]
Exact = Annotated[bool, Meta(description="It promises never to be wrong; the run fails where it is.")]
TimeMistakes = Annotated[int, Meta(ge=0, description="Of times of first contact, since 1.3.0; present if not 0.")]
Fresh = Annotated[int, Meta(ge=0, description="Cases asked that nobody knew before the run; since 1.5.0.")]
NotAsked = Annotated[fields.Counts, Meta(description="Cases that were skipped, by reason; since 1.5.0.")]
Nanoseconds = Annotated[float, Meta(ge=0, description="Nanoseconds a row.")]
"""Types with the descriptions that the schema gives."""


class OracleSummary(fields.LinePart, frozen=True, kw_only=True):
    """asked = agreed + undecided + disagreements."""

    asked: fields.Count
    agreed: fields.Count
    undecided: fields.Count
    disagreements: fields.Count
    seconds: Annotated[float, Meta(ge=0, description="Summed over the processes.")]
    stages: fields.Counts
    unavailable: Annotated[str, Meta(description="Why it was not asked; present only then.")] | UnsetType = UNSET


class Equations(fields.LinePart, frozen=True, kw_only=True):
    """The numbers of the paper's displayed formulas, by the verdict of the derivation."""

    holds: list[str]
    misprint: list[str]
    false: list[str]


class Proofs(fields.LinePart, frozen=True, kw_only=True):
    """How many quantities of formulas must be proved, and how many are."""

    asked: fields.Count
    hold: fields.Count
    fail: fields.Count


class Findings(fields.LinePart, frozen=True, kw_only=True):
    """Errors of formulas in exact arithmetic, one for each formula, family, side of its regimes and cause."""

    inside_stated_regimes: fields.Count
    outside_stated_regimes: fields.Count
    unlisted: fields.Count
    drift: list[str]


class Mistakes(fields.LinePart, frozen=True, kw_only=True, rename="kebab"):
    """Wrong and tolerated answers by the kind of mistake."""

    false_clear: fields.Count
    false_contact: fields.Count
    wrong_side: fields.Count
    late: TimeMistakes | UnsetType = UNSET
    early: TimeMistakes | UnsetType = UNSET


class FamilySummary(fields.LinePart, frozen=True, kw_only=True):
    """An implementation's cases of one family."""

    asked: fields.Count
    right: fields.Count
    tolerated: fields.Count
    wrong: fields.Count
    excused: fields.Count
    mistakes: Mistakes
    worst_backward_error_u: Units
    worst_case: CaseId
    fresh: Fresh | UnsetType = UNSET
    not_asked: NotAsked | UnsetType = UNSET


class Claims(fields.LinePart, frozen=True, kw_only=True):
    """What an implementation under test declares, or what it was judged as."""

    question: fields.Question
    precision: fields.Precision
    domain: DomainPart


class CauseSummary(fields.LinePart, frozen=True, kw_only=True):
    """A cause of wrong answers of an implementation under test; `cause` is "unexplained" where none is known."""

    cause: str
    sentence: str
    remedy: str
    cases: fields.Count
    families: fields.Counts
    worst_case: str


class ImplementationSummary(fields.LinePart, frozen=True, kw_only=True):
    """An implementation that was judged; one under test also has its declaration, restarts and retests."""

    name: str
    spec: str
    precision: fields.Precision
    question: fields.Question
    exact: Exact
    asked: fields.Count
    right: fields.Count
    tolerated: fields.Count
    wrong: fields.Count
    excused: fields.Count
    mistakes: Mistakes
    worst_backward_error_u: Units
    worst_case: CaseId
    families: dict[str, FamilySummary]
    statuses: fields.Counts
    declared: Claims | UnsetType = UNSET
    judged_as: Claims | UnsetType = UNSET
    restarts: fields.Count | UnsetType = UNSET
    asked_again: Retest | UnsetType = UNSET
    causes: Annotated[list[CauseSummary], Meta(description="Since 1.4.0; present if any.")] | UnsetType = UNSET
    fresh: Fresh | UnsetType = UNSET
    not_asked: NotAsked | UnsetType = UNSET
    families_not_asked: (
        Annotated[dict[str, list[str]], Meta(description="Families of which no row was asked, by reason; since 1.5.0.")]
        | UnsetType
    ) = UNSET


class TimingSummary(fields.LinePart, frozen=True, kw_only=True):
    """The time of a contender; `ratio`: to the plain formula's time in the same rounds; null: that was not timed."""

    name: str
    workload: str
    rows: fields.Count
    median_ns: Nanoseconds
    ratio: fields.Amount | None


class WorkloadSummary(fields.LinePart, frozen=True, kw_only=True):
    """A method's answers on a workload of a benchmark."""

    asked: fields.Count
    wrong: fields.Count
    false_clear: fields.Count
    false_contact: fields.Count
    wrong_side: fields.Count
    abstained: fields.Count
    reliable_above: Distance


class TimeSummary(fields.LinePart, frozen=True, kw_only=True):
    """A method's time on a workload of a benchmark, and its ratio to the run's reference."""

    workload: str
    mode: str
    rows: fields.Count
    median_ns: float
    ratio: float | None
    ratio_ci95: fields.Interval | None


class MethodSummary(fields.LinePart, frozen=True, kw_only=True):
    """A method of a benchmark, over all workloads and for each."""

    name: str
    tier: str
    kind: str
    precision: str
    question: str
    exact: bool
    asked: fields.Count
    wrong: fields.Count
    reliable_above: Distance
    workloads: dict[str, WorkloadSummary]
    times: list[TimeSummary]


class FailureSummary(fields.LinePart, frozen=True, kw_only=True):
    """A failure of the run, and how many of its kind it stands for."""

    subject: Annotated[str, fields.one_of("proof", "oracle", "implementation", "findings", "measurement")]
    name: str
    group: str
    kind: str
    message: str
    case: str | None
    count: Annotated[int, Meta(ge=1)]


class Summary(fields.LinePart, frozen=True, kw_only=True):
    """Totals of a run, under keys that do not change. Explained in docs/record.md.

    Later versions 1.x may add keys and change none; ignore what you do not know.
    """

    hypcheck: Annotated[str, Meta(description="The version that wrote the record.")]
    schema: Annotated[str, Meta(pattern=r"^1\.[0-9]+\.[0-9]+$")]
    exit_code: Annotated[int | None, Meta(description="null: the run was interrupted before its end.")]
    passed: Annotated[bool, Meta(description="The run is complete and nothing failed.")]
    truncated: Annotated[bool, Meta(description="The record has no footer.")]
    verdict: Annotated[str, Meta(description="One sentence for people.")]
    started: Annotated[str, Meta(description="ISO 8601 with its offset.")]
    seconds: Annotated[fields.Amount | None, Meta(description="Wall-clock time of the whole run.")]
    settings: Annotated[
        SettingsPart | None,
        Meta(description="Since 1.2.0; null where there was no settings file, and nothing weakens the gate."),
    ] = None
    oracles: dict[str, OracleSummary]
    equations: Equations
    proofs: Proofs
    findings: Findings
    implementations: list[ImplementationSummary]
    timings: list[TimingSummary]
    methods: Annotated[list[MethodSummary], Meta(description="Of a benchmark, since 1.1.0.")]
    failures: list[FailureSummary]


def render(record: Record) -> bytes:
    """Render the summary as JSON in UTF-8; a lone surrogate, which UTF-8 cannot hold, becomes a question mark."""
    text = json.dumps(fields.as_json(summary(record)), ensure_ascii=False, allow_nan=False, indent=2)
    return (text + "\n").encode("utf-8", "replace")


def summary(record: Record) -> Summary:
    """Make the summary; its keys and their order are the same for every run."""
    ended, footer, causes = verdict(record), record.footer, record.of(CauseLine)
    return Summary(
        hypcheck=record.header.hypcheck,
        schema=SCHEMA,
        exit_code=None if footer is None else footer.exit_code,
        passed=ended.passed,
        truncated=footer is None,
        verdict=ended.sentence,
        started=record.header.started,
        seconds=None if footer is None else footer.seconds,
        settings=None if record.header.settings is UNSET else record.header.settings,
        oracles={total.name: _oracle(total) for total in model.oracle_totals(record)},
        equations=Equations(**model.equations(record)),
        proofs=_proofs(record.of(ProofLine)),
        findings=_findings(record),
        implementations=[
            _implementation(judged, [line for line in causes if line.spec == judged.spec])
            for judged in implementations(record)
        ],
        timings=[fields.decoded(total, TimingSummary) for total in model.timing_totals(record)],
        methods=[_method(method) for method in measured_methods(record)],
        failures=[fields.decoded(failure, FailureSummary) for failure in failures(record)],
    )


def _oracle(total: model.OracleTotal) -> OracleSummary:
    """Convert the total of an oracle to its part of the summary."""
    return OracleSummary(
        asked=total.asked,
        agreed=total.agreed,
        undecided=total.undecided,
        disagreements=total.disagreements,
        seconds=round(total.seconds, 3),
        stages=total.stages,
        unavailable=UNSET if total.unavailable is None else total.unavailable,
    )


def _proofs(lines: list[ProofLine]) -> Proofs:
    """Count the proofs that hold and those that fail."""
    holding = sum(line.holds for line in lines)
    return Proofs(asked=len(lines), hold=holding, fail=len(lines) - holding)


def _findings(record: Record) -> Findings:
    """Count the findings inside and outside the stated regimes; add the differences from the known ones."""
    lines = record.of(FindingLine)
    return Findings(
        inside_stated_regimes=sum(line.inside for line in lines),
        outside_stated_regimes=sum(not line.inside for line in lines),
        unlisted=sum(map(unlisted, lines)),
        drift=[line.sentence for line in record.of(DriftLine)],
    )


def _implementation(total: model.ImplementationTotal, causes: list[CauseLine]) -> ImplementationSummary:
    """Convert the total of an implementation; `causes` are the causes of its wrong answers."""
    counts = ImplementationSummary(
        name=total.name,
        spec=total.spec,
        precision=total.precision,
        question=total.question,
        exact=total.exact,
        **_counts(total.asked, total.statuses, total.mistakes, total.worst),
        families={group.family: _family(group) for group in total.groups},
        statuses=total.statuses,
    )
    whole = total.whole
    if whole is None:
        return counts
    return replace(
        counts,
        declared=fields.decoded(whole.declared, Claims),
        judged_as=fields.decoded(whole.used, Claims),
        restarts=whole.restarts,
        asked_again=whole.retest,
        causes=[_cause(line) for line in causes] or UNSET,
        fresh=UNSET if total.fresh is None else total.fresh,
        not_asked=total.not_asked,
        families_not_asked=UNSET
        if whole.not_asked is UNSET
        else {why: [*some] for why, some in whole.not_asked.items()},
    )


def _cause(line: CauseLine) -> CauseSummary:
    """Convert the line of a cause."""
    return CauseSummary(
        cause=line.cause,
        sentence=line.sentence,
        remedy=line.remedy,
        cases=line.cases,
        families=line.families,
        worst_case=line.worst.case,
    )


def _family(group: GroupLine) -> FamilySummary:
    """Convert the line of a family."""
    counts = _counts(group.asked, group.counts, group.mistakes, worst_case(group.worst))
    return FamilySummary(**counts, fresh=group.fresh, not_asked=group.not_asked)


def _counts(cases: int, statuses: dict[str, int], mistakes: dict[str, int], worst: WrongAnswer | None) -> Fields:
    """Return the fields that an implementation and a family share: cases, statuses, mistakes and the worst case."""
    return {
        "asked": cases,
        **{status: statuses.get(status, 0) for status in ("right", "tolerated", "wrong", "excused")},
        "mistakes": _mistakes(mistakes),
        "worst_backward_error_u": model.worst_error_u(worst),
        "worst_case": None if worst is None else worst.case,
    }


def _mistakes(counted: dict[str, int]) -> Mistakes:
    """Convert counts by kind of mistake; wrong times are left out if there are none."""
    counts = {name: counted.get(name.replace("_", "-"), 0) for name in Mistakes.__struct_fields__}
    return Mistakes(**{name: number for name, number in counts.items() if number or name not in ("late", "early")})


def _method(method: MeasuredMethod) -> MethodSummary:
    """Convert a method of a benchmark."""
    line = method.line
    return MethodSummary(
        name=method.name,
        tier=line.tier,
        kind=line.kind,
        precision=line.precision,
        question=line.question,
        exact=line.exact,
        asked=method.asked,
        wrong=method.wrong,
        reliable_above=fields.Unsigned(method.reliable_above),
        workloads={name: fields.decoded(measurement, WorkloadSummary) for name, measurement in method.accuracy.items()},
        times=[fields.decoded(measurement, TimeSummary) for measurement in method.speed.values()],
    )
