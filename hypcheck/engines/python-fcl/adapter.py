"""FCL by python-fcl: its Ellipsoid (its Sphere where the body is a ball) against a BVHModel of the surface's triangles.

Contact is `fcl.collide`. The distance is minus the deepest penetration of its contacts, without any that of
`fcl.distance`, of which −1 says that bodies meet and is no distance. A result is not reset between calls, so that each
gets its own. python-fcl exposes no tolerance, but two solvers: libccd's by default, FCL's own at the other setting.
"""

from __future__ import annotations

import sys
from importlib.metadata import version

import fcl
import numpy as np
from speak import TIGHTEST, Point, Scene, matrix, serve  # first: it keeps standard output for replies

scene = Scene(sys.argv[1])
mesh = fcl.BVHModel()
mesh.beginModel(len(scene.triangles), len(scene.vertices))
mesh.addSubModel(np.array(scene.vertices), np.array(scene.triangles))
mesh.endModel()
surface = fcl.CollisionObject(mesh)
shape = fcl.Sphere(scene.b) if scene.round else fcl.Ellipsoid(scene.b, scene.b, scene.d)
body = fcl.CollisionObject(shape)
SOLVER = fcl.GJKSolverType.GST_INDEP if TIGHTEST else fcl.GJKSolverType.GST_LIBCCD


def _place(center: Point, turned: Point) -> None:
    body.setTransform(fcl.Transform(np.array(matrix(turned)), np.array(center)))


def touches(center: Point, turned: Point) -> bool:
    """Whether FCL reports a contact."""
    _place(center, turned)
    return bool(fcl.collide(body, surface, fcl.CollisionRequest(gjk_solver_type=SOLVER), fcl.CollisionResult()) > 0)


def distance(center: Point, turned: Point) -> float:
    """The signed distance that FCL reports."""
    _place(center, turned)
    result = fcl.CollisionResult()
    request = fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True, gjk_solver_type=SOLVER)
    if fcl.collide(body, surface, request, result) > 0:
        return -float(max(abs(each.penetration_depth) for each in result.contacts))
    apart = float(fcl.distance(body, surface, fcl.DistanceRequest(gjk_solver_type=SOLVER), fcl.DistanceResult()))
    return apart if apart != -1.0 else float("nan")


serve(scene, "python-fcl", version("python-fcl"), touches, distance)
