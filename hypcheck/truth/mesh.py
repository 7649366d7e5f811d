"""Meshes of the surface for FCL (python-fcl), the distance to them, and what a search for the mesh oracle ends with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import UnavailableError
from hypcheck.geometry.rows import Floats

Vertices = Floats
Triangles = NDArray[np.int64]
Mesh = tuple[Vertices, Triangles]


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


Measure = Callable[[Vertices, Triangles], float]
"""Measures the distance from C to a mesh."""


class MeshOutcome(Enum):
    """What a mesh can say of a pair: it has sides only by the sign of F(C), so it names none."""

    CLEAR = "clear"
    CONTACT = "contact"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class Refinement:
    """What cutting the surface into cells led to, and the meshes that show it, seen from C in spheroid radii.

    The mesh of a clear pair is the near one over all cells within reach, each at the size at which it was settled; that
    of a contact the far one over cells that were open. Where the surface ends, both count. The distance of each has to
    be off 1 by more than `slack`; there are none where nothing is decided. `side` is the exact sign of the
    hyperboloid's equation at C. `levels` counts the rounds of cutting. The distance from C to the surface, in radii, is
    between `lower` and `upper`; `reason` says why nothing is decided.
    """

    outcome: MeshOutcome
    side: int
    meshes: tuple[Mesh, ...]
    levels: int
    lower: float = 0.0
    upper: float = float("inf")
    slack: float = 0.0
    reason: str = ""
