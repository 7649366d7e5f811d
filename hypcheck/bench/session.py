"""One fresh process that measures: it checks every method, then times all of them in rounds, workload by workload."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from hypcheck.bench.accuracy import answers_print, chosen_workloads, timed_rows
from hypcheck.bench.claims import CostClaim, cost_claims
from hypcheck.bench.contender import Contender, EmptyCall, LoadedMethod, PreparedWork
from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.timing import Samples, TimingEntry, measure
from hypcheck.bench.workloads import Workload
from hypcheck.geometry.rows import Rows

MODES: Mapping[str, Callable[[LoadedMethod, Rows], PreparedWork | None]] = {
    "batch": lambda way, rows: way.batch(rows),
    "single": lambda way, rows: way.single(rows),
    "build": lambda way, rows: way.build(rows),
}
"""The modes of timing a method: many rows by one call, rows one by one, and the building before."""

REFERENCE_AGAIN = "the reference again"
"""The reference a second time: its difference from the first is noise."""

MODE_WORKLOADS: Mapping[str, tuple[str, ...]] = {
    "single": ("uniform", "near-contact", "tower"),
    "build": ("uniform", "one-axis", "region", "tower"),
}
"""The workloads of a mode, if not all: single rows have no neighbours, and a mesh belongs to the scene."""

BUILDS = 2
"""Rounds of building meshes: a large mesh takes almost a second."""

NOT_ANSWERED = "not answered"
"""Replaces the hash of answers if the method failed when it was judged, which is recorded already."""

COST_OF = "cost of "
"""Begins the name of a claim, in place of a workload."""

FIRST_AGAIN = "the first again"
"""The first alternative of a comparison a second time; its difference is noise."""

EMPTY_CALL = "an empty call"

MeasurementKey = tuple[str, str, str]
"""A method, a workload and a mode."""


@dataclass(frozen=True)
class MeasuringSession:
    """The work of one process.

    `expected` are hashes of the answers by method, workload and mode; a method with other answers is refused. `loops`
    are loops and takes of the first process, which all others use; the first gets none.
    """

    plan: BenchPlan
    number: int
    expected: Mapping[MeasurementKey, str]
    loops: Mapping[MeasurementKey, tuple[int, int]]


@dataclass(frozen=True)
class Measurement:
    """The samples of one process for one method, workload and mode, from which `empty_ns` is subtracted.

    The rest may be negative, if noise made the empty call longer. `calls_ns` are the samples of the empty call, in
    nanoseconds a row of the method.
    """

    key: MeasurementKey
    samples: Samples
    empty_ns: float
    timed_by: str
    calls_ns: tuple[float, ...] = ()


@dataclass(frozen=True)
class _MeasuredTogether:
    """Work that is measured together: by name, with the empty calls that are subtracted."""

    where: tuple[str, str]
    ready: dict[str, PreparedWork]
    empties: dict[str, PreparedWork]
    empty_of: dict[str, str]
    refused: list[Measurement]
    sums: dict[str, int] = field(default_factory=dict)


def run_session(session: MeasuringSession) -> list[Measurement]:
    """All measurements, in the order of workloads and modes."""
    found = contenders(session.plan)
    ways = {name: each.load() for name, each in found.items() if not each.accuracy_only}
    measured = []
    try:
        for workload in chosen_workloads(session.plan):
            for mode in _modes(workload):
                here = _field(session, found, ways, workload, mode)
                measured += [*here.refused, *_measured(session, here)]
        for claim in cost_claims(session.plan):
            measured += _measured(session, _compared(session, claim))
    finally:
        for way in ways.values():
            way.close()
    return measured


def _compared(session: MeasuringSession, claim: CostClaim) -> _MeasuredTogether:
    """The alternatives of a claim about cost, and the first of them again."""
    ready = claim.compared(session.plan)
    again = {FIRST_AGAIN: next(iter(ready.values()))}
    return _MeasuredTogether((f"{COST_OF}{claim.name}-{claim.tier}", "batch"), {**ready, **again}, {}, {}, [])


def _modes(workload: Workload) -> Sequence[str]:
    """The modes of a workload, without those that repeat another result."""
    return tuple(
        mode for mode in MODES if workload.timed and workload.name in MODE_WORKLOADS.get(mode, (workload.name,))
    )


def _field(
    session: MeasuringSession,
    found: Mapping[str, Contender],
    ways: Mapping[str, LoadedMethod],
    workload: Workload,
    mode: str,
) -> _MeasuredTogether:
    here = _MeasuredTogether((workload.name, mode), {}, {}, {}, [])
    for name, way in ways.items():
        rows = timed_rows(session.plan, found[name], workload)
        if mode == "single":
            rows = rows[: found[name].singles]
        key = (name, *here.where)
        told = session.expected.get(key)
        ready = MODES[mode](way, rows) if len(rows) and told != NOT_ANSWERED else None
        if ready is None:
            continue
        answers = ready.answers()
        if told is not None and answers_print(answers) != told:
            reason = "its answers, when it was about to be timed, were not those that were judged"
            here.refused.append(Measurement(key, Samples(name, ready.rows, 0, 0, refused=reason), 0.0, ready.timed_by))
            continue
        here.ready[name], here.sums[name] = ready, int(answers.sum(dtype=np.int64))
        _with_empty(here, name, way.empty(rows, mode))
    return here


def _with_empty(here: _MeasuredTogether, name: str, empty: EmptyCall | None) -> None:
    if empty is not None:
        here.empty_of[name] = f"{EMPTY_CALL} of {empty.name}"
        here.empties.setdefault(here.empty_of[name], empty.ready)


def _measured(session: MeasuringSession, here: _MeasuredTogether) -> Iterator[Measurement]:
    if not here.ready:
        return
    reference = session.plan.reference
    todo = {**here.ready, **({REFERENCE_AGAIN: here.ready[reference]} if reference in here.ready else {})}
    samples = _rounds(session, here, {**todo, **here.empties})
    for name, ready in todo.items():
        found = samples[name]
        empty = samples.get(here.empty_of.get(reference if name == REFERENCE_AGAIN else name, ""))
        empty_ns = empty.median_ns if empty is not None and empty.samples_ns else 0.0
        share = 1 if here.where[1] == "single" else 1 / ready.rows
        found.samples_ns = [sample - share * empty_ns for sample in found.samples_ns]
        calls = () if empty is None else tuple(share * sample for sample in empty.samples_ns)
        yield Measurement((name, *here.where), found, empty_ns, ready.timed_by, calls)
    for name in here.empties:
        yield Measurement((name, *here.where), samples[name], 0.0, "process")


def _rounds(session: MeasuringSession, here: _MeasuredTogether, todo: Mapping[str, PreparedWork]) -> dict[str, Samples]:
    where, entries = here.where, []
    for name, each in todo.items():
        total = here.sums.get(session.plan.reference if name == REFERENCE_AGAIN else name)
        total = int(each.answers().sum(dtype=np.int64)) if total is None else total
        loops, takes = session.loops.get((name, *where), (None, 1))
        entries.append(TimingEntry(name, each.rows, each.run, total, loops, takes))
    first = session.number * len(entries) // max(1, session.plan.processes)
    shortest = session.plan.amounts.sample_s
    rounds = BUILDS if where[1] == "build" else session.plan.rounds
    samples = measure(entries, rounds, shortest, first)
    return {each.name: each for each in samples}
