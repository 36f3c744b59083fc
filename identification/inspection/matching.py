"""Which column of a log an actuator or a sensor of a model is, as their names tell.

The words of a column are compared with those of the actuator or sensor and of its joint. A column
that shares more words with one than with any other is that one; of two that share as many, the one
whose name says that it is an input, or an output. What is left is taken in its order where there
are as many columns left as actuators or sensors. Either way it is a guess.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco

from identification.inspection.guesses import is_rate, role_of, words_of
from identification.inspection.inspected import Inspection

SAME = "the same name"  # how a column was found, which is no guess
_RATE = int(mujoco.mjtSensor.mjSENS_JOINTVEL)
_POSITION = int(mujoco.mjtSensor.mjSENS_JOINTPOS)
_LENGTH = int(mujoco.mjtSensor.mjSENS_TENDONPOS)
_OF_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


@dataclass(frozen=True)
class Channel:
    """An actuator or a sensor of a model that a column of a log may be."""

    name: str
    joint: str  # on which it acts, or which it measures; "" for another thing, such as a tendon
    is_input: bool
    is_rate: bool = False


@dataclass(frozen=True)
class Match:
    """A channel with its column, "" where no column was found, and how it was found."""

    channel: Channel
    column: str
    how: str


def channels_of(model: mujoco.MjModel) -> tuple[Channel, ...]:
    """Returns the actuators of a model, and its sensors of joints and of lengths of tendons."""
    inputs = [
        Channel(model.actuator(k).name, _joint(model, k), True) for k in range(model.nu)
    ]  # fmt: skip
    outputs = [
        Channel(model.sensor(k).name, _measured(model, k), False,
                int(model.sensor_type[k]) == _RATE)
        for k in range(model.nsensor) if int(model.sensor_type[k]) in (_RATE, _POSITION, _LENGTH)
    ]  # fmt: skip
    return (*inputs, *outputs)


def match(channels: Sequence[Channel], found: Inspection) -> tuple[Match, ...]:
    """Returns for each channel of a model the column that it most likely is."""
    free = [c.name for c in found.columns]
    out: dict[Channel, Match] = {}
    for channel in channels:
        if channel.name in free:
            out[channel] = Match(channel, channel.name, SAME)
            free.remove(channel.name)
    pairs = sorted(
        ((_alike(channel, name), i, k) for i, channel in enumerate(channels)
         for k, name in enumerate(free) if channel not in out and _may_be(channel, name, found)),
        key=lambda pair: pair[0],
        reverse=True,
    )  # fmt: skip
    names = [*free]
    for score, i, k in pairs:
        rivals = [p for p in pairs if p[0] == score and (p[1] == i) != (p[2] == k)
                  and channels[p[1]] not in out and names[p[2]] in free]  # fmt: skip
        if score[0] > 0 and channels[i] not in out and names[k] in free and not rivals:
            out[channels[i]] = Match(channels[i], names[k], "guessed by the words of its name")
            free.remove(names[k])
    for kind in ((True, False), (False, False), (False, True)):
        rest = [c for c in channels if c not in out and (c.is_input, c.is_rate) == kind]
        columns = [name for name in free if rest and _may_be(rest[0], name, found)]
        if rest and len(rest) == len(columns):
            for channel, name in zip(rest, columns, strict=True):
                how = "guessed by its order" if len(rest) > 1 else "guessed: no other is left"
                out[channel] = Match(channel, name, how)
                free.remove(name)
    return tuple(out.get(channel, Match(channel, "", "")) for channel in channels)


def _alike(channel: Channel, name: str) -> tuple[int, bool]:
    """Returns how many words a column shares with a channel or its joint, and if roles agree."""
    names = {*_words(channel.name), *_words(channel.joint)}
    role = "input" if channel.is_input else "output"
    return len(names & {*_words(name)}), role_of(name) == role


def _words(name: str) -> set[str]:
    digits = "".join(c if c.isdigit() else " " for c in name).split()
    return {*words_of(name), *digits}


def _may_be(channel: Channel, name: str, found: Inspection) -> bool:
    role = next(c.role for c in found.columns if c.name == name)
    if channel.is_input:
        return role != "output"
    return role != "input" and is_rate(name) == channel.is_rate


def _measured(model: mujoco.MjModel, sensor: int) -> str:
    if int(model.sensor_type[sensor]) == _LENGTH:
        return ""
    return str(model.joint(int(model.sensor_objid[sensor])).name)


def _joint(model: mujoco.MjModel, actuator: int) -> str:
    if int(model.actuator_trntype[actuator]) not in _OF_JOINTS:
        return ""
    return str(model.joint(int(model.actuator_trnid[actuator, 0])).name)
