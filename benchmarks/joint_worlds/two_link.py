"""Two links that hang in a vertical plane, by Lagrange.

    a = m_1 c_1² + I_1 + (m_2 + m_p) l_1²       b = (m_2 c_2 + m_p l_2) l_1
    d = m_2 c_2² + I_2 + m_p l_2²
    M = [[a + d + 2 b cos q_2, d + b cos q_2], [d + b cos q_2, d]]
    c = b sin q_2 (-v_2 (2 v_1 + v_2), v_1²)
    g = γ ((m_1 c_1 + (m_2 + m_p) l_1) sin q_1 + e, e),    e = (m_2 c_2 + m_p l_2) sin(q_1 + q_2)

q_1 from hanging, q_2 from the first link; m_p: a payload at the end. M q̈ + c + g = τ.
"""

from __future__ import annotations

import numpy as np

from joint_worlds.robot import Free, JointRobot
from joint_worlds.slots import compiled

M1, C1, L1, I1, M2, C2, L2, I2, PAYLOAD, GRAVITY = range(10)


@compiled
def two_link(q, v, p, M, c, g):  # type: ignore[no-untyped-def]
    """Mass matrix, centrifugal and Coriolis forces, and gravity, into M, c and g."""
    l1, l2, m2, mp = p[L1], p[L2], p[M2], p[PAYLOAD]
    a = p[M1] * p[C1] ** 2 + p[I1] + (m2 + mp) * l1**2
    b = (m2 * p[C2] + mp * l2) * l1
    d = m2 * p[C2] ** 2 + p[I2] + mp * l2**2
    x = b * np.cos(q[1])
    M[0, 0], M[0, 1], M[1, 0], M[1, 1] = a + d + 2 * x, d + x, d + x, d
    s = b * np.sin(q[1])
    c[0], c[1] = -s * v[1] * (2 * v[0] + v[1]), s * v[0] ** 2
    e = p[GRAVITY] * (m2 * p[C2] + mp * l2) * np.sin(q[0] + q[1])
    g[0] = p[GRAVITY] * (p[M1] * p[C1] + (m2 + mp) * l1) * np.sin(q[0]) + e
    g[1] = e


def mjcf(p: np.ndarray, damping: np.ndarray) -> str:
    """The same robot for MuJoCo, without what it lacks."""
    return f"""<mujoco model="two_link">
  <option timestep="0.0025" gravity="0 0 -{p[GRAVITY]:.17g}" integrator="RK4"/>
  <worldbody>
    <body name="upper" pos="0 0 2">
      <inertial pos="0 0 -{p[C1]:.17g}" mass="{p[M1]:.17g}" diaginertia="{p[I1]:.17g} {p[I1]:.17g} {p[I1]:.17g}"/>
      <joint name="shoulder" type="hinge" axis="0 1 0" damping="{damping[0]:.17g}"/>
      <body name="lower" pos="0 0 -{p[L1]:.17g}">
        <inertial pos="0 0 -{p[C2]:.17g}" mass="{p[M2]:.17g}" diaginertia="{p[I2]:.17g} {p[I2]:.17g} {p[I2]:.17g}"/>
        <site name="tip" pos="0 0 -{p[L2]:.17g}"/>
        <joint name="elbow" type="hinge" axis="0 1 0" damping="{damping[1]:.17g}"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="u1" joint="shoulder"/>
    <motor name="u2" joint="elbow"/>
  </actuator>
  <sensor>
    <jointpos name="q1" joint="shoulder"/>
    <jointpos name="q2" joint="elbow"/>
  </sensor>
</mujoco>
"""  # noqa: E501


TWO_LINK = JointRobot(
    name="two_link", code=2, joints=("shoulder", "elbow"), inputs=("u1", "u2"),
    outputs=("q1", "q2"), kind="hinge",
    numbers=(1.2, 0.15, 0.3, 0.014, 0.8, 0.12, 0.25, 0.006, 0.0, 9.81),
    payload=(PAYLOAD,), link=(M2, I2), end="lower", tip=(L2,),
    damping=(0.10, 0.05), coulomb=(0.20, 0.10), heavy=(True, True),
    travel=(1.2, 1.4), speed=(4.0, 5.0), bandwidth=12.0,
    counts=(2**15, 2**15), white=(1e-4, 1e-4),
    sampling_time=0.005, substeps=50, horizon=0.2,
    free=(
        Free("body/upper.mass", "mass", number=M1),
        Free("body/upper.inertia[1]", "mass", number=I1),
        Free("body/lower.mass", "mass", number=M2),
        Free("body/lower.inertia[1]", "mass", number=I2),
    ),
    mjcf=mjcf,
)  # fmt: skip
