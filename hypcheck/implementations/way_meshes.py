"""Ways against meshes: FCL's continuous collision, and steps by an engine's distance, which coal's users must take.

A scene has one inscribed mesh of the whole surface (meshes.py), as high as its ways. What FCL's solvers do with a mesh,
as python-fcl 0.7.0.11 has them:

- *naive* asks `collide` at equally distant times, ten of them unless told otherwise. It takes every pairing; here it
  has the ellipsoid, in the caller's units.
- *conservative advancement*, FCL's own choice, supports no ellipsoid with a mesh, overflows the stack where a sphere
  comes before a mesh, and takes a mesh before a sphere, or two. Its steps are then too long: what does not
  touch at the start it calls clear. The unit sphere in spheroid radii stands behind the mesh here.
- *polynomial* takes two meshes that are translated, of which it forgets where they are placed, so that the vertices
  must stand there, and which it leaves moved, so that the spheroid's is built for each way. It sees crossings of
  faces and edges, and stops at any of them: it tells hits, but not the first time.
- *ray shooting* is an empty branch: it answers nothing.

coal has no continuous collision. What its users can write is conservative advancement with its distance between the
centre and the mesh in spheroid radii, and that is done here with FCL's as well.

Answers are 1 for contact and 0 for none, CANNOT_SAY where the engine refuses the mesh, where a length is too large for
it, or where the steps make no progress.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Rows
from hypcheck.implementations.meshes import COAL, FCL, LARGEST, MeshGrid, MeshLibrary, grid_of, rows_by_sizes
from hypcheck.implementations.method import Answers
from hypcheck.implementations.ways import MOST_ADVANCES, NEARNESS, HitsAndTimes
from hypcheck.truth.mesh import Triangles, Vertices, fcl_module, mesh_object

TRIANGLES = 2000
"""Of the hyperboloid's mesh, about."""

BALL = 500
"""Triangles of the spheroid's mesh, about."""

Meets = Callable[[Floats, Floats], tuple[int, float]]
"""Whether the body meets the mesh between two centres (3,), and the time of first contact, NaN if there is none."""


@dataclass(frozen=True, slots=True)
class WaySolver:
    """A way to ask an engine: `meets` makes it from vertices, triangles, b and d; None if the engine refuses them.

    `scaled`: lengths are in spheroid radii, so that the body is a unit sphere. `times`: it gives the first time.
    """

    name: str
    title: str
    engine: MeshLibrary
    meets: Callable[[Vertices, Triangles, float, float], Meets | None]
    scaled: bool = True
    times: bool = True


@dataclass(frozen=True, slots=True)
class WayMesh:
    """A mesh in an engine, for one α, γ, b, d; `unit` are the units of a centre's three coordinates."""

    triangles: int
    unit: tuple[float, float, float]
    meets: Meets | None

    def hits_and_times(self, rows: Rows) -> HitsAndTimes:
        """Hits and times (n,) of rows (n, 10) that have these sizes."""
        hits, times = np.full(len(rows), CANNOT_SAY, dtype=np.int8), np.full(len(rows), np.nan)
        ends = rows[:, 4:] / np.array(self.unit * 2)
        if self.meets is not None:
            for place in np.flatnonzero((np.abs(ends) < LARGEST).all(axis=1)).tolist():
                hits[place], times[place] = self.meets(ends[place, :3], ends[place, 3:])
        return hits, times

    def answers(self, rows: Rows) -> Answers:
        """Hits alone."""
        return self.hits_and_times(rows)[0]


def height_of_ways(sizes: Sizes, rows: Rows) -> float:
    """The height of a scene's mesh, in the caller's unit: beyond γ, and beyond every way that is asked."""
    _, gamma, _, d = sizes
    return float(max(1.2 * gamma, np.abs(rows[:, [6, 9]]).max(initial=0.0)) + 1.1 * d)


def way_mesh(solver: WaySolver, sizes: Sizes, height: float, triangles: int = TRIANGLES) -> WayMesh:
    """The scene's mesh for a solver."""
    alpha, gamma, b, d = sizes
    grid = grid_of(alpha / b, gamma / d, height / d, triangles)
    whole = grid if solver.scaled else MeshGrid(alpha, gamma, height, grid.around, grid.along)
    with np.errstate(all="ignore"):
        vertices, indices = whole.mesh()
    usable = bool(np.abs(vertices).max() < LARGEST)
    unit = (b, b, d) if solver.scaled else (1.0, 1.0, 1.0)
    return WayMesh(whole.triangles, unit, solver.meets(vertices, indices, b, d) if usable else None)


def hits_and_times(solver: WaySolver, rows: Rows) -> HitsAndTimes:
    """Hits and times of rows (n, 10) of any sizes, each scene with a mesh that is built now."""
    hits, times = np.empty(len(rows), dtype=np.int8), np.empty(len(rows))
    for sizes, places in rows_by_sizes(rows):
        mesh = way_mesh(solver, sizes, height_of_ways(sizes, rows[places]))
        hits[places], times[places] = mesh.hits_and_times(rows[places])
    return hits, times


def _solved(result: Any, returned: float) -> tuple[int, float]:  # noqa: ANN401 - FCL has no types
    """What FCL found; it returns −1 where it cannot."""
    if returned < 0:
        return CANNOT_SAY, math.nan
    return (1, float(result.time_of_contact)) if result.is_collide else (0, math.nan)


def _naive(count: int) -> Callable[[Vertices, Triangles, float, float], Meets | None]:
    def make(vertices: Vertices, triangles: Triangles, b: float, d: float) -> Meets | None:
        fcl, mesh = fcl_module(), mesh_object(vertices, triangles)
        if mesh is None:
            return None
        body, still = fcl.CollisionObject(fcl.Ellipsoid(b, b, d)), fcl.Transform()
        request = _request(fcl.CCDSolverType.CCDC_NAIVE, num_max_iterations=count)

        def meets(start: Floats, end: Floats) -> tuple[int, float]:
            body.setTranslation(start)
            result = fcl.ContinuousCollisionResult()
            return _solved(result, fcl.continuousCollide(body, fcl.Transform(end), mesh, still, request, result))

        return meets

    return make


def _advancement(vertices: Vertices, triangles: Triangles, _b: float, _d: float) -> Meets | None:
    fcl, mesh = fcl_module(), mesh_object(vertices, triangles)
    if mesh is None:
        return None
    body, still = fcl.CollisionObject(fcl.Sphere(1.0)), fcl.Transform()
    request = _request(fcl.CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT)

    def meets(start: Floats, end: Floats) -> tuple[int, float]:
        body.setTranslation(start)
        result = fcl.ContinuousCollisionResult()
        return _solved(result, fcl.continuousCollide(mesh, still, body, fcl.Transform(end), request, result))

    return meets


def _polynomial(vertices: Vertices, triangles: Triangles, _b: float, _d: float) -> Meets | None:
    fcl, mesh = fcl_module(), mesh_object(vertices, triangles)
    if mesh is None:
        return None
    still, (ball, facets) = fcl.Transform(), ball_mesh(BALL)
    request = _request(fcl.CCDSolverType.CCDC_POLYNOMIAL_SOLVER)

    def meets(start: Floats, end: Floats) -> tuple[int, float]:
        body = mesh_object(np.ascontiguousarray(ball + start), facets)
        if body is None:
            return CANNOT_SAY, math.nan
        result = fcl.ContinuousCollisionResult()
        found = fcl.continuousCollide(body, fcl.Transform(end - start), mesh, still, request, result)
        return _solved(result, found)

    return meets


def _request(solver: int, **more: int) -> object:
    fcl = fcl_module()
    request: object = fcl.ContinuousCollisionRequest(
        ccd_solver_type=solver, ccd_motion_type=fcl.CCDMotionType.CCDM_TRANS, **more
    )
    return request


@cache
def ball_mesh(triangles: int) -> tuple[Vertices, Triangles]:
    """A unit sphere of about so many triangles, inscribed: parallels and meridians, twice as many of these."""
    parallels = max(2, round(math.sqrt(triangles) / 2))
    around = 2 * parallels
    polar, azimuth = np.meshgrid(
        np.linspace(0, math.pi, parallels + 1)[1:-1], np.linspace(0, 2 * math.pi, around, endpoint=False), indexing="ij"
    )
    rings = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1)
    vertices = np.concatenate([[(0.0, 0.0, 1.0)], rings.reshape(-1, 3), [(0.0, 0.0, -1.0)]])
    here = np.arange(around)
    there, last = (here + 1) % around, len(vertices) - 1
    caps = [(0 * here, 1 + here, 1 + there), (0 * here + last, last - around + there, last - around + here)]
    first = 1 + around * np.arange(parallels - 2)[:, np.newaxis]
    left, right = (first + here).ravel(), (first + there).ravel()
    belts = [(left, left + around, right), (right, left + around, right + around)]
    return vertices, np.concatenate([np.stack(corners, axis=1) for corners in [*caps, *belts]])


def _stepping(engine: MeshLibrary) -> Callable[[Vertices, Triangles, float, float], Meets | None]:
    """Conservative advancement: from each time as far as the centre's distance from the mesh allows, in radii."""

    def make(vertices: Vertices, triangles: Triangles, _b: float, _d: float) -> Meets | None:
        distance = engine.distance(vertices, triangles)
        if distance is None:
            return None

        def meets(start: Floats, end: Floats) -> tuple[int, float]:
            way, time = end - start, 0.0
            speed = math.hypot(*way)
            for _ in range(MOST_ADVANCES):
                gap = distance(*(start + time * way).tolist()) - 1
                if gap <= NEARNESS:
                    return 1, time
                if time >= 1 or not speed:
                    return 0, math.nan
                time = min(1.0, time + gap / speed)
            return CANNOT_SAY, math.nan

        return meets

    return make


NAIVE_TIMES = (10, 100)
"""Times at which the naive solver looks; ten are FCL's own choice."""

WAY_SOLVERS = {
    solver.name: solver
    for solver in (
        *(
            WaySolver(
                f"passage-fcl-naive-{count}",
                f"FCL's naive continuous collision: its ellipsoid and a mesh at {count} times",
                FCL,
                _naive(count),
                scaled=False,
            )
            for count in NAIVE_TIMES
        ),
        WaySolver(
            "passage-fcl-advancement",
            "FCL's conservative advancement, its own choice: a scaled mesh and the unit sphere",
            FCL,
            _advancement,
        ),
        WaySolver(
            "passage-fcl-polynomial",
            "FCL's polynomial solver: a scaled mesh and a mesh of the unit sphere",
            FCL,
            _polynomial,
            times=False,
        ),
        *(
            WaySolver(
                f"passage-{engine.name}-distance",
                f"conservative advancement by {engine.title}'s distance from the centre to a scaled mesh",
                engine,
                _stepping(engine),
            )
            for engine in (FCL, COAL)
        ),
    )
}
"""By name: what a collision engine offers for a way."""
