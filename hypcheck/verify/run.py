"""One run of verify: derive, prove, cross-check, judge, time, draw; everything goes into the record as it comes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import msgspec

from hypcheck import judge
from hypcheck.bench.rounds import measure
from hypcheck.derivation.printed import check_equations
from hypcheck.derivation.proofs import prove_formulas
from hypcheck.errors import Exit, RunOutcome
from hypcheck.judge import Status
from hypcheck.methods.builtin import builtin, builtin_methods, methods_without_meshes
from hypcheck.methods.method import Method
from hypcheck.processes import processes
from hypcheck.record import Recorder, lines
from hypcheck.verify import contenders, crosscheck, findings, known, maps
from hypcheck.verify.crosscheck import OracleTally
from hypcheck.verify.opinions import ORACLES
from hypcheck.verify.plan import Batch, Plan, batches, chosen_families

ROUNDS = 9
"""Timing rounds: enough for a median that one disturbed round does not move."""

MESH = "mesh"
"""The oracle without which nothing of FCL is loaded."""

Advance = Callable[[int], object]


@dataclass(frozen=True)
class Stage:
    """A part of the run: its title for the progress bar, how many steps it has, and what does them."""

    title: str
    steps: int
    run: Callable[[Advance], None]


def stages(plan: Plan, recorder: Recorder, outcome: RunOutcome) -> tuple[Stage, ...]:
    """The run's parts in order. Raises InputError where the plan names a family or an oracle that does not exist."""
    families = chosen_families(plan)
    all_batches = batches(plan, families)
    available = builtin_methods() if MESH in plan.oracles else methods_without_meshes()
    methods = tuple(method for method in available.values() if not method.measured)
    todo = crosscheck.tasks(_with_available(plan, recorder), all_batches)
    formulas = findings.exact_formulas()
    return (
        Stage("derivation", 2, lambda advance: _derive(recorder, outcome, advance)),
        Stage("oracles", len(todo), lambda advance: _cross_check(plan, all_batches, todo, recorder, outcome, advance)),
        Stage(
            "mathematics of the formulas",
            len(all_batches) * len(formulas),
            lambda advance: _exact_findings(plan, all_batches, recorder, outcome, advance),
        ),
        Stage(
            "methods in floats",
            len(all_batches) * (len(methods) + 1),
            lambda advance: _judge(plan, all_batches, methods, recorder, outcome, advance),
        ),
        Stage("map", 2, lambda advance: _draw(recorder, advance)),
        Stage("timing", ROUNDS, lambda advance: _time(plan, recorder, advance)),
    )


def _with_available(plan: Plan, recorder: Recorder) -> Plan:
    """The plan without the oracles that cannot run here; the record says why."""
    reasons = {name: ORACLES[name].available() for name in plan.oracles}
    for name, reason in reasons.items():
        if reason is not None:
            recorder.add(lines.Unavailable(oracle=name, reason=reason))
    present = tuple(name for name, reason in reasons.items() if reason is None)
    return replace(plan, oracles=present)


def _derive(recorder: Recorder, outcome: RunOutcome, advance: Advance) -> None:
    for equation in check_equations():
        recorder.add(lines.Equation(**asdict(equation)))
    advance(1)
    for proof in prove_formulas():
        recorder.add(lines.Proof(**asdict(proof)))
        if not proof.holds:
            outcome.because[Exit.ORACLES_DISAGREE].append(f"{proof.formula}: {proof.statement}")
    advance(1)


def _cross_check(
    plan: Plan,
    all_batches: Sequence[Batch],
    todo: Sequence[crosscheck.Task],
    recorder: Recorder,
    outcome: RunOutcome,
    advance: Advance,
) -> None:
    tallies: list[OracleTally] = []
    with processes(plan.workers) as executor:
        for task, opinions, seconds in crosscheck.perform(todo, executor):
            tallies.append(crosscheck.compare(task, opinions, all_batches[task.batch], seconds))
            advance(1)
    for tally in crosscheck.merged(tallies):
        outcome.because[Exit.ORACLES_DISAGREE] += [f"{case.oracle} on {case.case}" for case in tally.disagreements]
        cases = [
            lines.Disagreement(**{**asdict(case), "row": tuple(value.hex() for value in case.row)})
            for case in tally.disagreements[:20]
        ]
        recorder.add(
            lines.Oracle(
                oracle=tally.oracle,
                family=tally.family,
                asked=tally.asked,
                undecided=tally.undecided,
                stages=dict(tally.stages),
                seconds=tally.seconds,
                disagreeing=len(tally.disagreements),
                disagreements=cases,
            )
        )


def _exact_findings(
    plan: Plan, all_batches: Sequence[Batch], recorder: Recorder, outcome: RunOutcome, advance: Advance
) -> None:
    found, listed = [], known.known_findings()
    for batch in all_batches:
        for formula in findings.exact_formulas():
            for finding in findings.mathematical(formula, batch, plan):
                found.append(finding)
                recorder.add(msgspec.structs.replace(finding, reason=known.reason_for(finding, listed)))
            advance(1)
    for sentence in known.drift(found, listed, complete=plan.complete):
        recorder.add(lines.Drift(sentence=sentence))
        outcome.because[Exit.WRONG].append(sentence)


def _judge(
    plan: Plan,
    all_batches: Sequence[Batch],
    methods: Sequence[Method],
    recorder: Recorder,
    outcome: RunOutcome,
    advance: Advance,
) -> None:
    for batch in (each.head(plan.judged) for each in all_batches):
        octaves = judge.flip_octaves(batch.rows)
        advance(1)
        for method in methods:
            line = findings.group(method, batch, octaves, plan)
            recorder.add(line)
            if method.exact and set(line.counts) - {Status.RIGHT.value, Status.SKIPPED.value}:
                outcome.because[Exit.WRONG].append(f"{method.name} on {batch.family.name}")
            advance(1)


def _draw(recorder: Recorder, advance: Advance) -> None:
    for panel in maps.tower_panels():
        recorder.add(maps.draw(panel, builtin("table-2-float32")))
        advance(1)


def _time(plan: Plan, recorder: Recorder, advance: Advance) -> None:
    rows, found = contenders.workload(plan.seed), contenders.contenders(meshes=MESH in plan.oracles)
    for _, timings in measure([each.entry(rows) for each in found], ROUNDS):
        advance(1)
        for contender, timing in zip(found, timings, strict=False):
            recorder.add(contenders.line(contender, timing))


def options(plan: Plan) -> Mapping[str, Any]:
    """The plan as the record's header shows it."""
    return {**asdict(plan), "tolerance": float(plan.tolerance)}
