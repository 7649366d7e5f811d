"""What a plan saves in time: its kernel in C beside Table 2 as printed, in C too, on centres all over the region."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hypcheck.bench.contenders.c_library import InC, bodies, compile_c, compiled
from hypcheck.bench.rounds import Entry, clocked, measure
from hypcheck.bench.statistics import Estimate, estimate, ratios
from hypcheck.kernel.emission.kernel import emitted
from hypcheck.kernel.specialise.plan import Plan, Stages
from hypcheck.kernel.specialise.sampling import centres
from hypcheck.methods.method import Answers
from hypcheck.rows import Rows

ROUNDS = 11
TIMES = 16
"""How often the sample's centres are laid end to end: 65,536 rows, which a branch predictor cannot learn by heart."""


@dataclass(frozen=True)
class Saved:
    """Nanoseconds a centre, and how long the kernel takes for each of Table 2's."""

    stages: Stages
    rows: int
    kernel_ns: float
    printed_ns: float
    ratio: Estimate

    @property
    def says(self) -> str:
        """The measurement in a sentence."""
        times = 1 / self.ratio.median
        how = f"{times:.2f} times as fast as" if times >= 1 else f"{self.ratio.median:.2f} times as slow as"
        return (
            f"{self.kernel_ns:.2f} ns a centre in C, {how} Table 2 as printed in C ({self.printed_ns:.2f} ns); "
            f"ratio {self.ratio.median:.3f}, 95 % interval {self.ratio.low:.3f} to {self.ratio.high:.3f}"
        )


def saved(plan: Plan, folder: Path) -> Iterator[Saved]:
    """Each setting of the plan, measured in turn. Raises UnavailableError where there is no C compiler."""
    methods, _ = compiled(folder)
    code, kernel = folder / "kernel.c", folder / "kernel.so"
    code.write_text(emitted(plan, "c", ["hypcheck", "emit"]), encoding="utf-8")
    compile_c(code, kernel)
    library = ctypes.CDLL(str(kernel))
    place = [body.name for body in bodies()].index(f"table-2-{plan.format.name}") + 1
    for stages in plan.settings:
        yield _saved(stages, library, InC(methods, place))


def line(found: Saved) -> dict[str, Any]:
    """The record's line about one setting."""
    return {
        "sizes": list(found.stages.setting.sizes),
        "uses": list(found.stages.setting.uses),
        "rows": found.rows,
        "shares": found.stages.shares,
        "kernel_ns": found.kernel_ns,
        "printed_ns": found.printed_ns,
        "ratio": found.ratio.median,
        "ratio_ci95": [found.ratio.low, found.ratio.high],
        "says": found.says,
    }


def _saved(stages: Stages, library: ctypes.CDLL, printed: InC) -> Saved:
    rows = rows_of(stages)
    sizes, centre = np.array(stages.setting.sizes), [np.ascontiguousarray(column) for column in rows[:, 4:].T]
    answers = np.zeros(len(rows), dtype=np.int8)
    places = [each.ctypes.data_as(ctypes.c_void_p) for each in (sizes, *centre, answers)]

    def work() -> Answers:
        library.hypcheck_classify_scene(places[0], ctypes.c_size_t(len(rows)), *places[1:])
        return answers

    entries = [Entry("kernel", len(rows), clocked(work)), Entry("printed", len(rows), printed.batch(rows).run)]
    *_, (_, (own, other)) = measure(entries, ROUNDS)
    ratio = estimate(ratios([own.samples_ns], [other.samples_ns]))
    return Saved(stages, len(rows), own.median_ns, other.median_ns, ratio)


def rows_of(stages: Stages, times: int = TIMES) -> Rows:
    """The sample's centres so many times over, in random order."""
    x, y, z = centres(stages.setting)
    order = np.random.Generator(np.random.PCG64(1)).permutation(np.tile(np.arange(len(x)), times))
    sizes = [np.full(len(order), size) for size in stages.setting.sizes]
    return np.ascontiguousarray(np.column_stack([*sizes, x[order], y[order], z[order]]))
