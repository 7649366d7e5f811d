"""The facts of each line of a benchmark: its name, measurements, failures and sentences; and a table of all types."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar

from msgspec.structs import asdict

from hypcheck.geometry.pair import Position
from hypcheck.messages import counted
from hypcheck.record import Record, RecordLine, lines, measurements
from hypcheck.report import facts
from hypcheck.report.facts import Failure, LineFacts, Measurement, NotJudged, RecordContext
from hypcheck.report.messages import classify_command, figure, from_hex, listed, pace, with_interval
from hypcheck.runs.judge import in_words

MEASUREMENT = "measurement"

SLOWER, INCONCLUSIVE = "slower", "inconclusive"
"""Kinds of failures of speed: certain, and too noisy to tell."""

Timed = TypeVar(
    "Timed", measurements.SpeedLine, measurements.UnmeasuredLine, measurements.RefusedLine, measurements.ComparisonLine
)


class TimedFacts(LineFacts[Timed]):
    """The facts of a line about a method on a workload in a mode."""

    @property
    def name(self) -> str:
        return f"{self.line.method} on {self.where}"

    @property
    def where(self) -> str:
        """The workload and the mode."""
        return f"{self.line.workload}, {self.line.mode}"


class AccuracyFacts(LineFacts[measurements.AccuracyLine]):
    """A method's answers on a workload; a wrong answer of a method that promises to be exact fails the run."""

    @property
    def name(self) -> str:
        return f"{self.line.method} on {self.line.workload}"

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.method, self.line.workload)
        names = ("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained", "reliable_above")
        yield from self.fields(*where, "", *names)
        for exponent, cases, wrong in line.octaves:
            for quantity, number in (("asked", cases), ("wrong", wrong)):
                yield *where, f"octave {exponent}", quantity, number

    def failures(self) -> Iterator[Failure]:
        line, method = self.line, self.context.methods.get(self.line.method)
        if method is None or not method.exact or not (line.wrong or line.abstained):
            return
        counts = ((line.wrong, "wrong"), (line.abstained, "not told"))
        wrong = listed([f"{number:,} {word}" for number, word in counts if number])
        message = f"{line.method} promises to be exact, but of {counted(line.asked, 'answer')} {wrong}"
        case = next(iter(line.worst), None)
        if case is None:
            yield Failure(MEASUREMENT, line.method, line.workload, "wrong", message)
            return
        answer = in_words(case.answer, method.line.question)
        message += f"; {case.case} is {Position(case.truth).label}; answered: {answer}"
        row = from_hex((*case.row, *(case.axis or ())))
        where, replay = (line.method, line.workload), classify_command(row)
        yield Failure(MEASUREMENT, *where, "wrong", message, case.case, replay=replay, row=row)

    def sentences(self) -> Iterator[str]:
        reliable = figure(self.line.reliable_above)
        yield f"{self.line.wrong:,} of {counted(self.line.asked, 'answer')} wrong; reliable above {reliable}"


class SpeedFacts(TimedFacts[measurements.SpeedLine]):
    """A method's time on a workload."""

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.method, self.line.workload)
        yield *where, line.mode, "ns", line.median_ns, *line.ci95_ns
        yield *where, line.mode, "ratio", line.ratio, *(line.ratio_ci95 or ())
        for process, rounds in enumerate(line.samples_ns):
            for number, sample in enumerate(rounds):
                yield *where, f"{line.mode}, process {process}, round {number}", "ns", sample

    def sentences(self) -> Iterator[str]:
        ratio = "" if self.line.ratio is None else f"{pace(self.line.ratio, 'the reference')}, "
        yield f"{ratio}{figure(self.line.median_ns)} ns"


class UnmeasuredFacts(TimedFacts[measurements.UnmeasuredLine]):
    """A method that could not be timed, which does not fail the run."""

    def not_judged(self) -> NotJudged | None:
        return NotJudged("unmeasured", self.line.reason)


class RefusedFacts(TimedFacts[measurements.RefusedLine]):
    """A method that is not timed because it was wrong, which fails the run."""

    def failures(self) -> Iterator[Failure]:
        message = f"{self.line.method} is not timed: {self.line.reason}"
        yield Failure(MEASUREMENT, self.line.method, self.where, "refused", message)


class ComparisonFacts(TimedFacts[measurements.ComparisonLine]):
    """A ratio compared with the baseline's; a gating method that is slower, or too noisy to tell, fails the run."""

    @classmethod
    def clause(cls, together: Sequence[measurements.ComparisonLine]) -> str:
        held = [line for line in together if line.gates]
        slower = sum(line.verdict == SLOWER for line in held)
        compared = f"{counted(len(held), 'ratio')} held to the baseline's, {slower:,} of them slower than allowed"
        return compared if held else ""

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.method, self.line.workload, self.line.mode)
        yield *where, "change", line.change, *(line.ci95 or ())
        yield from self.fields(*where, "before", "after", "allowed")

    def failures(self) -> Iterator[Failure]:
        line = self.line
        if line.verdict in (SLOWER, INCONCLUSIVE) and line.gates:
            words = "is slower than the baseline allows" if line.verdict == SLOWER else "was too noisy to compare"
            change, allowed = with_interval(line.change, line.ci95), figure(line.allowed)
            message = f"{line.method} {words} ({self.where}): {change} times its former ratio, allowed {allowed}"
            yield Failure(MEASUREMENT, line.method, self.where, line.verdict, message)

    def not_judged(self) -> NotJudged | None:
        noisy = self.line.verdict == INCONCLUSIVE and not self.line.gates
        return NotJudged(INCONCLUSIVE, next(self.sentences())) if noisy else None

    def sentences(self) -> Iterator[str]:
        line = self.line
        yield f"{figure(line.change)} times its former ratio, allowed {figure(line.allowed)}: {line.verdict}"


class SceneFacts(LineFacts[measurements.SceneLine]):
    """The kernel of a scene, timed relative to Table 2; a wrong answer fails the run."""

    @classmethod
    def clause(cls, together: Sequence[measurements.SceneLine]) -> str:
        return f"{counted(len(together), 'scene')} timed against Table 2"

    @property
    def name(self) -> str:
        return self.line.scene

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, ("kernel", self.line.scene)
        for name, share in asdict(line.shares).items():
            yield *where, name, "share", share
        yield from self.fields(*where, "", "rows", "wrong")
        for mode, times in (("batch", line.batch), ("single", line.single)):
            yield from self.fields(*where, mode, "kernel_ns", "printed_ns", "certified_ns", part=times)
            yield *where, mode, "by_printed", times.by_printed, *(times.by_printed_ci95 or ())
            yield *where, mode, "by_certified", times.by_certified, *(times.by_certified_ci95 or ())

    def failures(self) -> Iterator[Failure]:
        line = self.line
        if line.wrong:
            message = f"the kernel of the scene answers {line.wrong:,} of {counted(line.rows, 'row')} wrongly"
            yield Failure(MEASUREMENT, line.scene, "scene", "wrong", message)

    def sentences(self) -> Iterator[str]:
        for mode, times in (("in a batch", self.line.batch), ("one by one", self.line.single)):
            if times.by_printed:
                yield f"{mode}: {pace(times.by_printed, 'Table 2', times.by_printed_ci95)}"
        yield f"{self.line.wrong:,} wrong"


class ForestFacts(LineFacts[measurements.ForestLine]):
    """A method for a walker among trees; a wrong answer of one that promises to be exact fails the run."""

    @classmethod
    def clause(cls, together: Sequence[measurements.ForestLine]) -> str:
        trees = {line.trees for line in together}
        return f"a walker's step timed in {counted(len(trees), 'forest')} of up to {max(trees):,} trees"

    @property
    def name(self) -> str:
        return f"{self.line.method}, {self.trees}"

    @property
    def trees(self) -> str:
        """The size of the forest."""
        return f"{self.line.trees:,} trees"

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.method, "", f"{self.line.trees} trees")
        yield *where, "step_ns", line.step_ns, *(line.ci95_ns or ())
        yield *where, "ratio", line.ratio, *(line.ratio_ci95 or ())
        yield from self.fields(*where, "build_s", "asked", "wrong")

    def failures(self) -> Iterator[Failure]:
        line = self.line
        if line.exact and line.wrong:
            wrong = f"of {counted(line.asked, 'step')} {line.wrong:,} wrong"
            message = f"{line.method} promises to be exact, but {wrong}"
            yield Failure(MEASUREMENT, line.method, self.trees, "wrong", message)

    def sentences(self) -> Iterator[str]:
        yield f"{figure(self.line.step_ns)} ns a step, {self.line.wrong:,} wrong"


class KernelFacts(LineFacts[measurements.KernelLine]):
    """A target of a kernel's speed, which fails the run if it is missed, certainly or within the noise."""

    @classmethod
    def clause(cls, together: Sequence[measurements.KernelLine]) -> str:
        met = sum(line.met for line in together)
        return f"{met:,} of {counted(len(together), 'target')} of the kernels met"

    @property
    def name(self) -> str:
        return f"{self.line.name}: {self.line.target}"

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.name, "", self.line.target)
        yield *where, "wanted", line.wanted
        yield *where, "measured", line.measured, *(line.ci95 or ())

    def failures(self) -> Iterator[Failure]:
        line = self.line
        if not line.met:
            low, high = line.ci95 or (line.measured, line.measured)
            kind = INCONCLUSIVE if low <= line.wanted <= high else SLOWER
            measured = with_interval(line.measured, line.ci95)
            message = f"{line.name} misses its target, {line.target}: {measured}, wanted {figure(line.wanted)}"
            yield Failure(MEASUREMENT, line.name, "target", kind, message)

    def sentences(self) -> Iterator[str]:
        line = self.line
        met = "met" if line.met else "not met"
        yield f"wanted {figure(line.wanted)}, measured {figure(line.measured)}: {met}"
        yield line.says


class NoiseFacts(LineFacts[measurements.NoiseLine]):
    """The relative difference between two times of the same method."""

    def measurements(self) -> Iterator[Measurement]:
        line = self.line
        yield "", line.workload, line.mode, "ratio", line.ratio, *(line.ratio_ci95 or ())
        yield "", line.workload, line.mode, "floor", line.floor


class MemoryFacts(LineFacts[measurements.MemoryLine]):
    """The memory of a method."""

    def measurements(self) -> Iterator[Measurement]:
        return self.fields(self.line.method, "", str(self.line.rows), "peak_bytes")


class StabilityFacts(LineFacts[measurements.StabilityLine]):
    """A method's errors over sizes of pairs."""

    def measurements(self) -> Iterator[Measurement]:
        line = self.line
        for across, up, cases, wrong in line.bins:
            for quantity, number in (("asked", cases), ("wrong", wrong)):
                yield line.method, line.precision, f"bin {across} {up}", quantity, number


class PlacesFacts(LineFacts[measurements.PlacesLine]):
    """A method's errors over places of a region."""

    def measurements(self) -> Iterator[Measurement]:
        letters = "".join(self.line.wrong)
        for letter, name in ((".", "right"), ("c", "false_clear"), ("w", "false_contact"), ("s", "wrong_side")):
            yield self.line.method, "", self.line.region, name, letters.count(letter)


class ConvergenceFacts(LineFacts[measurements.ConvergenceLine]):
    """A method's errors and time on meshes with a given number of triangles."""

    def measurements(self) -> Iterator[Measurement]:
        names = ("build_ns", "query_ns", "deviation", "asked", "wrong")
        return self.fields(self.line.method, "", f"{self.line.triangles} triangles", *names)


class BoundingFacts(LineFacts[measurements.BoundingLine]):
    """The errors of a bounding shape that replaces the spheroid."""

    def measurements(self) -> Iterator[Measurement]:
        line, where = self.line, (self.line.shape, self.line.workload)
        yield from self.fields(*where, "", "asked", "false_contact", "false_clear")
        for ratio, *values in line.overlap:
            for name, value in zip(("asked", "false_contact", "excess_clearance"), values, strict=True):
                yield *where, f"d/b {ratio}", name, value

    def sentences(self) -> Iterator[str]:
        line = self.line
        if line.asked:
            share = figure(100 * line.false_contact / line.asked)
            yield f"a bounding {line.shape} in the spheroid's place, {line.workload}: {share} % false contacts"


class CostFacts(LineFacts[measurements.CostLine]):
    """A claim of the paper about cost."""

    def measurements(self) -> Iterator[Measurement]:
        line = self.line
        for compared in line.compared:
            where = compared.name, line.scene, line.claim
            yield *where, "ratio", compared.ratio, *(compared.ratio_ci95 or ())
            yield *where, "ns", compared.median_ns
            for operation, number in (compared.operations or {}).items():
                yield *where, f"operations {operation}", number

    def sentences(self) -> Iterator[str]:
        yield f"claim {self.line.verdict}, {self.line.scene}: {self.line.claim}"


class AbsentFacts(LineFacts[measurements.AbsentLine]):
    """A program or package that is not installed."""

    def sentences(self) -> Iterator[str]:
        yield f"left out: {self.line.reason}"


FACTS: Mapping[type[RecordLine], type[LineFacts[Any]]] = {
    lines.ProofLine: facts.ProofFacts,
    lines.EquationLine: facts.EquationFacts,
    lines.OracleLine: facts.OracleFacts,
    lines.FindingLine: facts.FindingFacts,
    lines.DriftLine: facts.DriftFacts,
    lines.GroupLine: facts.GroupFacts,
    lines.CauseLine: facts.CauseFacts,
    lines.ImplementationLine: facts.ImplementationFacts,
    lines.NotStartedLine: facts.NotStartedFacts,
    lines.MapLine: facts.MapFacts,
    lines.TimingLine: facts.TimingFacts,
    measurements.AccuracyLine: AccuracyFacts,
    measurements.SpeedLine: SpeedFacts,
    measurements.UnmeasuredLine: UnmeasuredFacts,
    measurements.RefusedLine: RefusedFacts,
    measurements.ComparisonLine: ComparisonFacts,
    measurements.SceneLine: SceneFacts,
    measurements.ForestLine: ForestFacts,
    measurements.KernelLine: KernelFacts,
    measurements.NoiseLine: NoiseFacts,
    measurements.MemoryLine: MemoryFacts,
    measurements.StabilityLine: StabilityFacts,
    measurements.PlacesLine: PlacesFacts,
    measurements.ConvergenceLine: ConvergenceFacts,
    measurements.BoundingLine: BoundingFacts,
    measurements.CostLine: CostFacts,
    measurements.AbsentLine: AbsentFacts,
}
"""The facts of each type of line; lines of other types state none that formats share."""


def facts_of(record: Record, *kinds: type[RecordLine]) -> list[LineFacts[Any]]:
    """Return the facts of all lines, or of the lines of these types, in the order of the record."""
    context = RecordContext(record)
    return [
        FACTS[type(line)](line, context)
        for line in record.lines
        if type(line) in FACTS and (not kinds or isinstance(line, kinds))
    ]


def failures_of(record: Record, *kinds: type[RecordLine]) -> list[Failure]:
    """Return the failures of all lines of these types, in the order of the record."""
    return [failure for line_facts in facts_of(record, *kinds) for failure in line_facts.failures()]


def sentences_of(record: Record, *kinds: type[RecordLine]) -> Iterator[str]:
    """Return an iterator over the sentences of all lines of these types."""
    return (sentence for line_facts in facts_of(record, *kinds) for sentence in line_facts.sentences())


def clauses_of(record: Record, *kinds: type[RecordLine]) -> Iterator[str]:
    """Yield a clause of the verdict on a passing run for each of these types of lines that the record has."""
    for kind in kinds:
        together = record.of(kind)
        clause = FACTS[kind].clause(together) if together else ""
        if clause:
            yield clause


def benchmark_failures(record: Record) -> Iterator[Failure]:
    """Yield a benchmark's failures: exact methods that erred, refused methods, wrong kernels, slowness, noise."""
    for line_facts in accuracy_facts(record):
        yield from line_facts.failures()
    for kind in (measurements.RefusedLine, measurements.ForestLine, measurements.SceneLine):
        yield from failures_of(record, kind)
    failures = [
        *_without_baseline(record),
        *failures_of(record, measurements.ComparisonLine),
        *failures_of(record, measurements.KernelLine),
    ]
    yield from sorted(failures, key=lambda failure: failure.kind != SLOWER)


def accuracy_facts(record: Record) -> list[LineFacts[Any]]:
    """Return the facts of all lines about answers, method by method."""
    context = RecordContext(record)
    methods = context.methods.values()
    return [AccuracyFacts(line, context) for method in methods for line in method.accuracy.values()]


def _without_baseline(record: Record) -> Iterator[Failure]:
    """Yield the failure of a run with a baseline in which no speed was compared with it."""
    if record.header.options.get("baseline") and not any(line.gates for line in record.of(measurements.ComparisonLine)):
        message = "nothing was compared with the baseline: no gated time was measured in both runs"
        yield Failure(MEASUREMENT, "baseline", "all workloads", INCONCLUSIVE, message)
