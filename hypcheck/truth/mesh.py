"""Meshes of the surface for FCL (python-fcl), the distance to them, and the mesh oracle's verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats

Vertices = Floats
Triangles = NDArray[np.int64]
Mesh = tuple[Vertices, Triangles]


def fcl_module() -> Any:  # noqa: ANN401 - the wheel has no types
    """Import python-fcl. Raises ImportError where it is not installed: it has no wheel for some platforms."""
    import fcl  # noqa: PLC0415

    return fcl


def availability() -> str | None:
    """Say why FCL cannot be imported; None if it can."""
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


def mesh_object(vertices: Vertices, triangles: Triangles) -> object | None:
    """Build FCL's object of a mesh; None if FCL refuses it, of which its status is the only sign.

    FCL checks nothing: an empty mesh or an index out of range ends the interpreter, and vertices that are not finite
    make every answer about it meaningless. The caller must prevent these.
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
    """Ask FCL for the distance from the origin to a mesh: inf if it has no triangles, nan if FCL refuses it."""
    if not len(triangles):
        return float("inf")
    fcl = fcl_module()
    mesh = mesh_object(vertices, triangles)
    if mesh is None:
        return float("nan")
    point = fcl.CollisionObject(fcl.Sphere(0.0))
    return float(fcl.distance(point, mesh, fcl.DistanceRequest(), fcl.DistanceResult()))


def side_of_center(pair: Pair) -> Position:
    """Decide exactly on which side C is: INTERIOR if it is between the ends and F(C) ≤ 0, else EXTERIOR.

    F(C) = (x² + y²)/α² − z²/γ² − 1.
    """
    lengths = pair.lengths
    alpha2, gamma2 = lengths.alpha**2, lengths.gamma**2
    inside = (lengths.x**2 + lengths.y**2 - alpha2) * gamma2 <= lengths.z**2 * alpha2
    return Position.INTERIOR if inside and pair.z_min <= pair.z <= pair.z_max else Position.EXTERIOR


Measure = Callable[[Vertices, Triangles], float]
"""A function that measures the distance from C to a mesh."""


class MeshOutcome(Enum):
    """The answer that a mesh gives about a pair. It names no side: a side follows only from side_of_center."""

    CLEAR = "clear"
    CONTACT = "contact"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class MeshVerdict:
    """The answer of cells of the surface about one pair, and the meshes that show it, relative to C in spheroid radii.

    For a clear pair the mesh is the near mesh over all cells within reach, each at the size at which it was decided;
    for a contact it is the far mesh over cells that were undecided. If the surface ends, both meshes are given; if
    nothing is near, or bounds decide nothing, there are none. The distance of each must differ from 1 by more than
    `slack`. `side` is the position of a spheroid that touches nothing. `levels` counts the rounds of cutting.
    `reason` is a sentence that says why nothing is decided.

    `lower` and `upper` are bounds of the distance from C to the surface, in radii (clearance + 1). They are proved for
    an upright spheroid and a hyperboloid without ends, else 0 and inf; for a clear pair they are seldom tight, and
    beyond 5/4 radii they are 5/4 and inf.
    """

    outcome: MeshOutcome
    side: Position
    meshes: tuple[Mesh, ...]
    levels: int
    lower: float = 0.0
    upper: float = float("inf")
    slack: float = 0.0
    reason: str = ""

    @property
    def position(self) -> Position | None:
        """The position; None if undecided."""
        if self.outcome is MeshOutcome.CLEAR:
            return self.side
        return Position.CONTACT if self.outcome is MeshOutcome.CONTACT else None

    @property
    def triangles(self) -> int:
        """The number of triangles given to FCL."""
        return sum(len(triangles) for _, triangles in self.meshes)
