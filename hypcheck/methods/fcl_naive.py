"""What one would write with FCL (python-fcl) at first: one plain mesh of the surface, and one query.

Three pairings, each a method under test and none a truth. The mesh is inscribed, its vertices on the surface, so it
lies up to its sagitta off on one side; docs/mesh-oracle.md shows what that costs, and what FCL's own tolerances cost.

- `ellipsoid_mesh`: FCL's ellipsoid collides with the mesh, in the caller's units.
- `sphere_mesh`: space is scaled first (Theorem 1), the unit sphere collides with the mesh.
- `point_mesh`: scaled likewise; FCL's distance from the centre to the mesh is compared with 1.

All answer 0 where FCL reports contact, else the sign of F(C) = (x² + y²)/α² − z²/γ² − 1 in plain floats, and
CANNOT_SAY where a number of the mesh is beyond what FCL computes with safely. All raise UnavailableError without FCL.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass
from math import isqrt

import numpy as np
from numpy.typing import NDArray

from hypcheck.rows import CANNOT_SAY, Positions, Rows
from hypcheck.truth.mesh_fcl import Triangles, Vertices, mesh_object, require_fcl

_LARGEST = 1e100
"""Beyond this a product of three lengths inside FCL may overflow, and it answers anything, in silence."""

_MARGIN = 1.1
"""The mesh covers this many semi-axes on each side of the body."""


@dataclass(frozen=True, slots=True)
class Body:
    """A pair as FCL is to see it: the surface about the origin, the body turned to azimuth 0, at (rho, 0, z)."""

    alpha: float
    gamma: float
    b: float
    d: float
    rho: float
    z: float


Query = Callable[[Body, object], bool]


def ellipsoid_mesh(rows: Rows, triangles: int = 2000) -> Positions:
    """Positions (n,) of rows (n, 7): fcl.collide of an Ellipsoid and a mesh of about that many triangles."""
    return _positions(rows, triangles, scaled=False, touches=_ellipsoid_touches)


def sphere_mesh(rows: Rows, triangles: int = 2000) -> Positions:
    """Positions (n,) of rows (n, 7): fcl.collide of a Sphere(1) and a mesh of about that many triangles."""
    return _positions(rows, triangles, scaled=True, touches=_sphere_touches)


def point_mesh(rows: Rows, triangles: int = 2000) -> Positions:
    """Positions (n,) of rows (n, 7): fcl.distance of the centre and a mesh of about that many triangles, to 1."""
    return _positions(rows, triangles, scaled=True, touches=_point_touches)


def _positions(rows: Rows, triangles: int, *, scaled: bool, touches: Query) -> Positions:
    require_fcl()
    with np.errstate(all="ignore"):
        answers = [_position(_body(row, scaled=scaled), triangles, touches) for row in rows]
    return np.array(answers, dtype=np.int8)


def _position(body: Body, triangles: int, touches: Query) -> int:
    level = (body.rho / body.alpha) ** 2 - (body.z / body.gamma) ** 2 - 1
    if np.isnan(level):
        return CANNOT_SAY
    side = 1 if level > 0 else -1
    vertices, indices = _mesh(body, triangles)
    if not len(indices):
        return side
    if not max(np.abs(vertices).max(), *np.abs(astuple(body))) < _LARGEST:
        return CANNOT_SAY
    mesh = mesh_object(vertices, indices)
    if mesh is None:
        return CANNOT_SAY
    return 0 if touches(body, mesh) else side


def _body(row: NDArray[np.float64], *, scaled: bool) -> Body:
    alpha, gamma, b, d, x, y, z = row
    if scaled:
        return Body(alpha / b, gamma / d, 1.0, 1.0, np.hypot(x, y) / b, z / d)
    return Body(alpha, gamma, b, d, np.hypot(x, y), z)


def _mesh(body: Body, triangles: int) -> tuple[Vertices, Triangles]:
    """A square grid of about that many triangles inscribed in the surface near the body; empty if none is there.

    Its heights are the body's, cut off where the surface is beyond the body's farthest point from the axis, its
    azimuths those that the body covers as seen from the axis.
    """
    half_width, half_height = _MARGIN * body.b, _MARGIN * body.d
    top = body.gamma * np.sqrt(((body.rho + half_width) / body.alpha) ** 2 - 1)  # nan where the waist is beyond reach
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


def _ellipsoid_touches(body: Body, mesh: object) -> bool:
    import fcl  # noqa: PLC0415

    return _collides(fcl.Ellipsoid(body.b, body.b, body.d), body, mesh)


def _sphere_touches(body: Body, mesh: object) -> bool:
    import fcl  # noqa: PLC0415

    return _collides(fcl.Sphere(1.0), body, mesh)


def _point_touches(body: Body, mesh: object) -> bool:
    import fcl  # noqa: PLC0415

    distance = fcl.distance(_placed(fcl.Sphere(0.0), body), mesh, fcl.DistanceRequest(), fcl.DistanceResult())
    return bool(distance <= 1.0)


def _collides(shape: object, body: Body, mesh: object) -> bool:
    import fcl  # noqa: PLC0415

    # FCL does not reset a result between calls: each needs its own.
    return bool(fcl.collide(_placed(shape, body), mesh, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)


def _placed(shape: object, body: Body) -> object:
    import fcl  # noqa: PLC0415

    placed: object = fcl.CollisionObject(shape, fcl.Transform(np.array([body.rho, 0.0, body.z])))
    return placed
