"""A cart on a level rail, tied to its middle by a spring: (m + m_p) ẍ + k x = F."""

from __future__ import annotations

import numpy as np

from joint_worlds.robot import Free, JointRobot
from joint_worlds.slots import compiled

MASS, SPRING, PAYLOAD = range(3)


@compiled
def cart(q, v, p, M, c, g):  # type: ignore[no-untyped-def]
    """Mass, the spring's pull, and no gravity, into M, c and g."""
    M[0, 0] = p[MASS] + p[PAYLOAD]
    c[0] = p[SPRING] * q[0]
    g[0] = 0.0


def mjcf(p: np.ndarray, damping: np.ndarray) -> str:
    """The same robot for MuJoCo, without what it lacks."""
    return f"""<mujoco model="cart">
  <option timestep="0.0025" gravity="0 0 -9.81" integrator="RK4"/>
  <worldbody>
    <body name="cart">
      <inertial pos="0 0 0" mass="{p[MASS]:.17g}" diaginertia="1 1 1"/>
      <joint name="rail" type="slide" axis="1 0 0" damping="{damping[0]:.17g}" stiffness="{p[SPRING]:.17g}"/>
    </body>
  </worldbody>
  <actuator><motor name="force" joint="rail"/></actuator>
  <sensor><jointpos name="x" joint="rail"/></sensor>
</mujoco>
"""  # noqa: E501


CART = JointRobot(
    name="cart", code=1, joints=("rail",), inputs=("force",), outputs=("x",), kind="slide",
    numbers=(12.0, 60.0, 0.0), payload=(PAYLOAD,), link=(MASS,), end="cart", tip=(),
    damping=(15.0,), coulomb=(4.0,), heavy=(False,),
    travel=(0.35,), speed=(1.0,), bandwidth=12.0, step=(1e-5,), white=(1e-5,),
    sampling_time=0.005, substeps=50, horizon=0.2,
    free=(Free("body/cart.mass", "mass", number=MASS),
          Free("joint/rail.stiffness", "spring", number=SPRING)),
    mjcf=mjcf,
)  # fmt: skip
