"""MuJoCo: its ellipsoid (its sphere where the body is a ball) against a rigid flex: the surface's triangles, radius 0.

A mesh would be replaced by its convex hull; a flex of dimension 2 is a surface of triangles. Contact is a contact of
`mj_collision` with a distance of 0 or less. The distance is that of the deepest contact; beside a flex MuJoCo tells
none.
"""

from __future__ import annotations

import sys

import mujoco
from speak import TIGHTEST, Point, Scene, serve  # first: it keeps standard output for replies

scene = Scene(sys.argv[1])


POINTS = " ".join(repr(each) for vertex in scene.vertices for each in vertex)
ELEMENTS = " ".join(str(each) for triangle in scene.triangles for each in triangle)
BALL, ELLIPSOID = f'type="sphere" size="{scene.b!r}"', f'type="ellipsoid" size="{scene.b!r} {scene.b!r} {scene.d!r}"'
OPTIONS = '<option ccd_tolerance="1e-12" ccd_iterations="1000"/>' if TIGHTEST else ""
model = mujoco.MjModel.from_xml_string(f"""<mujoco>{OPTIONS}<worldbody>
  <flexcomp name="surface" type="direct" dim="2" rigid="true" radius="0" point="{POINTS}" element="{ELEMENTS}">
    <contact selfcollide="none"/>
  </flexcomp>
  <body><freejoint/><geom {BALL if scene.round else ELLIPSOID} mass="1"/></body>
</worldbody></mujoco>""")
data = mujoco.MjData(model)


def distance(center: Point, turned: Point) -> float:
    """The distance of the deepest of MuJoCo's contacts."""
    x, y, z, w = turned
    data.qpos[:] = [*center, w, x, y, z]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_flex(model, data)
    mujoco.mj_collision(model, data)
    return min((float(each.dist) for each in data.contact), default=float("nan"))


def touches(center: Point, turned: Point) -> bool:
    """Whether MuJoCo makes a contact with a distance of 0 or less."""
    return distance(center, turned) <= 0


serve(scene, "mujoco", mujoco.__version__, touches, distance)
