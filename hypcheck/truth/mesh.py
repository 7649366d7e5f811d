"""The mesh oracle: FCL asked about one-sided meshes of the surface, fine enough by proof (docs/mesh-oracle.md).

It says clear, contact or undecided, and never a wrong word: bounds proved without FCL settle the pair, and FCL, asked
about the very mesh that shows it, must say the same. The one question to FCL (python-fcl) is how far C is from a mesh.
FCL knows no sides; the side is the exact sign of F(C).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats
from hypcheck.truth.mesh_meridian import RESOLUTION, MeshOutcome, Refinement, Segment, meridian_of, refine

Vertices = Floats
Triangles = NDArray[np.int64]

_HALVES_OF_A_SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def fcl_module() -> Any:  # noqa: ANN401 - the wheel has no types
    """The module of python-fcl. Raises ImportError where it is not installed: it has no wheel for some platforms."""
    import fcl  # noqa: PLC0415

    return fcl


def availability() -> str | None:
    """None where FCL can be imported, else the sentence that says why not."""
    try:
        fcl_module()
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
    the lattice of mesh_meridian.UNIT, so that none is so short.
    """
    ends: Floats = np.array(segments, dtype=np.float64).reshape(-1, 4)
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
    fcl = fcl_module()
    mesh = fcl.BVHModel()
    mesh.beginModel(len(triangles), len(vertices))
    mesh.addSubModel(vertices, triangles)
    if mesh.endModel() != 0:
        return None
    built: object = fcl.CollisionObject(mesh)
    return built


def distance_to_mesh(vertices: Vertices, triangles: Triangles) -> float:
    """FCL's distance from the origin to a mesh: inf where it has no triangles, nan where FCL refuses it."""
    if not len(triangles):
        return float("inf")
    fcl = fcl_module()
    mesh = mesh_object(vertices, triangles)
    if mesh is None:
        return float("nan")
    point = fcl.CollisionObject(fcl.Sphere(0.0))
    return float(fcl.distance(point, mesh, fcl.DistanceRequest(), fcl.DistanceResult()))


@dataclass(frozen=True, slots=True)
class MeshVerdict:
    """What the meshes say of one pair.

    `position` is None where undecided, and then `reason` is the sentence why. `lower` and `upper` are proved bounds
    on the distance from the spheroid's centre to the surface, in spheroid radii (clearance + 1); a clear pair's are
    seldom tight, and beyond 5/4 radii they are 5/4 and inf. `levels` counts the rounds of cutting, the
    uncut window being the first, `triangles` what FCL was asked about; both are 0 where the window is empty.
    """

    outcome: MeshOutcome
    position: Position | None
    levels: int
    triangles: int
    lower: float
    upper: float
    reason: str | None = None


def verdict(pair: Pair) -> MeshVerdict:
    """The position of any valid pair, or undecided. Raises UnavailableError where FCL cannot be imported."""
    require_fcl()
    meridian = meridian_of(pair)
    refinement = refine(meridian)
    if refinement.outcome is MeshOutcome.UNDECIDED:
        return _undecided(refinement, 0, _why_open(refinement))
    vertices, triangles = ribbon(refinement.facets)
    distance = distance_to_mesh(vertices, triangles)
    if not (distance > 1.0 if refinement.outcome is MeshOutcome.CLEAR else distance <= 1.0):
        reason = f"FCL's distance {distance!r} to the mesh does not bear out the proved {refinement.outcome.value}"
        return _undecided(refinement, len(triangles), reason)
    return MeshVerdict(
        outcome=refinement.outcome,
        position=Position.CONTACT if refinement.outcome is MeshOutcome.CONTACT else Position(meridian.side),
        levels=refinement.levels,
        triangles=len(triangles),
        lower=refinement.lower,
        upper=refinement.upper,
    )


def _undecided(refinement: Refinement, triangles: int, reason: str) -> MeshVerdict:
    return MeshVerdict(
        MeshOutcome.UNDECIDED, None, refinement.levels, triangles, refinement.lower, refinement.upper, reason
    )


def _why_open(refinement: Refinement) -> str:
    if refinement.upper - refinement.lower <= RESOLUTION:
        return f"the distance is within {RESOLUTION:.1e} radii of 1: a tangency, or as near as float64 meshes tell"
    return f"too many cells stay open at level {refinement.levels}: the surfaces run close along an arc"
