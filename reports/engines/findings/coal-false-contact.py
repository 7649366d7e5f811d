# coal 3.0.3 says contact. Exact: clear by 0.00082 mm (at a tower of 2 m).
# Certificate: with n = (-0.990411, -0.132981, -0.037432), every corner v of the triangle has n·v >= 0.24982573735260966, and every
# point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.24982495586027309;
# |n| = 0.99999952495288724.
# Needs: pip install coal==3.0.3. Ends with 1 while it is wrong.
import sys

import coal
import numpy as np

b, d, corners = 0.25, 0.01, np.array([[-0.2401721477508545, -0.06416893005371094, -0.09145522117614746], [-0.24599123001098633, -0.02082991600036621, -0.09145522117614746], [-0.2620868682861328, -0.023159503936767578, 0.34269094467163086]])
mesh = coal.BVHModelOBBRSS()
mesh.beginModel(1, 3)
mesh.addVertices(corners)
mesh.addTriangles(np.array([[0, 1, 2]]))
mesh.endModel()
body, here = coal.Sphere(b) if b == d else coal.Ellipsoid(b, b, d), coal.Transform3s()
contact = coal.collide(body, here, mesh, here, coal.CollisionRequest(), coal.CollisionResult()) > 0
distance = coal.distance(body, here, mesh, here, coal.DistanceRequest(), coal.DistanceResult())
print("contact:", contact, " distance:", distance)
sys.exit(contact)
