"""The self-check: derive, prove, cross-check, judge, draw, time; each result goes into the record at once.

What verify times: the fast path beside the plain formula, general-purpose roots and FCL, on the cooling tower.

One run of verify: derive, prove, cross-check, judge, time, draw; everything goes into the record as it comes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import msgspec
import numpy as np

from hypcheck.bench.timing import Samples, TimingEntry, clocked, measure
from hypcheck.derivation.printed_equations import check_equations
from hypcheck.derivation.proofs import prove_formulas
from hypcheck.errors import Exit, RunOutcome
from hypcheck.geometry.rows import CANNOT_SAY, Rows
from hypcheck.implementations.alternatives import numpy_roots
from hypcheck.implementations.builtin import builtin, builtin_methods, fast_scene, methods_without_meshes
from hypcheck.implementations.meshes import point_mesh
from hypcheck.implementations.method import Answers, Method
from hypcheck.processes import Advance, Stage, processes
from hypcheck.record import Recorder, lines
from hypcheck.record.fields import row_fields
from hypcheck.record.lines import TimingLine
from hypcheck.runs import findings, judge, oracles
from hypcheck.runs.findings import FamilyBatch, SelfCheckPlan, batches, self_check_families
from hypcheck.runs.judge import Status
from hypcheck.runs.oracles import ORACLES, OracleTally
from hypcheck.vectors.families import FAMILIES

WORKLOAD = "tower-body"
TIMED_ROWS = 100_000
FAST, PLAIN = "fast path", "plain numpy formula"


@dataclass(frozen=True)
class TimedMethod:
    """Something to be timed: `run` answers the first `count` rows of the workload it is given."""

    name: str
    title: str
    run: Callable[[Rows], Answers]
    count: int

    def entry(self, rows: Rows) -> TimingEntry:
        """It, ready to be timed on those rows."""
        part = rows[: self.count]
        return TimingEntry(self.name, len(part), clocked(lambda: self.run(part)))


def timed_rows(seed: int) -> Rows:
    """Uniform positions in the box around the cooling tower; all rows have its sizes."""
    return FAMILIES[WORKLOAD].rows(seed, TIMED_ROWS)


def timed_methods(*, meshes: bool) -> list[TimedMethod]:
    """The methods to be timed; the slow ones on fewer rows. FCL is loaded only where `meshes` are asked for."""
    found = [
        TimedMethod(FAST, "certified floats, integers where they cannot tell; exact", _fast, TIMED_ROWS),
        TimedMethod(PLAIN, "Table 2 as one writes it in numpy; not certified", _plain, TIMED_ROWS),
        TimedMethod(
            "numpy.roots", "eigenvalues of the companion matrix, one call a row; not certified", numpy_roots, 200
        ),
    ]
    if meshes and ORACLES["mesh"].available() is None:
        found += [
            TimedMethod("FCL point-mesh", "distance to a mesh of 2,000 triangles built for each row", point_mesh, 60),
            TimedMethod("FCL certified", "two one-sided meshes built for each row; contact or clear only", _mesh, 60),
        ]
    return found


def timing_line(contender: TimedMethod, timing: Samples) -> TimingLine:
    """The record's line about one contender."""
    return TimingLine(
        workload=WORKLOAD,
        median_ns=timing.median_ns,
        name=timing.name,
        title=contender.title,
        rows=timing.rows,
        loops=timing.loops,
        samples_ns=timing.samples_ns,
        checksum=timing.checksum,
    )


def _fast(rows: Rows) -> Answers:
    sizes = tuple(rows[0, :4].tolist())
    return fast_scene((sizes[0], sizes[1], sizes[2], sizes[3]), rows[:, 4], rows[:, 5], rows[:, 6])


def _plain(rows: Rows) -> Answers:
    """Procedure 1 and the repaired interior condition, as the paper's Table 2 reads in numpy."""
    alpha, gamma, b, d = rows[0, :4].tolist()
    x, y, z = rows[:, 4], rows[:, 5], rows[:, 6]
    A, B = (alpha / b) ** 2, (gamma / d) ** 2
    c0 = -A * B
    P, Q = (x**2 + y**2) / b**2, (z / d) ** 2
    c1 = c0 + A - B + B * P - A * Q
    c2 = A - B + 1 - P - Q
    delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
    clear, outside = delta > 0, (c2 < 0) & (c1 > 0)
    return np.where(clear, np.where(outside, 1, -1), 0).astype(np.int8)


def _mesh(rows: Rows) -> Answers:
    opinions = ORACLES["mesh"].ask(rows)
    return np.array([CANNOT_SAY if each.position is None else each.position for each in opinions], dtype=np.int8)


TIMING_ROUNDS = 9
"""Timing rounds: enough for a median that one disturbed round does not move."""

MESH = "mesh"
"""The oracle without which nothing of FCL is loaded."""


def stages(plan: SelfCheckPlan, recorder: Recorder, outcome: RunOutcome) -> tuple[Stage, ...]:
    """The run's parts in order. Raises InputError where the plan names a family or an oracle that does not exist."""
    families = self_check_families(plan)
    all_batches = batches(plan, families)
    available = builtin_methods() if MESH in plan.oracles else methods_without_meshes()
    methods = tuple(method for method in available.values() if not method.measured)
    todo = oracles.oracle_tasks(_with_available(plan, recorder), all_batches)
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
        Stage("timing", TIMING_ROUNDS, lambda advance: _time(plan, recorder, advance)),
    )


def _with_available(plan: SelfCheckPlan, recorder: Recorder) -> SelfCheckPlan:
    """The plan without the oracles that cannot run here; the record says why."""
    reasons = {name: ORACLES[name].available() for name in plan.oracles}
    for name, reason in reasons.items():
        if reason is not None:
            recorder.add(lines.UnavailableLine(oracle=name, reason=reason))
    present = tuple(name for name, reason in reasons.items() if reason is None)
    return replace(plan, oracles=present)


def _derive(recorder: Recorder, outcome: RunOutcome, advance: Advance) -> None:
    for equation in check_equations():
        recorder.add(lines.EquationLine(**asdict(equation)))
    advance(1)
    for proof in prove_formulas():
        recorder.add(lines.ProofLine(**asdict(proof)))
        if not proof.holds:
            outcome.because[Exit.ORACLES_DISAGREE].append(f"{proof.formula}: {proof.statement}")
    advance(1)


def _cross_check(
    plan: SelfCheckPlan,
    all_batches: Sequence[FamilyBatch],
    todo: Sequence[oracles.OracleTask],
    recorder: Recorder,
    outcome: RunOutcome,
    advance: Advance,
) -> None:
    tallies: list[OracleTally] = []
    with processes(plan.workers) as executor:
        for task, opinions, seconds in oracles.perform_tasks(todo, executor):
            tallies.append(oracles.compare_with_exact(task, opinions, all_batches[task.batch], seconds))
            advance(1)
    for tally in oracles.merged_tallies(tallies):
        outcome.because[Exit.ORACLES_DISAGREE] += [f"{case.oracle} on {case.case}" for case in tally.disagreements]
        cases = [
            lines.DisagreementPart(**{**asdict(case), **row_fields(case.row)}) for case in tally.disagreements[:20]
        ]
        recorder.add(
            lines.OracleLine(
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
    plan: SelfCheckPlan, all_batches: Sequence[FamilyBatch], recorder: Recorder, outcome: RunOutcome, advance: Advance
) -> None:
    found, listed = [], findings.known_findings()
    for batch in all_batches:
        for formula in findings.exact_formulas():
            for finding in findings.mathematical_findings(formula, batch, plan):
                found.append(finding)
                recorder.add(msgspec.structs.replace(finding, reason=findings.reason_for(finding, listed)))
            advance(1)
    for sentence in findings.finding_drift(found, listed, complete=plan.complete):
        recorder.add(lines.DriftLine(sentence=sentence))
        outcome.because[Exit.WRONG].append(sentence)


def _judge(
    plan: SelfCheckPlan,
    all_batches: Sequence[FamilyBatch],
    methods: Sequence[Method],
    recorder: Recorder,
    outcome: RunOutcome,
    advance: Advance,
) -> None:
    for batch in (each.head(plan.judged) for each in all_batches):
        octaves = judge.flip_exponents(batch.rows)
        advance(1)
        for method in methods:
            line = findings.method_group(method, batch, octaves, plan)
            recorder.add(line)
            if method.exact and set(line.counts) - {Status.RIGHT.value, Status.SKIPPED.value}:
                outcome.because[Exit.WRONG].append(f"{method.name} on {batch.family.name}")
            advance(1)


def _draw(recorder: Recorder, advance: Advance) -> None:
    for panel in findings.tower_panels():
        recorder.add(findings.map_line(panel, builtin("table-2-float32")))
        advance(1)


def _time(plan: SelfCheckPlan, recorder: Recorder, advance: Advance) -> None:
    rows, found = timed_rows(plan.seed), timed_methods(meshes=MESH in plan.oracles)
    for _, timings in measure([each.entry(rows) for each in found], TIMING_ROUNDS):
        advance(1)
        for contender, timing in zip(found, timings, strict=False):
            recorder.add(timing_line(contender, timing))


def options(plan: SelfCheckPlan) -> Mapping[str, Any]:
    """The plan as the record's header shows it."""
    return {**asdict(plan), "tolerance": float(plan.tolerance)}
