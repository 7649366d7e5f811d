"""How many triangles an error costs: a mesh of the tower, finer and finer, built and asked about near contact."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import NEAR_SCENES, near
from hypcheck.casebook.draw import Draw
from hypcheck.casebook.placing import Sizes
from hypcheck.methods.engines import FCL, PAIRINGS
from hypcheck.methods.method import Answers
from hypcheck.methods.scene_mesh import built, height_of
from hypcheck.record.measurements import Convergence
from hypcheck.rows import Rows
from hypcheck.truth import batch

TRIANGLES = (100, 300, 1_000, 3_000, 10_000, 30_000, 100_000)
GAPS = (-27, -3)
"""Distances from touching, m 2^e radii with e in this range: from 1e-8 to 0.25."""

ROWS = 400
_BUILDS_NS = 150_000_000
"""What is spent on building one size again and again."""


def steps(plan: BenchPlan) -> int:
    """How many lines there will be."""
    return len(PAIRINGS) * len(_sizes(plan))


def _sizes(plan: BenchPlan) -> list[int]:
    return [triangles for triangles in TRIANGLES if triangles <= plan.amounts.most_triangles]


def lines(plan: BenchPlan) -> Iterator[Convergence]:
    """A line for each pairing and size."""
    rows = near_the_tower(plan.seed)
    truth = batch.positions(rows)
    for pairing in PAIRINGS:
        for triangles in _sizes(plan):
            yield _line(pairing, triangles, rows, truth)


def near_the_tower(seed: int) -> Rows:
    """Bodies near touching the cooling tower."""
    draw = Draw("bench-convergence", 1, seed)
    return near(draw, Sizes(*np.repeat(np.array([NEAR_SCENES[0]]), ROWS, axis=0).T), GAPS)


def _line(pairing: str, triangles: int, rows: Rows, truth: Answers) -> Convergence:
    alpha, gamma, b, d = NEAR_SCENES[0]
    sizes = alpha, gamma, b, d
    height = height_of(sizes, rows)
    builds: list[int] = []
    while not builds or sum(builds) < _BUILDS_NS:
        started = time.perf_counter_ns()
        mesh = built(FCL, pairing, sizes, height, triangles)
        builds.append(time.perf_counter_ns() - started)
    queries = []
    for _ in range(5):
        started = time.perf_counter_ns()
        answers = mesh.positions(rows)
        queries.append((time.perf_counter_ns() - started) / len(rows))
    return Convergence(
        method=f"{FCL.name}-{pairing}",
        triangles=mesh.triangles,
        build_ns=float(np.median(builds)),
        query_ns=float(np.median(queries)),
        deviation=mesh.deviation,
        asked=len(rows),
        wrong=int(np.count_nonzero(answers != truth)),
    )
