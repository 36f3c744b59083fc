"""The worlds that the simulators of `benchmarks/gpu_speed.py` share.

A world is a start of the twin and numbers of its model. Those of a timing are drawn at random.
Those of the accuracy are what a fit simulates: the nominal values, and each parameter moved by the
step of a forward and of two central differences.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import mujoco
import numpy as np

from identification.model import rollout
from identification.model.predictor import Numbers
from identification.model.sensitivity import FORWARD_STEP, STEP
from inca_mj.effects.hooks import Layout
from inca_mj.robot.inputs import prbs
from inca_mj.robot.parameters import TIMESTEP
from inca_mj.twin.mjcf import build
from inca_mj.twin.twin import Twin, build_twin

FREE = ("lambda", "b", "R", "k_s", "J", "b_v", "b_c", "K_t", "m")
FIELDS = (
    "tendon_user", "actuator_user", "actuator_gear", "dof_armature", "dof_damping", "body_mass",
)  # fmt: skip
DRAWN = 64  # different worlds of a timing; more are copies of these


@dataclass(frozen=True, kw_only=True)
class Worlds:
    """What is simulated."""

    robot: Twin  # the twin as fits simulate it, without shapes and sensors
    start: rollout.State  # its starts, one row a world
    numbers: Numbers  # entries of its model, one value a world
    currents: np.ndarray  # of all worlds, one row a step, shape (steps, 8) [A]

    @property
    def model(self) -> mujoco.MjModel:
        """The model of the twin."""
        return self.robot.model

    def __len__(self) -> int:
        return len(self.start.qpos)

    def field(self, name: str) -> np.ndarray:
        """A field of mjModel with the numbers of each world, shape (n, ...)."""
        own = getattr(self.model, name)
        out = np.repeat(own[None], len(self), axis=0).astype(float)
        for slot, values in self.numbers:
            if slot.field == name:
                column = () if slot.column is None else (slot.column,)
                out[(slice(None), list(slot.rows), *column)] = np.asarray(values)[:, None]
        return out

    def widened(self, n: int, steps: int) -> Worlds:
        """So many worlds, which repeat these, over so many steps."""
        at = np.arange(n) % len(self)
        rows = (np.asarray(getattr(self.start, f))[at] for f in ("qpos", "qvel", "act"))
        return replace(
            self,
            start=rollout.State(*rows),
            numbers=[(slot, np.asarray(values)[at]) for slot, values in self.numbers],
            currents=np.resize(self.currents, (steps, 8)),
        )


@cache
def robot() -> Twin:
    """The twin as fits simulate it."""
    bare = build_twin(visual=False)
    return replace(bare, model=rollout.without_sensors(bare.model))


@cache
def motors() -> mujoco.MjModel:
    """The model with plain motors in place of the drives, as MuJoCo takes it without the law."""
    spec = build(robot().parameters, robot().geometry, Layout())
    spec.option.timestep = robot().model.opt.timestep
    spec.compiler.discardvisual = True
    for sensor in list(spec.sensors):
        spec.delete(sensor)
    for key in list(spec.keys):
        spec.delete(key)
    for actuator in spec.actuators:
        actuator.dyntype, actuator.biastype = mujoco.mjtDyn.mjDYN_NONE, mujoco.mjtBias.mjBIAS_NONE
        actuator.gainprm[0], actuator.actdim = 1.0, 0
    return rollout.without_sensors(spec.compile())


def drawn(steps: int = 1000) -> Worlds:
    """Moving starts whose parameters lie within a few percent of the nominal ones."""
    rng = np.random.default_rng(0)
    own = robot().parameters.values()
    nominal = np.array([own[name] for name in FREE])
    values = nominal * rng.uniform(0.98, 1.02, (DRAWN, len(FREE)))
    start, numbers = robot().settings(FREE, values)
    speed = rng.normal(0, 0.2, start.qvel.shape)
    currents = prbs(steps + 1, TIMESTEP)[:-1]
    start = rollout.State(start.qpos, speed, start.act)
    return Worlds(robot=robot(), start=start, numbers=numbers, currents=currents)


def moved(seconds: float) -> Worlds:
    """Nominal values, then each moved by + and - STEP, and by FORWARD_STEP; PRBS from rest."""
    own, p = robot().parameters.values(), len(FREE)
    nominal = np.array([own[name] for name in FREE])
    eye = np.eye(p)
    moves = np.concatenate([np.zeros((1, p)), STEP * eye, -STEP * eye, FORWARD_STEP * eye])
    start, numbers = robot().settings(FREE, nominal * np.exp(moves))
    held = np.repeat(prbs(round(100 * seconds) + 1, 0.01)[:-1], round(0.01 / TIMESTEP), axis=0)
    return Worlds(robot=robot(), start=start, numbers=numbers, currents=held)


def columns(angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Central and forward columns of the Jacobian from the angles of `moved`.

    Args:
        angles: shape (worlds, N, 8) [rad].

    Returns:
        Each of shape (parameters, N, 8) [rad], by the logarithms of the parameters.
    """
    p = len(FREE)
    angles = angles.astype(float)
    central = (angles[1 : p + 1] - angles[p + 1 : 2 * p + 1]) / (2 * STEP)
    return central, (angles[2 * p + 1 : 3 * p + 1] - angles[0]) / FORWARD_STEP
