"""Write a robot's TOML with the values that were found, so that it can be read again."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

from identification.files import write_text
from identification.robot.robot import Robot


def write_robot(
    robot: Robot, values: Mapping[str, float], path: Path, place: Path, remark: str = ""
) -> Path:
    """Write a robot with new values; sizes of named effects become free parameters.

    Args:
        robot: the robot that was fitted.
        values: values of its free parameters and of the effects that it now has, by name.
        path: path of the file to write.
        place: the folder from which the file will be read.
        remark: one line about the values that stands above them as a comment.
    """
    file, at = robot.file, robot.plant.parameters
    shapes = {f"{e.name}.{s.name}" for e in robot.plant.effects for s in e.shapes}
    fixed = {**file.fixed, **{n: v for n, v in values.items() if n in shapes}}
    names = [*file.free, *(n for n in values if n not in (*file.free, *shapes))]
    lines = [f"# {remark}"] if remark else []
    lines += [
        f"model = {_text(os.path.relpath(file.model, place))}",
        f"outputs = {_list(robot.log.output_names)}",
        f"free = {_list(names)}",
    ]
    lines += [f"own = {_list(file.own)}"] if file.own else []
    lines += [] if file.horizon is None else [f"horizon = {file.horizon!r}"]
    lines += [f"every = {file.every}"] if file.every > 1 else []
    lines += [f"trust = {_list(file.trust)}"] if file.trust else []
    tables: dict[str, dict[str, object]] = {
        "start": dict(file.start), "log": dict(file.log), "columns": dict(file.columns),
        "fixed": dict(fixed),
    }  # fmt: skip
    for name in names:
        said = {**file.records.get(name, {}), "unit": at[name].unit}
        tables[f"parameters.{_text(name)}"] = {
            **said, "value": float(values.get(name, at[name].value))
        }  # fmt: skip
    tables["effects"] = {
        key: list(given)
        for key, given in (("joints", file.joints), ("only", file.only), ("turns", file.turns))
        if given
    }
    for title, table in tables.items():
        if table:
            lines += ["", f"[{title}]", *(f"{_text(k)} = {_value(v)}" for k, v in table.items())]
    return write_text(path, "\n".join(lines) + "\n")


def _text(text: str) -> str:
    """A basic string of TOML, written as JSON, whose escapes are valid in TOML too."""
    return json.dumps(text, ensure_ascii=False)


def _list(names: tuple[str, ...] | list[str]) -> str:
    return f"[{', '.join(map(_text, names))}]"


def _value(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_text(k)} = {_value(v)}' for k, v in value.items())}}}"
    return _text(value) if isinstance(value, str) else repr(value)
