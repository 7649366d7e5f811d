# mujoco 4.0.0 says contact. Exact: clear by 0.00045 mm (at a tower of 2 m).
# Certificate: with n = (-0.165987, 0.984549, -0.055782), every corner v of the triangle has n·v >= 0.2497514034690857, and every
# point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.24975095156458363;
# |n| = 1.0000000245469998.
# Needs: pip install mujoco==4.0.0. Ends with 1 while it is wrong.
import sys

import mujoco

b, d, corners = 0.25, 0.15, [[-0.041031837463378906, 0.24351024627685547, -0.05723857879638672], [0.0010404586791992188, 0.2760505676269531, 0.3769083023071289], [-0.045243263244628906, 0.2673978805541992, 0.3769083023071289]]
points = " ".join(repr(each) for corner in corners for each in corner)
model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody>
  <flexcomp name="triangle" type="direct" dim="2" rigid="true" radius="0" point="{points}" element="0 1 2">
    <contact selfcollide="none"/>
  </flexcomp>
  <body><freejoint/><geom type="{'sphere' if b == d else 'ellipsoid'}" size="{b!r} {b!r} {d!r}" mass="1"/></body>
</worldbody></mujoco>""")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
distance = min((each.dist for each in data.contact), default=float("nan"))
contact = distance <= 0
print("contact:", contact, " distance:", distance)
sys.exit(contact)
