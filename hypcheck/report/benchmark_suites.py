"""A benchmark as test suites: its answers, its times, the baseline it was held to, the targets of the kernels.

Only what fails the run is a failure. What a method that promises nothing gets wrong is a passed case that says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hypcheck.record import Record
from hypcheck.record.measurements import Comparison, Forest, Kernel, Refused, Scene, Speed, Unmeasured
from hypcheck.report.benchmark import INCONCLUSIVE, SLOWER, SUBJECT
from hypcheck.report.failure import Failure
from hypcheck.report.measured import measured
from hypcheck.report.suite import Case, Suite, Trouble, details
from hypcheck.report.text import counted, figure


def benchmark_suites(record: Record, failed: Sequence[Failure]) -> Iterator[Suite]:
    """The suites of a benchmark, all of them empty where there was none."""
    found = [failure for failure in failed if failure.subject == SUBJECT]
    yield Suite("bench.answers", tuple(_answers(record, found)))
    yield Suite("bench.times", tuple(_times(record, found)))
    yield Suite("bench.baseline", tuple(_comparison(line, found) for line in record.of(Comparison)))
    yield Suite("bench.scenes", tuple(_scenes(record, found)))
    yield Suite("bench.kernels", tuple(_kernel(line, found) for line in record.of(Kernel)))


def _answers(record: Record, failed: Sequence[Failure]) -> Iterator[Case]:
    for each in measured(record):
        for workload, line in each.accuracy.items():
            reliable = figure(float(line.reliable_above))
            said = f"{line.wrong:,} of {counted(line.asked, 'answer')} wrong; reliable above {reliable}"
            yield Case(f"{each.name} on {workload}", _trouble(failed, "wrong", each.name, workload), (said,))


def _times(record: Record, failed: Sequence[Failure]) -> Iterator[Case]:
    for line in record.of(Speed):
        ratio = "" if line.ratio is None else f"{figure(line.ratio)} times the reference's time, "
        said = f"{ratio}{figure(line.median_ns)} ns"
        yield Case(_name(line), output=(said,))
    for unmeasured in record.of(Unmeasured):
        yield Case(_name(unmeasured), Trouble("skipped", "unmeasured", unmeasured.reason))
    for refused in record.of(Refused):
        yield Case(_name(refused), _trouble(failed, "refused", refused.method, _group(refused)))


def _scenes(record: Record, failed: Sequence[Failure]) -> Iterator[Case]:
    for line in record.of(Scene):
        ratios = (figure(times.by_printed or 0.0) for times in (line.batch, line.single))
        said = f"{' in a batch and '.join(ratios)} one by one times Table 2's time, {line.wrong:,} wrong"
        yield Case(line.scene, _trouble(failed, "wrong", line.scene, "scene"), (said,))
    for step in record.of(Forest):
        group = f"{step.trees:,} trees"
        said = f"{figure(step.step_ns)} ns a step, {step.wrong:,} wrong"
        yield Case(f"{step.method}, {group}", _trouble(failed, "wrong", step.method, group), (said,))


def _comparison(line: Comparison, failed: Sequence[Failure]) -> Case:
    said = f"{figure(line.change)} times its former ratio, allowed {figure(line.allowed)}: {line.verdict}"
    trouble = _trouble(failed, line.verdict, line.method, _group(line))
    if trouble is None and line.verdict == "inconclusive":
        trouble = Trouble("skipped", "inconclusive", said)
    return Case(_name(line), trouble, (said,))


def _kernel(line: Kernel, failed: Sequence[Failure]) -> Case:
    said = f"wanted {figure(line.wanted)}, measured {figure(line.measured)}: {'met' if line.met else 'not met'}"
    missed = (_trouble(failed, kind, line.name, "target") for kind in (SLOWER, INCONCLUSIVE))
    return Case(f"{line.name}: {line.target}", next(filter(None, missed), None), (said, str(line.says)))


def _name(line: Speed | Unmeasured | Refused | Comparison) -> str:
    return f"{line.method} on {_group(line)}"


def _group(line: Speed | Unmeasured | Refused | Comparison) -> str:
    return f"{line.workload}, {line.mode}"


def _trouble(failed: Sequence[Failure], kind: str, name: str, group: str) -> Trouble | None:
    mine = [each for each in failed if (each.kind, each.name, each.group) == (kind, name, group)]
    return Trouble("failure", kind, mine[0].message, tuple(details(mine))) if mine else None
