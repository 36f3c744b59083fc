"""Worlds of small robots in the manner of MuJoCo Menagerie, each with something its model lacks.

    Q_hidden = s F f(q, q̇, Q) / rms(f)      at one driven joint; or inputs that come late, or a mass

F: rms of the drives' force Q at that joint without the effect, s: its share; a voltage limit and a
lever are as large as they are. A simulation takes steps
of a quarter of the model's and adds the force itself; no code of the search takes part.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
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
SHARES = (0.1, 0.3)  # s, the least and the most
LATE = (0.005, 0.02)  # of inputs that come late [s]
HEAVIER = (0.2, 0.4)  # of the mass of a body that carries more
LOAD = (0.1, 0.3)  # of the mass of the body that carries it
LOAD_AT = (0.4, 1.2)  # of the way to the body's end; and aside by as much as `ASIDE` of it
ASIDE = 0.3
ROTOR = (0.2, 0.6)  # of the inertia that a joint swings
SEEN = 4.0  # rms change of the outputs over their noise, below which an effect is made larger
MOST_DOUBLINGS = 4
# Names that are right for what is hidden; none for forces that no law of the catalogue describes.
NAMES: Mapping[str, tuple[str, ...]] = {
    "nothing": (),
    "coulomb_friction": ("coulomb_friction",),
    "quadratic_friction": ("quadratic_friction",),
    "hardening": ("hardening",),
    "offset": ("offset",),
    "cogging": ("cogging",),
    "delay": ("delay", "time_shift"),
    # its inertia grows too, and is all that a body on a vertical axis shows
    "heavier": ("mass_mismatch", "payload", "inertia_mismatch"),
    "load": ("load",),
    # at a joint on the frame an inertia of its body acts alike
    "rotor": ("rotor_inertia", "inertia_mismatch"),
    "bump": (),
    "stop": (),
    "voltage": (),
    "lever": (),
    "guide": (),
}
OF_TWO = ("voltage", "lever", "guide")  # forces that depend on two variables at once
UNLISTED = ("bump", "stop", *OF_TWO)
AS_THEY_ARE = ("voltage", "lever")  # forces whose size is no choice


@dataclass(frozen=True)
class World:
    """A robot and what its model lacks."""

    robot: str
    effect: str  # of `NAMES`
    joint: str  # where, or the joint of the body that is heavier; "" where nothing is hidden
    size: float  # amplitude of the force [N or N m], lateness [s], mass or inertia [kg or kg m²]
    seed: int
    place: tuple[float, ...] = ()  # of a load, in its body's frame, shape (3,) [m]

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


def simulate(world: World, force: Law | None, seed: int) -> Motion:
    """Returns the motion of a world under inputs of a seed; `force` acts at its joint."""
    truth = DRIVEN[world.robot]
    spec = mujoco.MjSpec.from_file(str(world.folder / "model.xml"))
    spec.option.timestep /= linkages.FINER
    if world.effect == "coulomb_friction":  # MuJoCo's own dry friction sticks; a sign chatters
        joint = spec.joint(world.joint)
        joint.frictionloss, joint.solref_friction[:] = world.size, linkages.STIFF
        force = None
    if world.effect == "rotor":
        spec.joint(world.joint).armature += world.size
        force = None
    if world.effect == "load":
        small = np.full(3, 1e-6 * world.size)
        load = spec.joint(world.joint).parent.add_body(pos=world.place, mass=world.size)
        load.ipos, load.inertia, load.explicitinertial = np.zeros(3), small, True
        force = None
    model = spec.compile()
    if world.effect == "heavier":
        body = model.jnt_bodyid[model.joint(world.joint).id]
        grown = 1 + world.size / model.body_mass[body]
        model.body_mass[body] *= grown
        model.body_inertia[body] *= grown
        mujoco.mj_setConst(model, mujoco.MjData(model))
    chance, data = np.random.default_rng(seed), mujoco.MjData(model)
    time = np.arange(round(linkages.SECONDS / linkages.SAMPLING)) * linkages.SAMPLING
    mujoco.mj_forward(model, data)
    middle = data.ten_length if np.isnan(truth.middle) else truth.middle
    waves = chance.uniform(0.1, 1.6, (5, model.nu)), chance.uniform(0, 2 * np.pi, (5, model.nu))
    shape = np.sin(2 * np.pi * waves[0] * time[:, None, None] + waves[1]).sum(1) / 2.5
    inputs = np.round(middle + truth.reach * shape, 4)
    each = round(linkages.SAMPLING / model.opt.timestep)
    late = round(world.size / model.opt.timestep) if world.effect == "delay" else 0
    steps = np.repeat(inputs, each, axis=0)
    steps = np.vstack([np.repeat(steps[:1], late, axis=0), steps])[: len(steps)]
    at = model.joint(world.joint).id if force else 0
    place, dof = model.jnt_qposadr[at], model.jnt_dofadr[at]
    outputs, q, v, drive = [], [], [], []
    for k in range(len(time)):
        mujoco.mj_forward(model, data)
        outputs.append([linkages.measured(model, data, c) for c in truth.columns])
        for rows, of in ((q, data.qpos), (v, data.qvel), (drive, data.qfrc_actuator)):
            rows.append(np.array(of))
        for i in range(each):
            data.ctrl[:] = steps[k * each + i]
            if force:
                data.qfrc_applied[dof] = world.size * force(
                    data.qpos[place], data.qvel[dof], data.qfrc_actuator[dof]
                )
            mujoco.mj_step(model, data)
    return Motion(time, inputs, *map(np.array, (outputs, q, v, drive)))


def make(robot: str, effect: str, seed: int) -> tuple[World, list[Motion]]:
    """Returns a world with the motions of two records, its effect large enough to be seen.

    Args:
        robot: of `DRIVEN`.
        effect: of `NAMES`.
        seed: of the joint, the size and the inputs.
    """
    chance = np.random.default_rng([seed, *map(ord, robot + effect)])
    world = World(robot, "nothing", "", 0.0, seed)
    seeds = [int(s) for s in chance.integers(1, 2**31, 2)]
    without = [simulate(world, None, s) for s in seeds]
    if effect == "nothing":
        return world, without
    model = mujoco.MjModel.from_xml_path(str(world.folder / "model.xml"))
    felt = np.sqrt(np.mean(without[0].drive ** 2, axis=0))
    joint = int(chance.choice(np.flatnonzero(felt > 0.05 * felt.max())))
    ranges = {"delay": LATE, "heavier": HEAVIER, "load": LOAD, "rotor": ROTOR}
    size = float(chance.uniform(*ranges.get(effect, SHARES)))
    force, rms = (None, 0.0) if effect in ranges else law(effect, without[0], joint)
    place: tuple[float, ...] = ()
    if effect in ("heavier", "load"):
        size *= float(model.body_mass[model.jnt_bodyid[joint]])
    elif effect == "rotor":
        size *= float(model.dof_M0[model.jnt_dofadr[joint]])
    elif effect in AS_THEY_ARE:
        size = rms
    elif effect != "delay":
        size *= float(felt[joint])
    if effect == "load":
        place = place_of_load(model, int(model.jnt_bodyid[joint]), chance)
    world = World(robot, effect, model.joint(joint).name, size, seed, place)
    for _ in range(1 + MOST_DOUBLINGS):
        motions = [simulate(world, force, s) for s in seeds]
        if change_over_noise(world, motions, without) >= SEEN:
            break
        world = replace(world, size=2 * world.size)
    return world, motions


def place_of_load(
    model: mujoco.MjModel, body: int, chance: np.random.Generator
) -> tuple[float, ...]:
    """Returns where a load sits on a body, in its frame, shape (3,) [m]."""
    carried = np.flatnonzero(model.body_parentid == body)
    end = model.body_pos[carried[0]] if len(carried) else 2 * model.body_ipos[body]
    aside = chance.standard_normal(3)
    aside *= chance.uniform(0, ASIDE) * np.linalg.norm(end) / np.linalg.norm(aside)
    return tuple(map(float, end * chance.uniform(*LOAD_AT) + aside))


def change_over_noise(world: World, motions: list[Motion], without: list[Motion]) -> float:
    """Returns the rms change of the outputs that an effect makes, over their noise."""
    change = np.concatenate([a.outputs - b.outputs for a, b in zip(motions, without, strict=True)])
    return float(np.sqrt(np.mean(change**2))) / DRIVEN[world.robot].noise


def write(world: World, motions: list[Motion], folder: Path) -> tuple[Path, list[Path]]:
    """Write the robot's file, without a list of candidates, and its two logs; returns the paths."""
    truth = DRIVEN[world.robot]
    text = (world.folder / "robot.toml").read_text(encoding="utf-8").partition("[effects]")[0]
    toml = folder / "robot.toml"
    toml.write_text(text.replace("model.xml", str(world.folder / "model.xml")), encoding="utf-8")
    model = mujoco.MjModel.from_xml_path(str(world.folder / "model.xml"))
    drives = [model.actuator(k).name for k in range(model.nu)]
    header, logs = ",".join(("time", *drives, *truth.columns)), []
    for k, motion in enumerate(motions):
        noise = np.random.default_rng([world.seed, k]).standard_normal(motion.outputs.shape)
        outputs = np.round(motion.outputs + truth.noise * noise, 6)
        table = np.column_stack([motion.time, motion.inputs, outputs])
        logs.append(folder / f"record_{k + 1}.csv")
        np.savetxt(logs[-1], table, "%.7g", ",", header=header, comments="")
    return toml, logs
