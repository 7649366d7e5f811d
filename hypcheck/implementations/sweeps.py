"""Methods that answer whether a spheroid has contact with the hyperboloid on a straight sweep, and when first.

Lengths are in spheroid radii here: across the axis divided by b, along it by d. The spheroid is then a unit ball, and
it is in contact as long as its centre is no farther than 1 from the surface. A method returns hits, int8 (n,), and
times, float64 (n,), NaN where it sees no contact. Rows are those of upright spheroids, or have an axis.

Collision engines answer too, about upright spheroids: FCL's continuous collision on meshes, and steps by an
engine's distance, which coal's users must take. A scene has one inscribed mesh of the whole surface (meshes.py), as
high as its sweeps. What FCL's solvers do with a mesh, as python-fcl 0.7.0.11 has them:

- *naive* asks `collide` at equally distant times, ten of them by default. It takes every pairing; here it
  has the ellipsoid, in the caller's units.
- *conservative advancement*, FCL's own choice, supports no ellipsoid with a mesh, overflows the stack where a sphere
  comes before a mesh, and takes a mesh before a sphere, or two. Its steps are then too long: what does not
  touch at the start it calls clear. The unit sphere in spheroid radii stands behind the mesh here.
- *polynomial* takes two meshes that are translated, of which it forgets where they are placed, so that the vertices
  must stand there, and which it leaves moved, so that the spheroid's is built for each sweep. It sees crossings of
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
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, SWEEP_COLUMNS, Sizes
from hypcheck.geometry.rows import CANNOT_SAY, SWEEPS, Floats, Rows, parts_of
from hypcheck.implementations.meshes import COAL, FCL, LARGEST, MeshGrid, MeshLibrary, grid_of, rows_by_sizes
from hypcheck.implementations.method import Answers
from hypcheck.kernel.in_use import kernel
from hypcheck.truth.mesh import Triangles, Vertices, fcl_module, mesh_object
from hypcheck.truth.swept import passage_of_row

HitsAndTimes = tuple[NDArray[np.int8], Floats]

SWEEP_ENDS = slice(len(COLUMNS), len(SWEEP_COLUMNS))
"""The columns of where a sweep ends."""

_HALVINGS = 100
"""How often the multiplier is bisected: enough for every float64 between its two ends."""

_ZOOM, _ZOOMS = 64, 5
"""The least distance on a sweep is searched at the ends of _ZOOM pieces, _ZOOMS times: each time nearer to the best."""

MOST_ADVANCES = 400
"""The most steps of conservative advancement."""

NEARNESS = 1e-6
"""A gap of at most this part of a radius is contact to conservative advancement."""


def exact(rows: Rows) -> HitsAndTimes:
    """Return the exact decision, and the float64 below the first contact."""
    sweeps = [passage_of_row(row) for row in rows.tolist()]
    return np.array([sweep.hit for sweep in sweeps], dtype=np.int8), np.array([sweep.first_lower for sweep in sweeps])


def sampled(rows: Rows, count: int) -> HitsAndTimes:
    """Return hits and times by exact positions at `count` equally distant times, both ends included.

    A hit is contact, or the other side of the hyperboloid than at the time before.
    """
    times = np.linspace(0.0, 1.0, count)
    positions = _positions(rows, times)
    return _first(positions == 0, times)


def _positions(rows: Rows, times: Floats) -> NDArray[np.int8]:
    """Return positions (n, m) at m times."""
    n, m, width = len(rows), len(times), len(COLUMNS)
    pairs = np.repeat(np.delete(rows, SWEEP_ENDS, axis=1)[:, None, :], m, axis=1)
    pairs[:, :, 4:width] += times[None, :, None] * (rows[:, SWEEP_ENDS] - rows[:, 4:7])[:, None, :]
    pairs[:, times == 1.0, 4:width] = rows[:, None, SWEEP_ENDS]
    return kernel().answer_rows(pairs.reshape(n * m, pairs.shape[2]), "position", 1)[0].reshape(n, m)


def _first(touching: NDArray[np.bool_], times: Floats) -> HitsAndTimes:
    """Return the first of the times at which each row is touching."""
    hits = touching.any(axis=1)
    first: Floats = np.where(hits, times[np.argmax(touching, axis=1)], np.nan)
    return np.asarray(hits, dtype=np.int8), first


def distances(rows: Rows, times: Floats) -> Floats:
    """Return distances (n,) of the centres at the times (n,) from the surface, in spheroid radii.

    The nearest point is where a multiplier solves the secular equation, which falls in it, between two poles.
    """
    curvatures, centres = _in_radii(rows, rows[:, 4:7] + times[:, None] * (rows[:, SWEEP_ENDS] - rows[:, 4:7]))
    low, high = -1 / curvatures[:, 2], -1 / curvatures[:, 0]
    with np.errstate(all="ignore"):
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            outer = (curvatures * (centres / (1 + middle[:, None] * curvatures)) ** 2).sum(axis=1) > 1
            low, high = np.where(outer, middle, low), np.where(outer, high, middle)
        near = np.where(centres == 0, 0, centres / (1 + low[:, None] * curvatures))
        # Beside a pole the coordinate that belongs to it follows from the others, since the point is on the surface.
        pole = np.where(low > 0, 0, 2)[:, None]
        rest = 1 - np.where(np.arange(3) == pole, 0, curvatures * near**2).sum(axis=1, keepdims=True)
        last = np.sqrt(np.maximum(rest / np.take_along_axis(curvatures, pole, axis=1), 0))
        side = np.copysign(last, np.take_along_axis(centres, pole, axis=1))
    np.put_along_axis(near, pole, side, axis=1)
    return np.asarray(np.linalg.norm(centres - near, axis=1))


def _in_radii(rows: Rows, centres: Floats) -> tuple[Floats, Floats]:
    """Return the hyperboloids in coordinates q in which the spheroid is a unit ball and they are Σ λ_i q_i² = 1.

    These are λ ascending, (n, 3), and the centres there, (n, 3). For upright spheroids the plane through the axis and
    the centre is enough.
    """
    alpha, gamma, b, d = rows[:, :4].T
    if not SWEEPS.has_axis(rows):
        across = b**2 / alpha**2
        radius = np.hypot(centres[:, 0], centres[:, 1]) / b
        return (
            np.column_stack([-(d**2) / gamma**2, across, across]),
            np.column_stack([centres[:, 2] / d, 0 * radius, radius]),
        )
    stretch, shrink = _along_and_across(rows, d, b), _along_and_across(rows, 1 / d, 1 / b)
    surface = np.column_stack([alpha**-2.0, alpha**-2.0, -(gamma**-2.0)])[:, :, None]
    curvatures, frames = np.linalg.eigh(stretch @ (surface * stretch))
    return curvatures, np.einsum("nij,njk,nk->ni", frames.transpose(0, 2, 1), shrink, centres)


def _along_and_across(rows: Rows, along: Floats, across: Floats) -> Floats:
    """Return matrices (n, 3, 3) that multiply by `along` along the spheroid's axis, by `across` across it."""
    _, axis, _ = parts_of(rows, SWEEPS)
    axis = axis / np.abs(axis).max(axis=1, keepdims=True)  # the square of a number of the axis may be infinite, or 0
    axis = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    onto: Floats = axis[:, :, None] * axis[:, None, :]
    return across[:, None, None] * (np.eye(3) - onto) + along[:, None, None] * onto


def least_distances(rows: Rows) -> Floats:
    """Return rough least distances (n,) of the centre from the surface on each sweep, in spheroid radii.

    A spheroid made so many times as large just touches on its sweep.
    """
    n = len(rows)
    low, high = np.zeros(n), np.ones(n)
    best = np.full(n, np.inf)
    for _ in range(_ZOOMS):
        times = low[:, None] + np.linspace(0.0, 1.0, _ZOOM + 1)[None, :] * (high - low)[:, None]
        values = distances(np.repeat(rows, _ZOOM + 1, axis=0), times.ravel()).reshape(n, _ZOOM + 1)
        place = np.argmin(values, axis=1)
        best = np.minimum(best, values[np.arange(n), place])
        low = times[np.arange(n), np.maximum(place - 1, 0)]
        high = times[np.arange(n), np.minimum(place + 1, _ZOOM)]
    return best


def lengths_of(rows: Rows) -> Floats:
    """Return lengths (n,) of sweeps in spheroid radii."""
    step, (b, d) = rows[:, SWEEP_ENDS] - rows[:, 4:7], rows[:, 2:4].T
    if not SWEEPS.has_axis(rows):
        return np.asarray(np.hypot(np.hypot(step[:, 0] / b, step[:, 1] / b), step[:, 2] / d))
    return np.asarray(np.linalg.norm(_along_and_across(rows, 1 / d, 1 / b) @ step[:, :, None], axis=(1, 2)))


def advanced(rows: Rows) -> HitsAndTimes:
    """Return hits and times by conservative advancement, until the spheroid is within NEARNESS of contact.

    Each step goes as far as the distance at its time allows. The hit is CANNOT_SAY where MOST_ADVANCES steps reach
    neither the surface nor the end of the sweep.
    """
    n, speed = len(rows), lengths_of(rows)
    hits, times, now = np.full(n, CANNOT_SAY, dtype=np.int8), np.full(n, np.nan), np.zeros(n)
    going = np.arange(n)
    for _ in range(MOST_ADVANCES):
        gap = distances(rows[going], now[going]) - 1
        met = gap <= NEARNESS
        hits[going[met]], times[going[met]] = 1, now[going[met]]
        going, gap = going[~met], gap[~met]
        over = now[going] >= 1
        hits[going[over]] = 0
        going, gap = going[~over], gap[~over]
        with np.errstate(divide="ignore"):
            now[going] = np.minimum(1.0, now[going] + gap / speed[going])
        if not len(going):
            break
    return hits, times


def capsule(rows: Rows) -> HitsAndTimes:
    """Return hits and times of the ball about the spheroid, with the larger semi-axis, by conservative advancement."""
    balls = rows.copy()
    balls[:, 2] = balls[:, 3] = np.maximum(rows[:, 2], rows[:, 3])
    return advanced(balls)


def certified(rows: Rows) -> NDArray[np.int8]:
    """Return hits (n,): by the kernel where its bounds prove them, else by the exact decision."""
    hits = kernel().answer_sweeps(rows)[0]
    rest = np.flatnonzero(hits == CANNOT_SAY)
    hits[rest] = exact(rows[rest])[0]
    return hits


def certified_times(rows: Rows) -> HitsAndTimes:
    """Return hits and times by the kernel where its bounds prove both, else exact ones."""
    hits, times = kernel().answer_sweeps(rows)
    rest = np.flatnonzero((hits == CANNOT_SAY) | ((hits == 1) & np.isnan(times)))
    hits[rest], times[rest] = exact(rows[rest])
    return hits, times


def rough_exponents(rows: Rows) -> Floats:
    """Return about log2 |k − 1|, (n,), where k is the factor of the spheroid's size at which its sweep just touches."""
    off = np.abs(least_distances(rows) - 1)
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.isnan(off), -np.inf, np.log2(off)))


TRIANGLES = 2000
"""About how many triangles the hyperboloid's mesh has."""

BALL = 500
"""About how many triangles the spheroid's mesh has."""

Meets = Callable[[Floats, Floats], tuple[int, float]]
"""Whether the body meets the mesh between two centres (3,), and the time of first contact, NaN if there is none."""


@dataclass(frozen=True, slots=True)
class SweepSolver:
    """A solver of an engine; `meets` makes it from the engine's object of a mesh, b and d.

    `scaled`: lengths are in spheroid radii, so that the body is a unit sphere. `times`: it gives the first time.
    """

    name: str
    title: str
    engine: MeshLibrary
    meets: Callable[[object, float, float], Meets]
    scaled: bool = True
    times: bool = True


@dataclass(frozen=True, slots=True)
class SweepMesh:
    """A mesh in an engine, for one α, γ, b, d; `unit` has the lengths by which x, y and z of a centre are divided."""

    triangles: int
    unit: tuple[float, float, float]
    meets: Meets | None

    def hits_and_times(self, rows: Rows) -> HitsAndTimes:
        """Return hits and times (n,) of rows (n, 10) that have these sizes."""
        hits, times = np.full(len(rows), CANNOT_SAY, dtype=np.int8), np.full(len(rows), np.nan)
        ends = rows[:, 4:] / np.array(self.unit * 2)
        if self.meets is not None:
            for place in np.flatnonzero((np.abs(ends) < LARGEST).all(axis=1)).tolist():
                hits[place], times[place] = self.meets(ends[place, :3], ends[place, 3:])
        return hits, times

    def answers(self, rows: Rows) -> Answers:
        """Return the hits only."""
        return self.hits_and_times(rows)[0]


def height_of_sweeps(sizes: Sizes, rows: Rows) -> float:
    """Return the height of a scene's mesh, in the caller's unit: above γ, and above every sweep that is tested."""
    _, gamma, _, d = sizes
    return float(max(1.2 * gamma, np.abs(rows[:, [6, 9]]).max(initial=0.0)) + 1.1 * d)


def sweep_mesh(solver: SweepSolver, sizes: Sizes, height: float, triangles: int = TRIANGLES) -> SweepMesh:
    """Return the scene's mesh for a solver."""
    alpha, gamma, b, d = sizes
    grid = grid_of(alpha / b, gamma / d, height / d, triangles)
    whole = grid if solver.scaled else MeshGrid(alpha, gamma, height, grid.around, grid.along)
    with np.errstate(all="ignore"):
        vertices, indices = whole.mesh()
    built = solver.engine.mesh(vertices, indices) if np.abs(vertices).max() < LARGEST else None
    unit = (b, b, d) if solver.scaled else (1.0, 1.0, 1.0)
    return SweepMesh(whole.triangles, unit, None if built is None else solver.meets(built, b, d))


def hits_and_times(solver: SweepSolver, rows: Rows) -> HitsAndTimes:
    """Return hits and times of rows (n, 10) of any sizes, each scene with a mesh that is built now."""
    hits, times = np.empty(len(rows), dtype=np.int8), np.empty(len(rows))
    for sizes, places in rows_by_sizes(rows):
        mesh = sweep_mesh(solver, sizes, height_of_sweeps(sizes, rows[places]))
        hits[places], times[places] = mesh.hits_and_times(rows[places])
    return hits, times


def _solved(result: Any, returned: float) -> tuple[int, float]:  # noqa: ANN401 - FCL has no types
    """Return the results of FCL, which returns −1 if it fails."""
    if returned < 0:
        return CANNOT_SAY, math.nan
    return (1, float(result.time_of_contact)) if result.is_collide else (0, math.nan)


def _naive(count: int) -> Callable[[object, float, float], Meets]:
    """Return FCL's naive solver, at `count` times."""

    def make(mesh: object, b: float, d: float) -> Meets:
        fcl = fcl_module()
        body, still = fcl.CollisionObject(fcl.Ellipsoid(b, b, d)), fcl.Transform()
        request = _request(fcl.CCDSolverType.CCDC_NAIVE, num_max_iterations=count)

        def meets(start: Floats, end: Floats) -> tuple[int, float]:
            body.setTranslation(start)
            result = fcl.ContinuousCollisionResult()
            return _solved(result, fcl.continuousCollide(body, fcl.Transform(end), mesh, still, request, result))

        return meets

    return make


def _advancement(mesh: object, _b: float, _d: float) -> Meets:
    """Return FCL's conservative advancement of the unit sphere."""
    fcl = fcl_module()
    body, still = fcl.CollisionObject(fcl.Sphere(1.0)), fcl.Transform()
    request = _request(fcl.CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT)

    def meets(start: Floats, end: Floats) -> tuple[int, float]:
        body.setTranslation(start)
        result = fcl.ContinuousCollisionResult()
        return _solved(result, fcl.continuousCollide(mesh, still, body, fcl.Transform(end), request, result))

    return meets


def _polynomial(mesh: object, _b: float, _d: float) -> Meets:
    """Return FCL's polynomial solver, with a mesh of the unit sphere."""
    fcl = fcl_module()
    still, (ball, facets) = fcl.Transform(), ball_mesh(BALL)
    request = _request(fcl.CCDSolverType.CCDC_POLYNOMIAL_SOLVER)

    def meets(start: Floats, end: Floats) -> tuple[int, float]:
        body = mesh_object(np.ascontiguousarray(ball + start), facets)
        if body is None:
            return CANNOT_SAY, math.nan
        result = fcl.ContinuousCollisionResult()
        time = fcl.continuousCollide(body, fcl.Transform(end - start), mesh, still, request, result)
        return _solved(result, time)

    return meets


def _request(solver: int, **more: int) -> object:
    """Return a request for one of FCL's solvers, for translations."""
    fcl = fcl_module()
    request: object = fcl.ContinuousCollisionRequest(
        ccd_solver_type=solver, ccd_motion_type=fcl.CCDMotionType.CCDM_TRANS, **more
    )
    return request


@cache
def ball_mesh(triangles: int) -> tuple[Vertices, Triangles]:
    """Return a unit sphere of about so many triangles, inscribed: parallels and meridians, twice as many of these."""
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


def _stepping(engine: MeshLibrary) -> Callable[[object, float, float], Meets]:
    """Return a solver by conservative advancement: each step goes as far as the centre's distance allows."""

    def make(mesh: object, _b: float, _d: float) -> Meets:
        distance = engine.distance(mesh)

        def meets(start: Floats, end: Floats) -> tuple[int, float]:
            sweep, time = end - start, 0.0
            speed = math.hypot(*sweep)
            for _ in range(MOST_ADVANCES):
                gap = distance(*(start + time * sweep).tolist()) - 1
                if gap <= NEARNESS:
                    return 1, time
                if time >= 1 or not speed:
                    return 0, math.nan
                time = min(1.0, time + gap / speed)
            return CANNOT_SAY, math.nan

        return meets

    return make


NAIVE_TIMES = (10, 100)
"""At how many times the naive solver tests; ten are FCL's own choice."""

SWEEP_SOLVERS = {
    solver.name: solver
    for solver in (
        *(
            SweepSolver(
                f"passage-fcl-naive-{count}",
                f"FCL's naive continuous collision: its ellipsoid and a mesh at {count} times",
                FCL,
                _naive(count),
                scaled=False,
            )
            for count in NAIVE_TIMES
        ),
        SweepSolver(
            "passage-fcl-advancement",
            "FCL's conservative advancement, its own choice: a scaled mesh and the unit sphere",
            FCL,
            _advancement,
        ),
        SweepSolver(
            "passage-fcl-polynomial",
            "FCL's polynomial solver: a scaled mesh and a mesh of the unit sphere",
            FCL,
            _polynomial,
            times=False,
        ),
        *(
            SweepSolver(
                f"passage-{engine.name}-distance",
                f"conservative advancement by {engine.title}'s distance from the centre to a scaled mesh",
                engine,
                _stepping(engine),
            )
            for engine in (FCL, COAL)
        ),
    )
}
"""The solvers for sweeps that collision engines offer, by name."""
