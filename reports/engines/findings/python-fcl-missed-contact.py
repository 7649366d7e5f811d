# python-fcl 0.7.0.11 says clear. Exact: in contact: 0.00011 mm less in radius still touches (at a tower of 2 m).
# Certificate: the point p = (-0.00025783473392948508, 0.0049886503693414852, -0.00012751268513966352) of the triangle, which has the
# shares 0.13482666015625, 0.501678466796875, 0.363494873046875 of the corners, has (x² + y²)/b² + z²/d² = 0.99993105973222662 < 1.
# Needs: pip install python-fcl==0.7.0.11. Ends with 1 while it is wrong.
import sys

import fcl
import numpy as np

b, d, corners = 0.005, 0.003, np.array([[-0.2680938243865967, -0.29164624214172363, -3.850148916244507], [0.25373315811157227, 0.06197977066040039, 0.599851131439209], [-0.25145912170410156, 0.036359310150146484, 0.599851131439209]])
mesh = fcl.BVHModel()
mesh.beginModel(1, 3)
mesh.addSubModel(corners, np.array([[0, 1, 2]]))
mesh.endModel()
triangle = fcl.CollisionObject(mesh)
body = fcl.CollisionObject(fcl.Sphere(b) if b == d else fcl.Ellipsoid(b, b, d))
result = fcl.CollisionResult()
contact = fcl.collide(body, triangle, fcl.CollisionRequest(num_max_contacts=9, enable_contact=True), result) > 0
distance = -max((abs(each.penetration_depth) for each in result.contacts), default=0)
if not contact:
    distance = fcl.distance(body, triangle, fcl.DistanceRequest(), fcl.DistanceResult())
print("contact:", contact, " distance:", distance)
sys.exit(not contact)
