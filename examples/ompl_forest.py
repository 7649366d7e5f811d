"""A drone plans through a forest: OMPL with hypcheck's Scene as its checker, beside the same planner on FCL meshes.

All checkers get the same trees, start, goal, seeds and time limit, and the same resolution: states every 0.1 m of a
motion for FCL, and for `Scene` the same states (as a state checker), or whole motions (as a motion checker, by
`Scene.passage`). Every path that is accepted is then judged by the exact passage. Run it by

    pip install ompl python-fcl hypcheck
    python ompl_forest.py --trees 10000 --seconds 5 --seeds 5
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, field

import fcl
import numpy as np
from ompl import base, geometric, util

from hypcheck import Mover, Scene

RESOLUTION = 0.1
DRONE = Mover(0.4, 0.2)
SEGMENTS, RINGS = 24, 8
"""Of a tree's mesh: 24 sides, 8 rings."""


def forest(count: int, seed: int = 1) -> Scene:
    """Solid trees in rows 3 m apart, each up to 0.8 m off its place, 9 m tall."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(np.sqrt(count)))
    place = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count] * 3.0
    centers = np.c_[place + random.uniform(-0.8, 0.8, (count, 2)), np.zeros(count)]
    alpha, gamma = random.uniform(0.2, 0.6, count), random.uniform(3, 8, count)
    return Scene.from_arrays(alpha, gamma, centers, mover=DRONE, z_min=-1, z_max=8, solid=True)


def mesh_of(tree) -> fcl.BVHModel:
    """The wall and both ends of a tree as triangles, about its centre; corners lie on the surface."""
    turns = np.arange(SEGMENTS) / SEGMENTS * 2 * np.pi
    heights = np.linspace(tree.height.low, tree.height.high, RINGS + 1)
    radius = tree.alpha * np.sqrt(1 + (heights / tree.gamma) ** 2)
    rings = np.stack(
        [
            np.outer(radius, np.cos(turns)),
            np.outer(radius, np.sin(turns)),
            np.repeat(heights, SEGMENTS).reshape(-1, SEGMENTS),
        ],
        axis=-1,
    ).reshape(-1, 3)
    corners = np.vstack([rings, [[0, 0, heights[0]], [0, 0, heights[-1]]]])
    triangles = []
    for k in range(SEGMENTS):
        after = (k + 1) % SEGMENTS
        for ring in range(RINGS):
            a, b, c, d = (r * SEGMENTS + s for r in (ring, ring + 1) for s in (k, after))
            triangles += [(a, b, d), (a, d, c)]
        top = RINGS * SEGMENTS
        triangles += [(len(rings), after, k), (len(rings) + 1, top + k, top + after)]
    model = fcl.BVHModel()
    model.beginModel(len(triangles), len(corners))
    model.addSubModel(corners, np.array(triangles))
    model.endModel()
    return model


class FclWorld:
    """The same trees as meshes in FCL's tree of boxes, and the drone as its ellipsoid."""

    def __init__(self, scene: Scene) -> None:
        trees = scene.model.hyperboloids
        self.trees = [fcl.CollisionObject(mesh_of(tree), fcl.Transform(np.array(tree.center))) for tree in trees]
        self.manager = fcl.DynamicAABBTreeCollisionManager()
        self.manager.registerObjects(self.trees)
        self.manager.setup()
        self.drone = fcl.CollisionObject(fcl.Ellipsoid(DRONE.b, DRONE.b, DRONE.d))

    def clear(self, place) -> bool:
        """Whether FCL finds no contact there."""
        self.drone.setTransform(fcl.Transform(np.asarray(place)))
        data = fcl.CollisionData()
        self.manager.collide(self.drone, data, fcl.defaultCollisionCallback)
        return not data.result.is_collision


@dataclass
class Counted:
    """How many questions a checker was asked."""

    states: int = 0
    motions: int = 0


@dataclass
class Planned:
    """What a checker's planning gave, over all seeds."""

    name: str
    solved: int = 0
    seconds: list[float] = field(default_factory=list)
    states: int = 0
    motions: int = 0
    worst: float = np.inf
    paths: list[np.ndarray] = field(default_factory=list)
    touches: list[tuple[float, float, float]] = field(default_factory=list)
    """Where the drone is when an accepted path first touches a tree."""


class Exact(base.MotionValidator):
    """Whole motions, decided by Scene.passage."""

    def __init__(self, space, scene: Scene, counted: Counted) -> None:
        super().__init__(space)
        self.scene, self.counted = scene, counted

    def checkMotion(self, first, second, *_) -> bool:
        """Whether the motion is clear, ends included; the name is OMPL's."""
        self.counted.motions += 1
        return not self.scene.passage([first[0], first[1], first[2]], [second[0], second[1], second[2]]).hit


def plan(scene: Scene, kind: str, world: FclWorld | None, seed: int, seconds: float):
    """One run of RRT-Connect: its path (T, 3) or None, its time, and what was asked."""
    util.RNG.setSeed(seed)
    counted = Counted()
    span = float(max(tree.center[0] for tree in scene.model.hyperboloids))
    space = base.RealVectorStateSpace(3)
    bounds = base.RealVectorBounds(3)
    for axis, (low, high) in enumerate(((-5, span + 4), (-5, span + 4), (0.5, 6.0))):
        bounds.setLow(axis, low)
        bounds.setHigh(axis, high)
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    information = setup.getSpaceInformation()

    def valid(state) -> bool:
        counted.states += 1
        place = state[0], state[1], state[2]
        return world.clear(place) if kind == "FCL" else scene.position(*place) == 1

    setup.setStateValidityChecker(valid)
    information.setStateValidityCheckingResolution(RESOLUTION / space.getMaximumExtent())
    if kind == "Scene, motions":
        motions = Exact(information, scene, counted)
        information.setMotionValidator(motions)
    ends = [space.allocState() for _ in range(2)]
    for state, place in zip(ends, ((-4.0, -4.0, 2.0), (span + 3.0, span + 3.0, 3.0)), strict=True):
        for axis in range(3):
            state[axis] = place[axis]
    setup.setStartAndGoalStates(*ends)
    planner = geometric.RRTConnect(information)
    planner.setRange(6.0)
    setup.setPlanner(planner)
    begin = time.perf_counter()
    setup.solve(seconds)
    took = time.perf_counter() - begin
    if not setup.haveExactSolutionPath():
        return None, took, counted
    states = setup.getSolutionPath().getStates()
    return np.array([[state[0], state[1], state[2]] for state in states]), took, counted


def compared(scene: Scene, seeds: int, seconds: float) -> list[Planned]:
    """Each checker on the same seeds."""
    world = FclWorld(scene)
    found = []
    for kind in ("FCL", "Scene, states", "Scene, motions"):
        planned = Planned(kind)
        for seed in range(1, seeds + 1):
            path, took, counted = plan(scene, kind, world, seed, seconds)
            planned.states += counted.states
            planned.motions += counted.motions
            planned.seconds.append(took)
            if path is None:
                continue
            planned.solved += 1
            planned.paths.append(path)
            judged = scene.first_contact(path)
            if judged.hit:
                planned.touches.append(tuple(map(float, judged.center)))
            planned.worst = min(planned.worst, judged.least.distance_upper)
        found.append(planned)
    return found


def circles(axes, centers, radii, **style) -> None:
    """Draw circles about places (n, 2), in the units of the axes."""
    from matplotlib.collections import EllipseCollection  # noqa: PLC0415 - the picture alone needs it

    wide, at = 2 * np.asarray(radii), {"offsets": centers, "transOffset": axes.transData}
    axes.add_collection(EllipseCollection(wide, wide, np.zeros(len(wide)), units="xy", **at, **style))


def draw(scene: Scene, results: list[Planned], file: str) -> None:
    """The forest from above with the accepted paths, and the first place where one of them touches a tree."""
    from matplotlib.figure import Figure  # noqa: PLC0415 - the picture alone needs it

    trees = scene.model.hyperboloids
    centers = np.array([tree.center[:2] for tree in trees])
    figure = Figure(figsize=(11, 5.5), layout="constrained", dpi=110)
    whole, close = figure.subplots(1, 2, subplot_kw={"aspect": "equal", "xlabel": "x, m", "ylabel": "y, m"})
    touches = [(planned.name, place) for planned in results for place in planned.touches]
    name, (x, y, z) = touches[0] if touches else ("nothing", (*centers[0], 2.5))
    for axes in (whole, close):
        circles(axes, centers, [tree.alpha * np.hypot(1, z / tree.gamma) for tree in trees], facecolor="#8a9a7b")
        for planned, colour in zip(reversed(results), ("#d98200", "#1f5fa8", "#c2161d"), strict=True):
            for number, path in enumerate(planned.paths):
                axes.plot(*path[:, :2].T, color=colour, linewidth=1.2, label=planned.name if number == 0 else None)
    low, high = centers.min() - 8, centers.max() + 8
    whole.set(xlim=(low, high), ylim=(low, high), title="every accepted path")
    whole.legend(loc="upper left")
    if touches:
        circles(close, [(x, y)], [DRONE.b], facecolor="#c2161d55", edgecolor="#c2161d")
    title = f"{name}: an accepted path touches a tree" if touches else "no accepted path touches a tree"
    close.set(xlim=(x - 4, x + 4), ylim=(y - 4, y + 4), title=title)
    figure.savefig(file)


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--trees", type=int, default=10_000)
    options.add_argument("--seconds", type=float, default=5.0)
    options.add_argument("--seeds", type=int, default=5)
    options.add_argument(
        "--picture", metavar="FILE", help="draw the trees and a path of each checker (needs matplotlib)"
    )
    asked = options.parse_args()
    util.noOutputHandler()
    scene = forest(asked.trees)
    print("| checker | solved | median s | states | motions | states/s | paths that touch | least distance |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    results = compared(scene, asked.seeds, asked.seconds)
    for each in results:
        rate = each.states / sum(each.seconds)
        print(
            f"| {each.name} | {each.solved} of {asked.seeds} | {np.median(each.seconds):.3f} | {each.states:,} | "
            f"{each.motions:,} | {rate:,.0f} | {len(each.touches)} | {each.worst:.4f} |"
        )
    if asked.picture:
        draw(scene, results, asked.picture)


if __name__ == "__main__":
    main()
