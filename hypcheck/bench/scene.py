"""Kernels that are specialised for a scene: the time that each saves, and the share that each stage decides.

A scene's kernel in C as bench asks it: all centres by a call for each pair of sizes, or a call for each row.

What a plan saves in time: its kernel in C beside Table 2 as printed, in C too, on centres all over the region.

What leaving out saves in whole scenes: the share that each stage decided, and the time against what keeps all.

A scene is asked evenly over its region, each pair of sizes alike. Beside its kernel in C stand Table 2 as printed, in
C, which proves nothing, and the certified kernel that `hypcheck.classify_scene` runs; all in one thread, once by a call
for many rows and once by a call for each, as who flies or walks asks.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.c_library import InC, compile_c, compiled, place_of
from hypcheck.bench.contenders import COMPILER
from hypcheck.bench.needs import note_absent
from hypcheck.bench.timing import Clocked, Estimate, Samples, TimingEntry, clocked, estimate, measure, ratios
from hypcheck.errors import UnavailableError
from hypcheck.geometry.rows import CANNOT_SAY, Positions, Rows
from hypcheck.kernel.choice import Question
from hypcheck.kernel.classify import classify_scene
from hypcheck.kernel.emission.kernel import emitted
from hypcheck.kernel.emission.plan_text import PRINTED
from hypcheck.kernel.specialise.plan import ScenePlan, Stages, plan_of
from hypcheck.kernel.specialise.settings import COUNT, centres
from hypcheck.processes import Advance
from hypcheck.record import Recorder
from hypcheck.record.measurements import SceneLine, SceneTimes, Shares
from hypcheck.scene.reading import read_scene

_ONE_BY_ONE = """
void one_by_one(size_t n, const double *rows, int8_t *positions);
void one_by_one(size_t n, const double *rows, int8_t *positions)
{
    void (*volatile asked)(size_t, const double *, int8_t *) = hypcheck_classify;
    for (size_t i = 0; i < n; i++) asked(1, rows + 7 * i, positions + i);
}
"""
"""What a program in C does that has one question at a time; the compiler cannot see what it calls."""


@dataclass(frozen=True)
class SceneKernel:
    """The kernel, compiled and loaded."""

    library: ctypes.CDLL

    def batch(self, tables: Sequence[Rows]) -> Callable[[], Positions]:
        """Asks all rows by one call a table; the rows of a table have the same sizes."""
        found = np.zeros(sum(map(len, tables)), dtype=np.int8)
        kept, calls, start = [], [], 0
        for rows in tables:
            part = found[start : start + len(rows)]
            parts = (rows[0, :4].copy(), *np.ascontiguousarray(rows[:, 4:].T), part)
            pointers = [ctypes.c_void_p(each.ctypes.data) for each in parts]
            kept.append(parts)
            calls.append((pointers[0], ctypes.c_size_t(len(rows)), *pointers[1:]))
            start += len(rows)

        def work(_kept: object = kept) -> Positions:
            for call in calls:
                self.library.hypcheck_classify_scene(*call)
            return found

        return work

    def single(self, rows: Rows) -> Callable[[], Positions]:
        """Asks all rows by one call each, from C."""
        queries, found = np.ascontiguousarray(rows), np.zeros(len(rows), dtype=np.int8)
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (queries, found)]

        def work(_kept: object = queries) -> Positions:
            self.library.one_by_one(ctypes.c_size_t(len(found)), *pointers)
            return found

        return work


def compiled_kernel(plan: ScenePlan, folder: Path) -> SceneKernel:
    """The plan's kernel, made in a folder of its own. Raises UnavailableError where there is no C compiler."""
    folder.mkdir()
    code, library = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]) + _ONE_BY_ONE, encoding="utf-8")
    compile_c(code, library)
    return SceneKernel(ctypes.CDLL(str(library)))


KERNEL_ROUNDS = 11
REPEATED_CENTRES = 16
"""How often the sample's centres are laid end to end: 65,536 rows, which a branch predictor cannot learn by heart."""


@dataclass(frozen=True)
class KernelTimes:
    """Nanoseconds a centre, and how long the kernel takes for each of Table 2's."""

    kernel_ns: float
    printed_ns: float
    ratio: Estimate

    @classmethod
    def of(cls, own: Samples, other: Samples) -> KernelTimes:
        """From the samples of both."""
        return cls(own.median_ns, other.median_ns, estimate(ratios([own.samples_ns], [other.samples_ns])))

    @property
    def says(self) -> str:
        """The measurement in a sentence's part."""
        times = 1 / self.ratio.median
        how = f"{times:.2f} times as fast as" if times >= 1 else f"{self.ratio.median:.2f} times as slow as"
        return (
            f"{self.kernel_ns:.2f} ns a centre, {how} Table 2 as printed ({self.printed_ns:.2f} ns); "
            f"ratio {self.ratio.median:.3f}, 95 % interval {self.ratio.low:.3f} to {self.ratio.high:.3f}"
        )

    @property
    def fields(self) -> dict[str, Any]:
        """The measurement for programs."""
        return {
            "kernel_ns": self.kernel_ns,
            "printed_ns": self.printed_ns,
            "ratio": self.ratio.median,
            "ratio_ci95": [self.ratio.low, self.ratio.high],
        }


@dataclass(frozen=True)
class KernelSaving:
    """What one setting's kernel saves: by one call for many centres, and by a call for each."""

    stages: Stages
    rows: int
    batch: KernelTimes
    single: KernelTimes

    @property
    def says(self) -> str:
        """The measurement in sentences."""
        return f"In C, many by a call: {self.batch.says}. A call each: {self.single.says}."


def kernel_savings(plan: ScenePlan, folder: Path) -> Iterator[KernelSaving]:
    """Each setting of the plan, measured in turn. Raises UnavailableError where there is no C compiler."""
    methods, _ = compiled(folder)
    kernel, printed = compiled_kernel(plan, folder / "scene"), InC(methods, place_of(f"{PRINTED}-{plan.format.name}"))
    for stages in plan.settings:
        yield _kernel_saving(stages, kernel, printed)


def saving_fields(found: KernelSaving) -> dict[str, Any]:
    """The record's line about one setting."""
    return {
        "sizes": list(found.stages.setting.sizes),
        "uses": list(found.stages.setting.uses),
        "rows": found.rows,
        "shares": found.stages.shares,
        "batch": found.batch.fields,
        "single": found.single.fields,
        "says": found.says,
    }


def _kernel_saving(stages: Stages, kernel: SceneKernel, printed: InC) -> KernelSaving:
    rows = rows_of(stages)
    entries = [
        TimingEntry("kernel", len(rows), clocked(kernel.batch([rows]))),
        TimingEntry("printed", len(rows), printed.batch(rows).run),
        TimingEntry("kernel, one by one", len(rows), clocked(kernel.single(rows))),
        TimingEntry("printed, one by one", len(rows), printed.single(rows).run),
    ]
    *_, (_, samples) = measure(entries, KERNEL_ROUNDS)
    return KernelSaving(stages, len(rows), KernelTimes.of(*samples[:2]), KernelTimes.of(*samples[2:]))


def rows_of(stages: Stages, times: int = REPEATED_CENTRES) -> Rows:
    """The sample's centres so many times over, in random order."""
    x, y, z = centres(stages.setting)
    order = np.random.Generator(np.random.PCG64(1)).permutation(np.tile(np.arange(len(x)), times))
    sizes = [np.full(len(order), size) for size in stages.setting.sizes]
    return np.ascontiguousarray(np.column_stack([*sizes, x[order], y[order], z[order]]))


ROUNDS, QUICK_ROUNDS = 11, 5
ROWS = 2**17
"""About how many rows a scene is asked; a setting has its sample's 4096 at least."""

CERTIFIED = "fast"
"""The certified kernel's name among the methods in C."""

STAGES = ("always", "thresholds", "lines", "discriminant", "search")


def plans_of(names: Sequence[str]) -> list[ScenePlan]:
    """The plans of scenes by their names; raises InputError for what is no scene, or has no kernel."""
    return [plan_of(read_scene(name)) for name in names]


def run_scenes(
    plans: Sequence[ScenePlan], recorder: Recorder, advance: Advance, folder: Path, *, quick: bool
) -> Iterator[str]:
    """Add a line for each scene; yields a sentence about each whose kernel answered wrongly."""
    try:
        methods, _ = compiled(folder)
        for number, plan in enumerate(plans):
            line = _scene_line(plan, methods, folder / f"scene-{number}", QUICK_ROUNDS if quick else ROUNDS)
            recorder.add(line)
            if line.wrong:
                yield f"the kernel of the scene {plan.scene.name!r} answers {line.wrong:,} rows wrongly"
            advance(1)
    except UnavailableError as error:
        note_absent(recorder, COMPILER, str(error))


def _scene_line(plan: ScenePlan, methods: Path, folder: Path, rounds: int) -> SceneLine:
    tables, kernel = _tables(plan), compiled_kernel(plan, folder)
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
        shares=Shares(**stage_shares(plan.settings)),
        batch=_times(batches, len(rows), rounds),
        single=_times(singles, len(rows), rounds),
    )


def _times(asked: Mapping[str, Clocked], count: int, rounds: int) -> SceneTimes:
    """Nanoseconds a row of each, and how long the kernel takes for each of the others'."""
    *_, (_, samples) = measure([TimingEntry(name, count, run) for name, run in asked.items()], rounds)
    own, *others = samples
    found: dict[str, Any] = {f"{each.name}_ns": each.median_ns for each in samples}
    for other in others:
        ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
        found |= {f"by_{other.name}": ratio.median, f"by_{other.name}_ci95": (ratio.low, ratio.high)}
    return SceneTimes(**found)


def stage_shares(settings: Sequence[Stages]) -> dict[str, float]:
    """What share of the scene's queries each stage decides, each pair of sizes asked alike."""
    return {name: float(np.mean([each.shares.get(name, 0.0) for each in settings])) for name in STAGES}


def _tables(plan: ScenePlan) -> list[Rows]:
    """The rows of each setting."""
    times = max(1, ROWS // (COUNT * max(1, len(plan.settings))))
    return [rows_of(stages, times) for stages in plan.settings]


def _certified(plan: ScenePlan, tables: Sequence[Rows]) -> Callable[[], Positions]:
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
