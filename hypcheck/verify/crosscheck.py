"""The oracles against each other, and the repaired coefficient rule in exact rationals against the root patterns."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from hypcheck import processes
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.pairs import COLUMNS, Pair, Position
from hypcheck.rows import Rows
from hypcheck.verify.opinions import ORACLES, Opinion
from hypcheck.verify.plan import Batch, Plan

CHUNK = 100
"""Rows a task: small enough for a smooth progress bar, large enough to be worth sending."""


@dataclass(frozen=True, slots=True)
class Task:
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


def tasks(plan: Plan, all_batches: Sequence[Batch]) -> list[Task]:
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
        Task(oracle, place, start, batch.rows[start : min(start + CHUNK, shares[oracle])])
        for oracle in order
        for place, batch in enumerate(all_batches)
        for start in range(0, min(len(batch.rows), shares[oracle]), CHUNK)
    ]


def run(task: Task) -> tuple[list[Opinion], float]:
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


def perform(todo: Sequence[Task], executor: Executor | None) -> Iterator[tuple[Task, list[Opinion], float]]:
    """Each task with its opinions and seconds, as they are finished; without an executor, here and in order."""
    for task, (opinions, seconds) in processes.perform(run, todo, executor):
        yield task, opinions, seconds


def compare(task: Task, opinions: Sequence[Opinion], batch: Batch, seconds: float) -> OracleTally:
    """The opinions against the exact decisions."""
    disagreements = tuple(
        Disagreement(task.oracle, batch.name(task.start + index), tuple(task.rows[index].tolist()), *words)
        for index, opinion in enumerate(opinions)
        if (words := _difference(batch, task.start + index, opinion)) is not None
    )
    undecided = sum(opinion.position is None for opinion in opinions)
    stages = dict(Counter(opinion.stage for opinion in opinions))
    return OracleTally(task.oracle, batch.family.name, len(opinions), undecided, stages, seconds, disagreements)


def _difference(batch: Batch, index: int, opinion: Opinion) -> tuple[str, str] | None:
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


def merged(tallies: Sequence[OracleTally]) -> list[OracleTally]:
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
