"""A world as files: a nominal model, its TOML, two logs, and the truth."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from joint_worlds.robot import KNOWN, JointRobot
from joint_worlds.world import World


def robot_toml(world: World) -> str:
    """The robot as `python -m identification` reads it."""
    robot = world.robot
    names = [f.name for f in world.free]
    lines = [
        'model = "robot.xml"', f"outputs = {json.dumps(list(robot.outputs))}",
        f"free = {json.dumps(names)}", f"horizon = {robot.horizon}",
    ]  # fmt: skip
    for f in world.free:
        lines.append(f"[parameters.{json.dumps(f.name)}]\nknown = {KNOWN}")
        if f.kind == "coulomb" and f.slot is not None:
            lines.append(f"value = {robot.coulomb[f.slot[0]]}")
    return "\n".join(lines) + "\n"


def write_csv(path: Path, robot: JointRobot, inputs: np.ndarray, outputs: np.ndarray) -> None:
    """A log as CSV."""
    time = robot.sampling_time * np.arange(len(inputs))
    np.savetxt(path, np.column_stack([time, inputs, outputs]), "%.9g", ",",
               header=",".join(["time", *robot.inputs, *robot.outputs]), comments="")  # fmt: skip


def truth_of(world: World) -> dict[str, object]:
    """What a study compares answers with."""
    return {
        "robot": world.robot.name, "effect": world.effect, "names": list(world.names),
        "joint": world.joint, "places": list(world.places), "curve": world.curve,
        "size": world.size, "also": world.also,
        "acting": [asdict(a) for a in world.acting],
        "shape": world.shape, "ratio": world.ratio,
        "parameters": world.truth, "push": world.push,
        "references": [r.kind for r in world.records],
    }  # fmt: skip


def write_world(world: World, folder: Path) -> tuple[Path, Path, Path]:
    """Write a world; returns the paths of robot.toml, a.csv and b.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    robot = world.robot
    p, _ = robot.plain()
    (folder / "robot.xml").write_text(robot.mjcf(p, np.array(robot.damping)))
    (folder / "robot.toml").write_text(robot_toml(world))
    (folder / "truth.json").write_text(json.dumps(truth_of(world), indent=1) + "\n")
    logs = [folder / f"{letter}.csv" for letter in "ab"]
    for path, record in zip(logs, world.records, strict=True):
        write_csv(path, robot, record.inputs, record.outputs)
    return folder / "robot.toml", logs[0], logs[1]
