"""Columns of a log that look like inputs, and that no actuator of the model takes.

A log without inputs is fitted as one of a free swing. So torques that nothing reads end in a
damping that is nonsense. A column that bears the name of a motor that can be added is refused; one
that only looks like an input, by its name or its unit, is told. It is told where

    the model has no actuator                          any such column
    each actuator acts on a joint, and none on this    one whose name has all words of the joint's

and where it is not zero in all rows. What the motor of a driven joint reported is no input of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.cures import lines_of
from identification.logs.formats.formats import log_table
from identification.logs.headers.column_words import looks_like, name_words, unit_by_words
from identification.logs.headers.headers import name_and_unit
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.sidecar import read_sidecar
from identification.logs.units import UNITS
from identification.robot.file.completed import JOINT, motors_to_add
from identification.robot.file.file import RobotFile
from identification.storage.files import toml_key, toml_value

_UNTAKEN = "that no actuator of"


def told_of_inputs(file: RobotFile, spec: mujoco.MjSpec, log: Log, path: Path) -> Log:
    """Returns a log that tells of its columns that look like inputs and that nothing reads.

    Raises:
        InputError: one of them bears the name of a motor that would be added for it.
    """
    _refuse_torques(file, log)
    looks = _moving(file, path, _candidates(spec, log.unread))
    if not looks:
        return log
    return replace(log, remarks=(*log.remarks, _sentence(file, spec, log, looks, path)))


def inputs_told(remarks: Sequence[str]) -> list[str]:
    """Returns those remarks on a log that tell of inputs which nothing reads."""
    return [remark for remark in remarks if _UNTAKEN in remark]


def _refuse_torques(file: RobotFile, log: Log) -> None:
    """Refuse a log whose extras are torques that would move the robot, and that nothing reads."""
    moving = [name for name, column in log.extras.items() if column.any()]
    if moving:
        lines = ", ".join(f"{toml_key(n)} = {toml_value(n)}" for n in moving)
        raise InputError(
            f"log {log.name!r} has {listed(moving)}, and {file.model.name} has no actuator that"
            f" takes {'it' if len(moving) == 1 else 'them'}; write {lines} under [columns] in"
            f" {file.path}, which gives each such joint a motor, or name them under ignore in the"
            " TOML beside the log if they do not drive it"
        )


def _candidates(spec: mujoco.MjSpec, unread: Sequence[str]) -> dict[str, str]:
    """Returns columns that look like inputs of joints without a drive: "force" or "command"."""
    joints = motors_to_add(spec)
    looks = {column: looks_like(*name_and_unit(column)) for column in unread}
    if not list(spec.actuators):
        return {column: kind for column, kind in looks.items() if kind and joints}
    if list(spec.equalities) or any(a.trntype not in JOINT for a in spec.actuators):
        return {}  # an actuator may move each joint
    return {column: kind for column, kind in looks.items() if kind and _joint_of(column, joints)}


def _is_electric(column: str) -> bool:
    """Returns whether a column is a current or a voltage, by its unit, or else by its words."""
    name, unit = name_and_unit(column)
    return (UNITS[unit][0] if unit else unit_by_words(name)) in ("A", "V")


def _joint_of(column: str, joints: Iterable[str]) -> str:
    """Returns the joint all of whose words a column has; "" where that is none, or several."""
    words = name_words(name_and_unit(column)[0])
    found = [joint for joint in joints if (of := name_words(joint)) and of <= words]
    return found[0] if len(found) == 1 else ""


def _moving(file: RobotFile, path: Path, looks: Mapping[str, str]) -> dict[str, str]:
    """Returns those columns of a log's file that are not zero in all rows."""
    if not looks:
        return {}
    header = read_sidecar(path.with_suffix(".toml"), file.log, file.path).header
    try:
        table = log_table(path, lambda names: [n for n in names if n in looks], header=header)
    except InputError:  # one holds words and no numbers
        return {}
    return {n: looks[n] for n in table.names if np.nan_to_num(table[n]).any()}


def _sentence(
    file: RobotFile, spec: mujoco.MjSpec, log: Log, looks: Mapping[str, str], path: Path
) -> str:
    """Returns what to write for columns that look like inputs."""
    motors = motors_to_add(spec)
    joints = {column: _joint_of(column, motors) for column in looks}
    rest = [joint for joint in motors if joint not in joints.values()]
    nameless = [column for column, joint in joints.items() if not joint]
    if len(nameless) == len(rest):  # in the order in which both stand
        joints |= dict(zip(nameless, rest, strict=True))
    # The first of each kind for a joint: a drive has one input.
    first = {(joint, looks[c]): c for c, joint in reversed(joints.items()) if joint}
    known = {c: joint for c, joint in joints.items() if c in first.values()}
    such = "" if len(known) == len(looks) else "such as "
    known = known or {next(iter(looks)): next(iter(motors))}
    cures = []
    if forces := {c: motors[joint] for c, joint in known.items() if looks[c] == "force"}:
        lines = [f"{toml_key(motor)} = {toml_value(c)}" for c, motor in forces.items()]
        cure = (
            f"write {such}{lines_of(lines)} under [columns] in {file.path}, which gives"
            f" {'the' if len(forces) == 1 else 'each'} joint a motor of gear 1"
        )
        if any(_is_electric(column) for column in forces):
            gear = f'"actuator/{next(iter(forces.values()))}.gear[0]"'
            cure += f", and put {gear} into free, where 1 of the input is not 1 N m or 1 N"
        cures.append(cure)
    if commands := [joint for c, joint in known.items() if looks[c] == "command"]:
        cures.append(
            f'add <position name="{commands[0]}_command" joint="{commands[0]}" kp="1" kv="0.1"/>,'
            f" with the gains of the servo, to the <actuator> of {file.model.name}, and name its"
            f" column under [columns] in {file.path}"
        )
    look, it, they, drive = "look like inputs", "them", "they", "drive"
    if len(looks) == 1:
        look, it, they, drive = "looks like an input", "it", "it", "drives"
    return (
        f"{listed(looks)} of log {log.name!r} {look} {_UNTAKEN} {file.model.name} takes. Nothing"
        f" reads {it}, and what {they} did to the robot is taken for something else:"
        f" {'; or '.join(cures)}; or name {it} under ignore in {path.with_suffix('.toml')}"
        f" if {they} {drive} nothing."
    )
