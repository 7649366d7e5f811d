"""A sphere or a cylinder in the spheroid's place: how often it calls contact what is clear, and how far off that is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType

import numpy as np

from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.methods import bounding
from hypcheck.methods.method import Answers
from hypcheck.record.measurements import Bounding
from hypcheck.rows import Rows
from hypcheck.truth import batch

SHAPES: Mapping[str, Callable[[Rows], Answers]] = MappingProxyType(
    {"sphere": bounding.sphere, "cylinder": bounding.cylinder}
)
ON = ("uniform", "flight")
RATIOS = tuple(2.0**exponent for exponent in range(-4, 5))
"""d/b of the spheroids: from flat to tall."""

_SHARE = 4
"""One in so many of the judged rows is asked for each ratio: there are many."""


def lines(plan: BenchPlan) -> Iterator[Bounding]:
    """A line for each shape and workload."""
    for workload in ON:
        rows = WORKLOADS[workload].rows(plan.seed, plan.amounts.judged // _SHARE)
        for shape, answer in SHAPES.items():
            yield compared(rows, answer, shape, workload)


def compared(rows: Rows, answer: Callable[[Rows], Answers], shape: str, workload: str) -> Bounding:
    """What a shape in the spheroid's place says of these centres, for every ratio d/b in turn."""
    from hypcheck.truth.nearest import clearances  # noqa: PLC0415 - loads mpmath

    overlap: list[tuple[float, int, int, float | None]] = []
    false_contact = false_clear = 0
    for ratio in RATIOS:
        some = rows.copy()
        some[:, 3] = some[:, 2] * ratio
        positions, answers = batch.positions(some), answer(some)
        refused = (positions != 0) & (answers == 0)
        false_contact += int(refused.sum())
        false_clear += int(((answers != 0) & (answers != positions)).sum())
        excess = float(np.median(clearances(some[refused]).clearance)) if refused.any() else None
        overlap.append((ratio, len(some), int(refused.sum()), excess))
    asked = len(rows) * len(RATIOS)
    return Bounding(
        shape=shape,
        workload=workload,
        asked=asked,
        false_contact=false_contact,
        false_clear=false_clear,
        overlap=overlap,
    )
