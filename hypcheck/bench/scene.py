"""Kernels that are specialised for a scene: the time that each saves, and the share that each stage decides.

The rows of a scene are uniform in its region, with the same number for each pair of sizes. Its kernel in C is compared
with the printed Table 2 in C, which is not certified, and with the certified kernel of `hypcheck.classify_scene`. All
run in one thread, first with a call for many rows, then with a call for each row, as a craft or a walker does.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np

from hypcheck.bench.c_library import InC, compile_c, compiled, place_of
from hypcheck.bench.loaded import PreparedWork, prepared
from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Positions, Rows
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
from hypcheck.runs.timing import Clocked, Samples, TimingEntry, estimate, measure, ratios
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
    """A scene's kernel in C, compiled and loaded."""

    library: ctypes.CDLL

    def batch(self, rows: Rows) -> PreparedWork:
        """Return rows with the same sizes by one call."""
        sizes, (x, y, z) = rows[0, :4].copy(), np.ascontiguousarray(rows[:, 4:].T)
        return self._called("hypcheck_classify_scene", len(rows), sizes, len(rows), x, y, z)

    def single(self, rows: Rows) -> PreparedWork:
        """Prepare a call for each row, made from C."""
        return self._called("one_by_one", len(rows), len(rows), np.ascontiguousarray(rows))

    def _called(self, name: str, count: int, *arguments: Floats | int) -> PreparedWork:
        """Return work that calls a function of the library with these arguments and an array for `count` answers."""
        function, answers = getattr(self.library, name), np.zeros(count, dtype=np.int8)
        words = [
            ctypes.c_size_t(array) if isinstance(array, int) else ctypes.c_void_p(array.ctypes.data)
            for array in (*arguments, answers)
        ]

        def work(_kept: object = arguments) -> Positions:  # pointers would not keep the arrays alive
            function(*words)
            return answers

        return prepared(count, work)


def compiled_kernel(plan: ScenePlan, folder: Path) -> SceneKernel:
    """Return the plan's kernel, compiled in a folder of its own. Raises UnavailableError if there is no C compiler."""
    folder.mkdir()
    code, library = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]) + _ONE_BY_ONE, encoding="utf-8")
    compile_c(code, library)
    return SceneKernel(ctypes.CDLL(str(library)))


KERNEL_ROUNDS = 11
REPEATED_CENTRES = 16
"""How often the sample centres are repeated: 65,536 rows, which a branch predictor cannot learn."""


def kernel_savings(plan: ScenePlan, folder: Path, rounds: int = KERNEL_ROUNDS) -> Iterator[dict[str, Any]]:
    """Yield the time that each setting's kernel saves, with one call for many centres and with a call for each centre.

    The values are for programs; the values of "says" are sentences. Raises UnavailableError if there is no C compiler,
    InputError if the mover is tilted.
    """
    require_upright(plan)
    methods, _ = compiled(folder)
    kernel, printed = compiled_kernel(plan, folder / "scene"), InC(methods, place_of(f"{PRINTED}-{plan.format.name}"))
    for stages in plan.settings:
        rows = rows_of(stages)
        works = (kernel.batch(rows), printed.batch(rows), kernel.single(rows), printed.single(rows))
        entries = [TimingEntry(str(place), len(rows), work.run) for place, work in enumerate(works)]
        samples = measure(entries, rounds)
        batch, single = _saving(*samples[:2]), _saving(*samples[2:])
        yield {
            "sizes": list(stages.setting.sizes),
            "uses": list(stages.setting.uses),
            "rows": len(rows),
            "shares": stages.shares,
            "batch": batch,
            "single": single,
            "says": f"In C, many by a call: {_saving_text(**batch)}. A call each: {_saving_text(**single)}.",
        }


def _saving(own: Samples, other: Samples) -> dict[str, Any]:
    """Return nanoseconds for a centre, and the kernel's time relative to that of Table 2."""
    ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
    return {
        "kernel_ns": own.median_ns,
        "printed_ns": other.median_ns,
        "ratio": ratio.median,
        "ratio_ci95": [ratio.low, ratio.high],
    }


def _saving_text(kernel_ns: float, printed_ns: float, ratio: float, ratio_ci95: Sequence[float]) -> str:
    """Return the time that a kernel saves, as a part of a sentence."""
    low, high = ratio_ci95
    how = f"{1 / ratio:.2f} times as fast as" if ratio <= 1 else f"{ratio:.2f} times as slow as"
    return (
        f"{kernel_ns:.2f} ns a centre, {how} Table 2 as printed ({printed_ns:.2f} ns); "
        f"ratio {ratio:.3f}, 95 % interval {low:.3f} to {high:.3f}"
    )


def rows_of(stages: Stages, times: int = REPEATED_CENTRES) -> Rows:
    """Return the rows of the samples' centres, each `times` times, in random order."""
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
    """Return the plans of scenes by their names; raises InputError for an unknown scene, or one that is not timed."""
    plans = [plan_of(read_scene(name)) for name in names]
    for plan in plans:
        require_upright(plan)
    return plans


def require_upright(plan: ScenePlan) -> None:
    """Raise InputError if the mover is tilted: Table 2, with which kernels are compared, is for upright spheroids."""
    if plan.axis is not None:
        raise InputError(
            f"the scene {escaped(repr(plan.scene.name), 60)} is not timed: its mover is tilted, and Table 2 as "
            "printed, which kernels are timed beside, is about upright spheroids"
        )


def run_scenes(
    plans: Sequence[ScenePlan],
    recorder: Recorder,
    advance: Advance,
    folder: Path,
    rounds: int = ROUNDS,
    count: int = ROWS,
    kernel_of: Callable[[ScenePlan, Path], SceneKernel] = compiled_kernel,
) -> None:
    """Record a line for each scene, timed with `count` rows. Raises UnavailableError if there is no C compiler."""
    methods, _ = compiled(folder)
    for number, plan in enumerate(plans):
        kernel = kernel_of(plan, folder / f"scene-{number}")
        recorder.add(_scene_line(plan, methods, kernel, rounds, _tables(plan, count)))
        advance(1)


def _scene_line(plan: ScenePlan, methods: Path, kernel: SceneKernel, rounds: int, tables: Sequence[Rows]) -> SceneLine:
    """Return the record's line about a scene's kernel: its answers and times beside those of the other methods."""
    printed, certified = (InC(methods, place_of(name)) for name in (f"{PRINTED}-{plan.format.name}", CERTIFIED))
    rows = np.concatenate(tables)
    batches = {
        "kernel": [kernel.batch(table) for table in tables],
        "printed": [printed.batch(table) for table in tables],
        "certified": [_certified(plan, table) for table in tables],
    }
    singles = {
        "kernel": [kernel.single(rows)],
        "printed": [printed.single(rows)],
        "certified": [certified.single(rows)],
    }
    exact = _answers(batches["certified"])
    wrong = [
        (answers != exact) & (answers != CANNOT_SAY)
        for answers in map(_answers, (batches["kernel"], singles["kernel"]))
    ]
    return SceneLine(
        scene=plan.scene.name,
        question=plan.question,
        precision=plan.format.name,
        settings=len(plan.settings),
        rows=len(rows),
        wrong=int(np.logical_or(*wrong).sum()),
        shares=Shares(**stage_shares(plan.settings)),
        batch=_times(batches, len(rows), rounds),
        single=_times(singles, len(rows), rounds),
    )


def _answers(parts: Sequence[PreparedWork]) -> Positions:
    """Return the answers of several parts as one array."""
    return np.concatenate([part.answers() for part in parts])


def _times(works: Mapping[str, Sequence[PreparedWork]], count: int, rounds: int) -> SceneTimes:
    """Return the nanoseconds per row of each work, and the kernel's time relative to the others."""
    entries = [TimingEntry(name, count, _all_of([part.run for part in parts])) for name, parts in works.items()]
    samples = measure(entries, rounds)
    own, *others = samples
    values: dict[str, Any] = {f"{timed.name}_ns": timed.median_ns for timed in samples}
    for other in others:
        ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
        values |= {f"by_{other.name}": ratio.median, f"by_{other.name}_ci95": (ratio.low, ratio.high)}
    return SceneTimes(**values)


def stage_shares(settings: Sequence[Stages]) -> dict[str, float]:
    """Return the share of the scene's queries that each stage decides.

    Each pair of sizes has the same number of queries.
    """
    return {name: float(np.mean([setting.shares.get(name, 0.0) for setting in settings])) for name in STAGES}


def _tables(plan: ScenePlan, count: int) -> list[Rows]:
    """Return the rows of each setting."""
    times = max(1, count // (COUNT * max(1, len(plan.settings))))
    return [rows_of(stages, times) for stages in plan.settings]


def _certified(plan: ScenePlan, rows: Rows) -> PreparedWork:
    """Return the exact kernel of classify_scene with rows of the same sizes."""
    alpha, gamma, b, d = rows[0, :4].tolist()
    x, y, z = np.ascontiguousarray(rows[:, 4:].T)
    question, out = cast("Question", plan.question), np.zeros(len(rows), dtype=np.int8)
    ask = partial(classify_scene, (alpha, gamma, b, d), x, y, z, out, question=question, threads=1)
    return prepared(len(rows), ask)


def _all_of(parts: Sequence[Clocked]) -> Clocked:
    """Return one piece of work that does all parts in turn: its time and its total are the sums of theirs."""

    def run(repeat: int) -> tuple[int, int]:
        times = [part(repeat) for part in parts]
        return sum(took for took, _ in times), sum(total for _, total in times)

    return run
