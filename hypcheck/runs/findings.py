"""The plan and the cases of a self-check, the errors of formulas on them, and the map of the cooling tower.

A mathematical finding is an error in exact rationals, where only the formula can be wrong. Each known finding has a
reason. A complete run fails if a finding is not known, or if a known finding does not occur.

The map shows exact positions over the half plane (r, z), and the errors of a method in low precision. It shows the
ring: at z = 0, far outside the surface, the discriminant vanishes, and a plain evaluation answers "contact" though both
bodies are far apart (docs/mathematics.md, "The ring").
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import msgspec
import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, Formula, answering
from hypcheck.geometry.pair import COLUMNS, Pair
from hypcheck.geometry.rows import Positions, Rows
from hypcheck.implementations.domain import EVERYWHERE
from hypcheck.implementations.method import Method
from hypcheck.implementations.session import Answered
from hypcheck.record.lines import FindingLine, GroupLine, MapLine
from hypcheck.runs import judge, tally
from hypcheck.runs.cases import CaseChunk
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion
from hypcheck.runs.score import rows_asked, score
from hypcheck.truth import exact, float_filter
from hypcheck.truth.exact import Decision
from hypcheck.truth.kinds import Kind
from hypcheck.truth.pencil import cubic
from hypcheck.vectors.draw import Family


@dataclass(frozen=True, slots=True)
class SelfCheckPlan:
    """Options of a self-check.

    `families` are names and globs (none: all families but the extreme ones). The exact and the nearest-point oracle
    decide `count` rows of each family, and every method answers the first `judged` of these. The roots and the mesh
    oracle, which are slow, decide `roots` and `meshes` rows in total; by default the roots oracle decides all upright
    rows. Every formula is evaluated in exact arithmetic on `exact_formulas` rows of each family. `workers` processes
    evaluate the oracles; 1 means this process.
    """

    families: tuple[str, ...] = ()
    oracles: tuple[str, ...] = ("exact", "nearest", "roots", "heights", "mesh")
    count: int = 400
    judged: int = 400
    seed: int = 1
    roots: int = 22_000
    meshes: int = 2000
    exact_formulas: int = 60
    workers: int = 2
    tolerance: Fraction = DEFAULT_TOLERANCE

    @property
    def complete(self) -> bool:
        """Whether this run has at least the cases of the default plan, so that its findings must be the known ones."""
        default = SelfCheckPlan()
        enough = min(self.count, self.exact_formulas) >= default.exact_formulas
        return enough and (self.families, self.seed) == (default.families, default.seed)


@dataclass(frozen=True)
class Batch:
    """Cases of one family with their rows and exact decisions."""

    chunk: CaseChunk
    rows: Rows
    decisions: tuple[Decision, ...]

    @cached_property
    def positions(self) -> Positions:
        """The exact positions, int8 (n,)."""
        return np.array([decision.position for decision in self.decisions], dtype=np.int8)

    def head(self, count: int) -> Batch:
        """Return the first `count` cases."""
        return Batch(self.chunk.between(0, min(count, len(self.rows))), self.rows[:count], self.decisions[:count])


def batch_of(family: Family, seed: int, start: int, stop: int) -> Batch:
    """Return the cases of one family from `start` to `stop` − 1, decided exactly."""
    rows = np.ascontiguousarray(family.columns_between(seed, start, stop).T)
    decisions = tuple(exact.decide(Pair.from_row(row).lengths) for row in rows.tolist())
    return Batch(CaseChunk(family.name, seed, start, stop), rows, decisions)


def mathematical_findings(formula: Formula, batch: Batch, plan: SelfCheckPlan) -> list[FindingLine]:
    """Find a formula's errors in exact rationals on the first rows of a family.

    Return a line for each cause, inside and outside the regimes of the formula.

    The lines have no reason yet. Their key `asked` counts all tested rows inside or outside the regimes.
    """
    head = batch.head(plan.exact_formulas)
    answer = answering(formula, EXACT)
    answers = [answer(dict(zip(COLUMNS, row, strict=True))) for row in head.rows.tolist()]
    inside = replace(EVERYWHERE, regimes=formula.regimes).holds(head.rows)
    wrong: dict[tuple[bool, str], list[int]] = {}
    for place in np.flatnonzero(judge.is_wrong(head.positions, np.array(answers), formula.question)).tolist():
        wrong.setdefault((bool(inside[place]), cause(batch, place)), []).append(place)
    return [
        FindingLine(
            formula=formula.name,
            family=batch.chunk.family,
            inside=side,
            cause=why,
            asked=int((inside == side).sum()),
            wrong=len(places),
            first_case=batch.chunk.name(places[0]),
            first_row=tuple(value.hex() for value in batch.rows[places[0]].tolist()),
            reason=None,
        )
        for (side, why), places in sorted(wrong.items())
    ]


def cause(batch: Batch, place: int) -> str:
    """Return the property of a case that is the likely cause of an error, because printed statements seldom treat it.

    It is "ring", "zero-coefficient" or "none known".
    """
    decision = batch.decisions[place]
    if decision.kind is Kind.EXTERIOR_RING:
        return "ring"
    g = cubic(Pair.from_row(batch.rows[place].tolist()).lengths)
    if g.n2 == 0 or g.n1 == 0:
        return "zero-coefficient"
    return "none known"


def exact_formulas() -> list[Formula]:
    """Return the formulas whose only input is a pair, so that exact arithmetic can evaluate them."""
    return [formula for formula in FORMULAS.values() if formula.classifies_pairs]


def method_group(method: Method, batch: Batch, exponents: NDArray[np.float64], plan: SelfCheckPlan) -> GroupLine:
    """Judge one method on one family, and return the record's line.

    `exponents` are floor(log2) of the distance to the nearest other position, for all rows of the batch.
    """
    tolerance = Fraction(0) if method.exact else plan.tolerance
    criterion = Criterion(method.question, method.precision, tolerance)
    inside, left_out = rows_asked(batch.rows, batch.chunk.family, criterion, method.domain)
    places = inside[: method.max_rows]
    rows = batch.rows[places]
    scored = score(rows, batch.positions[places], Answered.of(method.answer(rows)), criterion)
    tallied = scored.tally(batch.chunk, places, exponents[places], left_out=left_out)
    return tally.group_line(
        tallied, batch.chunk.family, criterion, method=method.name, title=method.title, exact=method.exact
    )


@dataclass(frozen=True, slots=True)
class KnownFinding:
    """An expected finding: the formula errs inside its stated regimes for this cause, at least on these families."""

    formula: str
    cause: str
    families: tuple[str, ...]
    reason: str


def known_findings() -> tuple[KnownFinding, ...]:
    """Return the known findings in the list that hypcheck installs."""
    return msgspec.convert(toml.shipped("hypcheck.runs", "known_findings.toml")["finding"], tuple[KnownFinding, ...])


def reason_for(finding: FindingLine, known: Iterable[KnownFinding]) -> str | None:
    """Return the reason of a known finding; None if it is unknown, or outside the regimes of the formula."""
    if not finding.inside:
        return None
    matching = (entry.reason for entry in known if (entry.formula, entry.cause) == (finding.formula, finding.cause))
    return next(matching, None)


def finding_drift(lines: Sequence[FindingLine], known: Sequence[KnownFinding], *, complete: bool) -> list[str]:
    """Return a sentence for each difference between the findings and the known ones.

    A difference is an error inside the stated regimes that is not known or, in a complete run, a known error that did
    not occur.
    """
    unknown = [line for line in lines if line.inside and reason_for(line, known) is None]
    sentences = [
        f"{line.formula} errs on {line.family} inside its stated regimes (cause: {line.cause}), which is not a known "
        f"finding; see {line.first_case}"
        for line in unknown
    ]
    seen = {(line.formula, line.cause, line.family) for line in lines if line.inside}
    listed = [(entry.formula, entry.cause, family) for entry in known for family in entry.families] if complete else []
    sentences += [
        f"{formula} no longer errs on {family} (cause: {cause}), but is listed as a known finding"
        for formula, cause, family in listed
        if (formula, cause, family) not in seen
    ]
    return sentences


LETTERS = {1: "e", 0: "c", -1: "i"}
"""The letter of a grid point: exterior, contact, interior; upper case if the method is wrong there."""


@dataclass(frozen=True, slots=True)
class MapPanel:
    """A rectangle of the half plane (r, z) in metres, with `columns` × `lines` grid points."""

    name: str
    sizes: tuple[float, float, float, float]
    r: tuple[float, float]
    z: tuple[float, float]
    columns: int
    lines: int


TOWER = (2.0, 17.8, 0.25, 0.15)


def tower_panels() -> tuple[MapPanel, MapPanel]:
    """Return the panel of the whole cooling tower, and the panel of the surroundings of its ring.

    With a = α/b and c = γ/d the radius of the ring is b √((c² + 1)(a² + c²))/c.
    """
    alpha, gamma, b, d = TOWER
    a, c = alpha / b, gamma / d
    ring = b * np.sqrt((c * c + 1) * (a * a + c * c)) / c
    whole = MapPanel("cooling tower", TOWER, (0.0, 34.0), (-17.8, 17.8), 341, 179)
    near = MapPanel("the ring", TOWER, (ring - 0.03, ring + 0.03), (-0.03, 0.03), 121, 121)
    return whole, near


def map_line(panel: MapPanel, method: Method) -> MapLine:
    """Judge a method on the grid of a panel, and return the record's line: letters for each z, from the lowest up."""
    rows = _grid(panel)
    truth = float_filter.positions(rows)
    wrong = judge.is_wrong(truth, method.answer(rows), method.question)
    letters = np.array([LETTERS[position] for position in truth.tolist()])
    letters[wrong] = np.char.upper(letters[wrong])
    return MapLine(
        name=panel.name,
        method=method.name,
        sizes=panel.sizes,
        r=panel.r,
        z=panel.z,
        wrong=int(wrong.sum()),
        points=len(rows),
        lines=["".join(line) for line in letters.reshape(panel.lines, panel.columns).tolist()],
    )


def _grid(panel: MapPanel) -> Rows:
    """Return the rows of the grid points of a panel: x is r, y is 0."""
    r = np.linspace(*panel.r, panel.columns)
    z = np.linspace(*panel.z, panel.lines)
    rows = np.zeros((panel.columns * panel.lines, 7))
    rows[:, :4] = panel.sizes
    rows[:, 4] = np.tile(r, panel.lines)
    rows[:, 6] = np.repeat(z, panel.columns)
    return rows
