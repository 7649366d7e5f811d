"""`hypcheck bench --forest`: a walker's step among 10 to a million trees, compared with FCL's broad phase.

Forests of all sizes have the same density. A walk through each forest gives the questions; rational arithmetic gives
the true answers. The candidates are hypcheck's scene, and FCL's tree of bounding boxes with the trees as meshes or as
cylinders. The lines "forest" of the record show the time of a step by the number of trees; all answers are judged
before the timing.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from math import hypot
from time import perf_counter
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.plan import BenchPlan
from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Lengths, Position
from hypcheck.implementations.meshes import FCL, grid_of
from hypcheck.kernel.scene import Scene
from hypcheck.processes import Advance
from hypcheck.record import Recorder
from hypcheck.record.measurements import ForestLine
from hypcheck.runs.timing import TimingEntry, clocked_calls, estimate, measure, ratios
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, Span
from hypcheck.truth import exact
from hypcheck.truth.mesh import fcl_module

ROOM = 25.0
"""The area for each tree, in square metres."""

KINDS = tuple((alpha, gamma) for alpha in (0.61, 0.52, 0.45, 0.38, 0.27, 0.2, 0.14, 0.08) for gamma in (6.0, 28.0))
"""α and γ of the trees, in metres: half of them wider than the walker, half narrower (section 3.1 of the paper)."""

WALKER = Mover(0.3, 0.9)
STEP, REFUSED_TURN, LARGEST_TURN = 0.25, 60.0, 15.0
"""The walker's step in metres; her turn after a refused step, and the largest turn otherwise, in degrees."""

LOOK_AHEAD = 3.0
"""Metres beyond which no tree of KINDS touches a walker: the widest trunk is below 0.7 m at her height."""

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Forest:
    """Trees at `places` (n, 2), of the kinds with the numbers `kinds` (n,), on a square with sides of `side` metres."""

    side: float
    places: NDArray[np.float64]
    kinds: NDArray[np.int64]

    @cached_property
    def model(self) -> SceneModel:
        """The forest on a plain as a scene whose question is whether the walker is clear of all trees."""
        pairs = zip(self.kinds.tolist(), self.places.tolist(), strict=True)
        trees = tuple(_tree(number, kind, (x, y)) for number, (kind, (x, y)) in enumerate(pairs, start=1))
        return SceneModel("forest", "exterior", trees, WALKER, Region(z=Span(0.0, 0.0)))

    def clear(self, centre: Point) -> bool:
        """Whether the walker is clear, by rational arithmetic; trees that are metres away are left out."""
        x, y, _ = centre
        near = np.flatnonzero(np.hypot(self.places[:, 0] - x, self.places[:, 1] - y) < LOOK_AHEAD)
        return all(self._beside(index, centre) is Position.EXTERIOR for index in near.tolist())

    def _beside(self, index: int, centre: Point) -> Position:
        """Return the exact position of the walker at a centre beside one tree."""
        alpha, gamma = KINDS[int(self.kinds[index])]
        there = self.places[index].tolist()
        x, y = (Fraction(here) - Fraction(tree) for here, tree in zip(centre[:2], there, strict=True))
        return exact.position(Lengths.of((alpha, gamma, WALKER.b, WALKER.d, x, y, centre[2])))


def _tree(number: int, kind: int, place: tuple[float, float]) -> Hyperboloid:
    """Return a tree of a kind at a place."""
    alpha, gamma = KINDS[kind]
    return Hyperboloid(f"tree {number}", alpha, gamma, (*place, 0.0), Span(-0.9, 5.0))


def forest_of(trees: int, seed: int) -> Forest:
    """Return a forest of `trees` trees, uniform on a square."""
    draw = np.random.Generator(np.random.PCG64([seed, trees]))
    side = float(np.sqrt(ROOM * trees))
    return Forest(side, side * draw.random((trees, 2)), draw.integers(0, len(KINDS), trees))


def walk(scene: Scene, forest: Forest, steps: int, seed: int) -> list[Point]:
    """Return the centres that a walker tests: each is a step from the walker's place.

    The walker moves there if clear.
    """
    draw = np.random.Generator(np.random.PCG64([seed, steps]))
    x = y = forest.side / 2
    heading, centres = 0.0, []
    for turn, side in draw.random((steps, 2)).tolist():
        to_x = x + STEP * float(np.cos(np.deg2rad(heading)))
        to_y = y + STEP * float(np.sin(np.deg2rad(heading)))
        centres.append((to_x, to_y, 0.0))
        if 0 < to_x < forest.side and 0 < to_y < forest.side and scene.position(to_x, to_y, 0.0) == 1:
            x, y = to_x, to_y
            heading += LARGEST_TURN * (2 * turn - 1)
        else:
            heading += REFUSED_TURN if side < 0.5 else -REFUSED_TURN
    return centres


Clear = Callable[[float, float, float], int]
"""A function of the walker's centre x, y, z that returns 1 if the walker is clear of every tree, else 0."""

TRIANGLES = 128
HEIGHT = 1.2 * WALKER.d
"""The height of a tree's mesh on both sides: beyond the walker's head and feet."""


@dataclass(frozen=True)
class Walker:
    """A program that tests a walker's steps.

    `make` builds what it needs for a forest, and returns its answering function.
    """

    title: str
    triangles: int | None
    make: Callable[[Forest], Clear]


def _walker_scene(forest: Forest) -> Clear:
    """Return the answering function of hypcheck's scene."""
    scene = Scene(forest.model)
    scene.position(0.0, 0.0, 0.0)  # the first query prepares the tree
    return scene.position


def _meshes() -> list[Any]:
    """Return a mesh of each kind, which all trees of that kind share."""
    fcl = fcl_module()
    meshes = []
    for alpha, gamma in KINDS:
        vertices, triangles = grid_of(alpha, gamma, HEIGHT, TRIANGLES).mesh()
        mesh = fcl.BVHModel()
        mesh.beginModel(len(triangles), len(vertices))
        mesh.addSubModel(vertices, triangles)
        if mesh.endModel() != 0:
            raise UnavailableError("FCL refuses the mesh of a tree")
        meshes.append(mesh)
    return meshes


def _cylinders() -> list[Any]:
    """Return for each kind of tree the smallest upright cylinder around the part that the walker can reach."""
    return [fcl_module().Cylinder(alpha * hypot(1.0, WALKER.d / gamma), 2 * HEIGHT) for alpha, gamma in KINDS]


def _in_fcl(shapes: Callable[[], list[Any]], forest: Forest) -> Clear:
    """Return FCL's broad phase with every tree as the shape of its kind."""
    fcl, kinds = fcl_module(), shapes()
    trees = [
        fcl.CollisionObject(kinds[kind], fcl.Transform(np.array([x, y, 0.0])))
        for kind, (x, y) in zip(forest.kinds.tolist(), forest.places.tolist(), strict=True)
    ]
    manager = fcl.DynamicAABBTreeCollisionManager()
    manager.registerObjects(trees)
    manager.setup()
    walker = fcl.CollisionObject(fcl.Ellipsoid(WALKER.b, WALKER.b, WALKER.d))

    def clear(x: float, y: float, z: float, _kept: Any = (kinds, trees)) -> int:  # noqa: ANN401
        walker.setTranslation(np.array([x, y, z]))
        data = fcl.CollisionData()  # FCL keeps results between calls
        manager.collide(walker, data, fcl.defaultCollisionCallback)
        return int(not data.result.is_collision)

    return clear


OURS = "hypcheck.Scene"
WALKERS: Mapping[str, Walker] = MappingProxyType(
    {
        OURS: Walker("a grid of cells, then exact decisions", None, _walker_scene),
        "fcl-meshes": Walker(
            f"FCL: DynamicAABBTreeCollisionManager, trees as meshes of about {TRIANGLES} triangles, one for each of "
            f"{len(KINDS)} kinds; an Ellipsoid walks",
            TRIANGLES,
            partial(_in_fcl, _meshes),
        ),
        "fcl-cylinders": Walker(
            "FCL: the same with a bounding cylinder for each tree", None, partial(_in_fcl, _cylinders)
        ),
    }
)


TREES = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
MOST, QUICK_MOST = 100_000, 10_000
"""The largest forest of a run that measures everything, and of a quick one: FCL takes seconds to build the next."""

STEPS = 256
ROUNDS, QUICK_ROUNDS = 11, 5


def sizes(plan: BenchPlan) -> Sequence[int]:
    """Return the numbers of trees of the run's forests."""
    most = QUICK_MOST if plan.quick else max(TREES) if plan.forest else MOST
    return tuple(trees for trees in TREES if trees <= most)


def run(
    recorder: Recorder,
    advance: Advance,
    seed: int,
    forests: Sequence[int],
    rounds: int = ROUNDS,
    steps: int = STEPS,
    walkers: Mapping[str, Walker] = WALKERS,
) -> None:
    """Add a line for each number of trees in `forests` and each candidate, timed in `rounds` rounds."""
    for trees in forests:
        for line in _lines(forest_of(trees, seed), rounds, steps, walkers, seed):
            recorder.add(line)
        advance(1)


def _lines(
    forest: Forest, rounds: int, steps: int, candidates: Mapping[str, Walker], seed: int
) -> Iterator[ForestLine]:
    """Yield a line for each candidate that is available here; FCL may be missing."""
    centres = walk(Scene(forest.model), forest, steps, seed)
    truth = [int(forest.clear(centre)) for centre in centres]
    walkers = {name: candidate for name, candidate in candidates.items() if name == OURS or FCL.trouble() is None}
    functions = {name: _made(walker, forest) for name, walker in walkers.items()}
    wrong = {
        name: sum(clear(*centre) != true for centre, true in zip(centres, truth, strict=True))
        for name, (clear, _) in functions.items()
    }
    samples = measure(
        [TimingEntry(name, steps, clocked_calls(functions[name][0], centres)) for name in functions], rounds
    )
    for timed in samples:
        step = estimate([timed.samples_ns])
        ratio = estimate(ratios([timed.samples_ns], [samples[0].samples_ns]))
        yield ForestLine(
            method=timed.name,
            title=walkers[timed.name].title,
            exact=timed.name == OURS,
            trees=len(forest.places),
            triangles=walkers[timed.name].triangles,
            asked=steps,
            wrong=wrong[timed.name],
            build_s=functions[timed.name][1],
            step_ns=step.median,
            ci95_ns=(step.low, step.high),
            ratio=ratio.median,
            ratio_ci95=(ratio.low, ratio.high),
        )


def _made(walker: Walker, forest: Forest) -> tuple[Clear, float]:
    """Return a candidate's answering function, and the seconds for building it from the list of trees."""
    forest.model  # noqa: B018 - a property that is made once
    gc.collect()
    started = perf_counter()
    clear = walker.make(forest)
    return clear, perf_counter() - started
