"""One run of bench: find its requirements, judge, measure, compare; each result goes into the record at once."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from hypcheck.bench import accuracy, error_maps, forest, scene, speed, targets
from hypcheck.bench.accuracy import MethodAnswers, WorkloadTruth, chosen_workloads
from hypcheck.bench.baseline import Baseline, alike, comparisons, gated, read_baseline, require_common, speeds_of
from hypcheck.bench.c_library import compiled
from hypcheck.bench.contenders import COMPILER, Contender, ForeignMethod, contenders, foreign_method
from hypcheck.bench.plan import PASSAGE, BenchPlan
from hypcheck.bench.workloads import scene_of, tilted_scenes
from hypcheck.errors import Exit, InputError, NothingJudgedError, RunOutcome, UnavailableError
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.meshes import ENGINES, FCL
from hypcheck.implementations.session import StartError
from hypcheck.processes import Advance, Stage, perform, processes, usable_processors
from hypcheck.record import Recorder, RecordLine, measurements
from hypcheck.record.lines import NotStartedLine
from hypcheck.scene.reading import shipped_scenes


def stages(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome) -> Sequence[Stage]:
    """Return the stages of the run in order. Raises InputError naming a choice that does not exist."""
    if plan.kernel:
        return (Stage("the fast path", targets.steps(), lambda advance: _kernel(plan, recorder, outcome, advance)),)
    if plan.forest:
        return (_forest(plan, recorder, outcome),)
    tilted_movers = tilted_scenes(plan.scenes)
    if plan.scenes and not tilted_movers and not plan.tilted:
        if plan.chosen:
            raise InputError("--scene measures only scenes; other choices are allowed only if its mover is tilted")
        return (_scenes(plan, plan.scenes, recorder, outcome),)
    plan = _tilted_plan(plan, tilted_movers)
    workloads = chosen_workloads(plan)
    before = read_baseline(plan)
    plan = plan_with_needs(plan_with_specs(plan, recorder), recorder)  # a wrong SPEC is refused before C is compiled
    if len(plan.foreign) < len(plan.specs):
        outcome.codes.add(Exit.NOT_STARTED)
    if before is not None:
        plan = replace(plan, foreign=alike(before, plan.foreign))
    run = MethodsRun(plan, recorder, outcome, contenders(plan))
    if before is not None:
        require_common(before, gated(plan, run.contenders))
    return (
        Stage("methods", 1, run.introduce),
        Stage("answers", len(workloads) + len(run.contenders), run.judge),
        *(run.map_stages if plan.everyday else ()),
        Stage("speed", plan.processes, run.measure),
        *([] if before is None else [Stage("baseline", 1, lambda advance: run.compare(before, advance))]),
        *(run.mesh_and_memory_stages if plan.everyday else ()),
        *([_scenes(plan, shipped_scenes(), recorder, outcome), _forest(plan, recorder, outcome)] if plan.whole else []),
    )


def _tilted_plan(plan: BenchPlan, tilted_movers: Sequence[str]) -> BenchPlan:
    """Return the plan, about tilted spheroids if its scene's mover is tilted.

    Raises InputError if there are more scenes.
    """
    if not plan.scenes:
        return plan
    if not tilted_movers:
        raise InputError(f"--tilted measures tilted movers; the mover of the scene {plan.scenes[0]!r} is not")
    if len(plan.scenes) > 1:
        raise InputError(
            f"the mover of the scene {tilted_movers[0]!r} is tilted; measure that scene alone, with one --scene"
        )
    return replace(plan, tilted=True)


def plan_with_needs(plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    """Return the plan with the available methods and the missing requirements, which are also recorded.

    Raises InputError naming a method that does not exist.
    """
    for need in sorted({contender.needs for contender in contenders(plan).values()} - {""}):
        if need == COMPILER:
            try:
                library, compiler = compiled(plan.folder)
                recorder.add(compiler)
                plan, trouble = replace(plan, compiled=library), None
            except UnavailableError as error:
                trouble = str(error)
        else:
            trouble = ENGINES[need].trouble()
        if trouble is not None:
            note_absent(recorder, need, trouble)
            plan = replace(plan, missing=(*plan.missing, need))
    return plan


def plan_with_specs(plan: BenchPlan, recorder: Recorder) -> BenchPlan:
    """Return the plan with the methods of its SPECs; those that cannot be started are recorded instead.

    Raises InputError if a text is not a SPEC.
    """
    methods: list[ForeignMethod] = []
    for spec in plan.specs:
        try:
            used_names = [*contenders(plan), *(method.name for method in methods)]
            layout = QUESTIONS[plan.question].layout
            methods.append(foreign_method(spec, plan.limits, used_names, tilted=plan.tilted, layout=layout))
        except StartError as error:  # noqa: PERF203 - a process is started in each turn
            recorder.add(NotStartedLine(spec=spec, name=spec, trouble=str(error)))
    return replace(plan, foreign=tuple(methods))


def note_absent(recorder: Recorder, what: str, reason: str) -> None:
    """Record once that something is not available, and why."""
    if not any(isinstance(line, measurements.AbsentLine) and line.what == what for line in recorder.lines):
        recorder.add(measurements.AbsentLine(what=what, reason=reason))


def governor() -> str | None:
    """Return the governor of the processor's frequency, if the system reports it.

    Unless it is "performance", times vary.
    """
    with suppress(OSError):
        return Path("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor").read_text(encoding="utf-8").strip()
    return None


def load() -> tuple[float, float, float] | None:
    """Return the system's load, if it reports that: the mean number of runnable processes over 1, 5 and 15 minutes."""
    with suppress(OSError, AttributeError):
        short, middle, long = (round(average, 2) for average in os.getloadavg())
        return short, middle, long
    return None


def codes_of(lines: Iterable[RecordLine]) -> set[Exit]:
    """Yield the exit codes for a run with these lines of kernels, forests, scenes: wrong answers, missed targets."""
    codes = set()
    for line in lines:
        if isinstance(line, measurements.KernelLine) and not line.met:
            codes.add(Exit.SLOWER)
        elif (isinstance(line, measurements.ForestLine) and line.exact and line.wrong) or (
            isinstance(line, measurements.SceneLine) and line.wrong
        ):
            codes.add(Exit.WRONG)
    return codes


def _kernel(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome, advance: Advance) -> None:
    """Measure the targets of the fast path's speed."""
    targets.run(recorder, advance, plan.quick)
    outcome.codes |= codes_of(recorder.lines)


def _forest(plan: BenchPlan, recorder: Recorder, outcome: RunOutcome) -> Stage:
    """Return the stage that measures a walker's step."""

    def measure(advance: Advance) -> None:
        forest.run(recorder, advance, plan.seed, sizes, forest.QUICK_ROUNDS if plan.quick else forest.ROUNDS)
        outcome.codes |= codes_of(recorder.lines)
        if (trouble := FCL.trouble()) is not None:
            note_absent(recorder, FCL.title, trouble)

    sizes = forest.sizes(plan)
    return Stage("forest", len(sizes), measure)


def _scenes(plan: BenchPlan, names: Sequence[str], recorder: Recorder, outcome: RunOutcome) -> Stage:
    """Return the stage that measures the kernels of these scenes."""

    def measure(advance: Advance) -> None:
        try:
            rounds = scene.QUICK_ROUNDS if plan.quick else scene.ROUNDS
            scene.run_scenes(plans, recorder, advance, plan.folder, rounds)
        except UnavailableError as error:
            note_absent(recorder, COMPILER, str(error))
        outcome.codes |= codes_of(recorder.lines)
        if plan.scenes and not any(isinstance(line, measurements.SceneLine) for line in recorder.lines):
            reasons = [line.reason for line in recorder.lines if isinstance(line, measurements.AbsentLine)]
            raise NothingJudgedError(f"no scene was measured: {'; '.join(reasons)}")

    plans = scene.plans_of(names)
    return Stage("scenes", len(plans), measure)


@dataclass
class MethodsRun:
    """A run that compares methods: its stages, and the data that they share."""

    plan: BenchPlan
    recorder: Recorder
    outcome: RunOutcome
    contenders: dict[str, Contender]
    answers: list[MethodAnswers] = field(default_factory=list)
    speeds: list[RecordLine] = field(default_factory=list)

    @property
    def map_stages(self) -> Sequence[Stage]:
        """The stages with maps, for positions of upright spheroids; they follow the judging of answers."""
        maps = len(error_maps.stability_methods(self.contenders)) + len(error_maps.place_methods(self.contenders))
        shapes = any(contender.kind == "bounding" for contender in self.contenders.values())
        bounding = [Stage("bounding volumes", 1, self.bound)] if shapes else []
        return [Stage("maps", maps, self.draw_maps), *bounding]

    @property
    def mesh_and_memory_stages(self) -> Sequence[Stage]:
        """The stages with meshes and memory, for positions of upright spheroids; they come last."""
        stages = []
        if any(contender.needs == FCL.title for contender in self.contenders.values()):
            stages.append(Stage("meshes", error_maps.convergence_steps(self.plan), self.refine))
        if self.plan.amounts.memory:
            stages.append(Stage("memory", len(self.timed), self.weigh))
        return stages

    @property
    def timed(self) -> list[str]:
        """The methods that are timed."""
        return [name for name, contender in self.contenders.items() if not contender.accuracy_only]

    def introduce(self, advance: Advance) -> None:
        """Record the methods and the workloads."""
        names = ("title", "tier", "kind", "precision", "question", "exact", "amortised", "accuracy_only", "note")
        for contender in self.contenders.values():
            self.recorder.add(
                measurements.MethodLine(method=contender.name, **{name: getattr(contender, name) for name in names})
            )
        for workload in chosen_workloads(self.plan):
            count = self.plan.amounts.timed if workload.timed else workload.judged(self.plan)
            rows = workload.rows(self.plan.seed, count)
            self.recorder.add(
                measurements.WorkloadLine(
                    workload=workload.name,
                    title=workload.title,
                    text=workload.text,
                    rows=len(rows),
                    seed=self.plan.seed,
                    timed=workload.timed,
                    scene=scene_of(rows, workload.layout),
                )
            )
        advance(1)

    def judge(self, advance: Advance) -> None:
        """Let all methods answer all workloads, and judge the answers."""
        truths: dict[str, WorkloadTruth] = {}
        with processes(self.plan.workers) as executor:
            for truth in accuracy.workload_truths(self.plan, executor):
                truths[truth.workload.name] = truth
                advance(1)
            slowest_first = sorted(self.contenders, key=lambda name: self.contenders[name].timed or math.inf)
            tasks = [(self.plan, name) for name in slowest_first]  # these take longest
            for _, answered in perform(accuracy.method_answers, tasks, executor):
                self.answers += answered
                advance(1)
        methods, workloads = list(self.contenders), list(truths)
        self.answers.sort(
            key=lambda method_answers: (workloads.index(method_answers.workload), methods.index(method_answers.method))
        )
        for method_answers in self.answers:
            self._judge(method_answers, truths[method_answers.workload])

    def _judge(self, method_answers: MethodAnswers, truth: WorkloadTruth) -> None:
        """Record how right a method's answers to a workload are."""
        contender = self.contenders[method_answers.method]
        if method_answers.trouble:
            self.recorder.add(
                measurements.RefusedLine(
                    method=method_answers.method,
                    workload=method_answers.workload,
                    mode="batch",
                    reason=method_answers.trouble,
                )
            )
            self.outcome.codes.add(Exit.WRONG)
        if len(method_answers.places):
            tried = accuracy.FEW_TRIED if self.plan.quick and self.plan.question == PASSAGE else accuracy.WORST_TRIED
            line = accuracy.accuracy_line(contender, method_answers, truth, tried)
            self.recorder.add(line)
            if contender.exact and (line.wrong or line.abstained):
                self.outcome.codes.add(Exit.WRONG)

    def draw_maps(self, advance: Advance) -> None:
        """Record the maps of the methods that have maps, in the order of the methods."""
        maps: tuple[tuple[Callable[[tuple[BenchPlan, str]], Sequence[RecordLine]], list[str]], ...] = (
            (error_maps.stability_lines, error_maps.stability_methods(self.contenders)),
            (error_maps.place_lines, error_maps.place_methods(self.contenders)),
        )
        with processes(self.plan.workers) as executor:
            for lines_of, names in maps:
                lines_by_name = {}
                for (_, name), lines in perform(lines_of, [(self.plan, name) for name in names], executor):
                    lines_by_name[name] = lines
                    advance(1)
                for line in (line for name in names for line in lines_by_name[name]):
                    self.recorder.add(line)

    def bound(self, advance: Advance) -> None:
        """Record how often simpler shapes than the spheroid give wrong answers."""
        for line in error_maps.bounding_lines(self.plan):
            self.recorder.add(line)
        advance(1)

    def measure(self, advance: Advance) -> None:
        """Time all methods, and the claims about costs."""
        before = load()
        measured = speed.measurements_of(self.plan, speed.expected_prints(self.answers), advance)
        self.recorder.add(
            measurements.ConditionsLine(
                governor=governor(), processors=usable_processors(), load_before=before, load_after=load()
            )
        )
        for line in speed.speed_lines(measured, self.plan.reference):
            self.recorder.add(line)
            self.speeds.append(line)
            if isinstance(line, measurements.RefusedLine):
                self.outcome.codes.add(Exit.WRONG)
        for claim in speed.cost_lines(self.plan, measured):
            self.recorder.add(claim)

    def compare(self, baseline: Baseline, advance: Advance) -> None:
        """Compare the speeds with a baseline."""
        codes = {"slower": Exit.SLOWER, "inconclusive": Exit.INCONCLUSIVE}
        names, compared = gated(self.plan, self.contenders), False
        for line in comparisons(self.plan, baseline, speeds_of(self.speeds), names):
            self.recorder.add(line)
            compared |= line.gates
            if line.gates and line.verdict in codes:
                self.outcome.codes.add(codes[line.verdict])
        if not compared:
            self.outcome.codes.add(Exit.INCONCLUSIVE)  # no compared method was timed by both runs
        advance(1)

    def refine(self, advance: Advance) -> None:
        """Record errors and times of finer and finer meshes."""
        for line in error_maps.convergence_lines(self.plan):
            self.recorder.add(line)
            advance(1)

    def weigh(self, advance: Advance) -> None:
        """Record the memory of each method that is timed."""
        for line in accuracy.memory_lines(self.plan, self.timed):
            self.recorder.add(line)
            advance(1)
