"""What a step costs against the number of trees: lines "forest" of the record, all answers judged before the clock."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from time import perf_counter

from hypcheck.bench.forest.contenders import OURS, Clear, Walker, answers, here
from hypcheck.bench.forest.growth import Forest, forest_of, walk
from hypcheck.bench.needs import note_absent
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.rounds import Entry, Samples, clocked_calls, measure
from hypcheck.bench.statistics import estimate, ratios
from hypcheck.kernel.world.scene import Scene
from hypcheck.methods.engines import FCL
from hypcheck.record import Recorder
from hypcheck.record.measurements import Forest as ForestLine

TREES = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
MOST, QUICK_MOST = 100_000, 10_000
"""The largest forest of a run that measures all things, and of a quick one: FCL takes seconds to build the next."""

STEPS = 256
ROUNDS, QUICK_ROUNDS = 11, 5

Advance = Callable[[int], object]


def sizes(plan: BenchPlan) -> Sequence[int]:
    """How many trees the run's forests have."""
    most = QUICK_MOST if plan.quick else max(TREES) if plan.forest else MOST
    return tuple(trees for trees in TREES if trees <= most)


def run(recorder: Recorder, advance: Advance, seed: int, forests: Sequence[int], *, quick: bool) -> None:
    """Add a line for each forest, which has so many trees, and each of those that are asked."""
    for trees in forests:
        for line in _lines(forest_of(trees, seed), QUICK_ROUNDS if quick else ROUNDS, seed):
            recorder.add(line)
        advance(1)
    if (trouble := FCL.trouble()) is not None:
        note_absent(recorder, FCL.title, trouble)


def _lines(forest: Forest, rounds: int, seed: int) -> Iterator[ForestLine]:
    centres = walk(Scene(forest.model), forest, STEPS, seed)
    truth = [int(forest.clear(centre)) for centre in centres]
    made = {name: _made(each, forest) for name, each in here().items()}
    wrong = {
        name: sum(said != true for said, true in zip(answers(clear, centres), truth, strict=True))
        for name, (clear, _) in made.items()
    }
    entries = [Entry(name, STEPS, clocked_calls(clear, centres)) for name, (clear, _) in made.items()]
    *_, (_, samples) = measure(entries, rounds)
    ours = samples[0]
    for each in samples:
        built_s = made[each.name][1]
        yield _line(each, ours, here()[each.name], len(forest.places), built_s, wrong[each.name])


def _made(walker: Walker, forest: Forest) -> tuple[Clear, float]:
    """What answers, and the seconds it took to build; the list of trees is there before."""
    forest.model  # noqa: B018 - a property that is made once
    gc.collect()
    started = perf_counter()
    clear = walker.make(forest)
    return clear, perf_counter() - started


def _line(each: Samples, ours: Samples, walker: Walker, trees: int, built_s: float, wrong: int) -> ForestLine:
    step = estimate([each.samples_ns])
    ratio = estimate(ratios([each.samples_ns], [ours.samples_ns]))
    return ForestLine(
        method=each.name,
        title=walker.title,
        exact=each.name == OURS,
        trees=trees,
        triangles=walker.triangles,
        asked=STEPS,
        wrong=wrong,
        build_s=built_s,
        step_ns=step.median,
        ci95_ns=(step.low, step.high),
        ratio=ratio.median,
        ratio_ci95=(ratio.low, ratio.high),
    )
