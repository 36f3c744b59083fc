"""Guesses of what a column is: its unit and its role by its name, the unit of time by its steps.

A guess is told as one. It decides nothing but what a robot's file to begin with says.
"""

from __future__ import annotations

import re
from typing import Literal

import numpy as np

from identification.logs.names import group
from identification.logs.sampling import FloatArray
from identification.logs.units import UNITS

Role = Literal["input", "output", ""]
# Words of a name, the role of such a column, and its SI unit ("" where the word does not tell it).
_WORDS: tuple[tuple[tuple[str, ...], Role, str], ...] = (
    (("command", "commands", "commanded", "cmd", "cmds", "action", "actions", "desired", "des",
      "setpoint", "setpoints", "sp", "target", "targets", "reference", "references", "ref", "goal",
      "goals", "wanted", "demand", "sent", "soll", "input", "u", "ctrl", "control"), "input", ""),
    (("pwm", "duty"), "input", ""),
    (("effort", "efforts", "torque", "torques", "tau"), "input", "N m"),
    (("force",), "input", "N"),
    (("current", "curr", "amps", "i"), "input", "A"),
    (("voltage", "volt", "volts"), "input", "V"),
    (("velocity", "velocities", "vel", "speed", "rate", "qd", "dq", "qvel"), "output", "rad/s"),
    (("position", "positions", "pos", "angle", "theta", "q", "qpos", "encoder", "state", "y"),
     "output", "rad"),
    (("present", "actual", "measured", "meas", "observation", "observed", "obs", "feedback", "fb",
      "ist"), "output", ""),
)  # fmt: skip
# Words of forces and of what makes them; a single letter (i of a current) may be any other name.
_FORCES = {"pwm", "duty"} | {
    word for words, _, unit in _WORDS if unit in ("N m", "N", "A", "V") for word in words
    if len(word) > 1
}  # fmt: skip
_TIMES = ("time", "t", "timestamp", "stamp", "secs", "sec", "seconds", "ms", "us", "ns")
_STEPS = ((0.5, "s"), (200.0, "ms"), (2e5, "us"), (np.inf, "ns"))  # largest usual step in a unit
_DEGREES = 10 * np.pi  # an angle that goes farther than five turns is rather one in degrees
_TOKEN = re.compile(r"[A-Za-z]+|°|%")
_BRACKETS = re.compile(r"[\[(]([^\])]+)[\])]")


def words_of(name: str) -> tuple[str, ...]:
    """Returns the words of a column's name in small letters, such as joint, states, position."""
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return tuple(word.lower() for word in _TOKEN.findall(apart))


def role_of(name: str) -> Role:
    """Returns whether a column is an input or an output by its name; "" where it does not tell."""
    words = words_of(name)
    return next((role for known, role, _ in _WORDS if {*known} & {*words}), "")


def is_rate(name: str) -> bool:
    """Tells whether a column is a rate by its name, such as a velocity."""
    return _unit_by_words(name) == "rad/s"


def is_force(name: str) -> bool:
    """Tells whether a column is a force or what makes one, such as a current, by its name."""
    return bool(_FORCES & {*words_of(name)})


def family(name: str) -> str:
    """Returns what the columns of one list have in common: joint_states.position, or angle."""
    return name.rpartition(".")[0] or group(name)


def unit_of(name: str, farthest: float) -> tuple[str, str]:
    """Returns the unit of a column as a word of `UNITS`, and why it is believed; "" for unknown.

    `farthest` is the largest number of its family.
    """
    brackets = _BRACKETS.search(name)
    last = re.split(r"[_.\s]", name)[-1]
    for word in ([brackets[1].strip()] if brackets else []) + [last]:
        if word in UNITS and (brackets or len(word) > 1):
            return word, "its name ends in it"
    unit = _unit_by_words(name)
    if unit == "rad" and farthest > _DEGREES:
        return "deg", "it goes too far for radians"
    return unit, "its name" if unit else ""


def _unit_by_words(name: str) -> str:
    """Returns the SI unit that the words of a name tell of; "" for none."""
    return next((u for known, _, u in _WORDS if u and {*known} & {*words_of(name)}), "")


def is_time(name: str, values: FloatArray) -> bool:
    """Tells whether a column may be the time of a log: by its name, and because it goes on."""
    steps = np.diff(values)
    goes_on = steps.size > 0 and bool(np.all(steps >= 0)) and values[-1] > values[0]
    return goes_on and bool({*_TIMES} & {*words_of(name)})


def time_unit(time: FloatArray) -> str:
    """Returns the unit in which stamps come about as often as those of robots: 5 Hz to 2 kHz."""
    steps = np.diff(time)
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else 1.0
    return next(unit for most, unit in _STEPS if usual < most)
