"""The five oracles behind one interface, and the cross-check that compares each with the exact decision.

An oracle maps rows to opinions; an opinion may be undecided. The roots oracle is also compared with the repaired
coefficient rule in exact rationals. Rows with tilted spheroids or with hyperboloids that end come from frozen vectors,
whose positions are proved. If the hyperboloid ends, the roots oracle is not used, and the nearest-point oracle takes
the least value on the wall and the discs; its bounds may leave the position undecided.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, answering
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import PAIRS, Rows
from hypcheck.record.fields import row_fields
from hypcheck.record.lines import DisagreementPart, OracleLine
from hypcheck.runs.cases import CaseChunk
from hypcheck.runs.findings import Batch, SelfCheckPlan
from hypcheck.truth import exact, least, mesh, mesh_oracle, nearest_rows, roots, sections
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import STAGES
from hypcheck.truth.prove import prove
from hypcheck.vectors import frozen
from hypcheck.vectors.cases import Vector
from hypcheck.vectors.draw import Family
from hypcheck.vectors.families import ENDED_FAMILIES, TILTED_FAMILIES


@dataclass(frozen=True, slots=True)
class Opinion:
    """An oracle's opinion about one pair. `position` is None if undecided; `stage` names the part that decided.

    `tangent` and `kind` are None if the oracle does not determine them.
    """

    position: Position | None
    tangent: bool | None = None
    kind: str | None = None
    stage: str = ""


@dataclass(frozen=True, slots=True)
class Oracle:
    """An oracle: `ask` maps rows (n, 7), (n, 10) or (n, 13) to n opinions.

    `available` gives the reason why it cannot run here, or None.
    """

    ask: Callable[[Rows], Sequence[Opinion]]
    available: Callable[[], str | None] = lambda: None


def _each(opinion_of: Callable[[list[float]], Opinion]) -> Callable[[Rows], list[Opinion]]:
    """Return a function of rows that calls the given function for one row at a time."""
    return lambda rows: [opinion_of(row) for row in rows.tolist()]


_REFUSED = Opinion(None, stage="certificate refused")


def _exact(row: list[float]) -> Opinion:
    """Decide a row exactly, and check the certificate; a decision without a valid proof counts as undecided."""
    pair = Pair.from_row(row)
    decision = exact.decide(pair.lengths)
    certificate = prove(pair, decision)
    if certificate == Certificate(Position.CONTACT):
        return Opinion(decision.position, decision.tangent, stage="by the exact rule")
    proved = certificate.position is decision.position and check_certificate(pair, certificate)
    return Opinion(decision.position, decision.tangent, _name_of_kind(decision), "proved") if proved else _REFUSED


def _name_of_kind(decision: Decision) -> str | None:
    return None if decision.kind is None else decision.kind.value


def _nearest(rows: Rows) -> list[Opinion]:
    """Decide rows by the sign of the clearance.

    Floats with an error bound come first, then exact enclosures, narrowed until they decide. If the hyperboloid ends,
    branch and bound finds the least value on the wall and the discs.
    """
    if PAIRS.has_heights(rows):
        return [Opinion(least.position(Pair.from_row(row)), stage="least value") for row in rows.tolist()]
    decided = nearest_rows.positions(np.ascontiguousarray(rows))
    values = zip(decided.position.tolist(), decided.tangent.tolist(), decided.stage.tolist(), strict=True)
    return [Opinion(Position(position), tangent, None, STAGES[stage]) for position, tangent, stage in values]


def _roots(row: list[float]) -> Opinion:
    """Decide a row by the pattern of the pencil's roots and poles, re-derived after [10], whose text was not consulted.

    For an upright pair the coefficient rule in exact rationals must give the same position.
    """
    pair = Pair.from_row(row)
    decided = roots.classify_by_roots(pair)
    if decided.kind is None:
        return Opinion(decided.position, decided.tangent, None, "root pattern")
    rule = _coefficient_rule()(dict(zip(COLUMNS, pair.upright.row, strict=True)))
    stage = "signs suffice" if decided.literal is not None else "signs are ambiguous"
    if decided.position != rule:
        stage = f"{_RULE} says {Position(rule).label}"
    return Opinion(decided.position, decided.tangent, decided.kind.value, stage)


_RULE = "coefficient rule"


@cache
def _coefficient_rule() -> Callable[[Mapping[str, float]], int]:
    """Return the repaired coefficient rule in exact rationals: a function from columns by name to the position."""
    return answering(FORMULAS["coefficients"], EXACT)


def _heights(row: list[float]) -> Opinion:
    """Decide by the real roots of a polynomial in the height: whether the surfaces meet in some horizontal plane."""
    return Opinion(sections.position(Pair.from_row(row)), stage="rule in the height")


def _mesh(row: list[float]) -> Opinion:
    """Decide a row by FCL's distances to two meshes with the hyperboloid between them; undecided between the meshes."""
    verdict = mesh_oracle.verdict(Pair.from_row(row))
    return Opinion(verdict.position, stage=verdict.outcome.value)


ORACLES = {
    "exact": Oracle(_each(_exact)),
    "nearest": Oracle(_nearest),
    "roots": Oracle(_each(_roots)),
    "heights": Oracle(_each(_heights)),
    "mesh": Oracle(_each(_mesh), available=mesh.availability),
}


def frozen_families(plan: SelfCheckPlan) -> tuple[Family, ...]:
    """Return the families whose frozen vectors are tested: all with tilted spheroids or with hyperboloids that end.

    Extreme families are not among them; if the plan chooses families, the result is empty.
    """
    every = (*TILTED_FAMILIES.values(), *ENDED_FAMILIES.values())
    return () if plan.families else tuple(family for family in every if family.frozen and not family.extreme)


def frozen_batch(family: Family, count: int) -> Batch:
    """Return the first `count` frozen vectors of such a family."""
    cases = frozen.load(family.name).cases[:count]
    decisions = tuple(Decision(case.position, _limit_of(case)) for case in cases)
    return Batch(CaseChunk(family.name, None, 0, len(cases)), np.asarray([case.row for case in cases]), decisions)


def _limit_of(case: Vector) -> Position | None:
    """Return the clear position of which a tangency is the limit; None if the case is no tangency.

    The sign of the double root in its certificate decides; without a double root the exact rule does.
    """
    root = case.witness.double_root
    if root is None:
        return exact.decide(Pair.from_row(case.row).lengths).limit_of if case.tangent else None
    return Position.EXTERIOR if root > 0 else Position.INTERIOR


TILTED_ROOTS = 10
"""A tilted row, whose matrices and roots take longer, counts as so many upright ones where roots are counted."""


def shares(plan: SelfCheckPlan, family: Family, families: Sequence[Family]) -> dict[str, int]:
    """Return, for each oracle of the plan, the number of cases of `family` that it decides in a run of `families`."""
    tilted, ended = "axis" in family.groups, "heights" in family.groups
    with_roots = sum("heights" not in other.groups for other in families)
    roots = 0 if ended else -(-plan.roots // (with_roots * (TILTED_ROOTS if tilted else 1)))
    every = {
        "exact": plan.count,
        "nearest": plan.count,
        "roots": roots,
        "heights": min(roots, plan.count) if tilted and not ended else plan.count,
        "mesh": -(-plan.meshes // len(families)),
    }
    return {name: every[name] for name in plan.oracles}


def oracle_lines(batch: Batch, shares: Mapping[str, int]) -> list[OracleLine]:
    """Ask each oracle about the first cases of a batch, up to its number in `shares`, and return the record's lines."""
    parts = ((oracle, batch.rows[: max(0, share - batch.chunk.start)]) for oracle, share in shares.items())
    return [_oracle_line(oracle, batch, rows) for oracle, rows in parts if len(rows)]


def _oracle_line(oracle: str, batch: Batch, rows: Rows) -> OracleLine:
    """Ask an oracle about these rows of a batch, compare its opinions with the exact decisions, and return the line."""
    started = time.perf_counter()
    opinions = ORACLES[oracle].ask(rows)
    seconds = time.perf_counter() - started
    differences = [_difference(batch, index, opinion) for index, opinion in enumerate(opinions)]
    disagreements = [
        DisagreementPart(
            oracle=oracle,
            case=batch.chunk.name(index),
            **row_fields(rows[index].tolist()),
            exact=words[0],
            opinion=words[1],
        )
        for index, words in enumerate(differences)
        if words is not None
    ]
    return OracleLine(
        oracle=oracle,
        family=batch.chunk.family,
        asked=len(opinions),
        undecided=sum(opinion.position is None for opinion in opinions),
        stages=dict(sorted(Counter(opinion.stage for opinion in opinions).items())),
        seconds=seconds,
        disagreeing=len(disagreements),
        disagreements=sorted(disagreements, key=lambda disagreement: disagreement.case)[:DISAGREEMENTS_KEPT],
    )


def merged_lines(lines: Iterable[OracleLine]) -> list[OracleLine]:
    """Add the lines about the same oracle and family. The result is sorted by both, whatever the order of the lines."""
    parts: dict[tuple[str, str], list[OracleLine]] = {}
    for line in lines:
        parts.setdefault((line.oracle, line.family), []).append(line)
    return [_sum(parts[key]) for key in sorted(parts)]


def _sum(parts: Sequence[OracleLine]) -> OracleLine:
    """Add lines about the same oracle and family."""
    stages: Counter[str] = Counter()
    for part in parts:
        stages.update(part.stages)
    disagreements = (disagreement for part in parts for disagreement in part.disagreements)
    return OracleLine(
        oracle=parts[0].oracle,
        family=parts[0].family,
        asked=sum(part.asked for part in parts),
        undecided=sum(part.undecided for part in parts),
        stages=dict(sorted(stages.items())),
        seconds=sum(part.seconds for part in parts),
        disagreeing=sum(part.disagreeing for part in parts),
        disagreements=sorted(disagreements, key=lambda disagreement: disagreement.case)[:DISAGREEMENTS_KEPT],
    )


DISAGREEMENTS_KEPT = 20
"""The most disagreements of one oracle on one family that the record keeps."""


def _difference(batch: Batch, index: int, opinion: Opinion) -> tuple[str, str] | None:
    """Return the exact decision and the opinion, in words, if they contradict each other; else None."""
    decision = batch.decisions[index]
    kind = _name_of_kind(decision)
    exact_words = f"{decision.position.label}, tangent: {decision.tangent}{'' if kind is None else f', {kind}'}"
    if opinion.stage.startswith(_RULE) or opinion == _REFUSED:
        return exact_words, opinion.stage
    if opinion.position is None:
        return None
    same = opinion.position is decision.position
    same &= opinion.tangent in (None, decision.tangent) and (None in (opinion.kind, kind) or opinion.kind == kind)
    return None if same else (exact_words, f"{opinion.position.label}, tangent: {opinion.tangent}, {opinion.kind}")
