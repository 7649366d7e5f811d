"""coal: its Ellipsoid (its Sphere where the body is a ball) against a BVHModelOBBRSS of the surface's triangles.

Contact is `coal.collide`. The distance is `coal.distance`, which is negative where bodies penetrate.
"""

from __future__ import annotations

import sys
from importlib.metadata import version

import coal
import numpy as np
from speak import TIGHTEST, Point, Scene, matrix, serve  # first: it keeps standard output for replies

scene = Scene(sys.argv[1])
mesh = coal.BVHModelOBBRSS()
mesh.beginModel(len(scene.triangles), len(scene.vertices))
mesh.addVertices(np.array(scene.vertices))
mesh.addTriangles(np.array(scene.triangles))
mesh.endModel()
shape = coal.Sphere(scene.b) if scene.round else coal.Ellipsoid(scene.b, scene.b, scene.d)
here, there = coal.Transform3s(), coal.Transform3s()
collision, separation = coal.CollisionRequest(), coal.DistanceRequest()
if TIGHTEST:
    for request in (collision, separation):
        request.gjk_tolerance = request.epa_tolerance = 1e-10
        request.gjk_max_iterations = request.epa_max_iterations = 1000


def _place(center: Point, turned: Point) -> None:
    here.setTranslation(np.array(center))
    here.setRotation(np.array(matrix(turned)))


def touches(center: Point, turned: Point) -> bool:
    """Whether coal reports a contact."""
    _place(center, turned)
    return bool(coal.collide(shape, here, mesh, there, collision, coal.CollisionResult()) > 0)


def distance(center: Point, turned: Point) -> float:
    """The signed distance that coal reports."""
    _place(center, turned)
    return float(coal.distance(shape, here, mesh, there, separation, coal.DistanceResult()))


serve(scene, "coal", version("coal"), touches, distance)
