"""What a fit will ask for beside what stands in the robot's file to begin with, a sentence each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

from identification.inspection.channels import Match
from identification.inspection.inspected import Inspection
from identification.inspection.shared_names import ALONE
from identification.logs.names import listed
from identification.logs.units import to_si
from identification.refusals.limits import limit_sentence
from identification.robot.file.completed import position_of
from identification.storage.files import toml_key


def needs_of(model: mujoco.MjModel, matches: Sequence[Match]) -> list[str]:
    """Returns what a fit will ask for, a sentence each."""
    alone = [m.column for m in matches if m.column and m.how == ALONE]
    out = [_untold(alone)] if alone else []
    for m in matches:
        if m.channel.is_input and not m.column and m.channel.name not in alone:
            out.append(
                f"no column was found for actuator {m.channel.name}; name it under [columns], or"
                " take the actuator out of the model"
            )
    for j in np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)):
        body = model.body(int(model.jnt_bodyid[j])).name
        name = model.joint(int(j)).name or body or "NAME"
        out.append(
            f"body {body or 'without a name'} has a free joint; write {toml_key(name)} = [seven"
            " columns: x, y, z and the quaternion w, x, y, z] under [columns] if the log has its"
            " pose, or delete the free joint if it is fixed"
        )
    outputs = [m.channel.name for m in matches if not m.channel.is_input]
    if not any(m.column for m in matches if not m.channel.is_input):
        out.append(_unmeasured(model, outputs))
    return out


def _untold(columns: Sequence[str]) -> str:
    """Returns what a log lacks whose columns are an actuator's or its joint's of the same name."""
    one, first = len(columns) == 1, columns[0]
    return (
        f"{listed(columns)}: {'this is' if one else 'each is'} the name of an actuator and of what"
        f" it drives, and was taken for what was measured; what the"
        f" actuator{' was' if one else 's were'} told is missing: record it too, and write its"
        f' column under [columns], such as {toml_key(first)} = "{first}_cmd"; or, if'
        f" {'this is' if one else 'these are'} what was told, record the measured"
        f" position{'s' * (not one)}"
    )


def _unmeasured(model: mujoco.MjModel, sensors: Sequence[str]) -> str:
    """Returns what to do where no sensor of a model has a column."""
    if sensors:
        return (
            "no sensor of the model has a column; name that of each under [columns], such as"
            f' {toml_key(sensors[0])} = "COLUMN"; its sensors: {listed(sensors)}'
        )
    joint = model.joint(0).name if model.njnt else "NAME"
    name = position_of(joint, [model.actuator(k).name for k in range(model.nu)])
    return (
        "no sensor of the model has a column; give the model a sensor for each measured joint,"
        f' such as <jointpos name="{name}" joint="{joint}"/>, and name its column'
    )


def unanswered(
    found: Inspection, model: mujoco.MjModel, matches: Sequence[Match]
) -> tuple[str, ...]:
    """Returns a sentence on the columns that look like inputs and are those of no actuator."""
    taken = {m.column for m in matches}
    columns = [c.name for c in found.columns if c.role == "input" and c.name not in taken]
    if not columns:
        return ()
    drives = listed(model.actuator(k).name for k in range(model.nu)) if model.nu else "none"
    return (
        f"{listed(columns)}: no actuator of the model takes"
        f" {'it' if len(columns) == 1 else 'them'}; its actuators: {drives}",
    )


def limits_of(
    spec: mujoco.MjSpec, model: mujoco.MjModel, matches: Sequence[Match], found: Inspection,
    path: Path,
) -> list[str]:  # fmt: skip
    """Returns a sentence on a joint that the log has far outside its limits, or none."""
    factors = {c.name: to_si(c.unit)[1] if c.unit else 1.0 for c in found.columns}
    positions = {
        m.channel.joint: factors[m.column] * found.values[m.column]
        for m in matches
        if m.column and m.channel.joint and not m.channel.is_input and not m.channel.is_rate
    }
    said = limit_sentence(model, spec.compiler.degree, positions, path)
    return [said] if said else []
