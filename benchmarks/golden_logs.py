"""Small robots and their logs for `benchmarks/golden.py`, made by MuJoCo alone.

A pendulum and a cart with a friction that the models lack, an arm of two links with and without an
offset of its elbow, and a joint behind an elastic gear whose model is stiff.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np

STEP, RATE, SECONDS, NOISE = 1e-3, 100, 12, 2e-4  # [s], [Hz], [s], [rad or m]
LINK = (
    '<geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.4" mass="0.5" contype="0"'
    ' conaffinity="0"/>'
)
PENDULUM = f"""<mujoco>
  <option timestep="0.002" integrator="RK4"/><worldbody><body><joint name="j1" axis="0 1 0"
  damping="0.05" armature="0.005"/>{LINK}</body></worldbody><actuator><motor name="u1" joint="j1"/>
  </actuator><sensor><jointpos name="j1" joint="j1"/></sensor></mujoco>"""
CART = """<mujoco>
  <option timestep="0.002" integrator="RK4"/><worldbody><body><joint name="j1" type="slide"
  axis="1 0 0" damping="2" stiffness="6"/><geom size="0.05" mass="2" contype="0" conaffinity="0"/>
  </body></worldbody><actuator><motor name="u1" joint="j1"/></actuator>
  <sensor><jointpos name="j1" joint="j1"/></sensor></mujoco>"""
ARM = f"""<mujoco>
  <option timestep="0.002" integrator="RK4"/><worldbody><body><joint name="j1" axis="0 1 0"
  damping="0.1" armature="0.01"/>{LINK}<body pos="0 0 -0.4"><joint name="j2" axis="0 1 0"
  damping="0.05" armature="0.005"/>{LINK}</body></body></worldbody><actuator>
  <motor name="u1" joint="j1"/><motor name="u2" joint="j2"/></actuator><sensor>
  <jointpos name="j1" joint="j1"/><jointpos name="j2" joint="j2"/></sensor></mujoco>"""
# The motor's side carries the sensor; the stiff model has both inertias on one joint.
GEARED = f"""<mujoco>
  <option timestep="0.001" integrator="RK4"/><worldbody><body><joint name="j1" axis="0 1 0"
  armature="0.02" damping="0.05"/><geom size="0.01" mass="0.001" contype="0" conaffinity="0"/>
  <body><joint name="load" axis="0 1 0" stiffness="8" damping="0.02"/>{LINK}</body></body>
  </worldbody><actuator><motor name="u1" joint="j1"/></actuator>
  <sensor><jointpos name="j1" joint="j1"/></sensor></mujoco>"""
STIFF = PENDULUM.replace('armature="0.005"', 'armature="0.02"')

Force = Callable[[np.ndarray, np.ndarray], np.ndarray]  # of positions and velocities


def _no_force(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return 0.0 * v


@dataclass(frozen=True)
class Robot:
    """A model, and the world that its logs come from.

    Attributes:
        model: MJCF that is fitted.
        free: its free parameters.
        world: MJCF that moves; the model where None.
        force: what the model lacks, on each joint of the world.
        swing: largest input.
        horizon: whether predictions over 0.2 s are judged, and not a free run.
    """

    model: str
    free: tuple[str, ...]
    world: str | None = None
    force: Force = field(default=_no_force)
    swing: float = 0.6
    horizon: bool = True


def _dry(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return -0.04 * np.tanh(100 * v)


def _sticking(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return -(0.3 + 0.4 * np.exp(-((v / 0.05) ** 2))) * np.tanh(200 * v)


def _offset(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return np.array([0.0, 0.05])


ROBOTS: Mapping[str, Robot] = {
    "pendulum": Robot(PENDULUM, ("joint/j1.damping", "joint/j1.armature"), force=_dry),
    "cart": Robot(CART, ("joint/j1.damping", "joint/j1.stiffness"), force=_sticking, swing=6.0),
    "arm": Robot(ARM, ("joint/j1.damping", "joint/j2.damping"), force=_offset),
    "arm_null": Robot(ARM, ("joint/j1.damping", "joint/j2.damping")),
    "elastic": Robot(STIFF, ("joint/j1.damping", "joint/j1.armature"), world=GEARED),
}


def write_logs(folder: Path) -> None:
    """Write NAME.xml, NAME.toml, NAME_free.toml (of a free run) and NAME_log.csv of each robot."""
    for seed, (name, robot) in enumerate(ROBOTS.items()):
        (folder / f"{name}.xml").write_text(robot.model, encoding="utf-8")
        listed = ", ".join(f'"{path}"' for path in robot.free)
        text = f'model = "{name}.xml"\nfree = [{listed}]\n'
        (folder / f"{name}.toml").write_text(f"{text}horizon = 0.2\n", encoding="utf-8")
        (folder / f"{name}_free.toml").write_text(text, encoding="utf-8")
        _write_log(robot, folder / f"{name}_log.csv", seed)


def _write_log(robot: Robot, path: Path, seed: int) -> None:
    model = mujoco.MjModel.from_xml_string(robot.world or robot.model)
    model.opt.timestep = STEP
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    samples, every = SECONDS * RATE, round(1 / (RATE * STEP))
    inputs = robot.swing * rng.uniform(-1, 1, (samples // 30, model.nu)).repeat(30, axis=0)
    rows = []
    for k, u in enumerate(inputs):
        seen = data.qpos[: model.nsensor] + rng.normal(0, NOISE, model.nsensor)
        rows.append([k / RATE, *u, *seen])
        data.ctrl[:] = u
        for _ in range(every):
            data.qfrc_applied[:] = robot.force(data.qpos, data.qvel)
            mujoco.mj_step(model, data)
    names = ["time", *(f"{of}{k + 1}" for of in "uj" for k in range(model.nu))]
    np.savetxt(path, rows, fmt="%.9g", delimiter=",", header=",".join(names), comments="")
