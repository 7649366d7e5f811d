"""The one question asked of FCL (python-fcl): how far is C from a mesh.

The wheel is not built for every platform, so it is imported inside the functions alone.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import UnavailableError
from hypcheck.truth.mesh_cells import Segment

Vertices = NDArray[np.float64]
Triangles = NDArray[np.int64]

_HALVES_OF_A_SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def availability() -> str | None:
    """None where FCL can be imported, else the sentence that says why not."""
    try:
        import fcl  # noqa: F401, PLC0415
    except ImportError as error:
        return f"python-fcl cannot be imported ({error}); it has no wheels for musl Linux"
    return None


def require_fcl() -> None:
    """Raise UnavailableError where FCL cannot be imported."""
    reason = availability()
    if reason is not None:
        raise UnavailableError(f"FCL is not available: {reason}")


def ribbon(segments: Sequence[Segment]) -> tuple[Vertices, Triangles]:
    """Segments of the meridian plane (y = 0) drawn out across it: vertices (4n, 3) and triangles (2n, 3).

    Each becomes a square of two triangles with the segment in its middle, so the point of it nearest to C, which is
    in that plane, is the segment's. Segments without length are left out, as FCL's distance to a triangle without area
    is 0 wherever it lies; one below about 1e-77, whose fourth power underflows, is to FCL without area too. Ends are of
    the lattice of mesh_window.UNIT, so that none is so short.
    """
    ends: NDArray[np.float64] = np.array(segments, dtype=np.float64).reshape(-1, 4)
    half = np.hypot(ends[:, 2] - ends[:, 0], ends[:, 3] - ends[:, 1]) / 2
    ends, half = ends[half > 0], half[half > 0]
    (x, z), (u, w) = ends[:, :2].T, ends[:, 2:].T
    corners = np.array([(x, -half, z), (x, half, z), (u, half, w), (u, -half, w)])
    first = 4 * np.arange(len(ends))[:, np.newaxis, np.newaxis]
    return np.ascontiguousarray(corners.transpose(2, 0, 1).reshape(-1, 3)), (first + _HALVES_OF_A_SQUARE).reshape(-1, 3)


def mesh_object(vertices: Vertices, triangles: Triangles) -> object | None:
    """FCL's object of a mesh, or None where FCL refuses to build it; its status is the only sign of that.

    FCL checks nothing: an empty mesh or an index out of range ends the interpreter, and vertices that are not finite
    make every answer about it meaningless. The caller sees to these.
    """
    import fcl  # noqa: PLC0415

    mesh = fcl.BVHModel()
    mesh.beginModel(len(triangles), len(vertices))
    mesh.addSubModel(vertices, triangles)
    if mesh.endModel() != 0:
        return None
    built: object = fcl.CollisionObject(mesh)
    return built


def distance_to_mesh(vertices: Vertices, triangles: Triangles) -> float:
    """FCL's distance from the origin to a mesh: inf where it has no triangles, nan where FCL refuses it."""
    import fcl  # noqa: PLC0415

    if not len(triangles):
        return float("inf")
    mesh = mesh_object(vertices, triangles)
    if mesh is None:
        return float("nan")
    point = fcl.CollisionObject(fcl.Sphere(0.0))
    return float(fcl.distance(point, mesh, fcl.DistanceRequest(), fcl.DistanceResult()))
