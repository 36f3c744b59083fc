"""A driven pendulum: (I + m c² + m_p l²) q̈ + γ (m c + m_p l) sin q = τ, q from hanging.

m, c, I: mass, centre and inertia of the arm; m_p: a payload at its end l.
"""

from __future__ import annotations

import numpy as np

from joint_worlds.robot import Free, JointRobot
from joint_worlds.slots import compiled

MASS, CENTRE, INERTIA, LENGTH, PAYLOAD, GRAVITY = range(6)


@compiled
def pendulum(q, v, p, M, c, g):  # type: ignore[no-untyped-def]
    """Inertia, no velocity forces, and gravity, into M, c and g."""
    M[0, 0] = p[INERTIA] + p[MASS] * p[CENTRE] ** 2 + p[PAYLOAD] * p[LENGTH] ** 2
    c[0] = 0.0
    g[0] = p[GRAVITY] * (p[MASS] * p[CENTRE] + p[PAYLOAD] * p[LENGTH]) * np.sin(q[0])


def mjcf(p: np.ndarray, damping: np.ndarray) -> str:
    """The same robot for MuJoCo, without what it lacks."""
    i = f"{p[INERTIA]:.17g}"
    return f"""<mujoco model="pendulum">
  <option timestep="0.0025" gravity="0 0 -{p[GRAVITY]:.17g}" integrator="RK4"/>
  <worldbody>
    <body name="arm" pos="0 0 1">
      <inertial pos="0 0 -{p[CENTRE]:.17g}" mass="{p[MASS]:.17g}" diaginertia="{i} {i} {i}"/>
      <site name="tip" pos="0 0 -{p[LENGTH]:.17g}"/>
      <joint name="hinge" type="hinge" axis="0 1 0" damping="{damping[0]:.17g}"/>
    </body>
  </worldbody>
  <actuator><motor name="u" joint="hinge"/></actuator>
  <sensor><jointpos name="q" joint="hinge"/></sensor>
</mujoco>
"""


PENDULUM = JointRobot(
    name="pendulum", code=0, joints=("hinge",), inputs=("u",), outputs=("q",), kind="hinge",
    numbers=(0.8, 0.22, 0.012, 0.35, 0.0, 9.81), payload=(PAYLOAD,), link=(MASS, INERTIA),
    end="arm", tip=(LENGTH,), damping=(0.04,), coulomb=(0.08,), heavy=(True,),
    travel=(2.4,), speed=(8.0,), bandwidth=12.0, counts=(2**14,), white=(2e-4,),
    sampling_time=0.005, substeps=50, horizon=0.2,
    free=(Free("body/arm.mass", "mass", number=MASS),
          Free("body/arm.inertia[1]", "mass", number=INERTIA)),
    mjcf=mjcf,
)  # fmt: skip
