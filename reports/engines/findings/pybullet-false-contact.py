# pybullet 3.2.7 says contact. Exact: clear by 1.9 mm (at a tower of 2 m).
# Certificate: with n = (0.24, 0.97, 0.07), every corner v of the triangle has n·v >= 0.0068652343749999976, and every
# point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.0050006599564457492;
# |n| = 1.0016985574512922.
# Needs: pip install pybullet==3.2.7. Ends with 1 while it is wrong.
import sys
from math import cos, pi, sin

import pybullet as bullet

b, d, corners = 0.005, 0.003, [[-0.0185546875, 0.03369140625, -0.30517578125], [0.02490234375, -0.00830078125, 0.12890625], [-0.0263671875, 0.00439453125, 0.12890625]]
bullet.connect(bullet.DIRECT)
rings = [(sin(pi * k / 12), cos(pi * k / 12)) for k in range(1, 12)]
hull = [(0, 0, d), (0, 0, -d)] + [
    (b * r * cos(pi * t / 10), b * r * sin(pi * t / 10), d * z) for r, z in rings for t in range(20)
]  # 222 points on the spheroid
concave = bullet.GEOM_FORCE_CONCAVE_TRIMESH
mesh = bullet.createCollisionShape(bullet.GEOM_MESH, vertices=corners, indices=[0, 1, 2], flags=concave)
ball = {"shapeType": bullet.GEOM_SPHERE, "radius": b}
shape = bullet.createCollisionShape(**(ball if b == d else {"shapeType": bullet.GEOM_MESH, "vertices": hull}))
triangle, body = bullet.createMultiBody(0, mesh), bullet.createMultiBody(1, shape)
distance = min((each[8] for each in bullet.getClosestPoints(body, triangle, 4 * max(b, d))), default=float("nan"))
contact = distance <= 0
print("contact:", contact, " distance:", distance)
sys.exit(contact)
