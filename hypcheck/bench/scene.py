"""Kernels that are specialised for a scene: the time that each saves, and the share that each stage decides.

A scene is asked evenly over its region, with the same number of rows for each pair of sizes. Its kernel in C is
compared with Table 2 as printed, in C, which proves nothing, and with the certified kernel of
`hypcheck.classify_scene`. All run in one thread, first by a call for many rows, then by a call for each, as a craft or
a walker asks.
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
from hypcheck.bench.timing import Clocked, Estimate, Samples, TimingEntry, clocked, estimate, measure, ratios
from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY, Positions, Rows
from hypcheck.kernel.choice import Question
from hypcheck.kernel.classify import classify_scene
from hypcheck.kernel.emission.kernel import emitted
from hypcheck.kernel.emission.plan_text import PRINTED
from hypcheck.kernel.specialise.plan import ScenePlan, Stages, plan_of
from hypcheck.kernel.specialise.settings import COUNT, centres
from hypcheck.messages import escaped
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
"""A program in C that asks one question at a time; the compiler cannot see the function that it calls."""


@dataclass(frozen=True)
class SceneKernel:
    """A compiled and loaded kernel."""

    library: ctypes.CDLL

    def batch(self, tables: Sequence[Rows]) -> Callable[[], Positions]:
        """All rows by one call for each table; the rows of a table have the same sizes."""
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
        """All rows by one call each, from C."""
        queries, found = np.ascontiguousarray(rows), np.zeros(len(rows), dtype=np.int8)
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (queries, found)]

        def work(_kept: object = queries) -> Positions:
            self.library.one_by_one(ctypes.c_size_t(len(found)), *pointers)
            return found

        return work


def compiled_kernel(plan: ScenePlan, folder: Path) -> SceneKernel:
    """The plan's kernel, compiled in a folder of its own. Raises UnavailableError if there is no C compiler."""
    folder.mkdir()
    code, library = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]) + _ONE_BY_ONE, encoding="utf-8")
    compile_c(code, library)
    return SceneKernel(ctypes.CDLL(str(library)))


KERNEL_ROUNDS = 11
REPEATED_CENTRES = 16
"""The sample's centres are repeated so often: 65,536 rows, which a branch predictor cannot learn."""


@dataclass(frozen=True)
class KernelTimes:
    """Nanoseconds for a centre, and the kernel's time relative to that of Table 2."""

    kernel_ns: float
    printed_ns: float
    ratio: Estimate

    @classmethod
    def of(cls, own: Samples, other: Samples) -> KernelTimes:
        """The times from the samples of both."""
        return cls(own.median_ns, other.median_ns, estimate(ratios([own.samples_ns], [other.samples_ns])))

    @property
    def says(self) -> str:
        """The times as a part of a sentence."""
        times = 1 / self.ratio.median
        how = f"{times:.2f} times as fast as" if times >= 1 else f"{self.ratio.median:.2f} times as slow as"
        return (
            f"{self.kernel_ns:.2f} ns a centre, {how} Table 2 as printed ({self.printed_ns:.2f} ns); "
            f"ratio {self.ratio.median:.3f}, 95 % interval {self.ratio.low:.3f} to {self.ratio.high:.3f}"
        )

    @property
    def fields(self) -> dict[str, Any]:
        """The times as values for programs."""
        return {
            "kernel_ns": self.kernel_ns,
            "printed_ns": self.printed_ns,
            "ratio": self.ratio.median,
            "ratio_ci95": [self.ratio.low, self.ratio.high],
        }


@dataclass(frozen=True)
class KernelSaving:
    """The time that the kernel of one setting saves: by one call for many centres, and by a call for each."""

    stages: Stages
    rows: int
    batch: KernelTimes
    single: KernelTimes

    @property
    def says(self) -> str:
        """The savings in sentences."""
        return f"In C, many by a call: {self.batch.says}. A call each: {self.single.says}."


def kernel_savings(plan: ScenePlan, folder: Path) -> Iterator[KernelSaving]:
    """The savings of each setting of the plan.

    Raises UnavailableError if there is no C compiler, InputError where the mover leans.
    """
    require_upright(plan)
    methods, _ = compiled(folder)
    kernel, printed = compiled_kernel(plan, folder / "scene"), InC(methods, place_of(f"{PRINTED}-{plan.format.name}"))
    for stages in plan.settings:
        yield _kernel_saving(stages, kernel, printed)


def saving_fields(found: KernelSaving) -> dict[str, Any]:
    """The fields of the record's line about one setting."""
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
    samples = measure(entries, KERNEL_ROUNDS)
    return KernelSaving(stages, len(rows), KernelTimes.of(*samples[:2]), KernelTimes.of(*samples[2:]))


def rows_of(stages: Stages, times: int = REPEATED_CENTRES) -> Rows:
    """The sample's centres, repeated, in random order."""
    x, y, z = centres(stages.setting)
    order = np.random.Generator(np.random.PCG64(1)).permutation(np.tile(np.arange(len(x)), times))
    sizes = [np.full(len(order), size) for size in stages.setting.sizes]
    return np.ascontiguousarray(np.column_stack([*sizes, x[order], y[order], z[order]]))


ROUNDS, QUICK_ROUNDS = 11, 5
ROWS = 2**17
"""The number of rows that a scene is asked about; each setting has at least the 4096 of its sample."""

CERTIFIED = "fast"
"""The name of the certified kernel among the methods in C."""

STAGES = ("always", "thresholds", "lines", "discriminant", "search")


def plans_of(names: Sequence[str]) -> list[ScenePlan]:
    """The plans of scenes by their names; raises InputError for an unknown scene, or one that is not timed."""
    plans = [plan_of(read_scene(name)) for name in names]
    for plan in plans:
        require_upright(plan)
    return plans


def require_upright(plan: ScenePlan) -> None:
    """Raise InputError where the mover leans: Table 2, which kernels are timed beside, is about upright spheroids."""
    if plan.axis is not None:
        raise InputError(
            f"the scene {escaped(repr(plan.scene.name), 60)} is not timed: its mover leans, and Table 2 as printed, "
            "which kernels are timed beside, is about upright spheroids"
        )


def run_scenes(plans: Sequence[ScenePlan], recorder: Recorder, advance: Advance, folder: Path, *, quick: bool) -> None:
    """Record a line for each scene. Raises UnavailableError if there is no C compiler."""
    methods, _ = compiled(folder)
    for number, plan in enumerate(plans):
        rounds = QUICK_ROUNDS if quick else ROUNDS
        recorder.add(_scene_line(plan, methods, folder / f"scene-{number}", rounds))
        advance(1)


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
    """Nanoseconds for a row of each, and the kernel's time relative to the others'."""
    samples = measure([TimingEntry(name, count, run) for name, run in asked.items()], rounds)
    own, *others = samples
    found: dict[str, Any] = {f"{each.name}_ns": each.median_ns for each in samples}
    for other in others:
        ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
        found |= {f"by_{other.name}": ratio.median, f"by_{other.name}_ci95": (ratio.low, ratio.high)}
    return SceneTimes(**found)


def stage_shares(settings: Sequence[Stages]) -> dict[str, float]:
    """The share of the scene's queries that each stage decides, with the same number for each pair of sizes."""
    return {name: float(np.mean([each.shares.get(name, 0.0) for each in settings])) for name in STAGES}


def _tables(plan: ScenePlan) -> list[Rows]:
    """The rows of each setting."""
    times = max(1, ROWS // (COUNT * max(1, len(plan.settings))))
    return [rows_of(stages, times) for stages in plan.settings]


def _certified(plan: ScenePlan, tables: Sequence[Rows]) -> Callable[[], Positions]:
    """The exact kernel of classify_scene with the same rows."""
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
    """The work of all parts as one."""

    def run(repeat: int) -> tuple[int, int]:
        done = [part(repeat) for part in parts]
        return sum(took for took, _ in done), sum(total for _, total in done)

    return run


def _wrong(said: Positions, exact: Positions) -> NDArray[np.bool_]:
    """The rows to which the kernel gives another answer than the exact one; "cannot say" is not wrong."""
    return np.asarray((said != exact) & (said != CANNOT_SAY))
