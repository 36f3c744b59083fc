"""Do all drives act against the sign that their model gives them?

A motor on a tendon pushes the ends of the tendon apart where its force is positive, so that a winch
needs a negative gear. With the wrong sign no mass and no payload explains how the robot moves:
masses are positive. Forces tell this, even where the model lacks so much that its simulations
explain little of the log with either sign. They say nothing of a robot that hardly accelerates:
there gravity that is turned would explain the log as well as inputs that are turned.

A drive that only pulls has a range of inputs on one side of zero. An input that is tried with the
other sign is therefore tried with the range turned too.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import replace

import mujoco
import numpy as np

from identification.effects.joint_plant import JointPlant
from identification.logs.cures import how_to_turn
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.readings import NEARER, UNEXPLAINED, Reading, turned
from identification.quantities import held
from identification.robot.balance import unbalanced_share
from identification.robot.file import RobotFile

PUSHES = " (a motor on a tendon pushes its ends apart where it is positive)"


def all_inputs_turned(
    log: Log, bad: np.ndarray, column: Mapping[str, str], model: mujoco.MjModel, file: RobotFile
) -> Iterator[Reading]:
    """Yields the other sign of all inputs, where there are some.

    Args:
        log: as it is read.
        bad: true where an output is not explained, shape (ny,).
        column: what an output or input is called in the log's file.
        model: with the log's actuators.
        file: the robot's.
    """
    nu = log.inputs.shape[1]
    if not log.inputs.any():
        return
    other = replace(log, inputs=turned(log.inputs, range(nu)))
    said = "with the other sign of all inputs" if nu > 1 else "with the other sign of the input"
    yield Reading(other, np.flatnonzero(bad).tolist(), said, _cure(log, column, model, file))


def decided_by_forces(
    reading: Reading, model: mujoco.MjModel, own: np.ndarray | None, log: Log
) -> str | None:
    """Says how much less of the drives' forces is unexplained with other signs.

    Args:
        reading: the other sign of all inputs.
        model: with the log's actuators and sensors.
        own: η of the log as it is read, shape (ny,); None where it cannot be had.
        log: as it is read.

    Returns:
        None where forces do not explain the log with other signs, or not far better.
    """
    if own is None:
        return None
    left = unbalanced_share(with_turned_ranges(model, log, reading.log), reading.log)
    if left is None or (left > UNEXPLAINED).any() or left.sum() > NEARER * own.sum():
        return None
    times = held(float(own.sum() / max(left.sum(), np.finfo(float).tiny)))
    return (
        f"leaves {times} times as much of the drives' forces unexplained as it would"
        f" {reading.said}, whatever payload, gravity and friction it has; {reading.cure}"
    )


def with_turned_ranges(model: mujoco.MjModel, log: Log, other: Log) -> mujoco.MjModel:
    """Returns the model with the ranges turned of those inputs that another reading turns.

    Args:
        model: with the log's actuators.
        log: as it is read.
        other: the same log with other signs of some inputs.
    """
    back = (other.inputs == -log.inputs).all(axis=0) & log.inputs.any(axis=0)
    of = np.flatnonzero(back)
    if not model.actuator_ctrlrange[of].any():
        return model
    changed = copy.copy(model)
    changed.actuator_ctrlrange[of] = -model.actuator_ctrlrange[of][:, ::-1]
    return changed


def plant_of_reading(plant: JointPlant, log: Log, other: Log) -> JointPlant:
    """Returns the plant whose ranges of inputs are turned as another reading turns inputs."""
    model = with_turned_ranges(plant.bare.model, log, other)
    if model is plant.bare.model:
        return plant
    return replace(plant, bare=replace(plant.bare, model=model))


def _cure(log: Log, column: Mapping[str, str], model: mujoco.MjModel, file: RobotFile) -> str:
    """Returns what to write into the model, or the log's TOML where the model's ranges allow it."""
    names, factors = log.input_names, {column[n]: f for n, f in log.factors.items() if n in column}
    in_log = how_to_turn([column[n] for n in names], factors)
    if file.model.suffix.lower() == ".urdf":  # it has no gears that could be written
        return in_log
    gears: dict[str, list[str]] = {}
    for i, name in enumerate(names):
        gear = model.actuator_gear[i]
        entries = gear[: int(np.flatnonzero(gear).max(initial=0)) + 1] + 0.0
        gears.setdefault(" ".join(f"{-x:g}" for x in entries), []).append(name)
    lines = listed(f'gear="{gear}" for {listed(of)}' for gear, of in gears.items())
    tendons = (model.actuator_trntype[: len(names)] == int(mujoco.mjtTrn.mjTRN_TENDON)).any()
    in_model = f"write {lines} into {file.model}{PUSHES if tendons else ''}"
    low, high = model.actuator_ctrlrange[: len(names)].T
    limited = model.actuator_ctrllimited[: len(names)].astype(bool)
    outside = limited & ((-log.inputs < low) | (-log.inputs > high)).any(axis=0)
    return in_model if outside.any() else f"{in_model}, or {in_log}"
