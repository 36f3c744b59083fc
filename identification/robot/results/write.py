"""Write a robot's TOML with the values that were found, so that it can be read again."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, nan
from pathlib import Path

from identification.discovery.result import keep_of_robot
from identification.effects.laws.joint_group import SLIDE
from identification.effects.named import effect_of
from identification.robot.file.carried import digest
from identification.robot.file.parameters import KNOWN, Free, effect_sizes
from identification.robot.robot import Robot
from identification.storage.files import toml_key, toml_table, toml_value, write_text


def write_robot(
    robot: Robot,
    values: Mapping[str, float],
    path: Path,
    place: Path,
    remark: str = "",
    own_values: Mapping[str, Mapping[str, float]] | None = None,
    std: Mapping[str, float] | None = None,
) -> Path:
    """Write a robot with new values; sizes of named effects become free parameters.

    What was known of a parameter before the fit stays as it was: a fit of the same log would else
    count that log twice. The std that the fit gives counts for other logs
    (`identification.robot.file.carried`). A shape that tells something of the fitted log alone,
    such as what an input did before its first sample, is not written.

    Args:
        robot: the robot that was fitted.
        values: values of its free parameters and of the effects that it now has, by name.
        path: path of the file to write.
        place: the folder from which the file will be read.
        remark: one line about the values that stands above them as a comment.
        own_values: by record and by name, what each record has for itself.
        std: of the values by name, in their units; what is unknown or not finite is left out.
    """
    file, at = robot.file, robot.plant.parameters
    own_values = own_values or {}
    own = [*dict.fromkeys([*file.own, *(n for each in own_values.values() for n in each)])]
    values = {**_means([n for n in own if n not in file.own], own_values), **values}
    values = keep_of_robot(values, robot.plant.effects)
    held = {f"{e.name}.{s.name}" for e in robot.plant.effects for s in e.shapes}
    # a size that is there or not, such as that of a limit, is nothing to be fitted
    held |= {e.parameter(s.name, where) for e in robot.plant.effects for s in e.sizes
             for where in e.places if s.present is not None}  # fmt: skip
    fixed = {**file.fixed, **{n: v for n, v in values.items() if n in held}}
    alike = {n for a in file.spread for n in a.names}
    found = [n for n in values if n not in (*file.free, *held)]
    names = [*file.free, *found]
    used = {effect_of(n) for n in (*names, *fixed)}
    of_user = [e.name for e in robot.own_effects if e.name in used]
    lines = [f"# {remark}"] if remark else []
    lines += [
        f"model = {toml_value(os.path.relpath(file.model, place))}",
        f"outputs = {toml_value(robot.log.output_names)}",
    ]
    if any(SLIDE in name for name in found):
        lines.append(f"# effects with {SLIDE} in their names act on slides, the others on hinges")
    if of_user:
        lines.append(f"# {', '.join(of_user)}: your own, which read_robot takes as own_effects")
    lines.append(f"free = {toml_value([*file.by_itself, *found])}")
    lines += [f"held = {toml_value(file.held)}"] if file.held else []
    lines += [f"own = {toml_value(own)}"] if own else []
    lines += [] if file.horizon is None else [f"horizon = {file.horizon!r}"]
    lines += [f"every = {file.every}"] if file.every > 1 else []
    lines += [f"trust = {toml_value(file.trust)}"] if file.trust else []
    tables: dict[str, dict[str, object]] = {
        "start": dict(file.start), "log": dict(file.log), "columns": {**file.columns, **file.poses},
        "fixed": dict(fixed),
    }  # fmt: skip
    for name in names:
        said = {k: v for k, v in file.records.get(name, {}).items() if k != "std"}
        said["unit"] = at[name].unit
        value = float(values.get(name, at[name].value))
        known = {} if name in alike else _known(robot, name, value)
        found_std = float((std or {}).get(name, nan))
        is_common = name not in (*own, *robot.starts)  # it then holds for other logs too
        told = {"std": found_std} if is_common and 0 < found_std < inf else {}
        tables[f"parameters.{toml_key(name)}"] = {**said, "value": value, **told, **known}
    for name in file.held:
        tables[f"parameters.{toml_key(name)}"] = dict(file.records[name])
    for a in file.spread:
        tables[f"spread.{toml_key(a.name)}"] = {"of": list(a.of), "std": a.std, "known": a.known}
    for record, each in own_values.items():
        tables[f"own_values.{toml_key(record)}"] = {n: float(v) for n, v in each.items()}
    tables["effects"] = {
        key: list(given)
        for key, given in (
            ("joints", file.joints),
            ("only", file.only),
            ("own", of_user),
            ("turns", file.turns),
        )
        if given
    }
    if std is not None:
        tables["fitted"] = {log.name: digest(log) for log in (robot.log, *robot.others)}
    for title, table in tables.items():
        lines += toml_table(title, table)
    return write_text(path, "\n".join(lines) + "\n")


def _known(robot: Robot, name: str, value: float) -> dict[str, object]:
    """Returns mean and std of the prior of a parameter that is written with a new value.

    Of the size of an effect that was named nothing was known but what is plausible.
    """
    record = robot.plant.parameters[name]
    if name in robot.file.free:
        if name in robot.starts:  # it is told by the log, and differs from log to log
            return {}
        k = robot.file.free.index(name)
        known = Free(record, robot.mean[name], float(robot.std[k])).known
        said = robot.file.records.get(name, {})
        # The file says `known` to the last digit, unless the std of a fit of other logs counted.
        is_said = "known" in said and "std" not in said
        return {"prior": robot.mean[name], **({} if is_said else {"known": known})}
    found = Free(replace(record, value=value), value, 1.0)
    width = KNOWN * effect_sizes(robot.plant.effects)[name][1]
    return {"known": max(KNOWN, width / value) if found.is_relative else width}


def _means(names: Sequence[str], own_values: Mapping[str, Mapping[str, float]]) -> dict[str, float]:
    """Returns the mean over records of what each has for itself, by name."""
    each = {n: [own[n] for own in own_values.values() if n in own] for n in names}
    return {n: sum(values) / len(values) for n, values in each.items()}
