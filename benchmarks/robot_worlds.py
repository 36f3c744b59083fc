"""Worlds of small robots in the manner of MuJoCo Menagerie, each with something its model lacks.

A world hides one effect or several: a force of a share s of the drives' force F at a driven joint,
inputs that come late, or a mass (`robot_motions`). Each is at a joint of its own choice and large
enough to be seen alone; a voltage limit and a lever are as large as they are.

No law is exact on a real robot. A rough world also has at every driven joint a force that no law
describes, of an rms ρ s F; ρ is drawn from `ROUGH`, and s F is the hidden force there.

Two clocks may have stamped a record. In a world of clocks the inputs of each record act later than
their stamps say by a time of its own, which is drawn from `CLOCKS`; a servo does not answer what it
is told later.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
from robot_motions import DRIVEN, Hidden, Law, Motion, World, law, rough_law, simulate

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
    "voltage": ("voltage_limit",),
    "lever": (),
    "guide": (),
}
# Robot and joint whose axis is vertical: of a load or a body that is heavier the motion shows the
# inertia about it alone.
UPRIGHT = (("arm", "pan"),)
LISTED = tuple(name for name, right in NAMES.items() if right)
OF_TWO = ("lever", "guide")  # forces that depend on two variables at once
UNLISTED = ("bump", "stop", *OF_TWO)
ROUGH = (0.05, 0.2)  # ρ, the least and the most
WITH_LINKS = ("arm", "finger", "leg")  # bodies on which a load has a place
SERVOS = ("arm", "crane", "gripper", "leg")  # their inputs are set points
WITH_TENDONS = ("crane", "finger")  # what limits a winch is no limit of a joint
MASS_IS_FREE = ("cart", "crane")  # of the body that would have more: nothing would be missing
CLOCKS = (-0.025, 0.025)  # of a record [s]
AS_THEY_ARE = ("voltage", "lever")  # forces whose size is no choice; they would hide others
# Worlds that hide several effects: how many of the catalogue, and how many of none.
SEVERAL: Mapping[str, tuple[int, int]] = {"two": (2, 0), "three": (3, 0), "two_unlisted": (1, 1)}


def make(
    robot: str, effect: str, seed: int, is_rough: bool = False, has_clocks: bool = False
) -> tuple[World, list[Motion]]:
    """Returns a world with the motions of two records, each effect large enough to be seen.

    Args:
        robot: of `DRIVEN`.
        effect: of `NAMES`, or of `SEVERAL`.
        seed: of the joint, the size and the inputs; and of the effects, where there are several.
        is_rough: whether the robot also has what no law describes.
        has_clocks: whether two clocks stamp each record.
    """
    chance = np.random.default_rng([seed, *map(ord, robot + effect)])
    bare = World(robot, seed, clocks=_clocks(robot, seed) if has_clocks else ())
    seeds = [int(s) for s in chance.integers(1, 2**31, 2)]
    clocks = bare.clocks or (0.0, 0.0)
    without = [simulate(bare, {}, s) for s in seeds]
    if effect == "nothing" and not is_rough:
        return bare, [simulate(bare, {}, *each) for each in zip(seeds, clocks, strict=True)]
    chosen = [effect] if effect != "nothing" else []
    if effect in SEVERAL:
        listed, unlisted = SEVERAL[effect]
        some = [e for e in LISTED if is_asked(robot, e) and e not in AS_THEY_ARE]
        of = some, [e for e in UNLISTED if e not in OF_TWO]
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
    each = zip(seeds, clocks, strict=True)
    return world, [simulate(world, forces, s, clock, roughness) for s, clock in each]


def _clocks(robot: str, seed: int) -> tuple[float, ...]:
    """Returns how much later the inputs of each of two records act than their stamps say [s]."""
    low, high = (0.0, CLOCKS[1]) if robot in SERVOS else CLOCKS
    chance = np.random.default_rng([seed, *map(ord, robot), 1])
    return tuple(map(float, chance.uniform(low, high, 2).round(5)))


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
        laws[name] = rough_law(chance, motion.q[:, j].std(), motion.v[:, j].std())
    return replace(world, rough=tuple(rough)), laws


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
    if effect == "voltage":
        return robot not in WITH_TENDONS
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
        table = table[~np.isnan(outputs).any(axis=1)]
        np.savetxt(logs[-1], table, "%.7g", ",", header=header, comments="")
    return toml, logs
