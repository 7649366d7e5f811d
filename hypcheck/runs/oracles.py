"""The four oracles behind one interface, and the cross-check that compares each with the exact decision.

An oracle maps rows to opinions; an opinion may be that it cannot decide. The roots oracle is also compared with the
repaired coefficient rule in exact rationals. Rows of ten numbers go to the oracles for tilted spheroids; these are
asked about frozen vectors, whose positions are proved.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, answering
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import Rows
from hypcheck.record.fields import row_fields
from hypcheck.record.lines import DisagreementPart
from hypcheck.runs.findings import FamilyBatch, SelfCheckPlan
from hypcheck.truth import certificate, exact, mesh, nearest, nearest_exact, prove, roots
from hypcheck.truth.mesh import MeshOutcome
from hypcheck.truth.tilted import certificate as tilted_certificate
from hypcheck.truth.tilted import exact as tilted_exact
from hypcheck.truth.tilted import mesh as tilted_mesh
from hypcheck.truth.tilted import nearest as tilted_nearest
from hypcheck.truth.tilted import prove as tilted_prove
from hypcheck.truth.tilted import roots as tilted_roots
from hypcheck.truth.tilted.exact import TiltedDecision
from hypcheck.truth.tilted.pair import TiltedPair
from hypcheck.vectors import frozen
from hypcheck.vectors.families import TILTED_FAMILIES
from hypcheck.vectors.family import Family
from hypcheck.vectors.tilted.format import TiltedVector


@dataclass(frozen=True, slots=True)
class Opinion:
    """An oracle's opinion about one pair; None where it has none. `stage` names the part of the oracle that decided."""

    position: Position | None
    tangent: bool | None = None
    kind: str | None = None
    stage: str = ""


@dataclass(frozen=True, slots=True)
class Oracle:
    """An oracle: `ask` maps rows (n, 7) to n opinions; `available` gives the reason why it cannot run here, or None.

    `ask_tilted` maps rows (n, 10) of tilted spheroids to n opinions.
    """

    name: str
    title: str
    ask: Callable[[Rows], Sequence[Opinion]]
    ask_tilted: Callable[[Rows], Sequence[Opinion]]
    available: Callable[[], str | None] = lambda: None


def ask_exact(rows: Rows) -> list[Opinion]:
    """The exact decision with a checked certificate; a decision without a valid proof counts as undecided."""
    opinions = []
    for row in rows.tolist():
        pair = Pair.from_row(row)
        decision = exact.decide(pair.lengths)
        found = prove.prove(pair, decision)
        proved = found.position is decision.position and certificate.check_certificate(pair, found)
        opinions.append(_if_proved(decision.position, decision.tangent, decision.kind.value, proved=proved))
    return opinions


def _if_proved(position: Position, tangent: bool, kind: str | None, *, proved: bool) -> Opinion:
    return Opinion(position, tangent, kind, "proved") if proved else Opinion(None, stage="certificate refused")


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


def ask_exact_tilted(rows: Rows) -> list[Opinion]:
    """As ask_exact, of tilted spheroids."""
    opinions = []
    for row in rows.tolist():
        pair = TiltedPair.from_row(row)
        decision = tilted_exact.decide(pair.lengths)
        found = tilted_prove.prove(pair, decision)
        proved = found.position is decision.position and tilted_certificate.check_certificate(pair, found)
        opinions.append(_if_proved(decision.position, decision.tangent, None, proved=proved))
    return opinions


def ask_nearest_tilted(rows: Rows) -> list[Opinion]:
    """The sign of the clearance to the nearest point, in intervals of more and more bits until they decide."""
    found = [tilted_nearest.nearest(TiltedPair.from_row(row)) for row in rows.tolist()]
    return [Opinion(each.position, each.tangent, None, f"{each.bits} bits") for each in found]


def ask_roots_tilted(rows: Rows) -> list[Opinion]:
    """The pattern of the roots of the quartic det(S + λH) beside its poles."""
    reports = [tilted_roots.classify_tilted_by_roots(TiltedPair.from_row(row)) for row in rows.tolist()]
    return [Opinion(report.position, report.tangent, None, "root pattern") for report in reports]


def ask_mesh_tilted(rows: Rows) -> list[Opinion]:
    """FCL's distance to meshes of lines of the hyperboloid, the spheroid being the unit ball; undecided in its band."""
    found = [tilted_mesh.position(TiltedPair.from_row(row)) for row in rows.tolist()]
    return [Opinion(each, stage="undecided" if each is None else "clear" if each else "contact") for each in found]


ORACLES = {
    oracle.name: oracle
    for oracle in (
        Oracle("exact", "exact decision in integers, with a checked certificate", ask_exact, ask_exact_tilted),
        Oracle("nearest", "nearest point of the hyperboloid", ask_nearest, ask_nearest_tilted),
        Oracle(
            "roots",
            "root patterns after [10], re-derived; its text was not consulted",
            ask_roots,
            ask_roots_tilted,
        ),
        Oracle("mesh", "FCL on two one-sided meshes", ask_mesh, ask_mesh_tilted, mesh.availability),
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


@dataclass(frozen=True)
class TiltedBatch:
    """Frozen vectors of one family of tilted spheroids: rows (n, 10), ids, and their proved labels."""

    family: Family
    rows: Rows
    decisions: tuple[TiltedDecision, ...]
    ids: tuple[str, ...]

    def name(self, index: int) -> str:
        """The id of a case."""
        return self.ids[index]


Batch = FamilyBatch | TiltedBatch


def tilted_batches(plan: SelfCheckPlan) -> tuple[TiltedBatch, ...]:
    """The frozen vectors of all families of tilted spheroids but the extreme one; none where families were chosen."""
    families = () if plan.families else tuple(each for each in TILTED_FAMILIES.values() if not each.extreme)
    return tuple(_tilted_batch(family, plan.count) for family in families)


def _tilted_batch(family: Family, count: int) -> TiltedBatch:
    cases = frozen.load_tilted(family.name).cases[:count]
    return TiltedBatch(
        family,
        np.asarray([case.row for case in cases]),
        tuple(TiltedDecision(case.position, _limit_of(case)) for case in cases),
        tuple(case.id for case in cases),
    )


def _limit_of(case: TiltedVector) -> Position | None:
    """The clear position that a tangency touches from, by the sign of its double root."""
    root = case.witness.double_root
    return None if root is None else Position.EXTERIOR if root > 0 else Position.INTERIOR


def oracle_tasks(plan: SelfCheckPlan, all_batches: Sequence[Batch]) -> list[OracleTask]:
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
    oracle = ORACLES[task.oracle]
    if task.rows.shape[1] > len(COLUMNS):
        return list(oracle.ask_tilted(task.rows)), time.perf_counter() - started
    opinions = list(oracle.ask(task.rows))
    if task.oracle == "roots":
        rule = answering(FORMULAS["coefficients"], EXACT)
        opinions = [
            _unless_rule_differs(opinion, rule(dict(zip(COLUMNS, row, strict=True))))
            for row, opinion in zip(task.rows.tolist(), opinions, strict=True)
        ]
    return opinions, time.perf_counter() - started


def _unless_rule_differs(opinion: Opinion, rule: int) -> Opinion:
    """The opinion, unless the coefficient rule in exact rationals reads another position from the coefficients."""
    if opinion.position == rule:
        return opinion
    return Opinion(opinion.position, opinion.tangent, opinion.kind, f"coefficient rule says {Position(rule).label}")


def compare_with_exact(task: OracleTask, opinions: Sequence[Opinion], batch: Batch, seconds: float) -> OracleTally:
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


def _difference(batch: Batch, index: int, opinion: Opinion) -> tuple[str, str] | None:
    """The exact decision and the opinion in words if they contradict each other, else None."""
    decision = batch.decisions[index]
    kind = decision.kind.value if isinstance(decision, exact.Decision) else None
    said = f"{decision.position.label}, tangent: {decision.tangent}{'' if kind is None else f', {kind}'}"
    if opinion.stage.startswith("coefficient rule") or opinion.stage == "certificate refused":
        return said, opinion.stage
    if opinion.position is None:
        return None
    same = opinion.position is decision.position
    same &= opinion.tangent in (None, decision.tangent) and opinion.kind in (None, kind)
    return None if same else (said, f"{opinion.position.label}, tangent: {opinion.tangent}, {opinion.kind}")


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
