"""What leaving out saves in whole scenes: the share that each stage decided, and the time against what keeps all.

A scene is asked evenly over its region, each pair of sizes alike. Beside its kernel in C stand Table 2 as printed, in
C, which proves nothing, and the certified kernel that `hypcheck.classify_scene` runs; all in one thread.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from hypcheck.bench.contenders.c_library import InC, compile_c, compiled, place_of
from hypcheck.bench.contenders.c_tier import COMPILER
from hypcheck.bench.needs import note_absent
from hypcheck.bench.rounds import Clocked, Entry, Samples, clocked, measure
from hypcheck.bench.scene import rows_of
from hypcheck.bench.statistics import estimate, ratios
from hypcheck.errors import UnavailableError
from hypcheck.kernel.classify import classify_scene
from hypcheck.kernel.emission.kernel import emitted
from hypcheck.kernel.question import Question
from hypcheck.kernel.specialise.plan import Plan, Stages, plan_of
from hypcheck.kernel.specialise.sampling import COUNT
from hypcheck.record import Recorder
from hypcheck.rows import CANNOT_SAY, Positions, Rows
from hypcheck.scene.reading import read_scene

ROUNDS, QUICK_ROUNDS = 11, 5
ROWS = 2**17
"""About how many rows a scene is asked; a setting has its sample's 4096 at least."""

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
            recorder.add("scene", **line)
            if line["wrong"]:
                yield f"the kernel of the scene {plan.scene.name!r} answers {line['wrong']:,} rows wrongly"
            advance(1)
    except UnavailableError as error:
        note_absent(recorder, COMPILER, str(error))


def _line(plan: Plan, methods: Path, folder: Path, rounds: int) -> dict[str, Any]:
    tables = _tables(plan)
    kernel, certified = _kernel(plan, folder, tables), _certified(plan, tables)
    wrong = _wrong(kernel(), certified())
    count = sum(map(len, tables))
    printed = InC(methods, place_of("table-2-float64"))
    entries = [
        Entry("kernel", count, clocked(kernel)),
        Entry("printed", count, _all_of([printed.batch(rows).run for rows in tables])),
        Entry("certified", count, clocked(certified)),
    ]
    *_, (_, (own, plain, other)) = measure(entries, rounds)
    return {
        "scene": plan.scene.name,
        "question": plan.question,
        "precision": plan.format.name,
        "settings": len(plan.settings),
        "rows": count,
        "wrong": wrong,
        "shares": shares(plan.settings),
        "kernel_ns": own.median_ns,
        "printed_ns": plain.median_ns,
        "certified_ns": other.median_ns,
        **_ratio("ratio", own, plain),
        **_ratio("certified_ratio", own, other),
    }


def shares(settings: Sequence[Stages]) -> dict[str, float]:
    """What share of the scene's queries each stage decides, each pair of sizes asked alike."""
    return {name: float(np.mean([each.shares.get(name, 0.0) for each in settings])) for name in STAGES}


def _ratio(name: str, own: Samples, other: Samples) -> dict[str, Any]:
    found = estimate(ratios([own.samples_ns], [other.samples_ns]))
    return {name: found.median, f"{name}_ci95": [found.low, found.high]}


def _tables(plan: Plan) -> list[Rows]:
    """The rows of each setting."""
    times = max(1, ROWS // (COUNT * max(1, len(plan.settings))))
    return [rows_of(stages, times) for stages in plan.settings]


def _kernel(plan: Plan, folder: Path, tables: Sequence[Rows]) -> Callable[[], Positions]:
    """The scene's kernel, asked about all rows, one pair of sizes after the other."""
    folder.mkdir()
    code, library = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]), encoding="utf-8")
    compile_c(code, library)
    function = ctypes.CDLL(str(library)).hypcheck_classify_scene
    found = np.zeros(sum(map(len, tables)), dtype=np.int8)
    kept, calls, start = [], [], 0
    for rows in tables:
        part = found[start : start + len(rows)]
        sizes, columns = rows[0, :4].copy(), [np.ascontiguousarray(column) for column in rows[:, 4:].T]
        pointers = [ctypes.c_void_p(each.ctypes.data) for each in (sizes, *columns, part)]
        kept.append((sizes, columns))
        calls.append((pointers[0], ctypes.c_size_t(len(rows)), *pointers[1:]))
        start += len(rows)

    def work(_kept: object = kept) -> Positions:
        for call in calls:
            function(*call)
        return found

    return work


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


def _wrong(said: Positions, exact: Positions) -> int:
    """How many rows the kernel answers otherwise than is exact; "cannot say" is no wrong answer."""
    return int(((said != exact) & (said != CANNOT_SAY)).sum())
