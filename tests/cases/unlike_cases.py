"""A robot with a hinge and a slide: model, file and two logs, of which the truth is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from plain_logs import plain_log

from identification import Parameter, Predictor, joint_plant, write_log

STEP, NOISE = 0.01, {"turn": 1e-3, "way": 2e-5}  # [s], [rad] and [m]
MODEL = """<mujoco>
  <option timestep="0.005" gravity="0 0 0" integrator="RK4"/>
  <worldbody>
    <body name="arm"><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>
      <joint name="hinge" axis="0 1 0" stiffness="2" damping="0.2"/></body>
    <body name="cart"><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
      <joint name="slide" type="slide" axis="1 0 0" stiffness="200" damping="4"/></body>
  </worldbody>
  <actuator><motor name="torque" joint="hinge"/><motor name="force" joint="slide"/></actuator>
  <sensor><jointpos name="turn" joint="hinge"/><jointpos name="way" joint="slide"/></sensor>
</mujoco>"""
TRUE = {"d": 0.2, "b": 4.0}
PARAMETERS = [
    Parameter(name=name, value=value, unit=unit, where=f"joint/{where}.damping", lower=0.0)
    for (name, value), unit, where in zip(
        TRUE.items(), ("N m s/rad", "N s/m"), ("hinge", "slide"), strict=True
    )
]
TOML = """model = "robot.xml"
free = ["d", "b"]
[parameters.d]
path = "joint/hinge.damping"
unit = "N m s/rad"
value = 0.3
[parameters.b]
path = "joint/slide.damping"
unit = "N s/m"
value = 3.0
"""


def write_robot_and_logs(path: Path) -> Path:
    """Write robot.xml, robot.toml, first.csv and second.csv into a folder, and return it."""
    (path / "robot.xml").write_text(MODEL)
    (path / "robot.toml").write_text(TOML)
    rng = np.random.default_rng(3)
    for name in ("first", "second"):
        u = np.repeat(rng.choice([-1.0, 1.0], (25, 2)), 20, axis=0) * (0.5, 2.0)
        log = plain_log(u, 0.01 * u, "torque force", "turn way", STEP, name=name)
        plant = joint_plant(MODEL, PARAMETERS, log, effects=())
        y = Predictor(plant, log, (), TRUE).predict(np.empty((1, 0)))[0]
        y = y + np.array([*NOISE.values()]) * rng.standard_normal(y.shape)
        write_log(replace(log, outputs=y), path / f"{name}.csv")
    return path
