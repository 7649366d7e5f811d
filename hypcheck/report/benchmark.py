"""What fails a benchmark, and what it shows where nothing does."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.judge import in_words
from hypcheck.pairs import Position
from hypcheck.record import Record
from hypcheck.record.measurements import Accuracy, Comparison, Forest, Kernel, Refused, Scene
from hypcheck.report.failure import Failure
from hypcheck.report.measured import Measured, measured
from hypcheck.report.text import classify_command, counted, figure, from_hex, listed, with_interval

SUBJECT = "measurement"

ALONE = (Kernel, Forest, Scene)
"""Types of lines that a run can have without comparing methods on rows."""

SLOWER, INCONCLUSIVE = "slower", "inconclusive"
"""Kinds of failures of speed: for certain, and as far as the noise lets tell."""


def failures(record: Record) -> Iterator[Failure]:
    """Promises of exactness that were broken, answers that were other ones while they were timed, slowness, noise."""
    for each in measured(record):
        if each.exact:
            yield from _broken(each)
    for line in record.of(Refused):
        group = f"{line.workload}, {line.mode}"
        yield Failure(SUBJECT, line.method, group, "refused", f"{line.method} is not timed: {line.reason}")
    yield from _of_scenes(record)
    held = [*_compared(record), *_targets(record)]
    yield from sorted(held, key=lambda each: each.kind != SLOWER)


def _of_scenes(record: Record) -> Iterator[Failure]:
    """Wrong answers about a forest from what is exact, and about a scene from its kernel."""
    for line in record.of(Forest):
        if line.exact and line.wrong:
            wrong = f"of {counted(line.asked, 'step')} {line.wrong:,} wrong"
            said = f"{line.method} promises to be exact, but {wrong}"
            yield Failure(SUBJECT, line.method, f"{line.trees:,} trees", "wrong", said)
    for scene in record.of(Scene):
        if scene.wrong:
            said = f"the kernel of the scene answers {scene.wrong:,} of {counted(scene.rows, 'row')} wrongly"
            yield Failure(SUBJECT, scene.scene, "scene", "wrong", said)


def _broken(each: Measured) -> Iterator[Failure]:
    for workload, line in each.accuracy.items():
        if line.wrong or line.abstained:
            message = f"{each.name} promises to be exact, but {_of(line)}"
            case = next(iter(line.worst), None)
            if case is None:
                yield Failure(SUBJECT, each.name, workload, "wrong", message)
                continue
            truth = Position(case.truth).label
            message += f"; {case.case} is {truth}; answered: {in_words(case.answer, each.line.question)}"
            replay = classify_command(from_hex(case.row))
            yield Failure(SUBJECT, each.name, workload, "wrong", message, case.case, replay=replay)


def _of(line: Accuracy) -> str:
    counts = ((line.wrong, "wrong"), (line.abstained, "not told"))
    parts = [f"{number:,} {word}" for number, word in counts if number]
    return f"of {counted(line.asked, 'answer')} {listed(parts)}"


def _compared(record: Record) -> Iterator[Failure]:
    """Speeds that were held to an earlier run's; a run of which none could be has not passed."""
    if record.header.options.get("baseline") and not any(line.gates for line in record.of(Comparison)):
        message = "nothing is held to the baseline: no time of what is to be held to it was measured in both runs"
        yield Failure(SUBJECT, "baseline", "all workloads", INCONCLUSIVE, message)
    for line in record.of(Comparison):
        if line.verdict in (SLOWER, INCONCLUSIVE) and line.gates:
            words = "is slower than the baseline allows" if line.verdict == SLOWER else "was too noisy to compare"
            change = with_interval(line.change, line.ci95)
            where, allowed = f"{line.workload}, {line.mode}", figure(line.allowed)
            message = f"{line.method} {words} ({where}): {change} times its former ratio, allowed {allowed}"
            yield Failure(SUBJECT, line.method, where, line.verdict, message)


def _targets(record: Record) -> Iterator[Failure]:
    """Kernels that miss their targets, for certain or as far as the noise lets tell."""
    for line in record.of(Kernel):
        if not line.met:
            low, high = line.ci95 or (line.measured, line.measured)
            kind = INCONCLUSIVE if low <= line.wanted <= high else SLOWER
            measured_ = with_interval(line.measured, line.ci95)
            message = f"{line.name} misses its target, {line.target}: {measured_}, wanted {figure(line.wanted)}"
            yield Failure(SUBJECT, line.name, "target", kind, message)


def clauses(record: Record) -> Iterator[str]:
    """What a benchmark in which nothing failed has shown."""
    yield from _methods(record)
    yield from _alone(record)


def _methods(record: Record) -> Iterator[str]:
    """What was compared on rows."""
    found = [each for each in measured(record) if each.asked or each.speed]
    if not found:
        return
    timed = sum(bool(each.speed) for each in found)
    workloads = {name for each in found for name in each.accuracy} | {name for each in found for name, _ in each.speed}
    yield f"{counted(len(found), 'method')} compared on {counted(len(workloads), 'workload')}, {timed:,} of them timed"
    exact = [f"{each.name} ({each.asked:,})" for each in found if each.exact and each.asked]
    if exact:
        yield f"right on every row: {listed(exact)}"
    held = [line for line in record.of(Comparison) if line.gates]
    if held:
        slower = sum(line.verdict == SLOWER for line in held)
        yield f"{counted(len(held), 'ratio')} held to the baseline's, {slower:,} of them slower than allowed"


def _alone(record: Record) -> Iterator[str]:
    """What was measured without comparing methods on rows."""
    targets = record.of(Kernel)
    if targets:
        met = sum(bool(line.met) for line in targets)
        yield f"{met:,} of {counted(len(targets), 'target')} of the kernels met"
    forests = record.of(Forest)
    if forests:
        trees = {line.trees for line in forests}
        yield f"a walker's step timed in {counted(len(trees), 'forest')} of up to {max(trees):,} trees"
    if record.of(Scene):
        yield f"{counted(len(record.of(Scene)), 'scene')} timed against Table 2"
