"""One run of bench: judge, measure, compare; each result goes into the record at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from hypcheck.bench import accuracy, error_maps, forest, scene, speed, targets
from hypcheck.bench.accuracy import MethodAnswers, WorkloadTruth, chosen_workloads
from hypcheck.bench.baseline import Baseline, alike, comparisons, gated, read_baseline, require_common, speeds_of
from hypcheck.bench.contender import Contender
from hypcheck.bench.contenders import contenders
from hypcheck.bench.needs import governor, load, needs_met, plan_with_needs
from hypcheck.bench.plan import PASSAGE, BenchPlan
from hypcheck.bench.workloads import leaning_scenes, scene_of
from hypcheck.errors import Exit, InputError, NothingJudgedError, RunOutcome
from hypcheck.implementations.meshes import FCL
from hypcheck.processes import Advance, Stage, perform, processes, usable_processors
from hypcheck.record import Recorder, RecordLine
from hypcheck.record.measurements import (
    AbsentLine,
    ConditionsLine,
    ForestLine,
    KernelLine,
    MethodLine,
    RefusedLine,
    SceneLine,
    WorkloadLine,
)
from hypcheck.scene.reading import shipped_scenes


@dataclass
class _Run:
    """The values that the stages of a run share."""

    plan: BenchPlan
    recorder: Recorder
    outcome: RunOutcome
    found: dict[str, Contender]
    answers: list[MethodAnswers] = field(default_factory=list)
    baseline: Baseline | None = None
    speeds: list[RecordLine] = field(default_factory=list)

    @property
    def timed(self) -> list[str]:
        """The methods that are timed."""
        return [name for name, each in self.found.items() if not each.accuracy_only]

    @property
    def meshes(self) -> bool:
        """Whether FCL is compared."""
        return any(each.needs == FCL.title for each in self.found.values())

    @property
    def shapes(self) -> bool:
        """Whether other shapes than the spheroid are compared."""
        return any(each.kind == "bounding" for each in self.found.values())


def stages(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome) -> Sequence[Stage]:
    """The stages of the run in order. Raises InputError naming a choice that does not exist."""
    if plan.kernel:
        return (Stage("the fast path", targets.steps(), lambda advance: _kernel(plan, recorder, outcome, advance)),)
    if plan.forest:
        return (_forest(plan, recorder, outcome),)
    leaning = leaning_scenes(plan.scenes)
    if plan.scenes and not leaning and not plan.tilted:
        if plan.chosen:
            raise InputError("--scene measures only scenes; other choices are allowed only if its mover leans")
        return (_scenes(plan, plan.scenes, recorder, outcome),)
    plan = _tilted_plan(plan, leaning)
    workloads = len(chosen_workloads(plan))
    before = read_baseline(plan)
    plan = needs_met(plan_with_needs(plan, recorder), recorder)
    if len(plan.foreign) < len(plan.specs):
        outcome.codes.add(Exit.NOT_STARTED)
    if before is not None:
        plan = replace(plan, foreign=alike(before, plan.foreign))
    run = _Run(plan, recorder, outcome, contenders(plan), baseline=before)
    if before is not None:
        require_common(before, gated(plan, run.found))
    return (
        Stage("methods", 1, lambda advance: _introduce(run, advance)),
        Stage("answers", workloads + len(run.found), lambda advance: _judge(run, advance)),
        *(_map_stages(run) if plan.everyday else ()),
        Stage("speed", plan.processes, lambda advance: _measure(run, advance)),
        Stage("baseline", 0 if before is None else 1, lambda advance: _compare(run, advance)),
        *(_mesh_and_memory_stages(run) if plan.everyday else ()),
        *([_scenes(plan, shipped_scenes(), recorder, outcome), _forest(plan, recorder, outcome)] if plan.whole else []),
    )


def _map_stages(run: _Run) -> Sequence[Stage]:
    maps = len(error_maps.stability_methods(run.found)) + len(error_maps.place_methods(run.found))
    return (
        Stage("maps", maps, lambda advance: _map(run, advance)),
        Stage("bounding volumes", 1, lambda advance: _bound(run, advance)),
    )


def _mesh_and_memory_stages(run: _Run) -> Sequence[Stage]:
    meshes = error_maps.convergence_steps(run.plan) if run.meshes else 0
    return (
        Stage("meshes", meshes, lambda advance: _refine(run, advance)),
        Stage("memory", len(run.timed) if run.plan.amounts.memory else 0, lambda advance: _weigh(run, advance)),
    )


def _tilted_plan(plan: BenchPlan, leaning: Sequence[str]) -> BenchPlan:
    """The plan of a run about one scene that leans, or any other plan. Raises InputError for more scenes than one."""
    if not plan.scenes:
        return plan
    if not leaning:
        raise InputError(f"--tilted measures movers that lean; the mover of the scene {plan.scenes[0]!r} does not")
    if len(plan.scenes) > 1:
        raise InputError(f"the mover of the scene {leaning[0]!r} leans; measure that scene alone, with one --scene")
    return replace(plan, tilted=True)


def _forest(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome) -> Stage:
    def measure(advance: Advance) -> None:
        forest.run(recorder, advance, plan.seed, sizes, quick=plan.quick)
        for line in recorder.lines:
            if isinstance(line, ForestLine) and line.exact and line.wrong:
                outcome.codes.add(Exit.WRONG)

    sizes = forest.sizes(plan)
    return Stage("forest", len(sizes), measure)


def _scenes(plan: BenchPlan, names: Sequence[str], recorder: Recorder, outcome: RunOutcome) -> Stage:
    def measure(advance: Advance) -> None:
        scene.run_scenes(plans, recorder, advance, plan.folder, quick=plan.quick)
        measured = [line for line in recorder.lines if isinstance(line, SceneLine)]
        if any(line.wrong for line in measured):
            outcome.codes.add(Exit.WRONG)
        if plan.scenes and not measured:
            reasons = [line.reason for line in recorder.lines if isinstance(line, AbsentLine)]
            raise NothingJudgedError(f"no scene was measured: {'; '.join(reasons)}")

    plans = scene.plans_of(names)
    return Stage("scenes", len(plans), measure)


def _kernel(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome, advance: Advance) -> None:
    targets.run(recorder, advance, plan.quick)
    for line in recorder.lines:
        if isinstance(line, KernelLine) and not line.met:
            outcome.codes.add(Exit.SLOWER)


def _introduce(run: _Run, advance: Advance) -> None:
    for each in run.found.values():
        run.recorder.add(introduction(each))
    for workload in chosen_workloads(run.plan):
        count = run.plan.amounts.timed if workload.timed else workload.judged(run.plan)
        rows = workload.rows(run.plan.seed, count)
        run.recorder.add(
            WorkloadLine(
                workload=workload.name,
                title=workload.title,
                text=workload.text,
                rows=len(rows),
                seed=run.plan.seed,
                timed=workload.timed,
                scene=scene_of(rows, workload.layout),
            )
        )
    advance(1)


def introduction(contender: Contender) -> MethodLine:
    """The record's line that introduces a method."""
    names = ("title", "tier", "kind", "precision", "question", "exact", "amortised", "accuracy_only", "note")
    return MethodLine(method=contender.name, **{name: getattr(contender, name) for name in names})


def _judge(run: _Run, advance: Advance) -> None:
    truths: dict[str, WorkloadTruth] = {}
    with processes(run.plan.workers) as executor:
        for truth in accuracy.workload_truths(run.plan, executor):
            truths[truth.workload.name] = truth
            advance(1)
        slowest_first = sorted(run.found, key=lambda name: run.found[name].timed or math.inf)  # they take longest
        tasks = [(run.plan, name) for name in slowest_first]
        for _, answered in perform(accuracy.method_answers, tasks, executor):
            run.answers += answered
            advance(1)
    tried = accuracy.FEW_TRIED if run.plan.quick and run.plan.question == PASSAGE else accuracy.WORST_TRIED
    methods, workloads = list(run.found), list(truths)
    run.answers.sort(key=lambda each: (workloads.index(each.workload), methods.index(each.method)))
    for each in run.answers:
        if each.trouble:
            run.recorder.add(RefusedLine(method=each.method, workload=each.workload, mode="batch", reason=each.trouble))
            run.outcome.codes.add(Exit.WRONG)
        if not len(each.places):
            continue
        line = accuracy.accuracy_line(run.found[each.method], each, truths[each.workload], tried)
        run.recorder.add(line)
        if run.found[each.method].exact and (line.wrong or line.abstained):
            run.outcome.codes.add(Exit.WRONG)


def _map(run: _Run, advance: Advance) -> None:
    with processes(run.plan.workers) as executor:
        bins = list(
            _counted(error_maps.stability_lines(run.plan, error_maps.stability_methods(run.found), executor), advance)
        )
        maps = list(_counted(error_maps.place_lines(run.plan, error_maps.place_methods(run.found), executor), advance))
    order = list(run.found).index
    for line in sorted(bins, key=lambda each: order(each.method)):
        run.recorder.add(line)
    for found in sorted(maps, key=lambda each: order(each[0].method)):
        for line in found:
            run.recorder.add(line)


def _bound(run: _Run, advance: Advance) -> None:
    if run.shapes:
        for line in error_maps.bounding_lines(run.plan):
            run.recorder.add(line)
    advance(1)


def _measure(run: _Run, advance: Advance) -> None:
    before = load()
    found = speed.measurements_of(run.plan, speed.expected_prints(run.answers), advance)
    run.recorder.add(
        ConditionsLine(governor=governor(), processors=usable_processors(), load_before=before, load_after=load())
    )
    for line in speed.speed_lines(found, run.plan.reference):
        run.recorder.add(line)
        run.speeds.append(line)
        if isinstance(line, RefusedLine):
            run.outcome.codes.add(Exit.WRONG)
    for claim in speed.cost_lines(run.plan, found):
        run.recorder.add(claim)


def _compare(run: _Run, advance: Advance) -> None:
    if run.baseline is not None:
        names, compared = gated(run.plan, run.found), False
        for line in comparisons(run.plan, run.baseline, speeds_of(run.speeds), names):
            run.recorder.add(line)
            compared |= line.gates
            if line.gates and line.verdict == "slower":
                run.outcome.codes.add(Exit.SLOWER)
            if line.gates and line.verdict == "inconclusive":
                run.outcome.codes.add(Exit.INCONCLUSIVE)
        if not compared:
            run.outcome.codes.add(Exit.INCONCLUSIVE)  # both runs timed nothing that is held to the baseline
        advance(1)


def _refine(run: _Run, advance: Advance) -> None:
    if run.meshes:
        for line in _counted(error_maps.convergence_lines(run.plan), advance):
            run.recorder.add(line)


def _weigh(run: _Run, advance: Advance) -> None:
    if run.plan.amounts.memory:
        for line in _counted(accuracy.memory_lines(run.plan, run.timed), advance):
            run.recorder.add(line)


def _counted(found: Iterable[Any], advance: Advance) -> Iterable[Any]:
    for each in found:
        advance(1)
        yield each
