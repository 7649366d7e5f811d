"""The facts of each line of a verification's record: its name, measurements, failures and sentences, stated once.

A format renders these facts; it does not interpret lines. The facts of a benchmark's lines are in benchmark_facts.py,
which also has the table of all types of lines.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

from msgspec import UNSET

from hypcheck.messages import counted
from hypcheck.record import Record, RecordLine, lines
from hypcheck.record.fields import layout_of, numbers_of
from hypcheck.report import messages
from hypcheck.report.measured import MeasuredMethod, measured_methods
from hypcheck.report.model import SubjectKey, explanation, in_order, names_in, subject_of, worst_case
from hypcheck.runs.judge import UNANSWERED, Status, in_words, truth_in_words

Measurement = tuple[Any, ...]
"""A measurement: method, workload, detail, quantity and value, then the two ends of its interval if it has one."""

HARMLESS = ("right", "skipped")
"""Statuses of cases that do not break the promise of an exact method."""

Line = TypeVar("Line", bound=RecordLine)


@dataclass(frozen=True, slots=True)
class Failure:
    """A failure of a run.

    subject: what failed: "proof", "oracle", "implementation", "findings", "measurement", or "run" (how it ended). name:
    the name of the subject that failed. group: the family, the quantity or the workload. kind: one word for the
    failure. message: one sentence about it, without a full stop. case: the id of the first case, if there is one.
    place: its place in the record. replay: the command that shows it. row: the numbers of the case. count: the number
    of failures of its kind that it represents.
    """

    subject: str
    name: str
    group: str
    kind: str
    message: str
    case: str | None = None
    place: str | None = None
    replay: str | None = None
    row: tuple[float, ...] = ()
    count: int = 1


@dataclass(frozen=True, slots=True)
class NotJudged:
    """Why a line has no result: one word, and a sentence without a full stop."""

    kind: str
    message: str


@dataclass(frozen=True)
class RecordContext:
    """A record, with the data of its other lines that the facts of one line need."""

    record: Record

    @cached_property
    def replays(self) -> messages.Replays:
        """The commands that show its cases."""
        return messages.Replays.of(self.record)

    @cached_property
    def names(self) -> dict[SubjectKey, str]:
        """The names of its implementations in reports."""
        return names_in(self.record)

    @cached_property
    def methods(self) -> dict[str, MeasuredMethod]:
        """The methods of a benchmark by name."""
        return {method.name: method for method in measured_methods(self.record)}


class LineFacts(Generic[Line]):
    """The facts of one line; a subclass overrides the methods for facts that its type of line has."""

    def __init__(self, line: Line, context: RecordContext) -> None:
        self.line, self.context = line, context

    @property
    def name(self) -> str:
        """The name of the line's subject; it does not depend on the result."""
        return ""

    def measurements(self) -> Iterator[Measurement]:
        """Yield the numbers of the line."""
        yield from ()

    def failures(self) -> Iterator[Failure]:
        """Yield the failures of the line, worst first."""
        yield from ()

    def headline(self) -> str:
        """Return one sentence for all failures of the line together; "" if their messages are enough."""
        return ""

    @classmethod
    def clause(cls, together: Sequence[Line]) -> str:  # noqa: ARG003 - a type that has a clause reads them
        """Return the clause about all lines of this type in the verdict of a passing run; "" if there is none."""
        return ""

    def not_judged(self) -> NotJudged | None:
        """Return why the line has no result; None if it has one."""
        return None

    def sentences(self) -> Iterator[str]:
        """Yield the content of the line, in sentences without a full stop."""
        yield from ()

    def seconds(self) -> float | None:
        """Return the time that was spent on the line's subject; None if it was not measured."""
        return None

    def fields(
        self, method: str, workload: str, detail: str, *names: str, part: object = None
    ) -> Iterator[Measurement]:
        """Yield a measurement for each of these fields (`names`) of the line, or of `part` of it."""
        for name in names:
            yield method, workload, detail, name, getattr(self.line if part is None else part, name)


class ProofFacts(LineFacts[lines.ProofLine]):
    """A quantity of a formula; if it does not hold, the run fails."""

    @property
    def name(self) -> str:
        return f"{self.line.formula}: {self.line.quantity}"

    def failures(self) -> Iterator[Failure]:
        if not self.line.holds:
            message = f"{self.line.formula}: not proved: {self.line.statement}"
            yield Failure("proof", self.line.formula, self.line.quantity, "unproved", message)

    def headline(self) -> str:
        return f"not proved: {self.line.statement}"

    @classmethod
    def clause(cls, together: Sequence[lines.ProofLine]) -> str:
        return f"{counted(len(together), 'proof')} {'holds' if len(together) == 1 else 'hold'}"

    def sentences(self) -> Iterator[str]:
        if self.line.holds:
            yield self.line.statement


class EquationFacts(LineFacts[lines.EquationLine]):
    """A displayed formula of the paper; if it does not hold, this is a finding and not a failure."""

    @property
    def name(self) -> str:
        return f"({self.line.number})"

    def sentences(self) -> Iterator[str]:
        yield f"{self.line.verdict}: {self.line.finding}"
        yield f"printed: {self.line.statement}"
        if not self.line.holds:
            yield f"derived: {self.line.correction}"


class OracleFacts(LineFacts[lines.OracleLine]):
    """An oracle on a family: each case on which it and the exact decision disagree fails the run."""

    @property
    def name(self) -> str:
        return self.line.family

    def measurements(self) -> Iterator[Measurement]:
        return self.fields(self.line.oracle, self.line.family, "", "asked", "undecided", "disagreeing", "seconds")

    def failures(self) -> Iterator[Failure]:
        line = self.line
        yield from map(self._disagreement, line.disagreements)
        rest = line.disagreeing - len(line.disagreements)
        if rest > 0:
            message = f"{line.oracle} on {line.family}: {counted(rest, 'further case')}, not kept in the record"
            yield Failure("oracle", line.oracle, line.family, "disagreement", message, count=rest)

    def _disagreement(self, case: lines.DisagreementPart) -> Failure:
        """Make the failure about one case on which the oracle and the exact decision disagree."""
        message = f"{case.oracle}: {case.opinion}; exact decision: {case.exact}"
        row = messages.from_hex(numbers_of(case))
        where = self.line.oracle, self.line.family
        return Failure(
            "oracle",
            *where,
            "disagreement",
            message,
            case.case,
            replay=messages.classify_command(row, layout_of(case)),
            row=row,
        )

    def headline(self) -> str:
        first = next(self.failures())
        counts = f"{counted(self.line.disagreeing, 'disagreement')} in {counted(self.line.asked, 'case')}"
        return f"{counts}; first: {first.message}"

    def not_judged(self) -> NotJudged | None:
        undecided = self.line.undecided == self.line.asked
        return NotJudged("undecided", "no case could be decided") if undecided else None

    def sentences(self) -> Iterator[str]:
        stages = ", ".join(f"{stage} {number:,}" for stage, number in self.line.stages.items())
        yield f"{counted(self.line.asked, 'case')}, {self.line.undecided:,} undecided: {stages}"

    def seconds(self) -> float | None:
        return self.line.seconds


class FindingFacts(LineFacts[lines.FindingLine]):
    """A formula that errs in exact arithmetic; this is a finding and not a failure."""

    @property
    def name(self) -> str:
        return f"{self.line.formula} on {self.line.family}"

    def measurements(self) -> Iterator[Measurement]:
        return self.fields(self.line.formula, self.line.family, self.line.cause, "asked", "wrong")

    def sentences(self) -> Iterator[str]:
        line, where = self.line, "inside" if self.line.inside else "outside"
        yield f"wrong in exact arithmetic, {where} its stated regimes: {line.wrong:,} of {line.asked:,}"
        yield explanation(line)
        yield f"first case: {line.first_case}"
        yield f"replay: {messages.classify_command(messages.from_hex(line.first_row))}"


class DriftFacts(LineFacts[lines.DriftLine]):
    """A difference from the known findings, which fails the run."""

    @property
    def name(self) -> str:
        return "known findings"

    def failures(self) -> Iterator[Failure]:
        yield Failure("findings", self.name, "drift", "drift", self.line.sentence)


class GroupFacts(LineFacts[lines.GroupLine]):
    """A method on a family: the statuses of its cases, the worst cases, and the cases that fail the run."""

    @property
    def name(self) -> str:
        return self.line.family

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.method, self.line.family)
        if line.fresh is not UNSET:
            yield *where, line.spec or "", "fresh", line.fresh
        for reason, number in (line.not_asked or {}).items():
            yield *where, line.spec or "", f"not asked: {reason}", number
        for counts in (line.counts, line.mistakes):
            for name, number in counts.items():
                yield *where, line.spec or "", name, number
        for exponent, counts in line.octaves.items():
            for status, number in counts.items():
                yield *where, f"octave {exponent}", status, number

    def failures(self) -> Iterator[Failure]:
        for status, number in in_order(Counter(self.line.counts)).items():
            if status in (self.line.failing or ()) or self._breaks_promise(status):
                yield self._broken_promise(status, number)

    def _breaks_promise(self, status: str) -> bool:
        """Decide whether a status fails the method: any but HARMLESS if it is exact, else one without an answer."""
        return status not in HARMLESS if self.line.exact else status in UNANSWERED

    def _broken_promise(self, status: str, number: int) -> Failure:
        """Make the failure about all cases of one status; it names the first such case that the record keeps."""
        line, name, replays = self.line, self.context.names[subject_of(self.line)], self.context.replays
        promise = " promises to be exact, but" if line.exact else ":"
        message = f"{name}{promise} {number:,} of {counted(line.asked, 'case')} ended as {status}"
        first = next((case for case in line.worst if case.status == status), None)
        fault = next((case for case in line.faults or () if case.status == status), None)
        if fault is not None:
            message += f"; {fault.case}: {fault.reason}"
        elif first is not None:
            truth, answer = truth_in_words(first.truth, line.question), in_words(first.answer, line.question)
            message += f"; {first.case} is {truth}; answered: {answer}"
            message += f" ({first.mistake}, {messages.error_text(first)})"
        case = first if fault is None else fault
        if case is None:
            return Failure("implementation", name, line.family, status, message)
        place, replay, row = replays.place(case), replays.command(line, case), messages.from_hex(numbers_of(case))
        return Failure("implementation", name, line.family, status, message, case.case, place, replay, row)

    def not_judged(self) -> NotJudged | None:
        counts = in_order(Counter(self.line.counts))
        if set(counts) != {"skipped"}:
            return None
        outside = "they lie outside the method's domain or its format's range"
        why = messages.rows_not_asked(self.line.not_asked or {}) or outside
        return NotJudged("skipped", f"all {counted(sum(counts.values()), 'case')} were not asked: {why}")

    def sentences(self) -> Iterator[str]:
        line, replays = self.line, self.context.replays
        counts = in_order(Counter(line.counts))
        if self.not_judged():
            return
        for status, number in counts.items():
            why = messages.rows_not_asked(line.not_asked or {}) if status == "skipped" else ""
            yield f"{status}: {number:,} of {counted(sum(counts.values()), 'case')}{why and f': {why}'}"
            worst = worst_case([case for case in line.worst if case.status == status])
            if worst is not None:
                numbered = f" ({replays.place(worst)})" if line.tested else ""
                yield f"worst backward error: {messages.figure(worst.backward_error_u)} u, case {worst.case}{numbered}"
                yield f"replay: {replays.command(line, worst)}"
        if line.fresh:
            yield f"fresh rows: {line.fresh:,}"


class CauseFacts(LineFacts[lines.CauseLine]):
    """A cause of wrong answers of an implementation under test."""

    @property
    def name(self) -> str:
        return self.line.cause

    @property
    def command(self) -> str:
        """The command that explains the cause; "" if no known cause gives the answers."""
        return "" if self.line.cause == lines.UNEXPLAINED else f"hypcheck explain {self.line.cause}"

    @property
    def replay(self) -> str:
        """The command that shows the worst answer."""
        return self.context.replays.of_case(self.line.worst.case, self.line.spec)

    @property
    def share(self) -> str:
        """The share of the implementation's wrong answers that have this cause: "12 %", "under 1 %"."""
        line = self.line
        alike = [other for other in self.context.record.of(lines.CauseLine) if other.spec == line.spec]
        total = sum(other.cases for other in alike if other.method == line.method)
        percent = 100 * line.cases / total if total else 0.0
        return "under 1 %" if percent < 1 else f"{min(percent, 99 if line.cases < total else 100):.0f} %"

    def families(self, most: int = 3) -> str:
        """Return the families of the wrong answers, `most` by name: "ring 140, osculation 15 and 2 more families"."""
        ranked = sorted(self.line.families.items(), key=lambda counts: (-counts[1], counts[0]))
        shown = [f"{family} {number:,}" for family, number in ranked[:most]]
        rest = len(ranked) - most
        return messages.listed([*shown, *([counted(rest, "more family", "more families")] if rest > 0 else [])])

    def headline(self) -> str:
        return f"{self.line.cases:,} wrong: {self.line.sentence}"

    def sentences(self) -> Iterator[str]:
        yield f"fix: {self.line.remedy}"


def cause_facts(record: Record) -> list[CauseFacts]:
    """Return the facts of all causes of wrong answers, in the order of the record."""
    context = RecordContext(record)
    return [CauseFacts(line, context) for line in record.of(lines.CauseLine)]


class ImplementationFacts(LineFacts[lines.ImplementationLine]):
    """An implementation under test as a whole: its declarations, and the behaviour that fails the run."""

    @property
    def name(self) -> str:
        return self.context.names[subject_of(self.line)]

    def failures(self) -> Iterator[Failure]:
        if self.line.broke_protocol_throughout:
            message = f"{self.name} broke the protocol throughout"
            yield Failure("implementation", self.name, "start", Status.PROTOCOL.value, message + self._first_reply())
        for trouble in self.line.troubles:
            yield Failure("implementation", self.name, "all families", "behaviour", trouble)

    def _first_reply(self) -> str:
        """Return why the first reply that the record keeps breaks the protocol; "" if it keeps none."""
        subject = subject_of(self.line)
        groups = [group for group in self.context.record.of(lines.GroupLine) if subject_of(group) == subject]
        faults = [fault for group in groups for fault in group.faults or () if fault.status == Status.PROTOCOL.value]
        return f"; {faults[0].case}: {faults[0].reason}" if faults else ""

    def sentences(self) -> Iterator[str]:
        return messages.implementation_claims(self.line)


class NotStartedFacts(LineFacts[lines.NotStartedLine]):
    """An implementation that could not be started, which fails the run."""

    @property
    def name(self) -> str:
        return self.context.names[subject_of(self.line)]

    def failures(self) -> Iterator[Failure]:
        yield Failure("implementation", self.name, "start", "not-started", self.line.trouble)


class MapFacts(LineFacts[lines.MapLine]):
    """A method's errors over the half plane of a scene."""

    def measurements(self) -> Iterator[Measurement]:
        return self.fields(self.line.method, self.line.name, "", "points", "wrong")


class TimingFacts(LineFacts[lines.TimingLine]):
    """A contender on a workload."""

    def measurements(self) -> Iterator[Measurement]:
        line = self.line
        yield line.name, line.workload, "batch", "median_ns", line.median_ns
        for number, sample in enumerate(line.samples_ns):
            yield line.name, line.workload, f"round {number}", "ns", sample
