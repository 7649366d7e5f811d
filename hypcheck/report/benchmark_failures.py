"""What a failure of a run is, and the failures of a benchmark: exact methods that err, noise, slowness, targets."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from hypcheck.geometry.pair import Position
from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.measurements import AccuracyLine, ComparisonLine, ForestLine, KernelLine, RefusedLine, SceneLine
from hypcheck.report.measured import MeasuredMethod, measured_methods
from hypcheck.report.messages import classify_command, figure, from_hex, listed, with_interval
from hypcheck.runs.judge import in_words


@dataclass(frozen=True, slots=True)
class Failure:
    """One thing that fails a run.

    subject: "proof", "oracle", "implementation", "findings", "measurement", or "run": how it ended.
    name: the one that failed.
    group: the family, the quantity or the workload.
    kind: one word for what happened.
    message: one sentence about it, without a full stop.
    case: the id of the first case, if there is one.
    place: its place in the record.
    replay: the command that shows it.
    row: the numbers of the case.
    count: how many failures of its kind it stands for.
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


MEASUREMENT = "measurement"

SLOWER, INCONCLUSIVE = "slower", "inconclusive"
"""Kinds of failures of speed: certain, and too noisy to tell."""


def benchmark_failures(record: Record) -> Iterator[Failure]:
    """Exact methods that erred, answers that changed while they were timed, slowness, noise."""
    for each in measured_methods(record):
        if each.exact:
            yield from _broken_exactness(each)
    for line in record.of(RefusedLine):
        group = f"{line.workload}, {line.mode}"
        yield Failure(MEASUREMENT, line.method, group, "refused", f"{line.method} is not timed: {line.reason}")
    yield from _scene_failures(record)
    held = [*_baseline_failures(record), *_target_failures(record)]
    yield from sorted(held, key=lambda each: each.kind != SLOWER)


def _scene_failures(record: Record) -> Iterator[Failure]:
    """Wrong answers of exact methods about a forest, and of a scene's kernel."""
    for line in record.of(ForestLine):
        if line.exact and line.wrong:
            wrong = f"of {counted(line.asked, 'step')} {line.wrong:,} wrong"
            said = f"{line.method} promises to be exact, but {wrong}"
            yield Failure(MEASUREMENT, line.method, f"{line.trees:,} trees", "wrong", said)
    for scene in record.of(SceneLine):
        if scene.wrong:
            said = f"the kernel of the scene answers {scene.wrong:,} of {counted(scene.rows, 'row')} wrongly"
            yield Failure(MEASUREMENT, scene.scene, "scene", "wrong", said)


def _broken_exactness(each: MeasuredMethod) -> Iterator[Failure]:
    for workload, line in each.accuracy.items():
        if line.wrong or line.abstained:
            message = f"{each.name} promises to be exact, but {_wrong_counts(line)}"
            case = next(iter(line.worst), None)
            if case is None:
                yield Failure(MEASUREMENT, each.name, workload, "wrong", message)
                continue
            truth = Position(case.truth).label
            message += f"; {case.case} is {truth}; answered: {in_words(case.answer, each.line.question)}"
            row = from_hex((*case.row, *(case.axis or ())))
            replay = classify_command(row)
            yield Failure(MEASUREMENT, each.name, workload, "wrong", message, case.case, replay=replay, row=row)


def _wrong_counts(line: AccuracyLine) -> str:
    counts = ((line.wrong, "wrong"), (line.abstained, "not told"))
    parts = [f"{number:,} {word}" for number, word in counts if number]
    return f"of {counted(line.asked, 'answer')} {listed(parts)}"


def _baseline_failures(record: Record) -> Iterator[Failure]:
    """Speeds compared with the baseline; a run in which none could be compared has not passed."""
    if record.header.options.get("baseline") and not any(line.gates for line in record.of(ComparisonLine)):
        message = "nothing was compared with the baseline: no gated time was measured in both runs"
        yield Failure(MEASUREMENT, "baseline", "all workloads", INCONCLUSIVE, message)
    for line in record.of(ComparisonLine):
        if line.verdict in (SLOWER, INCONCLUSIVE) and line.gates:
            words = "is slower than the baseline allows" if line.verdict == SLOWER else "was too noisy to compare"
            change = with_interval(line.change, line.ci95)
            where, allowed = f"{line.workload}, {line.mode}", figure(line.allowed)
            message = f"{line.method} {words} ({where}): {change} times its former ratio, allowed {allowed}"
            yield Failure(MEASUREMENT, line.method, where, line.verdict, message)


def _target_failures(record: Record) -> Iterator[Failure]:
    """Kernels that miss their targets, certainly or within the noise."""
    for line in record.of(KernelLine):
        if not line.met:
            low, high = line.ci95 or (line.measured, line.measured)
            kind = INCONCLUSIVE if low <= line.wanted <= high else SLOWER
            measured_ = with_interval(line.measured, line.ci95)
            message = f"{line.name} misses its target, {line.target}: {measured_}, wanted {figure(line.wanted)}"
            yield Failure(MEASUREMENT, line.name, "target", kind, message)
