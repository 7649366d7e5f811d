"""One run of bench: judge, measure, compare; everything goes into the record as it comes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from hypcheck.bench import accuracy, speed
from hypcheck.bench.accuracy import Answered, Known, chosen_workloads
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.needs import prepared
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import scene_of
from hypcheck.processes import processes
from hypcheck.record import Recorder

Advance = Callable[[int], object]


@dataclass
class BenchOutcome:
    """What decides how the run ends: sentences for the exit codes 5, 1, 3 and 4."""

    not_started: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)
    slower: list[str] = field(default_factory=list)
    inconclusive: list[str] = field(default_factory=list)

    @property
    def exit_code(self) -> int:
        """The first that applies of 5, 1, 3 and 4; else 0."""
        reasons = ((self.not_started, 5), (self.wrong, 1), (self.slower, 3), (self.inconclusive, 4))
        return next((code for found, code in reasons if found), 0)


@dataclass(frozen=True)
class Stage:
    """A part of the run: its title for the progress bar, how many steps it has, and what does them."""

    title: str
    steps: int
    run: Callable[[Advance], None]


@dataclass
class _Run:
    """What the parts of a run hand on."""

    plan: BenchPlan
    recorder: Recorder
    outcome: BenchOutcome
    found: dict[str, Contender]
    answers: list[Answered] = field(default_factory=list)


def stages(plan: BenchPlan, recorder: Recorder, outcome: BenchOutcome) -> Sequence[Stage]:
    """The run's parts in order. Raises InputError where the plan names what does not exist."""
    workloads = len(chosen_workloads(plan))
    plan = prepared(plan, recorder)
    run = _Run(plan, recorder, outcome, contenders(plan))
    return (
        Stage("methods", 1, lambda advance: _introduce(run, advance)),
        Stage("answers", workloads + len(run.found), lambda advance: _judge(run, advance)),
        Stage("speed", plan.processes, lambda advance: _measure(run, advance)),
    )


def _introduce(run: _Run, advance: Advance) -> None:
    for each in run.found.values():
        run.recorder.add("method", **introduction(each))
    for workload in chosen_workloads(run.plan):
        rows = workload.rows(run.plan.seed, run.plan.amounts.timed)
        run.recorder.add(
            "workload",
            workload=workload.name,
            title=workload.title,
            text=workload.text,
            rows=run.plan.amounts.timed if workload.timed else run.plan.amounts.judged,
            seed=run.plan.seed,
            timed=workload.timed,
            scene=scene_of(rows),
        )
    advance(1)


def introduction(contender: Contender) -> dict[str, Any]:
    """The record's line about what a method is."""
    names = ("title", "tier", "kind", "precision", "question", "exact", "amortised", "accuracy_only", "note")
    return {"method": contender.name, **{name: getattr(contender, name) for name in names}}


def _judge(run: _Run, advance: Advance) -> None:
    with processes(run.plan.workers) as executor:
        truths: dict[str, Known] = {}
        for truth in accuracy.known(run.plan, executor):
            truths[truth.workload.name] = truth
            advance(1)
        for answered in accuracy.asked(run.plan, list(run.found), executor):
            run.answers += answered
            advance(1)
    order = {name: place for place, name in enumerate(run.found)}
    run.answers.sort(key=lambda each: (list(truths).index(each.workload), order[each.method]))
    for each in run.answers:
        if not len(each.places):
            continue
        line = accuracy.line(run.found[each.method], each, truths[each.workload])
        run.recorder.add("accuracy", **line)
        if run.found[each.method].exact and (line["wrong"] or line["abstained"]):
            run.outcome.wrong.append(f"{each.method} promises to be exact and is not, on {each.workload}")


def _measure(run: _Run, advance: Advance) -> None:
    found = speed.measured(run.plan, speed.expected(run.answers), advance)
    for kind, line in speed.lines(found):
        run.recorder.add(kind, **line)
        if kind == "refused":
            run.outcome.wrong.append(f"{line['method']}: {line['reason']}")
