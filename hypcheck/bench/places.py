"""Where about the cooling tower a method is wrong: over the half plane (r, z), and about the ring."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing

import numpy as np

from hypcheck import judge
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.stability import ENOUGH
from hypcheck.bench.workloads import NEAR_SCENES
from hypcheck.judge import Mistake
from hypcheck.methods.method import Answers
from hypcheck.pairs import SIZES, Position
from hypcheck.processes import perform
from hypcheck.record.measurements import Places, Scenery
from hypcheck.rows import Rows
from hypcheck.truth import batch

SCENE = NEAR_SCENES[0]
FARTHEST = 34.0
"""Metres from the axis: beyond the ring, which is at 29.7."""

AROUND_THE_RING = 0.03
LETTERS = {Mistake.FALSE_CLEAR: "c", Mistake.FALSE_CONTACT: "w", Mistake.WRONG_SIDE: "s"}

Span = tuple[float, float, int]


def mapped(found: dict[str, Contender]) -> list[str]:
    """The methods of which maps are drawn: those in C answer what the same ones in numpy do."""
    return [name for name, each in found.items() if each.tier != "C" and (each.judged or ENOUGH) >= ENOUGH]


def regions(plan: BenchPlan) -> dict[str, tuple[Span, Span]]:
    """The intervals of r and of z, in metres, and how many points they have. The plane z = 0 is among them."""
    alpha, gamma, b, d = SCENE
    a, c = alpha / b, gamma / d
    ring = b * float(np.sqrt((c * c + 1) * (a * a + c * c))) / c
    count, near = plan.amounts.map_lines, AROUND_THE_RING
    whole = ((0.0, FARTHEST, 2 * count - 1), (-gamma, gamma, count))
    return {"whole": whole, "ring": ((ring - near, ring + near, count), (-near, near, count))}


def lines(plan: BenchPlan, names: Sequence[str], executor: Executor | None) -> Iterator[list[Places]]:
    """The lines of each of the methods, one for each region."""
    for _, found in perform(_lines, [(plan, name) for name in names], executor):
        yield found


def _lines(task: tuple[BenchPlan, str]) -> list[Places]:
    plan, name = task
    contender = contenders(plan)[name]
    with closing(contender.load()) as way:
        return [
            Places(
                method=name,
                scene=Scenery(**dict(zip(SIZES, SCENE, strict=True))),
                r=r,
                z=z,
                wrong=drawn(way.answer(rows), rows, contender.question, r[2]),
                region=region,
            )
            for region, (r, z) in regions(plan).items()
            for rows in [grid(r, z)]
        ]


def grid(r: Span, z: Span) -> Rows:
    """A row for each point, r varying fastest."""
    rows = np.zeros((r[2] * z[2], 7))
    rows[:, :4] = SCENE
    rows[:, 4] = np.tile(np.linspace(*r), z[2])
    rows[:, 6] = np.repeat(np.linspace(*z), r[2])
    return rows


def drawn(answers: Answers, rows: Rows, question: str, columns: int) -> list[str]:
    """A text for each z from the lowest up, with a character for each r."""
    positions = batch.positions(rows)
    letters = np.full(len(rows), ".")
    for place in np.flatnonzero(judge.is_wrong(positions, answers, question)):
        letters[place] = LETTERS[judge.mistake_of(Position(positions[place]), int(answers[place]), question)]
    return ["".join(line) for line in letters.reshape(-1, columns).tolist()]
