"""The four oracles behind one interface, and the cross-check that compares each with the exact decision.

The four oracles behind one door: each turns rows into opinions, and says so where it cannot tell.

The oracles against each other, and the repaired coefficient rule in exact rationals against the root patterns.
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
from hypcheck.runs.findings import FamilyBatch, SelfCheckPlan


@dataclass(frozen=True, slots=True)
class Opinion:
    """What an oracle says of one pair; None where it does not say. `stage` names the part of it that decided."""

    position: Position | None
    tangent: bool | None = None
    kind: str | None = None
    stage: str = ""


@dataclass(frozen=True, slots=True)
class Oracle:
    """One way to the truth. `ask` maps rows (n, 7) to n opinions; `share` is the part of the cases it is asked."""

    name: str
    title: str
    ask: Callable[[Rows], Sequence[Opinion]]
    available: Callable[[], str | None] = lambda: None


def ask_exact(rows: Rows) -> list[Opinion]:
    """The exact decision, its certificate made and checked: an answer without a valid proof counts as undecided."""
    from hypcheck.truth import exact  # noqa: PLC0415  an oracle that is not asked is not loaded
    from hypcheck.truth.certificate import check_certificate  # noqa: PLC0415
    from hypcheck.truth.prove import prove  # noqa: PLC0415

    opinions = []
    for row in rows.tolist():
        pair = Pair.from_row(row)
        decision = exact.decide(pair.lengths)
        certificate = prove(pair, decision)
        proved = certificate.position is decision.position and check_certificate(pair, certificate)
        opinions.append(
            Opinion(decision.position, decision.tangent, decision.kind.value, "proved")
            if proved
            else Opinion(None, stage="certificate refused")
        )
    return opinions


def ask_nearest(rows: Rows) -> list[Opinion]:
    """The sign of the clearance to the nearest point, in floats with a bound, more digits where that cannot tell."""
    from hypcheck.truth.nearest import positions  # noqa: PLC0415
    from hypcheck.truth.nearest_exact import STAGES  # noqa: PLC0415

    found = positions(np.ascontiguousarray(rows))
    return [
        Opinion(Position(position), tangent, None, STAGES[stage])
        for position, tangent, stage in zip(
            found.position.tolist(), found.tangent.tolist(), found.stage.tolist(), strict=True
        )
    ]


def ask_roots(rows: Rows) -> list[Opinion]:
    """The pattern of the roots of g, after [10]."""
    from hypcheck.truth.roots import classify_by_roots  # noqa: PLC0415

    reports = [classify_by_roots(Pair.from_row(row)) for row in rows.tolist()]
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
    from hypcheck.truth.mesh import verdict  # noqa: PLC0415
    from hypcheck.truth.mesh_meridian import MeshOutcome  # noqa: PLC0415

    def opinion(row: list[float]) -> Opinion:
        found = verdict(Pair.from_row(row))
        position = Position.CONTACT if found.outcome is MeshOutcome.CONTACT else found.position
        return Opinion(position, stage=found.outcome.name.lower())

    return [opinion(row) for row in rows.tolist()]


def _mesh_trouble() -> str | None:
    from hypcheck.truth.mesh import availability  # noqa: PLC0415

    return availability()


ORACLES = {
    oracle.name: oracle
    for oracle in (
        Oracle("exact", "exact decision in integers, with a checked certificate", ask_exact),
        Oracle("nearest", "nearest point of the hyperboloid", ask_nearest),
        Oracle("roots", "root patterns after [10], re-derived; its text was not consulted", ask_roots),
        Oracle("mesh", "FCL on two one-sided meshes", ask_mesh, _mesh_trouble),
    )
}


CHUNK = 100
"""Rows a task: small enough for a smooth progress bar, large enough to be worth sending."""


@dataclass(frozen=True, slots=True)
class OracleTask:
    """Rows of one family for one oracle; `start` is the place of the first in its family."""

    oracle: str
    batch: int
    start: int
    rows: Rows


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A case about which an oracle and the exact decision say different things."""

    oracle: str
    case: str
    row: tuple[float, ...]
    exact: str
    opinion: str


@dataclass(frozen=True, slots=True)
class OracleTally:
    """What came of asking one oracle about one family: counts of answers and of deciding stages, and its time."""

    oracle: str
    family: str
    asked: int
    undecided: int
    stages: dict[str, int]
    seconds: float
    disagreements: tuple[Disagreement, ...]


def oracle_tasks(plan: SelfCheckPlan, all_batches: Sequence[FamilyBatch]) -> list[OracleTask]:
    """Every piece of work, the slow oracles first so that no long task is left for the end."""
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
    """Each task with its opinions and seconds, as they are finished; without an executor, here and in order."""
    for task, (opinions, seconds) in processes.perform(ask_oracle, todo, executor):
        yield task, opinions, seconds


def compare_with_exact(
    task: OracleTask, opinions: Sequence[Opinion], batch: FamilyBatch, seconds: float
) -> OracleTally:
    """The opinions against the exact decisions."""
    disagreements = tuple(
        Disagreement(task.oracle, batch.name(task.start + index), tuple(task.rows[index].tolist()), *words)
        for index, opinion in enumerate(opinions)
        if (words := _difference(batch, task.start + index, opinion)) is not None
    )
    undecided = sum(opinion.position is None for opinion in opinions)
    stages = dict(Counter(opinion.stage for opinion in opinions))
    return OracleTally(task.oracle, batch.family.name, len(opinions), undecided, stages, seconds, disagreements)


def _difference(batch: FamilyBatch, index: int, opinion: Opinion) -> tuple[str, str] | None:
    """How an opinion contradicts the exact decision, in words for both; None where it does not."""
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
    """One tally for each oracle and family, whatever the order in which their parts came."""
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
