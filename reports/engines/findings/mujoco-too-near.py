# mujoco 4.0.0 says 0.48 mm deep. Exact: 0.0113 mm apart at least (at a tower of 2 m).
# Certificate: with n = (0.9931, 0.1115, 0.0375), every corner v of the triangle has n·v >= 0.00024990727901458737, and every
# point x of the spheroid has n·x <= sqrt(b²(nx² + ny²) + d² nz²) = 0.00024989824304104261;
# |n| = 1.0000430540731735.
# Needs: pip install mujoco==4.0.0. Ends with 1 while it is wrong.
import sys

import mujoco

b, d, corners = 0.00025, 0.00015, [[0.00025963783264160156, 6.556510925292969e-05, -0.00040650367736816406], [0.00024831295013427734, 2.0384788513183594e-05, 2.765655517578125e-05], [0.0002434253692626953, 6.389617919921875e-05, 2.765655517578125e-05]]
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
sys.exit(distance < -3.7835089515685675e-08)
