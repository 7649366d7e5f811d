"""The four oracles behind one interface, and the cross-check that compares each with the exact decision.

An oracle maps rows to opinions; an opinion may be that it cannot decide. The roots oracle is also compared with the
repaired coefficient rule in exact rationals.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from hypcheck import processes
from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import Rows
from hypcheck.record.fields import row_fields
from hypcheck.record.lines import DisagreementPart
from hypcheck.runs.findings import FamilyBatch, SelfCheckPlan
from hypcheck.truth import certificate, exact, mesh, nearest, nearest_exact, prove, roots
from hypcheck.truth.mesh_meridian import MeshOutcome


@dataclass(frozen=True, slots=True)
class Opinion:
    """An oracle's opinion about one pair; None where it has none. `stage` names the part of the oracle that decided."""

    position: Position | None
    tangent: bool | None = None
    kind: str | None = None
    stage: str = ""


@dataclass(frozen=True, slots=True)
class Oracle:
    """An oracle: `ask` maps rows (n, 7) to n opinions; `available` gives the reason why it cannot run here, or None."""

    name: str
    title: str
    ask: Callable[[Rows], Sequence[Opinion]]
    available: Callable[[], str | None] = lambda: None


def ask_exact(rows: Rows) -> list[Opinion]:
    """The exact decision with a checked certificate; a decision without a valid proof counts as undecided."""
    opinions = []
    for row in rows.tolist():
        pair = Pair.from_row(row)
        decision = exact.decide(pair.lengths)
        found = prove.prove(pair, decision)
        proved = found.position is decision.position and certificate.check_certificate(pair, found)
        opinions.append(
            Opinion(decision.position, decision.tangent, decision.kind.value, "proved")
            if proved
            else Opinion(None, stage="certificate refused")
        )
    return opinions


def ask_nearest(rows: Rows) -> list[Opinion]:
    """The sign of the clearance to the nearest point: floats with a bound, then more digits until the bound decides."""
    found = nearest.positions(np.ascontiguousarray(rows))
    return [
        Opinion(Position(position), tangent, None, nearest_exact.STAGES[stage])
        for position, tangent, stage in zip(
            found.position.tolist(), found.tangent.tolist(), found.stage.tolist(), strict=True
        )
    ]


def ask_roots(rows: Rows) -> list[Opinion]:
    """The pattern of the roots of g, after [10]."""
    reports = [roots.classify_by_roots(Pair.from_row(row)) for row in rows.tolist()]
    return [
        Opinion(
            report.position,
            report.tangent,
            report.kind.value,
            "signs suffice" if report.literal is not None else "signs are ambiguous",
        )
        for report in reports
    ]


def ask_mesh(rows: Rows) -> list[Opinion]:
    """FCL's distance to two meshes with the hyperboloid between them; undecided inside its band."""
    verdicts = [mesh.verdict(Pair.from_row(row)) for row in rows.tolist()]
    return [
        Opinion(
            Position.CONTACT if found.outcome is MeshOutcome.CONTACT else found.position,
            stage=found.outcome.name.lower(),
        )
        for found in verdicts
    ]


ORACLES = {
    oracle.name: oracle
    for oracle in (
        Oracle("exact", "exact decision in integers, with a checked certificate", ask_exact),
        Oracle("nearest", "nearest point of the hyperboloid", ask_nearest),
        Oracle("roots", "root patterns after [10], re-derived; its text was not consulted", ask_roots),
        Oracle("mesh", "FCL on two one-sided meshes", ask_mesh, mesh.availability),
    )
}


CHUNK = 100
"""Rows of a task: few enough for a smooth progress bar, enough to be worth sending."""


@dataclass(frozen=True, slots=True)
class OracleTask:
    """Rows of one family for one oracle; `start` is the place of the first in its family."""

    oracle: str
    batch: int
    start: int
    rows: Rows


@dataclass(frozen=True, slots=True)
class OracleTally:
    """The answers of one oracle about one family: counts, deciding stages, seconds, and disagreements by case."""

    oracle: str
    family: str
    asked: int
    undecided: int
    stages: dict[str, int]
    seconds: float
    disagreements: tuple[DisagreementPart, ...]


def oracle_tasks(plan: SelfCheckPlan, all_batches: Sequence[FamilyBatch]) -> list[OracleTask]:
    """All tasks, those of slow oracles first, so that no long task is left for the end."""
    families = max(1, len(all_batches))
    shares = {
        "exact": plan.count,
        "nearest": plan.count,
        "roots": -(-plan.roots // families),
        "mesh": -(-plan.meshes // families),
    }
    order = [name for name in ("mesh", "roots", "exact", "nearest") if name in plan.oracles]
    return [
        OracleTask(oracle, place, start, batch.rows[start : min(start + CHUNK, shares[oracle])])
        for oracle in order
        for place, batch in enumerate(all_batches)
        for start in range(0, min(len(batch.rows), shares[oracle]), CHUNK)
    ]


def ask_oracle(task: OracleTask) -> tuple[list[Opinion], float]:
    """The oracle's opinions about a task's rows, and the seconds they took."""
    started = time.perf_counter()
    opinions = list(ORACLES[task.oracle].ask(task.rows))
    if task.oracle == "roots":
        opinions = [
            _unless_rule_differs(row, opinion) for row, opinion in zip(task.rows.tolist(), opinions, strict=True)
        ]
    return opinions, time.perf_counter() - started


def _unless_rule_differs(row: list[float], opinion: Opinion) -> Opinion:
    """The opinion, unless the coefficient rule in exact rationals reads another position from the coefficients."""
    rule = answers(FORMULAS["coefficients"], EXACT, dict(zip(COLUMNS, Pair.from_row(row).row, strict=True)))
    if opinion.position == rule:
        return opinion
    return Opinion(opinion.position, opinion.tangent, opinion.kind, f"coefficient rule says {Position(rule).label}")


def perform_tasks(
    todo: Sequence[OracleTask], executor: Executor | None
) -> Iterator[tuple[OracleTask, list[Opinion], float]]:
    """Each task with its opinions and seconds, as they finish; without an executor in this process and in order."""
    for task, (opinions, seconds) in processes.perform(ask_oracle, todo, executor):
        yield task, opinions, seconds


def compare_with_exact(
    task: OracleTask, opinions: Sequence[Opinion], batch: FamilyBatch, seconds: float
) -> OracleTally:
    """The tally of a task's opinions against the exact decisions."""
    disagreements = tuple(
        DisagreementPart(
            oracle=task.oracle,
            case=batch.name(task.start + index),
            **row_fields(task.rows[index].tolist()),
            exact=words[0],
            opinion=words[1],
        )
        for index, opinion in enumerate(opinions)
        if (words := _difference(batch, task.start + index, opinion)) is not None
    )
    undecided = sum(opinion.position is None for opinion in opinions)
    stages = dict(Counter(opinion.stage for opinion in opinions))
    return OracleTally(task.oracle, batch.family.name, len(opinions), undecided, stages, seconds, disagreements)


def _difference(batch: FamilyBatch, index: int, opinion: Opinion) -> tuple[str, str] | None:
    """The exact decision and the opinion in words if they contradict each other, else None."""
    decision = batch.decisions[index]
    exact = f"{decision.position.label}, tangent: {decision.tangent}, {decision.kind.value}"
    if opinion.stage.startswith("coefficient rule") or opinion.stage == "certificate refused":
        return exact, opinion.stage
    if opinion.position is None:
        return None
    same = opinion.position is decision.position
    same &= opinion.tangent in (None, decision.tangent) and opinion.kind in (None, decision.kind.value)
    return None if same else (exact, f"{opinion.position.label}, tangent: {opinion.tangent}, {opinion.kind}")


def merged_tallies(tallies: Sequence[OracleTally]) -> list[OracleTally]:
    """One tally for each oracle and family; the order of the parts does not matter."""
    parts: dict[tuple[str, str], list[OracleTally]] = {}
    for tally in tallies:
        parts.setdefault((tally.oracle, tally.family), []).append(tally)
    return [_sum(parts[key]) for key in sorted(parts)]


def _sum(parts: Sequence[OracleTally]) -> OracleTally:
    stages: Counter[str] = Counter()
    for part in parts:
        stages.update(part.stages)
    return OracleTally(
        parts[0].oracle,
        parts[0].family,
        sum(part.asked for part in parts),
        sum(part.undecided for part in parts),
        dict(sorted(stages.items())),
        sum(part.seconds for part in parts),
        tuple(sorted((case for part in parts for case in part.disagreements), key=lambda each: each.case)),
    )
