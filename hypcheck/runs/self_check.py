"""The self-check: derive, prove, cross-check, judge, draw, time; each result goes into the record at once.

Derivation, oracles, formulas and methods are tasks of one list, which several processes perform. After them, when no
task runs, the fast path is timed and compared with the plain formula, general-purpose roots and FCL, on the cooling
tower.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from hypcheck.errors import Exit, RunOutcome
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, Columns, Rows
from hypcheck.implementations.alternatives import delta_with_powers, numpy_roots
from hypcheck.implementations.builtin import builtin, fast_scene, methods, trouble_with
from hypcheck.implementations.meshes import naive_fcl, shared_meshes
from hypcheck.implementations.method import Answers, Method
from hypcheck.processes import Advance, Stage, in_order
from hypcheck.record import Recorder, lines
from hypcheck.record.lines import FindingLine, GroupLine, OracleLine, TimingLine
from hypcheck.runs import findings, oracles
from hypcheck.runs.findings import KnownFinding, SelfCheckPlan, batch_of
from hypcheck.runs.judge import Status
from hypcheck.runs.oracles import ORACLES
from hypcheck.runs.timing import Samples, TimingEntry, clocked, measure
from hypcheck.truth.backward_error import flip_exponents
from hypcheck.vectors.families import ALL, FAMILIES, select

if TYPE_CHECKING:
    from hypcheck.derivation.printed_equations import EquationCheck
    from hypcheck.derivation.proofs import Proof

WORKLOAD = "tower-body"
TIMED_ROWS = 100_000
FAST, PLAIN = "fast path", "plain numpy formula"


def timing_entry(method: Method, rows: Rows) -> TimingEntry:
    """Return the entry that times a method on these rows, the first `max_rows` of them."""
    part = rows[: method.max_rows]
    return TimingEntry(method.name, len(part), clocked(lambda: method.answer(part)))


def timed_rows(seed: int) -> Rows:
    """Return rows with uniform positions in the box around the cooling tower; all have the tower's sizes."""
    return FAMILIES[WORKLOAD].rows(seed, TIMED_ROWS)


def timed_methods(*, meshes: bool) -> list[Method]:
    """Return the methods to time, slow ones on fewer rows. FCL is loaded only with `meshes`."""
    methods = [
        Method(FAST, "certified floats, integers where they cannot tell; exact", _fast),
        Method(PLAIN, "Table 2 as one writes it in numpy; not certified", _plain),
        Method(
            "numpy.roots",
            "eigenvalues of the companion matrix, one call a row; not certified",
            numpy_roots,
            max_rows=200,
        ),
    ]
    if meshes and ORACLES["mesh"].available() is None:
        methods += [
            Method(
                "FCL point-mesh and building its mesh",
                "distance to a mesh of 2,000 triangles, built for each row",
                partial(naive_fcl, pairing="point"),
                max_rows=12,
            ),
            Method(
                "FCL certified and building its meshes",
                "two one-sided meshes, built for each row; contact or clear only",
                _mesh,
                max_rows=60,
            ),
        ]
    return methods


def timing_line(method: Method, timing: Samples) -> TimingLine:
    """Return the record's line about one timed method."""
    return TimingLine(
        workload=WORKLOAD,
        median_ns=timing.median_ns,
        name=timing.name,
        title=method.title,
        rows=timing.rows,
        loops=timing.loops,
        samples_ns=timing.samples_ns,
        checksum=timing.checksum,
    )


def _scene(rows: Rows) -> tuple[Sizes, Columns]:
    """Return the sizes of rows that share them, and the columns of their centres."""
    alpha, gamma, b, d = rows[0, :4].tolist()
    return (alpha, gamma, b, d), (rows[:, 4], rows[:, 5], rows[:, 6])


def _fast(rows: Rows) -> Answers:
    """Answer with the fast path, the kernel for one scene."""
    sizes, center = _scene(rows)
    return fast_scene(sizes, *center)


def _plain(rows: Rows) -> Answers:
    """Answer by the paper's Table 2 in numpy: Procedure 1 with the repaired interior condition."""
    sizes, center = _scene(rows)
    delta, c1, c2 = delta_with_powers(sizes, *center)
    return np.where(delta > 0, np.where((c2 < 0) & (c1 > 0), 1, -1), 0).astype(np.int8)


def _mesh(rows: Rows) -> Answers:
    """Answer with the mesh oracle; CANNOT_SAY where it is undecided."""
    opinions = ORACLES["mesh"].ask(rows)
    return np.array(
        [CANNOT_SAY if opinion.position is None else opinion.position for opinion in opinions], dtype=np.int8
    )


TIMING_ROUNDS = 9
"""Enough rounds for a median that one disturbed round does not change."""

MESH = "mesh"
"""The oracle that needs FCL; without it FCL is not loaded."""


def _done(task: Callable[[], object]) -> Any:  # noqa: ANN401 - of each task another type
    """Perform a task, and return its result; a task needs no other data of the run."""
    return task()


Derivation = tuple[Sequence["EquationCheck"], Sequence["Proof"]]


def derivation() -> Derivation:
    """Check the equations of the paper and prove the formulas; return the checks and the proofs."""
    from hypcheck.derivation import printed_equations, proofs  # noqa: PLC0415 - loads sympy, in one process

    return printed_equations.check_equations(), proofs.prove_formulas()


CASES = 400
"""The number of cases of one task: few enough that all processes end at about the same time."""


@dataclass(frozen=True, slots=True)
class FamilyLines:
    """The record's lines about cases of one family: errors of formulas, tallies of methods, opinions of oracles."""

    findings: list[FindingLine]
    groups: list[GroupLine]
    oracles: list[OracleLine]


def frozen_lines(family: str, plan: SelfCheckPlan, shares: Mapping[str, int]) -> FamilyLines:
    """Return the lines about the frozen vectors of a family of tilted spheroids, or of hyperboloids that end."""
    return FamilyLines([], [], oracles.oracle_lines(oracles.frozen_batch(ALL[family], plan.count), shares))


def upright_lines(family: str, start: int, stop: int, plan: SelfCheckPlan, shares: Mapping[str, int]) -> FamilyLines:
    """Test a family's cases `start` to `stop` − 1, and return the lines.

    Formulas and methods are tested only if `start` is 0, on the first cases.
    """
    batch = batch_of(FAMILIES[family], plan.seed, start, stop)
    opinions = oracles.oracle_lines(batch, shares)
    if start:
        return FamilyLines([], [], opinions)
    finding_lines = [
        finding
        for formula in findings.exact_formulas()
        for finding in findings.mathematical_findings(formula, batch, plan)
    ]
    head = batch.head(plan.judged)
    exponents = flip_exponents(head.rows)
    with shared_meshes():
        groups = [findings.method_group(method, head, exponents, plan) for method in methods_of(plan)]
    return FamilyLines(finding_lines, groups, opinions)


def family_tasks(plan: SelfCheckPlan) -> list[Callable[[], FamilyLines]]:
    """Return the tasks of all families. Tasks of frozen vectors come first, because their rows take longest.

    Raises InputError naming a family that does not exist.
    """
    upright, frozen = select(plan.families), oracles.frozen_families(plan)
    shares = {family.name: oracles.shares(plan, family, (*upright, *frozen)) for family in (*upright, *frozen)}
    first = max(CASES, plan.judged, plan.exact_formulas)
    starts = (0, *range(first, plan.count, CASES))
    ranges = list(zip(starts, (*starts[1:], plan.count), strict=True))
    return [
        *(partial(frozen_lines, family.name, plan, shares[family.name]) for family in frozen),
        *(
            partial(upright_lines, family.name, *cases, plan, shares[family.name])
            for cases in ranges
            for family in upright
        ),
    ]


def methods_of(plan: SelfCheckPlan) -> tuple[Method, ...]:
    """Return the built-in methods that are judged; those that measure meshes only if the plan asks the mesh oracle."""
    judged = (method for method in methods().values() if not method.measured)
    meshes = MESH in plan.oracles
    return tuple(method for method in judged if not method.needs or (meshes and trouble_with(method) is None))


@dataclass
class SelfCheck:
    """One self-check: its plan, the record that it writes, and its outcome.

    `derive` derives the formulas, and `known` are the known findings.
    """

    plan: SelfCheckPlan
    recorder: Recorder
    outcome: RunOutcome
    derive: Callable[[], Derivation] = derivation
    known: Sequence[KnownFinding] = field(default_factory=findings.known_findings)

    def stages(self) -> tuple[Stage, ...]:
        """Return the stages of the run in order; the record says which oracles are not available.

        Raises InputError naming a family that does not exist.
        """
        tasks = [self.derive, *family_tasks(self._with_available_oracles())]
        return (
            Stage("deriving, asking, judging", len(tasks), lambda advance: self._perform(tasks, advance)),
            Stage("map", 2, self._draw),
            Stage("timing", TIMING_ROUNDS, self._time),
        )

    def _with_available_oracles(self) -> SelfCheckPlan:
        """Return the plan without the oracles that cannot run here; record why they cannot."""
        reasons = {name: ORACLES[name].available() for name in self.plan.oracles}
        for name, reason in reasons.items():
            if reason is not None:
                self.recorder.add(lines.UnavailableLine(oracle=name, reason=reason))
        return replace(self.plan, oracles=tuple(name for name, reason in reasons.items() if reason is None))

    def _perform(self, tasks: Sequence[Callable[[], Any]], advance: Advance) -> None:
        """Perform the tasks, in several processes if the plan has workers; record their results in the tasks' order."""
        recorded: list[FindingLine] = []
        opinions: list[OracleLine] = []
        with closing(in_order(_done, tasks, self.plan.workers, 0, ahead=len(tasks))) as results:
            self._record_derivation(*next(results))
            advance(1)
            for made in results:
                recorded += self._record_family(made)
                opinions += made.oracles
                advance(1)
        self._record_drift(recorded)
        self._record_oracles(opinions)

    def _record_derivation(self, equations: Sequence[EquationCheck], proofs: Sequence[Proof]) -> None:
        """Record the checked equations and the proofs; a proof that does not hold sets the exit code."""
        for equation in equations:
            self.recorder.add(lines.EquationLine(**asdict(equation)))
        for proof in proofs:
            self.recorder.add(lines.ProofLine(**asdict(proof)))
            if not proof.holds:
                self.outcome.codes.add(Exit.ORACLES_DISAGREE)

    def _record_family(self, made: FamilyLines) -> list[FindingLine]:
        """Record a family's lines; return its findings, those that are known with their reasons."""
        known = [msgspec.structs.replace(line, reason=findings.reason_for(line, self.known)) for line in made.findings]
        for line in (*known, *made.groups):
            self.recorder.add(line)
        if any(line.exact and set(line.counts) - {Status.RIGHT.value, Status.SKIPPED.value} for line in made.groups):
            self.outcome.codes.add(Exit.WRONG)
        return known

    def _record_drift(self, recorded: Sequence[FindingLine]) -> None:
        """Record how the findings differ from the known ones; a difference sets the exit code."""
        for sentence in findings.finding_drift(recorded, self.known, complete=self.plan.complete):
            self.recorder.add(lines.DriftLine(sentence=sentence))
            self.outcome.codes.add(Exit.WRONG)

    def _record_oracles(self, opinions: Iterable[OracleLine]) -> None:
        """Record the lines about the oracles; a disagreement sets the exit code."""
        for line in oracles.merged_lines(opinions):
            self.recorder.add(line)
            if line.disagreeing:
                self.outcome.codes.add(Exit.ORACLES_DISAGREE)

    def _draw(self, advance: Advance) -> None:
        """Record the map of the cooling tower."""
        for panel in findings.tower_panels():
            self.recorder.add(findings.map_line(panel, builtin("table-2-float32")))
            advance(1)

    def _time(self, advance: Advance) -> None:
        """Time the methods, and record the times."""
        rows, methods = timed_rows(self.plan.seed), timed_methods(meshes=MESH in self.plan.oracles)
        timings = measure([timing_entry(method, rows) for method in methods], TIMING_ROUNDS, advance=advance)
        for method, timing in zip(methods, timings, strict=True):
            self.recorder.add(timing_line(method, timing))


def options(plan: SelfCheckPlan) -> Mapping[str, Any]:
    """Return the plan as the record's header has it."""
    return {**asdict(plan), "tolerance": float(plan.tolerance)}
