"""Bullet by pybullet: the convex hull of points on the spheroid (a sphere where it is a ball) against a triangle mesh.

Bullet has no ellipsoid. The mesh is static and concave (GEOM_FORCE_CONCAVE_TRIMESH). Contact and distance are those of
`getClosestPoints`, whose distance is negative where bodies penetrate: contact is a distance of 0 or less.
"""

from __future__ import annotations

import sys
from importlib.metadata import version

import pybullet as bullet
from speak import TIGHTEST, Point, Scene, serve  # first: it keeps standard output for replies

scene = Scene(sys.argv[1])
bullet.connect(bullet.DIRECT)
_flat = [index for triangle in scene.triangles for index in triangle]
_mesh = bullet.createCollisionShape(
    bullet.GEOM_MESH, vertices=scene.vertices, indices=_flat, flags=bullet.GEOM_FORCE_CONCAVE_TRIMESH
)
_shape = (
    bullet.createCollisionShape(bullet.GEOM_SPHERE, radius=scene.b)
    if scene.round
    else bullet.createCollisionShape(bullet.GEOM_MESH, vertices=scene.body)
)
surface, body = bullet.createMultiBody(0, _mesh), bullet.createMultiBody(1, _shape)
if TIGHTEST:
    for each in (surface, body):
        bullet.changeDynamics(each, -1, collisionMargin=0.0)
_REACH = 4 * max(scene.b, scene.d)


def _nearest(center: Point, turned: Point, reach: float) -> float:
    bullet.resetBasePositionAndOrientation(body, center, turned)
    return min((each[8] for each in bullet.getClosestPoints(body, surface, reach)), default=float("nan"))


def touches(center: Point, turned: Point) -> bool:
    """Whether the least distance that Bullet finds is 0 or less."""
    return _nearest(center, turned, 0.0) <= 0


def distance(center: Point, turned: Point) -> float:
    """The least distance that Bullet finds within reach."""
    return _nearest(center, turned, _REACH)


serve(scene, "pybullet", version("pybullet"), touches, distance)
