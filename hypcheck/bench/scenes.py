"""What leaving out saves in whole scenes: the share that each stage decided, and the time against what keeps all.

A scene is asked evenly over its region, each pair of sizes alike. Beside its kernel in C stand Table 2 as printed, in
C, which proves nothing, and the certified kernel that `hypcheck.classify_scene` runs; all in one thread, once by a call
for many rows and once by a call for each, as who flies or walks asks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders.c_library import InC, compiled, place_of
from hypcheck.bench.contenders.c_tier import COMPILER
from hypcheck.bench.needs import note_absent
from hypcheck.bench.rounds import Clocked, Entry, clocked, measure
from hypcheck.bench.scene import rows_of
from hypcheck.bench.scene_kernel import built
from hypcheck.bench.statistics import estimate, ratios
from hypcheck.errors import UnavailableError
from hypcheck.kernel.classify import classify_scene
from hypcheck.kernel.emission.telling import PRINTED
from hypcheck.kernel.question import Question
from hypcheck.kernel.specialise.plan import Plan, Stages, plan_of
from hypcheck.kernel.specialise.sampling import COUNT
from hypcheck.record import Recorder
from hypcheck.record.measurements import Scene as SceneLine
from hypcheck.record.measurements import SceneTimes, Shares
from hypcheck.rows import CANNOT_SAY, Positions, Rows
from hypcheck.scene.reading import read_scene

ROUNDS, QUICK_ROUNDS = 11, 5
ROWS = 2**17
"""About how many rows a scene is asked; a setting has its sample's 4096 at least."""

CERTIFIED = "fast"
"""The certified kernel's name among the methods in C."""

STAGES = ("always", "thresholds", "lines", "discriminant", "search")

Advance = Callable[[int], object]


def plans_of(names: Sequence[str]) -> list[Plan]:
    """The plans of scenes by their names; raises InputError for what is no scene, or has no kernel."""
    return [plan_of(read_scene(name)) for name in names]


def run(plans: Sequence[Plan], recorder: Recorder, advance: Advance, folder: Path, *, quick: bool) -> Iterator[str]:
    """Add a line for each scene; yields a sentence about each whose kernel answered wrongly."""
    try:
        methods, _ = compiled(folder)
        for number, plan in enumerate(plans):
            line = _line(plan, methods, folder / f"scene-{number}", QUICK_ROUNDS if quick else ROUNDS)
            recorder.add(line)
            if line.wrong:
                yield f"the kernel of the scene {plan.scene.name!r} answers {line.wrong:,} rows wrongly"
            advance(1)
    except UnavailableError as error:
        note_absent(recorder, COMPILER, str(error))


def _line(plan: Plan, methods: Path, folder: Path, rounds: int) -> SceneLine:
    tables, kernel = _tables(plan), built(plan, folder)
    rows = np.concatenate(tables)
    batch, single, certified = kernel.batch(tables), kernel.single(rows), _certified(plan, tables)
    exact = certified()
    wrong = int((_wrong(batch(), exact) | _wrong(single(), exact)).sum())
    printed = InC(methods, place_of(f"{PRINTED}-{plan.format.name}"))
    batches = {
        "kernel": clocked(batch),
        "printed": _all_of([printed.batch(each).run for each in tables]),
        "certified": clocked(certified),
    }
    singles = {
        "kernel": clocked(single),
        "printed": printed.single(rows).run,
        "certified": InC(methods, place_of(CERTIFIED)).single(rows).run,
    }
    return SceneLine(
        scene=plan.scene.name,
        question=plan.question,
        precision=plan.format.name,
        settings=len(plan.settings),
        rows=len(rows),
        wrong=wrong,
        shares=Shares(**shares(plan.settings)),
        batch=_times(batches, len(rows), rounds),
        single=_times(singles, len(rows), rounds),
    )


def _times(asked: Mapping[str, Clocked], count: int, rounds: int) -> SceneTimes:
    """Nanoseconds a row of each, and how long the kernel takes for each of the others'."""
    *_, (_, samples) = measure([Entry(name, count, run) for name, run in asked.items()], rounds)
    own, *others = samples
    found: dict[str, Any] = {f"{each.name}_ns": each.median_ns for each in samples}
    for other in others:
        ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
        found |= {f"by_{other.name}": ratio.median, f"by_{other.name}_ci95": (ratio.low, ratio.high)}
    return SceneTimes(**found)


def shares(settings: Sequence[Stages]) -> dict[str, float]:
    """What share of the scene's queries each stage decides, each pair of sizes asked alike."""
    return {name: float(np.mean([each.shares.get(name, 0.0) for each in settings])) for name in STAGES}


def _tables(plan: Plan) -> list[Rows]:
    """The rows of each setting."""
    times = max(1, ROWS // (COUNT * max(1, len(plan.settings))))
    return [rows_of(stages, times) for stages in plan.settings]


def _certified(plan: Plan, tables: Sequence[Rows]) -> Callable[[], Positions]:
    """The kernel of classify_scene, exact, asked the same."""
    question = cast("Question", plan.question)
    found = np.zeros(sum(map(len, tables)), dtype=np.int8)
    calls, start = [], 0
    for rows in tables:
        alpha, gamma, b, d = rows[0, :4].tolist()
        x, y, z = (np.ascontiguousarray(column) for column in rows[:, 4:].T)
        calls.append(((alpha, gamma, b, d), x, y, z, found[start : start + len(rows)]))
        start += len(rows)

    def work() -> Positions:
        for sizes, x, y, z, part in calls:
            classify_scene(sizes, x, y, z, part, question=question, threads=1)
        return found

    return work


def _all_of(parts: Sequence[Clocked]) -> Clocked:
    """The work of all parts, one after the other, as one."""

    def run(repeat: int) -> tuple[int, int]:
        done = [part(repeat) for part in parts]
        return sum(took for took, _ in done), sum(total for _, total in done)

    return run


def _wrong(said: Positions, exact: Positions) -> NDArray[np.bool_]:
    """The rows that the kernel answers otherwise than is exact; "cannot say" is no wrong answer."""
    return np.asarray((said != exact) & (said != CANNOT_SAY))
