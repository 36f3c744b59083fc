"""Worlds of small robots in the manner of MuJoCo Menagerie, each with something its model lacks.

    Q_hidden = s F f(q, q̇, Q) / rms(f)      at one driven joint; or inputs that come late, or a mass

F: rms of the drives' force Q at that joint without the effect, s: its share; a voltage limit and a
lever are as large as they are. A world hides one effect or several, each at a joint of its own
choice and each large enough to be seen alone. A simulation takes steps of a quarter of the model's
and adds the forces itself; no code of the search takes part.

No law is exact on a real robot. A rough world has at every driven joint j also

    Q_j = ρ s F_j √(2/3) Σ_k sin(a_k q/σ_q + b_k q̇/σ_q̇ + c_k),   a_k, b_k ~ N(0, 1),  k = 1, 2, 3

σ: standard deviations along the motion, ρ: drawn from `ROUGH`, s F: rms of the hidden force.
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
# What is no force of its own; all others are.
RANGES = {"delay": LATE, "heavier": HEAVIER, "load": LOAD, "rotor": ROTOR}
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
LISTED = tuple(name for name, right in NAMES.items() if right)
OF_TWO = ("voltage", "lever", "guide")  # forces that depend on two variables at once
UNLISTED = ("bump", "stop", *OF_TWO)
ROUGH = (0.05, 0.2)  # ρ, the least and the most
IN_THE_MODEL = ("coulomb_friction",)  # a force that the simulated model has by itself
WITH_LINKS = ("arm", "finger", "leg")  # bodies on which a load has a place
MASS_IS_FREE = ("cart", "crane")  # of the body that would have more: nothing would be missing
AS_THEY_ARE = ("voltage", "lever")  # forces whose size is no choice
# Worlds that hide several effects: how many of the catalogue, and how many of none.
SEVERAL: Mapping[str, tuple[int, int]] = {"two": (2, 0), "three": (3, 0), "two_unlisted": (1, 1)}


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
    world: World, forces: Mapping[str, Law], seed: int, roughness: Mapping[str, Law] | None = None
) -> Motion:
    """Returns the motion of a world under inputs of a seed.

    Args:
        world: what is simulated.
        forces: the force of each hidden effect that is one, in units of its size.
        seed: of the inputs.
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
    outputs, q, v, drive = [], [], [], []
    for k in range(len(time)):
        mujoco.mj_forward(model, data)
        outputs.append([linkages.measured(model, data, c) for c in truth.columns])
        for rows, of in ((q, data.qpos), (v, data.qvel), (drive, data.qfrc_actuator)):
            rows.append(np.array(of))
        for i in range(each):
            data.ctrl[:] = steps[k * each + i]
            data.qfrc_applied[:] = 0.0
            for size, force, at, dof in acting:
                data.qfrc_applied[dof] += size * force(
                    data.qpos[at], data.qvel[dof], data.qfrc_actuator[dof]
                )
            mujoco.mj_step(model, data)
    return Motion(time, inputs, *map(np.array, (outputs, q, v, drive)))


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


def make(robot: str, effect: str, seed: int, is_rough: bool = False) -> tuple[World, list[Motion]]:
    """Returns a world with the motions of two records, each effect large enough to be seen.

    Args:
        robot: of `DRIVEN`.
        effect: of `NAMES`, or of `SEVERAL`.
        seed: of the joint, the size and the inputs; and of the effects, where there are several.
        is_rough: whether the robot also has what no law describes.
    """
    chance = np.random.default_rng([seed, *map(ord, robot + effect)])
    bare = World(robot, seed)
    seeds = [int(s) for s in chance.integers(1, 2**31, 2)]
    without = [simulate(bare, {}, s) for s in seeds]
    if effect == "nothing" and not is_rough:
        return bare, without
    chosen = [effect] if effect != "nothing" else []
    if effect in SEVERAL:
        listed, unlisted = SEVERAL[effect]
        of = [e for e in LISTED if is_asked(robot, e)], [e for e in UNLISTED if e not in OF_TWO]
        chosen = [*map(str, chance.choice(of[0], listed, replace=False)),
                  *map(str, chance.choice(of[1], unlisted, replace=False))]  # fmt: skip
    forces: dict[str, Law] = {}
    hidden = []
    for name in chosen:
        one, mine = _seen(bare, name, chance, seeds, without)
        forces.update(mine)
        hidden.append(one)
    world = replace(bare, hidden=tuple(hidden))
    roughness: Mapping[str, Law] = {}
    if is_rough:
        world, roughness = _roughened(world, chance, without[0])
    return world, [simulate(world, forces, s, roughness) for s in seeds]


def _roughened(
    world: World, chance: np.random.Generator, motion: Motion
) -> tuple[World, dict[str, Law]]:
    """Returns a world that has what no law describes at its driven joints, and that by joint."""
    model = mujoco.MjModel.from_xml_path(str(world.folder / "model.xml"))
    felt = np.sqrt(np.mean(motion.drive**2, axis=0))
    own = {h.joint: h.size for h in world.hidden if h.effect not in RANGES}
    rough, laws = [], {}
    for j in np.flatnonzero(felt > 0.05 * felt.max()):
        name = model.joint(int(j)).name
        size = own.get(name, float(chance.uniform(*SHARES) * felt[j]))
        rough.append((name, float(chance.uniform(*ROUGH)) * size))
        laws[name] = _rough_law(chance, motion.q[:, j].std(), motion.v[:, j].std())
    return replace(world, rough=tuple(rough)), laws


def _rough_law(chance: np.random.Generator, of_q: float, of_v: float) -> Law:
    """Returns a force of position and rate that is in no catalogue, with an rms near 1."""
    a, b, c = (
        chance.standard_normal(3) / of_q,
        chance.standard_normal(3) / of_v,
        2 * np.pi * chance.random(3),
    )
    return lambda q, v, Q: float(np.sqrt(2 / 3) * np.sin(a * q + b * v + c).sum())


def _seen(
    bare: World, effect: str, chance: np.random.Generator, seeds: list[int], without: list[Motion]
) -> tuple[Hidden, dict[str, Law]]:
    """Returns an effect that is seen alone, and its force where it is one."""
    model = mujoco.MjModel.from_xml_path(str(bare.folder / "model.xml"))
    felt = np.sqrt(np.mean(without[0].drive ** 2, axis=0))
    joint = int(chance.choice(np.flatnonzero(felt > 0.05 * felt.max())))
    size = float(chance.uniform(*RANGES.get(effect, SHARES)))
    forces: dict[str, Law] = {}
    place: tuple[float, ...] = ()
    if effect not in RANGES:
        forces[effect], rms = law(effect, without[0], joint)
        size = rms if effect in AS_THEY_ARE else size * float(felt[joint])
    elif effect in ("heavier", "load"):
        size *= float(model.body_mass[model.jnt_bodyid[joint]])
    elif effect == "rotor":
        size *= float(model.dof_M0[model.jnt_dofadr[joint]])
    if effect == "load":
        place = place_of_load(model, int(model.jnt_bodyid[joint]), chance)
    hidden = Hidden(effect, model.joint(joint).name, size, place)
    for _ in range(MOST_DOUBLINGS):
        motions = [simulate(replace(bare, hidden=(hidden,)), forces, s) for s in seeds]
        if change_over_noise(bare.robot, motions, without) >= SEEN:
            break
        hidden = replace(hidden, size=2 * hidden.size)
    return hidden, forces


def is_asked(robot: str, effect: str) -> bool:
    """Returns whether a robot may hide an effect: no parameter that is free is the same."""
    if effect == "load":
        return robot in WITH_LINKS
    return effect not in ("heavier", "rotor") or robot not in MASS_IS_FREE


def place_of_load(
    model: mujoco.MjModel, body: int, chance: np.random.Generator
) -> tuple[float, ...]:
    """Returns where a load sits on a body, in its frame, shape (3,) [m]."""
    carried = np.flatnonzero(model.body_parentid == body)
    end = model.body_pos[carried[0]] if len(carried) else 2 * model.body_ipos[body]
    aside = chance.standard_normal(3)
    aside *= chance.uniform(0, ASIDE) * np.linalg.norm(end) / np.linalg.norm(aside)
    return tuple(map(float, end * chance.uniform(*LOAD_AT) + aside))


def change_over_noise(robot: str, motions: list[Motion], without: list[Motion]) -> float:
    """Returns the rms change of the outputs that an effect makes, over their noise."""
    change = np.concatenate([a.outputs - b.outputs for a, b in zip(motions, without, strict=True)])
    return float(np.sqrt(np.mean(change**2))) / DRIVEN[robot].noise


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
