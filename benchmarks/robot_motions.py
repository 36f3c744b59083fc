"""Motions of small robots in which forces act that their models lack.

    Q_hidden = s F f(q, q̇, Q) / rms(f)      at one driven joint

F: rms of the drives' force Q at that joint without it, s: its share. A simulation takes steps of a
quarter of the model's and adds the forces itself; no code of the search takes part. What no law
describes is

    Q_j ~ √(2/3) Σ_k sin(a_k q/σ_q + b_k q̇/σ_q̇ + c_k),   a_k, b_k ~ N(0, 1),  k = 1, 2, 3

σ: standard deviations along the motion, c_k: uniform.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from rows import ROOT

sys.path.insert(0, str(ROOT / "examples" / "linkages"))
import record as linkages

KINDS = ROOT / "benchmarks" / "robots" / "kinds"
# What each robot is driven with: columns of its outputs, their noise, middle and reach of inputs.
DRIVEN: Mapping[str, linkages.Truth] = {
    **linkages.ROBOTS,
    "arm": linkages.Truth("", "", 0.0, ("pan", "lift", "flex"), 3e-4, 0.0, 0.6),
    "finger": linkages.Truth("", "", 0.0, ("knuckle", "tip"), 3e-4, 0.0, 12.0),
    "gripper": linkages.Truth("", "", 0.0, ("left", "right"), 2e-5, 0.0, 0.02),
}
IN_THE_MODEL = ("coulomb_friction",)  # a force that the simulated model has by itself


@dataclass(frozen=True)
class Hidden:
    """An effect that the model lacks."""

    effect: str  # of `NAMES`, but "nothing"
    joint: str  # where, or the joint of the body that is heavier
    size: float  # amplitude of the force [N or N m], lateness [s], mass or inertia [kg or kg m²]
    place: tuple[float, ...] = ()  # of a load, in its body's frame, shape (3,) [m]


@dataclass(frozen=True)
class World:
    """A robot and what its model lacks."""

    robot: str
    seed: int
    hidden: tuple[Hidden, ...] = ()
    rough: tuple[tuple[str, float], ...] = ()  # joints, and rms of what nobody could name there
    # how much later the inputs of each record act than stamped [s]; none where clocks agree
    clocks: tuple[float, ...] = ()

    @property
    def effect(self) -> str:
        """The names of what is hidden, joined by "+"; "nothing" where nothing is."""
        return "+".join(h.effect for h in self.hidden) or "nothing"

    @property
    def joint(self) -> str:
        """Where it is hidden, in the same order and joined by "+"."""
        return "+".join(h.joint for h in self.hidden)

    @property
    def folder(self) -> Path:
        """The folder of its model and its robot's file."""
        own = self.robot in linkages.ROBOTS
        return (Path(linkages.__file__).parent if own else KINDS) / self.robot


@dataclass(frozen=True)
class Motion:
    """A simulated record."""

    time: np.ndarray  # shape (N,) [s]
    inputs: np.ndarray  # shape (N, nu)
    outputs: np.ndarray  # without noise, shape (N, ny)
    q: np.ndarray  # of each joint, shape (N, njnt)
    v: np.ndarray  # its rate, likewise
    drive: np.ndarray  # the drives' force on each joint, likewise


Law = Callable[[float, float, float], float]  # of q, q̇ and the drives' force there


def law(effect: str, motion: Motion, joint: int) -> tuple[Law, float]:
    """Returns the force of an effect at (q, q̇, Q), in units of its rms along a motion, and that.

    Args:
        effect: a force of `NAMES`.
        motion: along which it is scaled.
        joint: its index.
    """
    q, v, Q = motion.q[:, joint], motion.v[:, joint], motion.drive[:, joint]
    low, high = np.percentile(q, [2, 98])
    middle, width, waves = np.percentile(q, 65), (high - low) / 10, 4 * np.pi / (high - low)
    edge = np.percentile(q, 85)
    stall, fastest = np.percentile(np.abs(Q), 80), 2 * np.percentile(np.abs(v), 98)
    slow = 0.05 * float(np.sqrt(np.mean(v**2)))

    def limited(v: Any, Q: Any) -> Any:
        return np.clip(Q, -stall * (1 + v / fastest), stall * (1 - v / fastest))

    laws: dict[str, Callable[[Any, Any, Any], Any]] = {
        "coulomb_friction": lambda q, v, Q: -np.sign(v),
        "quadratic_friction": lambda q, v, Q: -v * np.abs(v),
        "hardening": lambda q, v, Q: -(q**3),
        "offset": lambda q, v, Q: 1.0 + 0.0 * q,
        "cogging": lambda q, v, Q: np.sin(max(1, round(waves)) * q + 1.0),
        "bump": lambda q, v, Q: np.exp(-(((q - middle) / width) ** 2)),
        "stop": lambda q, v, Q: -np.maximum(q - edge, 0.0),
        # a supply whose voltage the motor's own uses up: less force the faster it turns
        "voltage": lambda q, v, Q: limited(v, Q) - Q,
        # a crank between drive and joint
        "lever": lambda q, v, Q: Q * (np.cos(2.2 * (q - middle) / (high - low)) - 1),
        # a bent rail: friction on one part of the travel is five times that on the other
        "guide": lambda q, v, Q: -np.tanh(v / slow) * np.where(q > middle, 5.0, 1.0),
    }
    f = laws[effect]
    size = float(np.sqrt(np.mean(np.broadcast_to(f(q, v, Q), q.shape) ** 2)))
    return lambda q, v, Q: float(f(q, v, Q)) / size, size


def simulate(
    world: World,
    forces: Mapping[str, Law],
    seed: int,
    clock: float = 0.0,
    roughness: Mapping[str, Law] | None = None,
) -> Motion:
    """Returns the motion of a world under inputs of a seed.

    Args:
        world: what is simulated.
        forces: the force of each hidden effect that is one, in units of its size.
        seed: of the inputs.
        clock: how much later inputs act than they are stamped [s]. Outputs that come before the
            simulation, or after it, are NaN.
        roughness: of each rough joint, in units of its rms.
    """
    truth = DRIVEN[world.robot]
    model = _with_hidden(world)
    data = mujoco.MjData(model)
    chance = np.random.default_rng(seed)
    time = np.arange(round(linkages.SECONDS / linkages.SAMPLING)) * linkages.SAMPLING
    mujoco.mj_forward(model, data)
    middle = data.ten_length if np.isnan(truth.middle) else truth.middle
    waves = chance.uniform(0.1, 1.6, (5, model.nu)), chance.uniform(0, 2 * np.pi, (5, model.nu))
    shape = np.sin(2 * np.pi * waves[0] * time[:, None, None] + waves[1]).sum(1) / 2.5
    inputs = np.round(middle + truth.reach * shape, 4)
    each = round(linkages.SAMPLING / model.opt.timestep)
    lateness = sum(h.size for h in world.hidden if h.effect == "delay")
    late = round(lateness / model.opt.timestep)
    steps = np.repeat(inputs, each, axis=0)
    steps = np.vstack([np.repeat(steps[:1], late, axis=0), steps])[: len(steps)]
    laws = [
        *((h.joint, h.size, forces[h.effect]) for h in world.hidden
          if h.effect in forces and h.effect not in IN_THE_MODEL),
        *((joint, size, (roughness or {})[joint]) for joint, size in world.rough),
    ]  # fmt: skip
    acting = [
        (size, force, model.jnt_qposadr[j], model.jnt_dofadr[j])
        for joint, size, force in laws
        for j in (model.joint(joint).id,)
    ]
    ahead = round(clock / model.opt.timestep)
    outputs = np.full((len(time), len(truth.columns)), np.nan)
    q, v, drive = [], [], []
    for k in range(len(time)):
        mujoco.mj_forward(model, data)
        for rows, of in ((q, data.qpos), (v, data.qvel), (drive, data.qfrc_actuator)):
            rows.append(np.array(of))
        for i in range(each):
            shown, rest = divmod(k * each + i + ahead, each)
            if rest == 0 and 0 <= shown < len(time):
                mujoco.mj_forward(model, data)
                outputs[shown] = [linkages.measured(model, data, c) for c in truth.columns]
            data.ctrl[:] = steps[k * each + i]
            data.qfrc_applied[:] = 0.0
            if acting:  # laws of the drives' force take that of this input
                mujoco.mj_forward(model, data)
            for size, force, at, dof in acting:
                data.qfrc_applied[dof] += size * force(
                    data.qpos[at], data.qvel[dof], data.qfrc_actuator[dof]
                )
            mujoco.mj_step(model, data)
    return Motion(time, inputs, outputs, *map(np.array, (q, v, drive)))


def _with_hidden(world: World) -> mujoco.MjModel:
    """Returns the model with what is hidden in it, and with finer steps."""
    spec = mujoco.MjSpec.from_file(str(world.folder / "model.xml"))
    spec.option.timestep /= linkages.FINER
    for h in world.hidden:
        joint = spec.joint(h.joint)
        if h.effect == "coulomb_friction":  # MuJoCo's own dry friction sticks; a sign chatters
            joint.frictionloss, joint.solref_friction[:] = h.size, linkages.STIFF
        elif h.effect == "rotor":
            joint.armature += h.size
        elif h.effect == "load":
            load = joint.parent.add_body(pos=h.place, mass=h.size)
            small = np.full(3, 1e-6 * h.size)
            load.ipos, load.inertia, load.explicitinertial = np.zeros(3), small, True
    model = spec.compile()
    for h in world.hidden:
        if h.effect == "heavier":
            body = model.jnt_bodyid[model.joint(h.joint).id]
            grown = 1 + h.size / model.body_mass[body]
            model.body_mass[body] *= grown
            model.body_inertia[body] *= grown
            mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


def rough_law(chance: np.random.Generator, of_q: float, of_v: float) -> Law:
    """Returns a force of position and rate that is in no catalogue, with an rms near 1."""
    a, b, c = (
        chance.standard_normal(3) / of_q,
        chance.standard_normal(3) / of_v,
        2 * np.pi * chance.random(3),
    )
    return lambda q, v, Q: float(np.sqrt(2 / 3) * np.sin(a * q + b * v + c).sum())
