"""FCL by python-fcl: its Ellipsoid (its Sphere where the body is a ball) against a BVHModel of the surface's triangles.

Contact is `fcl.collide`. The distance is minus the deepest penetration of its contacts, without any that of
`fcl.distance`. A result is not reset between calls, so that each gets its own.
"""

from __future__ import annotations

import sys
from importlib.metadata import version

import fcl
import numpy as np
from speak import Point, Scene, matrix, serve  # first: it keeps standard output for replies

scene = Scene(sys.argv[1])
mesh = fcl.BVHModel()
mesh.beginModel(len(scene.triangles), len(scene.vertices))
mesh.addSubModel(np.array(scene.vertices), np.array(scene.triangles))
mesh.endModel()
surface = fcl.CollisionObject(mesh)
shape = fcl.Sphere(scene.b) if scene.round else fcl.Ellipsoid(scene.b, scene.b, scene.d)
body = fcl.CollisionObject(shape)


def _place(center: Point, turned: Point) -> None:
    body.setTransform(fcl.Transform(np.array(matrix(turned)), np.array(center)))


def touches(center: Point, turned: Point) -> bool:
    """Whether FCL reports a contact."""
    _place(center, turned)
    return bool(fcl.collide(body, surface, fcl.CollisionRequest(), fcl.CollisionResult()) > 0)


def distance(center: Point, turned: Point) -> float:
    """The signed distance that FCL reports."""
    _place(center, turned)
    result = fcl.CollisionResult()
    if fcl.collide(body, surface, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result) > 0:
        return -float(max(abs(each.penetration_depth) for each in result.contacts))
    return float(fcl.distance(body, surface, fcl.DistanceRequest(), fcl.DistanceResult()))


serve(scene, "python-fcl", version("python-fcl"), touches, distance)
