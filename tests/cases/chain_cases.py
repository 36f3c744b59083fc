"""An arm of several joints, and plants with some effects, those with states among them."""

import numpy as np
from joint_cases import STEP, steps

from identification import Log
from identification.effects.plant.joint_plant import JointPlant, joint_plant

WANTED = ("coulomb_friction", "joint_elasticity", "gear_backlash", "presliding", "stiffness")


def chain_text(joints: int, integrator: str) -> str:
    """An arm of several joints whose axes differ."""
    axes = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")
    bodies = "".join(
        f"""<body pos="0 0 {0.3 if k else 0}"><joint name="j{k}" axis="{axes[k % 6]}"
        armature="{0.5 / (1 + k)}"/><inertial pos=".01 .02 .1" mass="{6 / (1 + k)}"
        diaginertia="{0.12 / (1 + k)} {0.12 / (1 + k)} {0.06 / (1 + k)}"/>""" for k in range(joints)
    )  # fmt: skip
    named = [f"j{k}" for k in range(joints)]
    return f"""<mujoco model="chain"><option timestep="0.002" integrator="{integrator}"/><worldbody>
      {bodies}{"</body>" * joints}</worldbody>
      <actuator>{"".join(f'<motor name="u{j}" joint="{j}"/>' for j in named)}</actuator><sensor>
      {"".join(f'<jointpos name="q{j}" joint="{j}"/>' for j in named)}</sensor></mujoco>"""


def chain_log(joints: int) -> Log:
    """Random inputs of an arm of several joints."""
    t = STEP * np.arange(50)
    return Log(
        time=t, inputs=steps(50, joints, hold=10) * 10 / np.arange(1, joints + 1),
        outputs=np.sin(np.outer(t, 3 + np.arange(joints)) + 1),
        input_names=[f"uj{k}" for k in range(joints)],
        output_names=[f"qj{k}" for k in range(joints)],
    )  # fmt: skip


def with_some(model: str, log: Log) -> JointPlant:
    """A plant with the wanted effects of a model."""
    every = joint_plant(model, (), log)
    return joint_plant(model, (), log, effects=[e for e in every.effects if e.name in WANTED])
