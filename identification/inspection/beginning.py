"""The robot's file to begin with: what was found in a log and a model, and what was guessed."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np

from identification.errors import InputError
from identification.inspection.answers import Answer
from identification.inspection.channels import OF_JOINTS, Channel, Match, channels_of
from identification.inspection.inspected import SAID, Inspection, answers_of
from identification.inspection.matching import BY_PLACE, SAME, match
from identification.inspection.needs import limits_of, needs_of, unanswered
from identification.inspection.words import answer_sentences
from identification.logs.headers.column_words import Role, unit_by_words
from identification.logs.swing import FEWEST, part_of_swing
from identification.logs.units import to_si
from identification.model.scaled_servo import is_scaled_servo, scaling
from identification.model.tied import follows
from identification.robot.file.checks import is_toml_of
from identification.robot.file.completed import motors_to_add, positions_without_sensor
from identification.robot.file.file import RobotFile
from identification.robot.file.model_file import robot_spec
from identification.storage.files import exists, toml_key, toml_table, toml_value, whole_file

SLOWEST = 0.02  # [s] between samples, above which positions hardly tell an arm's accelerations
_DRIVES = {"position": "a position servo: its input is a setpoint",
           "velocity": "a velocity servo: its input is a setpoint"}  # fmt: skip


@dataclass(frozen=True)
class Beginning:
    """A robot's file to begin with, and sentences on what stands in it."""

    path: Path  # of the file
    found: tuple[str, ...]  # what the model and the log say
    guessed: tuple[str, ...]  # what is for the user to judge
    needs: tuple[str, ...]  # what a fit will ask for
    # Whether `identification torques` has what it needs: all joints measured, and forces as inputs,
    # often enough that positions tell accelerations.
    torques: bool = False


def write_beginning(found: Inspection, model: Path, path: Path) -> Beginning:
    """Write the robot's file to begin with, which nothing may stand in the place of.

    Raises:
        InputError: the file exists or bears the name of the log, or the model cannot be read.
    """
    file = RobotFile(path=path, model=model, free=())
    spec, said = robot_spec(file)
    if exists(path):
        raise InputError(
            f"{path} exists, and nothing of yours is replaced; give another name behind --robot"
        )
    if is_toml_of(path, found.path):
        raise InputError(
            f"{path} would be read as what {found.path} says of its own units and parts, because it"
            " bears its name; give another name behind --robot"
        )
    compiled = spec.compile()
    added = _motors(spec, compiled, found) | _sensors(spec, compiled, found)
    if added:
        spec, said = robot_spec(replace(file, columns=added))
        compiled = spec.compile()
    matches = match(channels_of(compiled), found)
    needs = [*needs_of(compiled, matches), *limits_of(spec, compiled, matches, found, model)]
    if len(found.time) < 2 * FEWEST:
        lasts = float(found.time[-1] - found.time[0])
        needs.append(
            f"the log lasts {lasts:.3g} s, {len(found.time)} rows: too short to fit one part of it"
            " and to confirm another; record some seconds of motion"
        )
    place = os.path.relpath(model, path.parent)
    lines = _lines(found, compiled, matches, place, [*said, *(f"NEEDED: {n}" for n in needs)])
    with whole_file(path) as draft:
        draft.write_text("\n".join(lines) + "\n", encoding="utf-8")
    sure = [m for m in matches if m.how == SAME]
    answers = answer_sentences(_answers(found, matches))
    told = [*said, f"columns of the same name: {_listed(sure)}"] if sure else [*said]
    return Beginning(
        path, (*told, *answers), _guesses(found, compiled, matches), tuple(needs),
        torques=not needs and _serves_torques(found, compiled, matches),
    )  # fmt: skip


def _answers(found: Inspection, matches: Sequence[Match]) -> tuple[Answer, ...]:
    """Returns what answers what, now that the model says what is an input and what an output."""
    roles: dict[str, Role] = {
        m.column: "input" if m.channel.is_input else "output" for m in matches if m.column
    }
    return answers_of(found, roles)


def _serves_torques(found: Inspection, model: mujoco.MjModel, matches: Sequence[Match]) -> bool:
    """Returns whether each joint has a drive's force and its position in the log, often enough."""
    turning = {mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE}
    joints = {model.joint(k).name for k in range(model.njnt)}
    inputs = [m for m in matches if m.channel.is_input]
    seen = {m.channel.joint for m in matches
            if m.column and not m.channel.is_input and not m.channel.is_rate}  # fmt: skip
    forces = all(m.column and not m.channel.follows for m in inputs)  # fmt: skip
    return (
        bool(joints) and joints <= seen and joints <= {m.channel.joint for m in inputs} and forces
        and {mujoco.mjtJoint(int(kind)) for kind in model.jnt_type} <= turning
        and model.neq == 0 and found.step <= SLOWEST
    )  # fmt: skip


def _motors(spec: mujoco.MjSpec, model: mujoco.MjModel, found: Inspection) -> dict[str, str]:
    """Returns the motors that a model without actuators needs for the torques in a log."""
    units = {c.name: to_si(c.unit)[0] if c.unit else unit_by_words(c.name) for c in found.columns}
    forces = {name for name, unit in units.items() if unit in ("N m", "N")}
    if model.nu or not forces:
        return {}
    lacking = [Channel(name, joint, True) for joint, name in motors_to_add(spec).items()]
    matches = match([*lacking, *channels_of(model)], found)
    return {m.channel.name: m.column for m in matches if m.channel.is_input and m.column in forces}


def _sensors(spec: mujoco.MjSpec, model: mujoco.MjModel, found: Inspection) -> dict[str, str]:
    """Returns the sensors of positions that a model with others needs for columns of their words.

    The order of columns is no reason to add one: a passive joint is often not measured.
    """
    lacking = [Channel(n, joint, False) for n, joint in positions_without_sensor(spec).items()]
    matches = match([*channels_of(model), *lacking], found) if lacking else ()
    return {m.channel.name: m.column for m in matches
            if m.channel in lacking and m.column and m.how not in BY_PLACE}  # fmt: skip


def _guesses(found: Inspection, model: mujoco.MjModel, matches: Sequence[Match]) -> tuple[str, ...]:
    """Returns a sentence on each thing in the file that is a guess."""
    free = _numbers_to_free(model, matches)
    columns = [
        f"{m.channel.name} is column {m.column} ({m.how.removeprefix('guessed').strip(' :')});"
        f" {_what(model, m)}"
        for m in matches
        if m.column and m.how != SAME
    ]
    units = [f"{line} (unit)" for line in _log_lines(found, matches) if "=" in line]
    return (
        *columns, *units, *unanswered(found, model, matches),
        f"free = {toml_value(free)}: one number for each measured joint, and the gain of each"
        " position servo; free what you want to know",
        f"horizon = {_horizon(found, matches)!r} s: how far ahead the model must predict, a part of"
        " a swing",
    )  # fmt: skip


def _horizon(found: Inspection, matches: Sequence[Match]) -> float:
    """Returns a horizon to begin with, from the motion of the columns that outputs measure."""
    grid = np.arange(found.time[0], found.time[-1], found.step)
    outputs = [m.column for m in matches if not m.channel.is_input and m.column]
    each = [np.interp(grid, found.time[rows], found.values[name][rows])
            for name in outputs if (rows := np.isfinite(found.values[name])).any()]  # fmt: skip
    return part_of_swing(np.reshape(each, (len(each), len(grid))).T, found.step)


def _measured(matches: Sequence[Match]) -> list[str]:
    """Returns the joints that a column measures."""
    outputs = [m for m in matches if not m.channel.is_input and m.column]
    return [*dict.fromkeys(m.channel.joint for m in outputs if m.channel.joint)]


def _listed(matches: Sequence[Match]) -> str:
    return ", ".join(m.channel.name for m in matches)


def _lines(
    found: Inspection, model: mujoco.MjModel, matches: Sequence[Match], place: str,
    said: Sequence[str],
) -> list[str]:  # fmt: skip
    """Returns the lines of the file; `said` stands in comments at its head."""
    inputs = [m for m in matches if m.channel.is_input and m.column]
    outputs = [m for m in matches if not m.channel.is_input and m.column]
    lines = [
        f"# What `identification new` found in {found.path.name} and {Path(place).name}.",
        "# Lines with 'guessed' are to be judged by you. docs/robot/keys.md tells all keys.",
        *(f"# {sentence}" for sentence in said),
        "",
        f"model = {toml_value(place)}",
        f"outputs = {toml_value([m.channel.name for m in outputs])}",
        "# guessed: a number of each measured joint, the gain of each position servo; free what"
        " you want to know",
        f"free = {toml_value(_numbers_to_free(model, matches))}",
        f"horizon = {_horizon(found, matches)!r}  # [s], guessed: a part of a swing that it must"
        " predict",
    ]
    if inputs or outputs:
        lines += ["", "[columns]  # actuator or sensor = column of the log"]
    for m in (*inputs, *outputs):
        note = f"  # {m.how}; {_what(model, m)}"
        lines.append(f"{toml_key(m.channel.name)} = {toml_value(m.column)}{note}")
    answers = {a.output: a for a in _answers(found, matches)}
    told = [answers[m.column] for m in outputs if m.column in answers]
    lines += [f"# {sentence}" for sentence in answer_sentences(told)]
    return [*lines, *_log_lines(found, matches)]


def _log_lines(found: Inspection, matches: Sequence[Match]) -> list[str]:
    """Returns the tables that tell how the log is to be read, where it differs from the usual."""
    lines = []
    if found.time_column not in ("", "time"):
        lines += toml_table("log.columns", {found.time_column: "time"})
        lines[-1] += "  # guessed"
    units = {} if found.time_unit == "s" or not found.time_column else {"time": found.time_unit}
    guessed = {c.name: c.unit for c in found.columns if c.why != SAID}
    for m in matches:
        if (unit := guessed.get(m.column)) and to_si(unit)[1] != 1:
            units[m.column] = unit
    known = {c.name for c in found.columns if c.unit}
    for answer in _answers(found, matches):  # a setpoint has the unit of the position it commands
        if answer.is_setpoint and answer.output in units and answer.input not in known:
            units[answer.input] = units[answer.output]
    lines += [f"{line}  # guessed" if "=" in line else line
              for line in toml_table("log.units", units)]  # fmt: skip
    return lines


def _what(model: mujoco.MjModel, m: Match) -> str:
    """Returns what a channel is, for a comment."""
    if not m.channel.is_input and not m.channel.joint:
        return "the length of a tendon, which tells joints"
    if not m.channel.is_input:
        return f"the {'rate' if m.channel.is_rate else 'position'} of joint {m.channel.joint}"
    row = int(model.actuator(m.channel.name).id)
    drives = _DRIVES.get(m.channel.follows, "its input is a torque, force or current")
    if is_scaled_servo(model, row):
        scale, offset = scaling(model, row)
        more = f" {offset:+.4g}".replace(" -", " - ").replace(" +", " + ") if offset else ""
        drives = f"a position servo: {scale:.4g} times its input{more} is the setpoint"
    return drives + _place_of(model, row)


def _place_of(model: mujoco.MjModel, row: int) -> str:
    """Returns on which joint or tendon an actuator acts, for a comment."""
    kind, at = int(model.actuator_trntype[row]), int(model.actuator_trnid[row, 0])
    if kind == int(mujoco.mjtTrn.mjTRN_TENDON):
        return f" of the length of tendon {model.tendon(at).name}"
    return f" at joint {model.joint(at).name}" if kind in OF_JOINTS else ""


def _numbers_to_free(model: mujoco.MjModel, matches: Sequence[Match]) -> list[str]:
    """Returns a number of each measured joint, and the gain of each position servo in the log.

    A gain that the model has wrong and that is held looks like a displaced mass or a late clock.
    """
    servos = [m.channel.name for m in matches if m.channel.is_input and m.column]
    gains = [f"actuator/{name}.kp" for name in servos
             if follows(model, model.actuator(name).id) == "position"]  # fmt: skip
    return [*(_number_of(model, joint) for joint in _measured(matches)), *gains]


def _number_of(model: mujoco.MjModel, joint: str) -> str:
    """Returns a number of a joint that is not zero in the model, or the mass that it carries."""
    j = model.joint(joint)
    for path, value in (("damping", float(model.dof_damping[j.dofadr[0]])),
                        ("armature", float(model.dof_armature[j.dofadr[0]]))):  # fmt: skip
        if value > 0:
            return f"joint/{joint}.{path}"
    return f"body/{model.body(int(j.bodyid[0])).name}.mass"
