"""Maps of errors: over planes of sizes and of places, by a mesh's triangles, and for simpler bodies than the spheroid.

One map shows where in the plane of log α/b and log γ/d a method is wrong, far enough from contact to matter. Another
shows where about the cooling tower it is wrong: over the half plane (r, z), and about the ring. A table shows the error
and the time of finer and finer meshes near contact. Another table shows how often a bounding sphere or cylinder is in
contact while the spheroid is clear, and at which distance.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.workloads import NEAR_SCENES, WORKLOADS, near
from hypcheck.geometry.pair import SIZES, Position
from hypcheck.geometry.rows import Rows
from hypcheck.implementations import alternatives
from hypcheck.implementations.meshes import FCL, PAIRINGS, height_of, scene_mesh
from hypcheck.implementations.method import Answers, on_rows
from hypcheck.record.measurements import BoundingLine, ConvergenceLine, PlacesLine, Scenery, StabilityLine
from hypcheck.runs import judge
from hypcheck.runs.judge import Mistake
from hypcheck.truth import float_filter
from hypcheck.truth.nearest_rows import clearances
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.random_pairs import Sizes, sizes

FIRST, LAST = -4, 15
"""Half decades of α/b and of γ/d: from 1e-2 to 1e8."""

STABILITY_GAPS = (-10, 1)
"""Distances from contact, m 2^e radii with e in this range: from a thousandth of a radius to two."""

STABILITY_KINDS = ("paper", "algebraic", "certified", "roots")
ENOUGH, ENOUGH_OUTSIDE = 2000, 10_000
"""A method that judges at least so many rows of a workload gets a map; a SPEC is asked each row through a pipe."""


def stability_methods(by_name: dict[str, Contender]) -> list[str]:
    """Return the methods with a map. Methods in C are left out, because they give the same answers as in numpy."""
    return [name for name, contender in by_name.items() if _wanted(contender)]


def _wanted(contender: Contender) -> bool:
    """Whether a contender gets a map: it judges enough rows, and is of a kind whose errors differ."""
    if contender.tier == "foreign":
        return (contender.judged or 0) >= ENOUGH_OUTSIDE
    ours = contender.kind in STABILITY_KINDS and contender.tier in ("numpy", "python")
    return ours and (contender.judged or ENOUGH) >= ENOUGH


def stability_lines(task: tuple[BenchPlan, str]) -> list[StabilityLine]:
    """Return the line with the stability map of the method with that name."""
    plan, name = task
    contender = contenders(plan)[name]
    rows, cells = stability_rows(plan)
    places = contender.asked(rows)
    with closing(contender.load()) as loaded:
        answers = loaded.answer(rows[places])
    wrong = judge.is_wrong(float_filter.positions(rows[places]), answers, contender.question)
    counts = np.bincount(cells[places], minlength=cells.max() + 1).tolist()
    errors = np.bincount(cells[places][wrong], minlength=cells.max() + 1).tolist()
    side = LAST - FIRST + 1
    bins = [
        [FIRST + cell // side, FIRST + cell % side, number, error]
        for cell, (number, error) in enumerate(zip(counts, errors, strict=True))
        if number
    ]
    return [StabilityLine(method=name, precision=contender.precision, bins=bins)]


def stability_rows(plan: BenchPlan) -> tuple[Rows, NDArray[np.intp]]:
    """Rows, the same number in each cell, and the cell of each row."""
    side, draw = LAST - FIRST + 1, Draw("bench-stability", 1, plan.seed)
    cells = np.repeat(np.arange(side * side), plan.amounts.cell)
    edges = np.sqrt(10.0) ** np.arange(FIRST, LAST + 2)
    a, c = (
        edges[place] + draw.unit(len(cells)) * (edges[place + 1] - edges[place])
        for place in (cells // side, cells % side)
    )
    return near(draw, sizes(draw, a, c), STABILITY_GAPS), cells


MAPPED_SCENE = NEAR_SCENES[0]
FARTHEST = 34.0
"""How far from the axis a map goes, in metres: beyond the ring, which is at 29.7."""

AROUND_THE_RING = 0.03
LETTERS = {Mistake.FALSE_CLEAR: "c", Mistake.FALSE_CONTACT: "w", Mistake.WRONG_SIDE: "s"}

Span = tuple[float, float, int]


def place_methods(by_name: dict[str, Contender]) -> list[str]:
    """Return the methods with maps of places.

    Methods in C are left out, because they give the same answers as in numpy.
    """
    return [
        name for name, contender in by_name.items() if contender.tier != "C" and (contender.judged or ENOUGH) >= ENOUGH
    ]


def mapped_regions(plan: BenchPlan) -> dict[str, tuple[Span, Span]]:
    """Return the intervals of r and of z, in metres, and the numbers of points. The plane z = 0 is among them."""
    alpha, gamma, b, d = MAPPED_SCENE
    a, c = alpha / b, gamma / d
    ring = b * float(np.sqrt((c * c + 1) * (a * a + c * c))) / c
    count, near = plan.amounts.map_lines, AROUND_THE_RING
    whole = ((0.0, FARTHEST, 2 * count - 1), (-gamma, gamma, count))
    return {"whole": whole, "ring": ((ring - near, ring + near, count), (-near, near, count))}


def place_lines(task: tuple[BenchPlan, str]) -> list[PlacesLine]:
    """Return the lines of the method with that name, one for each region."""
    plan, name = task
    contender = contenders(plan)[name]
    with closing(contender.load()) as loaded:
        return [
            PlacesLine(
                method=name,
                scene=Scenery(**dict(zip(SIZES, MAPPED_SCENE, strict=True))),
                r=r,
                z=z,
                wrong=letters_of(loaded.answer(rows), rows, contender.question, r[2]),
                region=region,
            )
            for region, (r, z) in mapped_regions(plan).items()
            for rows in [grid(r, z)]
        ]


def grid(r: Span, z: Span) -> Rows:
    """Return a row for each point, with r varying fastest."""
    rows = np.zeros((r[2] * z[2], 7))
    rows[:, :4] = MAPPED_SCENE
    rows[:, 4] = np.tile(np.linspace(*r), z[2])
    rows[:, 6] = np.repeat(np.linspace(*z), r[2])
    return rows


def letters_of(answers: Answers, rows: Rows, question: str, columns: int) -> list[str]:
    """Return a text for each z from the lowest up, with a character for each r."""
    positions = float_filter.positions(rows)
    letters = np.full(len(rows), ".")
    for place in np.flatnonzero(judge.is_wrong(positions, answers, question)):
        letters[place] = LETTERS[judge.mistake_of(Position(positions[place]), int(answers[place]), question)]
    return ["".join(line) for line in letters.reshape(-1, columns).tolist()]


CONVERGENCE_TRIANGLES = (100, 300, 1_000, 3_000, 10_000, 30_000, 100_000)
CONVERGENCE_GAPS = (-27, -3)
"""Distances from contact, m 2^e radii with e in this range: from 1e-8 to 0.25."""

CONVERGENCE_ROWS = 400
_BUILDS_NS = 150_000_000
"""A mesh of one size is built repeatedly for so many nanoseconds."""


def convergence_steps(plan: BenchPlan) -> int:
    """Return the number of lines that convergence_lines yields."""
    return len(PAIRINGS) * len(_triangle_counts(plan))


def _triangle_counts(plan: BenchPlan) -> list[int]:
    """Return the numbers of triangles of the meshes that the run measures."""
    return [triangles for triangles in CONVERGENCE_TRIANGLES if triangles <= plan.amounts.most_triangles]


def convergence_lines(plan: BenchPlan) -> Iterator[ConvergenceLine]:
    """Yield the line for each pairing and number of triangles."""
    rows = near_the_tower(plan.seed)
    truth = float_filter.positions(rows)
    for pairing in PAIRINGS:
        for triangles in _triangle_counts(plan):
            yield _convergence_line(pairing, triangles, rows, truth)


def near_the_tower(seed: int) -> Rows:
    """Return bodies close to contact with the cooling tower."""
    draw = Draw("bench-convergence", 1, seed)
    return near(draw, Sizes(*np.repeat(np.array([NEAR_SCENES[0]]), CONVERGENCE_ROWS, axis=0).T), CONVERGENCE_GAPS)


def _convergence_line(pairing: str, triangles: int, rows: Rows, truth: Answers) -> ConvergenceLine:
    """Return the record's line about a mesh of so many triangles: its errors, and times of building and asking."""
    alpha, gamma, b, d = NEAR_SCENES[0]
    sizes = alpha, gamma, b, d
    height = height_of(sizes, rows)
    builds: list[int] = []
    while not builds or sum(builds) < _BUILDS_NS:
        started = time.perf_counter_ns()
        mesh = scene_mesh(FCL, pairing, sizes, height, triangles)
        builds.append(time.perf_counter_ns() - started)
    queries = []
    for _ in range(5):
        started = time.perf_counter_ns()
        answers = mesh.answers(rows)
        queries.append((time.perf_counter_ns() - started) / len(rows))
    return ConvergenceLine(
        method=f"{FCL.name}-{pairing}",
        triangles=mesh.triangles,
        build_ns=float(np.median(builds)),
        query_ns=float(np.median(queries)),
        deviation=mesh.deviation,
        asked=len(rows),
        wrong=int(np.count_nonzero(answers != truth)),
    )


BOUNDING_SHAPES: Mapping[str, Callable[[Rows], Answers]] = MappingProxyType(
    {"sphere": alternatives.bounding_sphere, "cylinder": on_rows(alternatives.bounding_cylinder)}
)
BOUNDING_WORKLOADS = ("uniform", "flight")
BOUNDING_RATIOS = tuple(2.0**exponent for exponent in range(-4, 5))
"""The ratios d/b of the spheroids, from flat to tall."""

_SHARE = 4
"""One in so many of the judged rows is asked for each ratio, because there are many."""


def bounding_lines(plan: BenchPlan) -> Iterator[BoundingLine]:
    """Yield a line for each shape and workload."""
    for workload in BOUNDING_WORKLOADS:
        rows = WORKLOADS[workload].rows(plan.seed, plan.amounts.judged // _SHARE)
        for shape, answer in BOUNDING_SHAPES.items():
            yield bounding_line(rows, answer, shape, workload)


def bounding_line(rows: Rows, answer: Callable[[Rows], Answers], shape: str, workload: str) -> BoundingLine:
    """Return the answers of a shape that replaces the spheroid, for each ratio d/b."""
    overlap: list[tuple[float, int, int, float | None]] = []
    false_contact = false_clear = 0
    for ratio in BOUNDING_RATIOS:
        some = rows.copy()
        some[:, 3] = some[:, 2] * ratio
        positions, answers = float_filter.positions(some), answer(some)
        refused = (positions != 0) & (answers == 0)
        false_contact += int(refused.sum())
        false_clear += int(((answers != 0) & (answers != positions)).sum())
        excess = float(np.median(clearances(some[refused]).clearance)) if refused.any() else None
        overlap.append((ratio, len(some), int(refused.sum()), excess))
    count = len(rows) * len(BOUNDING_RATIOS)
    return BoundingLine(
        shape=shape,
        workload=workload,
        asked=count,
        false_contact=false_contact,
        false_clear=false_clear,
        overlap=overlap,
    )
