"""Times of all methods: fresh processes measure them, and the measurements become lines of the record.

A process checks the answers of every method, then times all methods in rounds, workload by workload. The lines have
medians, ratios to the reference and the noise floor.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from statistics import median

import numpy as np
from msgspec import UNSET

from hypcheck.bench.accuracy import MethodAnswers, answers_print, chosen_workloads, timed_rows
from hypcheck.bench.claims import COST_OF, FIRST_AGAIN, CostClaim, cost_claims, cost_line
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.loaded import EmptyCall, LoadedMethod, PreparedWork
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import Workload
from hypcheck.processes import Advance, fresh, perform
from hypcheck.record.measurements import CostLine, NoiseLine, RefusedLine, SpeedLine, UnmeasuredLine
from hypcheck.runs.timing import LEAST_NS, Estimate, Samples, TimingEntry, estimate, measure, ratios

MODES = ("batch", "single", "build")
"""The modes of timing a method: many rows by one call, rows one by one, and the building before."""

REFERENCE_AGAIN = "the reference again"
"""The name of the reference as it is measured a second time; its difference from the first time is noise."""

MODE_WORKLOADS: Mapping[str, tuple[str, ...]] = {
    "single": ("uniform", "near-contact", "tower"),
    "build": ("uniform", "one-axis", "region", "tower"),
}
"""The workloads of a mode, if not all: single rows have no neighbours, and a mesh belongs to the scene."""

BUILDS = 2
"""In how many rounds meshes are built: a large mesh takes almost a second."""

NOT_ANSWERED = "not answered"
"""Replaces the hash of answers if the method failed when it was judged, which is recorded already."""

EMPTY_CALL = "an empty call"

MeasurementKey = tuple[str, str, str]
"""A method, a workload and a mode."""


@dataclass(frozen=True)
class MeasuringSession:
    """The work of one process.

    `number` counts the processes. `expected` has the hash of the answers of each method, workload and mode; a method
    with other answers is refused. `loops` has the numbers of loops and of repetitions that the first process found to
    be long enough; all others use them, and the first process gets none.
    """

    plan: BenchPlan
    number: int
    expected: Mapping[MeasurementKey, str]
    loops: Mapping[MeasurementKey, tuple[int, int]]


@dataclass(frozen=True)
class Measurement:
    """The samples of one process for one method, workload and mode; the cost of an empty call is already subtracted.

    `empty_ns` is the cost of an empty call. The difference may be negative, if noise made the empty call longer.
    `timed_by` names the clock. `calls_ns` are the samples of the empty call, in nanoseconds for each row of the method.
    """

    key: MeasurementKey
    samples: Samples
    empty_ns: float
    timed_by: str
    calls_ns: tuple[float, ...] = ()


@dataclass(frozen=True)
class _Together:
    """Work that is measured together, for a workload and a mode: by name, with the empty calls that are subtracted.

    `sums` are the sums of the answers, if they are already known.
    """

    where: tuple[str, str]
    ready: dict[str, PreparedWork]
    empties: dict[str, EmptyCall] = field(default_factory=dict)
    sums: dict[str, int] = field(default_factory=dict)


def run_session(session: MeasuringSession) -> list[Measurement]:
    """Return all measurements, in the order of workloads and modes."""
    by_name = contenders(session.plan)
    methods_loaded = {name: contender.load() for name, contender in by_name.items() if not contender.accuracy_only}
    measured = []
    try:
        for workload in chosen_workloads(session.plan):
            for mode in _modes(workload):
                here, refused = _methods(session, by_name, methods_loaded, workload, mode)
                measured += [*refused, *_measured(session, here)]
        for claim in cost_claims(session.plan):
            measured += _measured(session, _compared(session, claim))
    finally:
        for loaded in methods_loaded.values():
            loaded.close()
    return measured


def _compared(session: MeasuringSession, claim: CostClaim) -> _Together:
    """Return the alternatives of a claim about cost, with the first alternative twice."""
    ready = claim.compared(session.plan)
    again = {FIRST_AGAIN: next(iter(ready.values()))}
    return _Together((claim.where, "batch"), {**ready, **again})


def _modes(workload: Workload) -> Sequence[str]:
    """Return the modes of a workload, without those that repeat another result."""
    return tuple(
        mode for mode in MODES if workload.timed and workload.name in MODE_WORKLOADS.get(mode, (workload.name,))
    )


def _methods(
    session: MeasuringSession,
    by_name: Mapping[str, Contender],
    methods_loaded: Mapping[str, LoadedMethod],
    workload: Workload,
    mode: str,
) -> tuple[_Together, list[Measurement]]:
    """Return the methods to measure, and the methods that are refused because their answers changed."""
    here, refused = _Together((workload.name, mode), {}), []
    for name, loaded in methods_loaded.items():
        rows = timed_rows(session.plan, by_name[name], workload)
        if mode == "single":
            rows = rows[: by_name[name].singles]
        key = (name, *here.where)
        expected_print = session.expected.get(key)
        ready = getattr(loaded, mode)(rows) if len(rows) and expected_print != NOT_ANSWERED else None
        if ready is None:
            continue
        answers = ready.answers()
        if expected_print is not None and answers_print(answers) != expected_print:
            reason = "its answers, when it was about to be timed, were not those that were judged"
            refused.append(Measurement(key, Samples(name, ready.rows, 0, 0, refused=reason), 0.0, ready.timed_by))
            continue
        here.ready[name], here.sums[name] = ready, int(answers.sum(dtype=np.int64))
        if (empty := loaded.empty(rows, mode)) is not None:
            here.empties[name] = empty
    return here, refused


def _measured(session: MeasuringSession, here: _Together) -> Iterator[Measurement]:
    """Measure work together; yield samples from which the cost of an empty call is subtracted."""
    if not here.ready:
        return
    reference = session.plan.reference
    todo = {**here.ready, **({REFERENCE_AGAIN: here.ready[reference]} if reference in here.ready else {})}
    calls: dict[str, PreparedWork] = {}
    for call in here.empties.values():
        calls.setdefault(_called(call), call.ready)
    samples = _rounds(session, here, {**todo, **calls})
    for name, ready in todo.items():
        timed, own = samples[name], here.empties.get(reference if name == REFERENCE_AGAIN else name)
        empty = None if own is None else samples[_called(own)]
        empty_ns = empty.median_ns if empty is not None and empty.samples_ns else 0.0
        share = 1 if here.where[1] == "single" else 1 / ready.rows
        timed.samples_ns = [sample - share * empty_ns for sample in timed.samples_ns]
        calls_ns = () if empty is None else tuple(share * sample for sample in empty.samples_ns)
        yield Measurement((name, *here.where), timed, empty_ns, ready.timed_by, calls_ns)
    for name in calls:
        yield Measurement((name, *here.where), samples[name], 0.0, "process")


def _called(call: EmptyCall) -> str:
    """Return the name of an empty call among the entries that are measured."""
    return f"{EMPTY_CALL} of {call.name}"


def _rounds(session: MeasuringSession, here: _Together, todo: Mapping[str, PreparedWork]) -> dict[str, Samples]:
    """Measure this work in rounds; return the samples by name."""
    where, entries = here.where, []
    for name, work in todo.items():
        total = here.sums.get(session.plan.reference if name == REFERENCE_AGAIN else name)
        total = int(work.answers().sum(dtype=np.int64)) if total is None else total
        loops, takes = session.loops.get((name, *where), (None, 1))
        entries.append(TimingEntry(name, work.rows, work.run, total, loops, takes))
    first = session.number * len(entries) // max(1, session.plan.processes)
    shortest = session.plan.amounts.sample_s
    rounds = BUILDS if where[1] == "build" else session.plan.rounds
    samples = measure(entries, rounds, shortest, first)
    return {timed.name: timed for timed in samples}


UNLIKE = 0.1
"""An empty call may differ by this share: through ctypes it takes 200 ns, and 7 ns more or less by its arguments."""


Measurements = dict[MeasurementKey, list[Measurement]]
"""The measurements of all processes, by method, workload and mode."""


def expected_prints(answers: list[MethodAnswers]) -> dict[MeasurementKey, str]:
    """Return the hashes of the judged answers, by method, workload and mode."""
    prints: dict[MeasurementKey, str] = {}
    for method_answers in answers:
        prints[method_answers.method, method_answers.workload, "batch"] = (
            NOT_ANSWERED if method_answers.trouble else method_answers.batch_print
        )
        prints[method_answers.method, method_answers.workload, "single"] = (
            NOT_ANSWERED if method_answers.trouble else method_answers.single_print
        )
    return prints


def measurements_of(plan: BenchPlan, prints: Mapping[MeasurementKey, str], advance: Advance) -> Measurements:
    """Return the measurements of the processes, one process after the other; the first calibrates for all."""
    measurements: Measurements = {}
    loops: dict[MeasurementKey, tuple[int, int]] = {}
    for number in range(plan.processes):
        with fresh(1) as executor:
            ((_, results),) = perform(run_session, [MeasuringSession(plan, number, prints, loops)], executor)
        for result in results:
            measurements.setdefault(result.key, []).append(result)
            loops.setdefault(result.key, (result.samples.loops, result.samples.takes))
        advance(1)
    return measurements


def speed_lines(
    measurements: Measurements, reference: str
) -> Iterator[NoiseLine | SpeedLine | UnmeasuredLine | RefusedLine]:
    """Yield the record's lines: noise before the speeds of the same workload; methods without a time last."""
    measurements = {key: parts for key, parts in measurements.items() if not key[1].startswith(COST_OF)}
    refused = {key: reason for key, parts in measurements.items() if (reason := _refusal(parts))}
    hidden = {key: reason for key, parts in measurements.items() if key not in refused and (reason := _hidden(parts))}
    timed = {key: parts for key, parts in measurements.items() if key not in refused and key not in hidden}
    for name, workload, mode in timed:
        if name == REFERENCE_AGAIN and (reference, workload, mode) in timed:
            yield _noise(timed, reference, workload, mode)
    for key in timed:
        if key[0] != REFERENCE_AGAIN and not key[0].startswith(EMPTY_CALL):
            yield _speed_line(timed, reference, key)
    for (name, workload, mode), reason in hidden.items():
        if name != REFERENCE_AGAIN:
            yield UnmeasuredLine(method=name, workload=workload, mode=mode, reason=reason)
    for (name, workload, mode), reason in refused.items():
        yield RefusedLine(method=name, workload=workload, mode=mode, reason=reason)


def _hidden(parts: list[Measurement]) -> str | None:
    """Return the reason why the time cannot be distinguished from the subtracted time of an empty call; None if it can.

    It can if the gap between the 95 % intervals of the two medians, before the subtraction, is larger than UNLIKE, the
    possible difference between the empty call and the cost of calling the method.
    """
    if not all(part.calls_ns for part in parts):
        return None
    call = estimate([[left + median(part.calls_ns) for left in part.samples.samples_ns] for part in parts])
    empty = estimate([part.calls_ns for part in parts])
    if call.low > (1 + UNLIKE) * empty.high and any(map(_possible, parts)):
        return None
    return (
        f"its time, {_time_text(call)}, cannot be distinguished from that of a call that does nothing, "
        f"{_time_text(empty)}, which must be taken off"
    )


def _time_text(time: Estimate) -> str:
    """Return a time with its interval, as text."""
    return f"{time.median:.3g} ns ({time.low:.3g} to {time.high:.3g})"


def _possible(part: Measurement) -> list[float]:
    """Return the positive samples of a process, to six digits, because no clock is more accurate."""
    return [float(f"{sample:.6g}") for sample in part.samples.samples_ns if sample > LEAST_NS]


def _refusal(parts: list[Measurement]) -> str | None:
    """Return the reason why a measurement was refused, or None."""
    return next((part.samples.refused for part in parts if part.samples.refused), None)


def _speed_line(measurements: Measurements, reference: str, key: MeasurementKey) -> SpeedLine:
    """Return the record's line about the speed of a method in one workload and mode."""
    name, workload, mode = key
    parts = measurements[key]
    first = parts[0].samples
    samples = [possible for part in parts if (possible := _possible(part))]
    dropped = sum(len(part.samples.samples_ns) for part in parts) - sum(map(len, samples))
    time, ratio = estimate(samples), _ratio(measurements, reference, key)
    return SpeedLine(
        method=name,
        workload=workload,
        mode=mode,
        rows=first.rows,
        loops=first.loops,
        samples_ns=samples,
        dropped=dropped or UNSET,
        median_ns=time.median,
        ci95_ns=(time.low, time.high),
        ratio=None if ratio is None else ratio.median,
        ratio_ci95=None if ratio is None else (ratio.low, ratio.high),
        checksum=first.checksum,
        empty_ns=median(part.empty_ns for part in parts),
        timed_by=parts[0].timed_by,
    )


def _ratio(measurements: Measurements, reference: str, key: MeasurementKey) -> Estimate | None:
    """Return the ratio of a method's times to those of the reference; None if there is none."""
    _, workload, mode = key
    parts = measurements.get((reference, workload, mode))
    if parts is None or _refusal(parts):
        return None
    pairs = ratios(samples_of(measurements[key]), samples_of(parts))
    return estimate(pairs) if any(pairs) else None


def _noise(measurements: Measurements, reference: str, workload: str, mode: str) -> NoiseLine:
    """Return the record's line about noise: the ratio of the reference to itself."""
    ratio = _ratio(measurements, reference, (REFERENCE_AGAIN, workload, mode))
    if ratio is None:
        raise ValueError(f"{reference} was measured again in {workload}, {mode}, and not before")
    return NoiseLine(
        workload=workload,
        mode=mode,
        ratio=ratio.median,
        ratio_ci95=(ratio.low, ratio.high),
        floor=ratio.half_width,
    )


def samples_of(parts: list[Measurement]) -> list[list[float]]:
    """Return the nanoseconds per row of each round, by process, to six digits, because no clock is more accurate."""
    return [[float(f"{sample:.6g}") for sample in part.samples.samples_ns] for part in parts]


def cost_lines(plan: BenchPlan, measurements: Measurements) -> Iterator[CostLine]:
    """Yield a line for each claim about costs."""
    for claim in cost_claims(plan):
        samples = {
            name: samples_of(parts) for (name, workload, _), parts in measurements.items() if workload == claim.where
        }
        yield cost_line(plan, claim, samples)
