"""What a plan saves in time: its kernel in C beside Table 2 as printed, in C too, on centres all over the region."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hypcheck.bench.contenders.c_library import InC, compiled, place_of
from hypcheck.bench.rounds import Entry, Samples, clocked, measure
from hypcheck.bench.scene_kernel import SceneKernel, built
from hypcheck.bench.statistics import Estimate, estimate, ratios
from hypcheck.kernel.emission.telling import PRINTED
from hypcheck.kernel.specialise.plan import Plan, Stages
from hypcheck.kernel.specialise.sampling import centres
from hypcheck.rows import Rows

ROUNDS = 11
TIMES = 16
"""How often the sample's centres are laid end to end: 65,536 rows, which a branch predictor cannot learn by heart."""


@dataclass(frozen=True)
class Times:
    """Nanoseconds a centre, and how long the kernel takes for each of Table 2's."""

    kernel_ns: float
    printed_ns: float
    ratio: Estimate

    @classmethod
    def of(cls, own: Samples, other: Samples) -> Times:
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
class Saved:
    """What one setting's kernel saves: by one call for many centres, and by a call for each."""

    stages: Stages
    rows: int
    batch: Times
    single: Times

    @property
    def says(self) -> str:
        """The measurement in sentences."""
        return f"In C, many by a call: {self.batch.says}. A call each: {self.single.says}."


def saved(plan: Plan, folder: Path) -> Iterator[Saved]:
    """Each setting of the plan, measured in turn. Raises UnavailableError where there is no C compiler."""
    methods, _ = compiled(folder)
    kernel, printed = built(plan, folder / "scene"), InC(methods, place_of(f"{PRINTED}-{plan.format.name}"))
    for stages in plan.settings:
        yield _saved(stages, kernel, printed)


def line(found: Saved) -> dict[str, Any]:
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


def _saved(stages: Stages, kernel: SceneKernel, printed: InC) -> Saved:
    rows = rows_of(stages)
    entries = [
        Entry("kernel", len(rows), clocked(kernel.batch([rows]))),
        Entry("printed", len(rows), printed.batch(rows).run),
        Entry("kernel, one by one", len(rows), clocked(kernel.single(rows))),
        Entry("printed, one by one", len(rows), printed.single(rows).run),
    ]
    *_, (_, samples) = measure(entries, ROUNDS)
    return Saved(stages, len(rows), Times.of(*samples[:2]), Times.of(*samples[2:]))


def rows_of(stages: Stages, times: int = TIMES) -> Rows:
    """The sample's centres so many times over, in random order."""
    x, y, z = centres(stages.setting)
    order = np.random.Generator(np.random.PCG64(1)).permutation(np.tile(np.arange(len(x)), times))
    sizes = [np.full(len(order), size) for size in stages.setting.sizes]
    return np.ascontiguousarray(np.column_stack([*sizes, x[order], y[order], z[order]]))
