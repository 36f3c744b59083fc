"""The actuators and sensors of a model that columns of a log may be."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco

from identification.logs.headers.column_words import Role, is_force, is_rate
from identification.model.tied import follows

_RATE = int(mujoco.mjtSensor.mjSENS_JOINTVEL)
_POSITION = int(mujoco.mjtSensor.mjSENS_JOINTPOS)
_LENGTH = int(mujoco.mjtSensor.mjSENS_TENDONPOS)
OF_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


@dataclass(frozen=True)
class Channel:
    """An actuator or a sensor of a model that a column of a log may be."""

    name: str
    joint: str  # on which it acts, or which it measures; "" for another thing, such as a tendon
    is_input: bool
    is_rate: bool = False
    # What the actuator is told to reach, "position" or "velocity"; "" where its input is a force.
    follows: str = ""


@dataclass(frozen=True)
class Match:
    """A channel with its column, "" where no column was found, and how it was found."""

    channel: Channel
    column: str
    how: str


def channels_of(model: mujoco.MjModel) -> tuple[Channel, ...]:
    """Returns the actuators of a model, and its sensors of joints and of lengths of tendons."""
    inputs = [
        Channel(model.actuator(k).name, _joint(model, k), True, follows=follows(model, k) or "")
        for k in range(model.nu)
    ]  # fmt: skip
    outputs = [
        Channel(model.sensor(k).name, _measured(model, k), False,
                int(model.sensor_type[k]) == _RATE)
        for k in range(model.nsensor) if int(model.sensor_type[k]) in (_RATE, _POSITION, _LENGTH)
    ]  # fmt: skip
    return (*inputs, *outputs)


def _measured(model: mujoco.MjModel, sensor: int) -> str:
    if int(model.sensor_type[sensor]) == _LENGTH:
        return ""
    return str(model.joint(int(model.sensor_objid[sensor])).name)


def _joint(model: mujoco.MjModel, actuator: int) -> str:
    if int(model.actuator_trntype[actuator]) not in OF_JOINTS:
        return ""
    return str(model.joint(int(model.actuator_trnid[actuator, 0])).name)


def may_be(channel: Channel, column: str, role: Role) -> bool:
    """Returns whether a column may belong to a channel, as its name and its role tell."""
    if channel.is_input:
        return role != "output" and not (channel.follows == "position" and is_force(column))
    return role != "input" and is_rate(column) == channel.is_rate
