"""Checks of what a robot's file, its model and its log must agree on, before a simulation."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import mujoco

from identification.errors import InputError, unknown_name
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.plausible import still_sentence
from identification.logs.sampling import MIN_ROWS, rows_between
from identification.logs.sidecar import read_sidecar
from identification.logs.units import to_si, units_that_fit
from identification.model.predictor import sensor_word
from identification.robot.file.completed import position_of
from identification.robot.file.file import RobotFile
from identification.robot.file.measured_base import pose_names
from identification.robot.file.measured_tendons import measured_tendons
from identification.storage.files import toml_key

FEW = 3  # sensors that a message tells
MOST_STEPS = 100.0  # of the model in a sample; with more, time is most often in ms, us or ns


def is_toml_of(path: Path, log: Path) -> bool:
    """Returns whether a file is, or would be, the TOML beside a log."""
    return bool(log.name) and os.path.realpath(log.with_suffix(".toml")) == os.path.realpath(path)


def refuse_same_stem(file: RobotFile, log: Path) -> None:
    """Refuse a robot's file that would also be read as the TOML of the log."""
    if is_toml_of(file.path, log):
        raise InputError(
            f"{file.path} bears the name of {log} and would be read as what its log's own TOML says"
            " of units and parts; rename one of them"
        )


def refuse_unnamed(model: mujoco.MjModel, file: RobotFile) -> None:
    """Refuse actuators without a name, and position sensors without a name that may be outputs."""
    kind = int(mujoco.mjtSensor.mjSENS_JOINTPOS)
    sensors = [(model.sensor(i).name, int(model.sensor_type[i])) for i in range(model.nsensor)]
    things = [("actuator", i, model.actuator(i).name) for i in range(model.nu)]
    if not file.outputs or not set(file.outputs) <= {name for name, _ in sensors}:
        things += [("sensor", i, name) for i, (name, type_) in enumerate(sensors) if type_ == kind]
    for what, i, name in things:
        if not name:
            raise InputError(
                f"{what} {i} of {file.model}, counted from 0, has no name; give it one, such as the"
                " name of its column in the log"
            )


def outputs_of(model: mujoco.MjModel, file: RobotFile) -> tuple[str, ...]:
    """Returns the sensors of a log's outputs: what the file names, or all joint positions.

    A measured pose or length stands for the joints that it tells.
    """
    sensors = {model.sensor(i).name: sensor_word(model, i) for i in range(model.nsensor)}
    outputs = file.outputs or tuple(n for n, kind in sensors.items() if kind == "a jointpos")
    if outputs:
        made = {n: pose_names(model, n) for n in outputs if n in sensors}
        tendons = measured_tendons(model, file)
        made |= dict.fromkeys(tendons.sensors, tendons.joints)
        return tuple(dict.fromkeys(each for n in outputs for each in made.get(n) or (n,)))
    if not sensors:
        raise InputError(
            f"{file.model} has no sensor; it needs a jointpos or jointvel sensor for every output,"
            " and an actuator for every input"
        )
    others = ", ".join(
        f'"{n}"' for n, kind in sensors.items() if kind in ("a jointvel", "a tendonpos") and n
    )
    if others:
        raise InputError(
            f"{file.model} has no jointpos sensor, and {file.path} names no outputs; write outputs"
            f" = [{others}] into {file.path}"
        )
    of, rest = f" of {file.model}", [*sensors.items()]
    kinds = [f"{n!r}{of * (k == 0)} is {kind}" for k, (n, kind) in enumerate(rest[:FEW])]
    more = f" and {len(rest) - FEW} more are of such kinds" if len(rest) > FEW else ""
    raise InputError(
        f"sensor {', '.join(kinds)}{more}; outputs are jointpos or jointvel sensors, so give the"
        " model one for each measured joint"
    )


def refuse_unknown_outputs(model: mujoco.MjModel, file: RobotFile, outputs: Sequence[str]) -> None:
    """Refuse an output that is no sensor of the model, with what to write."""
    sensors = [name for i in range(model.nsensor) if (name := model.sensor(i).name)]
    joints = [name for j in range(model.njnt) if (name := model.joint(j).name)]
    actuators = [model.actuator(k).name for k in range(model.nu)]
    for name in outputs:
        own = position_of(name, actuators)
        if name != own and (own in sensors or name in joints):
            raise InputError(
                f"outputs in {file.path}: {name} is an actuator of {file.model}, and a log has a"
                f' column for each; write "{own}", the sensor, in its place, and'
                f' {toml_key(own)} = "COLUMN" under [columns] for its column in the log'
            )
        if name not in sensors:
            unknown = unknown_name(f"sensor under outputs in {file.path}:", name, sensors)
            raise InputError(
                f'{unknown}; write one of these, or add <jointpos name="{name}" joint="JOINT"/> to'
                f" the <sensor> of {file.model}, with one of its joints: {listed(joints)}"
            )


def refuse_columns(file: RobotFile, names: Sequence[str], log: Path) -> None:
    """Refuse names under [columns] that are none of the model's, and columns that are given twice.

    Args:
        file: of the robot.
        names: of the actuators and sensors that have columns.
        log: path of the log.
    """
    for name in file.columns:
        if name == "time":
            raise InputError(
                f"[columns] in {file.path} names columns of actuators and sensors; the column of"
                f" time is named in the log's TOML, the other way round: write"
                f' {toml_key(file.columns[name])} = "time" under [columns] in'
                f" {log.with_suffix('.toml')}, or under [log.columns] in {file.path}"
            )
        if name not in names:
            where = f"actuator or sensor under columns in {file.path}:"
            unknown = unknown_name(where, name, names)
            raise InputError("; ".join([str(unknown), *_shared(file.columns, name)]))
    for name in file.columns:
        if shared := _shared(file.columns, name):
            raise InputError(f"in {file.path}, {shared[0]}; give each a column of its own")


def _shared(columns: Mapping[str, str], name: str) -> list[str]:
    """Returns that the column of an actuator or sensor is that of others too, or nothing."""
    column = columns[name]
    users = [n for n, other in columns.items() if other == column]
    return [f"column {column!r} is that of {' and '.join(users)}"] if len(users) > 1 else []


def refuse_short(log: Log, path: Path) -> None:
    """Refuse a log that has too few samples to fit one half and to confirm the other."""
    if len(log) < 2 * MIN_ROWS:
        raise InputError(
            f"{path} has {len(log)} rows; one half of a log is fitted and the other one confirms,"
            f" each of at least {MIN_ROWS}: record some seconds of motion, hundreds of rows"
        )


def refuse_milliseconds(model: mujoco.MjModel, file: RobotFile, log: Log, path: Path) -> None:
    """Refuse a log with so many model steps per sample that its time cannot be in seconds."""
    h, step = log.sampling_time, float(model.opt.timestep)
    if h <= MOST_STEPS * step or "time" in file.trust:
        return
    sidecar = read_sidecar(path.with_suffix(".toml"), file.log, file.path)
    given = log.said_units.get("time", "s")
    unit = next(iter(units_that_fit("s", h / to_si(given)[1], MOST_STEPS * step)), None)
    where, but_not = path.with_suffix(".toml"), ""
    if "time" in sidecar.units:
        where = sidecar.file_of("units")
        but_not = f", and not in {given} as {where} says"
    elif "time" in log.said_units:
        but_not = f", and not in {given} as its column says"
    asked = "see whether its stamps are right, else"
    if unit:
        asked = (
            f"is its time in {unit}{but_not}? then write time = "
            f'"{unit}" under [units] in {where}, else'
        )
    raise InputError(
        f"{path} is sampled every {h:g} s, {h / step:.0f} steps of {file.model}; {asked} give the"
        f" model a timestep of {h / MOST_STEPS:g} s or more, or write trust = ["
        f'"time"] into {file.path}'
    )


def with_judged_gaps(file: RobotFile, log: Log) -> Log:
    """Returns a log whose gaps cost what touches them; without gaps where they are trusted.

    A free run is refused, because it cannot begin anew behind a gap as a window does.
    """
    if not log.gaps:
        return log
    if "gaps" in file.trust:
        return replace(log, gaps=())
    if file.horizon is not None:
        return log
    begin, end = max(log.gaps, key=lambda gap: gap[1] - gap[0])
    several = len(log.gaps) > 1
    still = still_sentence(log)
    raise InputError(
        (f"{still} Besides, " if still else "")
        + f"log {log.name!r} has {len(log.gaps)} gap{'s' * several} that a free run cannot bridge;"
        f" {'the widest of them' if several else 'it'} is {end - begin:.3g} s long, from"
        f" {begin:.6g} s. Write a horizon into {file.path}, such as horizon = 0.2 (in seconds),"
        " over which only the windows that touch a gap are left out, or"
        ' trust = ["gaps"] to take what is made up there as measured'
    )


def refuse_every(file: RobotFile, log: Log) -> None:
    """Refuse to thin a log whose parts would become too short."""
    if file.every > 1 and not _left(log, file.every):
        largest = max((n for n in range(1, len(log)) if _left(log, n)), default=1)
        raise InputError(
            f"every in {file.path} is {file.every}, which leaves too few of the {len(log)} samples"
            f" of log {log.name!r}; it may be {largest} at most"
        )


def _left(log: Log, every: int) -> bool:
    """Returns whether every n-th sample is enough for each part of a log."""
    time = log.time[: (len(log) - 1) // every * every + 1 : every]
    if len(time) < 2 * MIN_ROWS:
        return False
    rows = (rows_between(time, *split) for split in log.splits.values())
    return all(last - first >= MIN_ROWS for first, last in rows)


def refuse_horizon(file: RobotFile, log: Log, is_whole: bool = False) -> None:
    """Refuse a horizon that does not fit into both parts of a log, or into all of it."""
    parts = [log] if is_whole else [log.part("estimation"), log.part("validation")]
    most, h = min(map(len, parts)), log.sampling_time
    if file.horizon is None or MIN_ROWS <= round(file.horizon / h) <= most:
        return
    raise InputError(
        f"horizon in {file.path} is {file.horizon:g} s; for log {log.name!r} write one from"
        f" {MIN_ROWS * h:g} s ({MIN_ROWS} samples) to {most * h:g} s"
        f" ({'the log' if is_whole else 'its shorter part'})"
    )
