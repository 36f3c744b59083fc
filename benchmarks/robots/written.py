"""Write a measured robot as files: its model, its TOML, and a CSV with a TOML for each record.

Anybody can then run the line that `command` gives:

    python -m identification discover FOLDER/emps_robot.toml FOLDER/a.csv … --confirm FOLDER/b.csv
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Mapping
from math import isfinite
from pathlib import Path

from identification import Log, write_log
from robots.measured_robot import MeasuredRobot


def write_files(robot: MeasuredRobot, folder: Path) -> tuple[Path, dict[str, list[Path]]]:
    """Write model, TOML and records; existing files are replaced.

    Args:
        robot: what to write.
        folder: where to; it is made where it is missing.

    Returns:
        Path of the robot's TOML, and the paths of its records by role: "fit", "confirm", "apart".
    """
    path = write_model(robot, folder)
    for each in robot.apart:
        if each.model is not None:
            shutil.copyfile(each.model, folder / each.model.name)
    apart = [log for each in robot.apart for log in each.logs]
    roles = {"fit": robot.fit, "confirm": robot.confirm, "apart": apart}
    paths: dict[str, list[Path]] = {role: [] for role in roles}
    for role, logs in roles.items():
        for log in logs:
            paths[role].append(folder / f"{stem(log)}.csv")
            write_log(log, paths[role][-1])
    return path, paths


def write_model(robot: MeasuredRobot, folder: Path) -> Path:
    """Write the model and the robot's TOML."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(robot.model, folder / robot.model.name)
    path = folder / f"{robot.name}_robot.toml"
    path.write_text(robot_toml(robot), encoding="utf-8")
    return path


def robot_toml(robot: MeasuredRobot) -> str:
    """The content of the robot's TOML (`docs/robot/keys.md` lists every key)."""
    outputs, free = (json.dumps(list(n)) for n in (robot.fit[0].output_names,
                                                   [p.name for p in robot.free]))  # fmt: skip
    lines = [
        f"# {robot.title}; {robot.source}",
        f"model = {json.dumps(robot.model.name)}",
        f"outputs = {outputs}",
        f"free = {free}",
        f"horizon = {robot.horizon!r}",
    ]
    if robot.fixed:
        lines += ["", "[fixed]", *(f"{json.dumps(n)} = {v!r}" for n, v in robot.fixed.items())]
    for p in robot.free:
        lines += ["", f"[parameters.{json.dumps(p.name)}]"]
        lines += [f"path = {json.dumps(p.path)}"] if p.path else []
        lines += [f"value = {float(p.value)!r}", f"known = {p.known!r}"]
        lines += [f"unit = {json.dumps(p.unit, ensure_ascii=False)}"] if p.unit else []
        lines += [f"scale = {p.scale!r}"] if p.scale else []
        lines += [
            f"{end} = {value!r}"
            for end, value in zip(("lower", "upper"), p.bounds or (), strict=False)
            if isfinite(value)
        ]
    return "\n".join(lines) + "\n"


def stem(log: Log) -> str:
    """A file name of a log's name."""
    return re.sub(r"[^A-Za-z0-9]+", "_", log.name).strip("_")


def command(path: Path, paths: Mapping[str, list[Path]]) -> str:
    """The line that discovers what this robot lacks."""
    words = ["python -m identification discover", str(path), *map(str, paths["fit"])]
    return " ".join([*words, "--confirm", *map(str, paths["confirm"])])
