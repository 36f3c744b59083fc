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
from collections.abc import Iterator
from dataclasses import replace

import mujoco
import numpy as np

from identification.effects.plant.joint_plant import JointPlant
from identification.logs.log import Log
from identification.logs.names import listed
from identification.refusals.columns import Doubt, turned
from identification.refusals.readings import Reading
from identification.refusals.trust import RobotFile

PUSHES = " (a motor on a tendon pushes its ends apart where it is positive)"


def all_inputs_turned(doubt: Doubt, model: mujoco.MjModel, file: RobotFile) -> Iterator[Reading]:
    """Yields the other sign of all inputs, where there are some."""
    nu = doubt.log.inputs.shape[1]
    if not doubt.log.inputs.any():
        return
    other = replace(doubt.log, inputs=turned(doubt.log.inputs, range(nu)))
    text = "with the other sign of all inputs" if nu > 1 else "with the other sign of the input"
    yield Reading(other, doubt.wrong, text, _cure(doubt, model, file))


def with_turned_ranges(model: mujoco.MjModel, log: Log, other: Log) -> mujoco.MjModel:
    """Returns the model with the ranges turned of those inputs that another reading turns."""
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


def _cure(doubt: Doubt, model: mujoco.MjModel, file: RobotFile) -> str:
    """Returns what to write into the model, or the log's TOML where the model's ranges allow it."""
    names, inputs = doubt.log.input_names, doubt.log.inputs
    in_log = doubt.how_to_turn(doubt.inputs)
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
    outside = limited & ((-inputs < low) | (-inputs > high)).any(axis=0)
    return in_model if outside.any() else f"{in_model}, or {in_log}"
