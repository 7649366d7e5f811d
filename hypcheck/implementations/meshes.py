"""Collision engines on meshes: python-fcl and coal, with one mesh for a scene, and the naive use of FCL.

An engine makes a mesh into a function that says whether the body with a given centre touches it. The engines are
imported inside functions, since neither is installed everywhere.

A scene has one mesh of the whole surface, built once. The mesh is inscribed: its vertices lie on the surface. Its grid
is the best one with so many triangles, equally inaccurate in both directions. There are three pairings: the ellipsoid
in the caller's units; and the unit sphere, or the distance of the centre, in spheroid radii (Theorem 1 of the paper).
The answer is 0 if the engine reports contact, else the sign of F(C) = (x² + y²)/α² − z²/γ² − 1 in plain floats, and
CANNOT_SAY if the engine refuses the mesh. α, γ are the sizes of the hyperboloid, b, d those of the spheroid, and C =
(x, y, z) is its centre.

The naive use of FCL builds a plain mesh for each row, as one would write it at first. It is under test, and no source
of truth. The mesh differs from the surface by up to its sagitta on one side; docs/mesh-oracle.md shows the effect of
that, and of FCL's own tolerances. It has the same pairings and answers, with CANNOT_SAY also if a number of the mesh
exceeds FCL's safe range. It raises UnavailableError without FCL.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from math import cos, hypot, isqrt, pi, sqrt
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, Floats, Positions, Rows
from hypcheck.implementations.method import Answers
from hypcheck.truth.mesh import Triangles, Vertices, availability, fcl_module, mesh_object, require_fcl


class ContactQuery(Protocol):
    """Whether the body with this centre touches the mesh; `turn` (3, 3) turns its axis of revolution away from z."""

    def __call__(self, x: float, y: float, z: float, turn: Floats | None = None, /) -> bool:
        """Ask the engine. Only an ellipsoid can be turned."""
        ...


class Distance(Protocol):
    """The distance between a point and the mesh."""

    def __call__(self, x: float, y: float, z: float, /) -> float:
        """Ask the engine."""
        ...


PAIRINGS = ("point", "sphere", "ellipsoid")
"""What is compared with the mesh: the centre, which touches if its distance is at most 1; the unit sphere; the
spheroid. For the first two, lengths are in spheroid radii."""


@dataclass(frozen=True, slots=True)
class MeshLibrary:
    """A collision engine; `trouble` gives the reason why it cannot be used, or None.

    `mesh` makes the engine's object from vertices and triangles, or None if the engine refuses them. From that object,
    `collides` makes the query for the pairing "sphere" or "ellipsoid" with the semi-axes b and d, and `distance` makes
    the function for the distance of a point.
    """

    name: str
    title: str
    trouble: Callable[[], str | None]
    mesh: Callable[[Vertices, Triangles], Any]
    collides: Callable[[Any, str, float, float], ContactQuery]
    distance: Callable[[Any], Distance]

    def question(self, pairing: str, built: object | None, b: float, d: float) -> ContactQuery | None:
        """Return the query of one of PAIRINGS about a mesh that the engine built; None if the engine refused the mesh.

        With "point" the body touches if the distance of its centre from the mesh is at most 1: lengths are in spheroid
        radii, so the spheroid is the unit ball.
        """
        if built is None:
            return None
        if pairing != "point":
            return self.collides(built, pairing, b, d)
        distance = self.distance(built)
        return lambda x, y, z, _turn=None: distance(x, y, z) <= 1.0


def _fcl_collides(mesh: object, pairing: str, b: float, d: float) -> ContactQuery:
    """Return the query by FCL for the unit sphere, or for the ellipsoid b, b, d."""
    fcl = fcl_module()
    body = fcl.CollisionObject(fcl.Sphere(1.0) if pairing == "sphere" else fcl.Ellipsoid(b, b, d))
    request = fcl.CollisionRequest()

    def collides(x: float, y: float, z: float, turn: Floats | None = None) -> bool:
        body.setTranslation(np.array([x, y, z]))
        if turn is not None:
            body.setRotation(turn)
        return bool(fcl.collide(body, mesh, request, fcl.CollisionResult()) > 0)  # FCL does not reset a result

    return collides


def _fcl_distance(mesh: object) -> Distance:
    """Return the function for the distance of a point by FCL."""
    fcl = fcl_module()
    point, near = fcl.CollisionObject(fcl.Sphere(0.0)), fcl.DistanceRequest()

    def distance(x: float, y: float, z: float) -> float:
        point.setTranslation(np.array([x, y, z]))
        return float(fcl.distance(point, mesh, near, fcl.DistanceResult()))

    return distance


def _coal_collides(mesh: object, pairing: str, b: float, d: float) -> ContactQuery:
    """Return the query by coal for the unit sphere, or for the ellipsoid b, b, d."""
    coal = _coal_module()
    shape = coal.Sphere(1.0) if pairing == "sphere" else coal.Ellipsoid(b, b, d)
    here, there = coal.Transform3s(), coal.Transform3s()
    request = coal.CollisionRequest()

    def collides(x: float, y: float, z: float, turn: Floats | None = None) -> bool:
        here.setTranslation(np.array([x, y, z]))
        if turn is not None:
            here.setRotation(turn)
        return bool(coal.collide(shape, here, mesh, there, request, coal.CollisionResult()) > 0)

    return collides


def _coal_distance(mesh: object) -> Distance:
    """Return the function for the distance of a point by coal."""
    coal = _coal_module()
    point, here, there, near = coal.Sphere(0.0), coal.Transform3s(), coal.Transform3s(), coal.DistanceRequest()

    def distance(x: float, y: float, z: float) -> float:
        here.setTranslation(np.array([x, y, z]))
        return float(coal.distance(point, here, mesh, there, near, coal.DistanceResult()))

    return distance


def _coal_mesh(vertices: Vertices, triangles: Triangles) -> Any:  # noqa: ANN401 - it has no types
    """Return coal's model of a mesh, or None where coal refuses it."""
    mesh = _coal_module().BVHModelOBBRSS()
    mesh.beginModel(len(triangles), len(vertices))
    mesh.addVertices(vertices)
    mesh.addTriangles(triangles)
    return None if mesh.endModel() != 0 else mesh


def _coal_module() -> Any:  # noqa: ANN401 - it has no types
    """Return the module of coal. Raises ImportError if it is not installed."""
    import coal  # noqa: PLC0415

    return coal


def _coal_trouble() -> str | None:
    """Return the reason why coal cannot be used, or None."""
    try:
        _coal_module()
    except ImportError as error:
        return f"coal cannot be imported ({error}); pip install 'hypcheck[peers]' brings it"
    return None


FCL = MeshLibrary("fcl", "FCL", availability, mesh_object, _fcl_collides, _fcl_distance)
COAL = MeshLibrary("coal", "coal", _coal_trouble, _coal_mesh, _coal_collides, _coal_distance)
ENGINES = {engine.title: engine for engine in (FCL, COAL)}


@dataclass(frozen=True, slots=True)
class MeshGrid:
    """A mesh of the surface with semi-axes `a`, `a`, `c` up to `height` on both sides of the waist."""

    a: float
    c: float
    height: float
    around: int
    along: int

    @property
    def triangles(self) -> int:
        """The number of triangles."""
        return 2 * self.around * self.along

    @property
    def deviation(self) -> float:
        """A bound of the horizontal distance between the mesh and the surface, on the side where it is greater.

        A point of a triangle is a mean of vertices within an azimuth of Δθ and a height of Δz. The mean of their radii
        is at least r(z), which is convex, and exceeds it by at most r″ Δz²/8, with r″ ≤ a/c²; the mean of their
        directions has a length of at least cos(Δθ/2).
        """
        widest = self.a * hypot(1.0, self.height / self.c)
        inward = widest * (1 - cos(pi / self.around))
        outward = self.a / self.c**2 * (2 * self.height / self.along) ** 2 / 8
        return max(inward, outward)

    def mesh(self) -> tuple[Vertices, Triangles]:
        """Return vertices (n, 3) and triangles (m, 3)."""
        azimuths = np.linspace(0, 2 * pi, self.around, endpoint=False)
        heights = np.linspace(-self.height, self.height, self.along + 1)
        z, azimuth = np.meshgrid(heights, azimuths, indexing="ij")
        r = self.a * np.hypot(1.0, z / self.c)
        vertices = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=-1).reshape(-1, 3)
        ring = np.arange(self.around)
        left = (np.arange(self.along)[:, np.newaxis] * self.around + ring).reshape(-1, 1)
        right = (np.arange(self.along)[:, np.newaxis] * self.around + (ring + 1) % self.around).reshape(-1, 1)
        lower = np.hstack([left, right, right + self.around])
        upper = np.hstack([left, right + self.around, left + self.around])
        return np.ascontiguousarray(vertices), np.concatenate([lower, upper])


def grid_of(a: float, c: float, height: float, triangles: int) -> MeshGrid:
    """Return the grid of about so many triangles that is equally inaccurate around the axis and along it."""
    across = pi * c / height * sqrt(hypot(1.0, height / c))
    around = max(3, round(sqrt(triangles / 2 * across)))
    return MeshGrid(a, c, height, around, max(1, round(triangles / 2 / around)))


def height_of(sizes: Sizes, rows: Rows) -> float:
    """Return the height of a scene's mesh, in the caller's unit: above γ, and above every body that is tested."""
    _, gamma, b, d = sizes
    reach = max(b, d) if PAIRS.has_axis(rows) else d
    return float(max(1.2 * gamma, np.abs(rows[:, 6]).max(initial=0.0)) + 1.1 * reach)


def turns_of(axes: Floats) -> Floats:
    """Return rotations (n, 3, 3) that take the z axis to each of these axes, (n, 3)."""
    along = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    level = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(axes))])
    length = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(length > 0, level / np.where(length > 0, length, 1.0), [1.0, 0.0, 0.0])
    return np.stack([level, np.cross(along, level), along], axis=2)


@dataclass(frozen=True, slots=True)
class SceneMesh:
    """A mesh in an engine, for one α, γ, b, d; `unit` has the lengths by which x, y and z of a centre are divided.

    `deviation` bounds the distance between the mesh and the surface, in spheroid radii.
    """

    sizes: Sizes
    unit: tuple[float, float, float]
    deviation: float
    triangles: int
    touches: ContactQuery | None

    def answers(self, rows: Rows) -> Answers:
        """Return positions (n,) of rows that have these sizes, (n, 7), or of an ellipsoid also (n, 10)."""
        touches = self.touches
        if touches is None:
            return np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        alpha, gamma, _, _ = self.sizes
        across, aside, up = self.unit
        turns = turns_of(rows[:, 7:]) if PAIRS.has_axis(rows) else [None] * len(rows)
        return np.array(
            [
                0
                if touches(x / across, y / aside, z / up, turn)
                else (1 if (x * x + y * y) / alpha**2 - (z / gamma) ** 2 > 1 else -1)
                for (x, y, z), turn in zip(rows[:, 4:7].tolist(), turns, strict=True)
            ],
            dtype=np.int8,
        )


def scene_mesh(engine: MeshLibrary, pairing: str, sizes: Sizes, height: float, triangles: int) -> SceneMesh:
    """Return the scene's mesh for one of PAIRINGS."""
    alpha, gamma, b, d = sizes
    scaled = grid_of(alpha / b, gamma / d, height / d, triangles)
    whole = pairing == "ellipsoid"
    grid = MeshGrid(alpha, gamma, height, scaled.around, scaled.along) if whole else scaled
    touches = engine.question(pairing, engine.mesh(*grid.mesh()), b, d)
    return SceneMesh(sizes, (1.0, 1.0, 1.0) if whole else (b, b, d), scaled.deviation, grid.triangles, touches)


def rows_by_sizes(rows: Rows) -> Iterator[tuple[Sizes, NDArray[np.intp]]]:
    """Yield the sizes that occur, each with the indices of its rows."""
    scenes, scene_of = np.unique(rows[:, :4], axis=0, return_inverse=True)
    for index, (alpha, gamma, b, d) in enumerate(scenes.tolist()):
        yield (alpha, gamma, b, d), np.flatnonzero(scene_of.reshape(-1) == index)


LARGEST = 1e100
"""Beyond this, a product of three lengths inside FCL may overflow, and its answer is meaningless without any
warning."""

_MARGIN = 1.1
"""The mesh covers this many semi-axes on each side of the body."""


class _Body(NamedTuple):
    """A pair for FCL: the surface about the origin, the body turned to azimuth 0, at (rho, 0, z)."""

    alpha: float
    gamma: float
    b: float
    d: float
    rho: float
    z: float


_SHARED: ContextVar[dict[tuple[_Body, int], object] | None] = ContextVar("_SHARED", default=None)


@contextmanager
def shared_meshes() -> Iterator[None]:
    """Within the block naive_fcl builds a mesh once for all pairings; times that are taken there would be too short."""
    before = _SHARED.set({})
    try:
        yield
    finally:
        _SHARED.reset(before)


def _built(body: _Body, triangles: int, mesh: tuple[Vertices, Triangles]) -> object | None:
    """Return FCL's object of a mesh, or None if FCL refuses it; within shared_meshes() it is built once."""
    shared, key = _SHARED.get(), (body, triangles)
    if shared is not None and key in shared:
        return shared[key]
    built: object | None = FCL.mesh(*mesh)
    if shared is not None:
        shared[key] = built
    return built


def naive_fcl(rows: Rows, pairing: str, triangles: int = 2000) -> Positions:
    """Return positions (n,) of rows (n, 7) by one of PAIRINGS and a mesh of about that many triangles for each row."""
    require_fcl()
    with np.errstate(all="ignore"):
        return np.array([_position(_body(row, pairing), pairing, triangles) for row in rows], dtype=np.int8)


def _body(row: Floats, pairing: str) -> _Body:
    """Return a row as a pair for FCL: in spheroid radii, except for the pairing "ellipsoid"."""
    alpha, gamma, b, d, x, y, z = row
    if pairing == "ellipsoid":
        return _Body(alpha, gamma, b, d, np.hypot(x, y), z)
    return _Body(alpha / b, gamma / d, 1.0, 1.0, np.hypot(x, y) / b, z / d)


def _position(body: _Body, pairing: str, triangles: int) -> int:
    """Return the position of a pair by this pairing, or CANNOT_SAY."""
    level = (body.rho / body.alpha) ** 2 - (body.z / body.gamma) ** 2 - 1
    if np.isnan(level):
        return CANNOT_SAY
    side = 1 if level > 0 else -1
    vertices, indices = _mesh(body, triangles)
    if not len(indices):
        return side
    if not max(np.abs(vertices).max(), *np.abs(body)) < LARGEST:
        return CANNOT_SAY
    touches = FCL.question(pairing, _built(body, triangles, (vertices, indices)), body.b, body.d)
    if touches is None:
        return CANNOT_SAY
    return 0 if touches(body.rho, 0.0, body.z) else side


def _mesh(body: _Body, triangles: int) -> tuple[Vertices, Triangles]:
    """Return a square grid of about that many triangles inscribed in the surface near the body; empty if none is there.

    Its heights are those of the body, cut off beyond the body's greatest distance from the axis; its azimuths are those
    that the body covers as seen from the axis.
    """
    half_width, half_height = _MARGIN * body.b, _MARGIN * body.d
    top = body.gamma * np.sqrt(((body.rho + half_width) / body.alpha) ** 2 - 1)  # nan if the waist is beyond reach
    low, high = np.maximum(body.z - half_height, -top), np.minimum(body.z + half_height, top)
    if not low < high:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    half_azimuth = np.arcsin(half_width / body.rho) if body.rho > half_width else np.pi
    cells = max(1, isqrt(triangles // 2))
    heights, azimuths = np.linspace(low, high, cells + 1), np.linspace(-half_azimuth, half_azimuth, cells + 1)
    z, azimuth = np.meshgrid(heights, azimuths, indexing="ij")
    r = body.alpha * np.hypot(1.0, z / body.gamma)
    vertices = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=-1).reshape(-1, 3)
    row = cells + 1
    first = (np.arange(cells)[:, np.newaxis] * row + np.arange(cells)).reshape(-1, 1, 1)
    return vertices, (first + np.array([[0, 1, row + 1], [0, row + 1, row]])).reshape(-1, 3)
