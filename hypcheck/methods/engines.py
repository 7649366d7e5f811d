"""Collision engines that hold a mesh: FCL by python-fcl, and coal, its successor, where it is installed.

An engine makes a mesh into a question: does the body, its centre here, touch it? Both are imported inside the functions
alone, since neither is everywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.truth.mesh_fcl import Triangles, Vertices, availability, mesh_object

Touches = Callable[[float, float, float], bool]
"""Whether the body with this centre touches the mesh."""

PAIRINGS = ("point", "sphere", "ellipsoid")
"""The distance from the centre, compared with 1; the unit sphere; the spheroid itself."""


@dataclass(frozen=True, slots=True)
class Engine:
    """`trouble` says why it cannot be used, else None; `question` is given pairing, vertices, triangles, b and d.

    Its answer is None where the engine refuses the mesh.
    """

    name: str
    title: str
    trouble: Callable[[], str | None]
    question: Callable[[str, Vertices, Triangles, float, float], Touches | None]


def _fcl(pairing: str, vertices: Vertices, triangles: Triangles, b: float, d: float) -> Touches | None:
    import fcl  # noqa: PLC0415

    mesh = mesh_object(vertices, triangles)
    if mesh is None:
        return None
    shapes = {"point": lambda: fcl.Sphere(0.0), "sphere": lambda: fcl.Sphere(1.0)}
    body = fcl.CollisionObject(shapes[pairing]() if pairing in shapes else fcl.Ellipsoid(b, b, d))
    if pairing == "point":
        near = fcl.DistanceRequest()

        def within(x: float, y: float, z: float) -> bool:
            body.setTranslation(np.array([x, y, z]))
            return bool(fcl.distance(body, mesh, near, fcl.DistanceResult()) <= 1.0)

        return within
    request = fcl.CollisionRequest()

    def collides(x: float, y: float, z: float) -> bool:
        body.setTranslation(np.array([x, y, z]))
        return bool(fcl.collide(body, mesh, request, fcl.CollisionResult()) > 0)  # results are not reset between calls

    return collides


def _coal(pairing: str, vertices: Vertices, triangles: Triangles, b: float, d: float) -> Touches | None:
    import coal  # noqa: PLC0415

    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(len(triangles), len(vertices))
    mesh.addVertices(vertices)
    mesh.addTriangles(triangles)
    if mesh.endModel() != 0:
        return None
    shapes = {"point": lambda: coal.Sphere(0.0), "sphere": lambda: coal.Sphere(1.0)}
    shape = shapes[pairing]() if pairing in shapes else coal.Ellipsoid(b, b, d)
    here, there = coal.Transform3s(), coal.Transform3s()
    if pairing == "point":
        near = coal.DistanceRequest()

        def within(x: float, y: float, z: float) -> bool:
            here.setTranslation(np.array([x, y, z]))
            return bool(coal.distance(shape, here, mesh, there, near, coal.DistanceResult()) <= 1.0)

        return within
    request = coal.CollisionRequest()

    def collides(x: float, y: float, z: float) -> bool:
        here.setTranslation(np.array([x, y, z]))
        return bool(coal.collide(shape, here, mesh, there, request, coal.CollisionResult()) > 0)

    return collides


def _coal_trouble() -> str | None:
    try:
        import coal  # noqa: F401, PLC0415
    except ImportError as error:
        return f"coal cannot be imported ({error}); pip install 'hypcheck[peers]' brings it"
    return None


FCL = Engine("fcl", "FCL", availability, _fcl)
COAL = Engine("coal", "coal", _coal_trouble, _coal)
