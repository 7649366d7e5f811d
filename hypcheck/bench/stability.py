"""Where in the plane of log α/b and log γ/d a method is wrong, far enough from touching for that to matter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import near
from hypcheck.casebook.draw import Draw
from hypcheck.casebook.placing import sizes
from hypcheck.processes import perform
from hypcheck.record.measurements import Stability
from hypcheck.rows import Rows
from hypcheck.truth import batch

FIRST, LAST = -4, 15
"""Half decades of α/b and of γ/d: from 1e-2 to 1e8."""

GAPS = (-10, 1)
"""Distances from touching, m 2^e radii with e in this range: from a thousandth of a radius to two."""

KINDS = ("paper", "algebraic", "certified", "roots")
ENOUGH, ENOUGH_OUTSIDE = 2000, 10_000
"""Who can be asked so many rows of a workload can be asked for a map; a SPEC is asked each row through a pipe."""


def mapped(found: dict[str, Contender]) -> list[str]:
    """The methods of which a map is drawn. Those in C answer what the same ones in numpy do."""
    return [name for name, each in found.items() if _wanted(each)]


def _wanted(contender: Contender) -> bool:
    if contender.tier == "foreign":
        return (contender.judged or 0) >= ENOUGH_OUTSIDE
    ours = contender.kind in KINDS and contender.tier in ("numpy", "python")
    return ours and (contender.judged or ENOUGH) >= ENOUGH


def lines(plan: BenchPlan, names: Sequence[str], executor: Executor | None) -> Iterator[Stability]:
    """A line for each of the methods."""
    for _, line in perform(_line, [(plan, name) for name in names], executor):
        yield line


def _line(task: tuple[BenchPlan, str]) -> Stability:
    plan, name = task
    contender = contenders(plan)[name]
    rows, cells = _rows(plan)
    places = contender.asked(rows)
    with closing(contender.load()) as way:
        answers = way.answer(rows[places])
    wrong = judge.is_wrong(batch.positions(rows[places]), answers, contender.question)
    asked = np.bincount(cells[places], minlength=cells.max() + 1).tolist()
    errors = np.bincount(cells[places][wrong], minlength=cells.max() + 1).tolist()
    side = LAST - FIRST + 1
    bins = [
        [FIRST + cell // side, FIRST + cell % side, number, error]
        for cell, (number, error) in enumerate(zip(asked, errors, strict=True))
        if number
    ]
    return Stability(method=name, precision=contender.precision, bins=bins)


def _rows(plan: BenchPlan) -> tuple[Rows, NDArray[np.intp]]:
    """As many rows for each cell, and the cell of each row."""
    side, draw = LAST - FIRST + 1, Draw("bench-stability", 1, plan.seed)
    cells = np.repeat(np.arange(side * side), plan.amounts.cell)
    edges = np.sqrt(10.0) ** np.arange(FIRST, LAST + 2)
    a, c = (
        edges[place] + draw.unit(len(cells)) * (edges[place + 1] - edges[place])
        for place in (cells // side, cells % side)
    )
    return near(draw, sizes(draw, a, c), GAPS), cells
