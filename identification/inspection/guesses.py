"""Guesses of what a column is: its unit by its name and its numbers, the unit of time by its steps.

A guess is told as one. It decides nothing but what a robot's file to begin with says.
"""

from __future__ import annotations

import re

import numpy as np

from identification.logs.headers.column_words import unit_by_words, words_of
from identification.logs.headers.headers import name_and_unit
from identification.logs.headers.unknown_units import unknown_unit
from identification.logs.names import group
from identification.logs.sampling import FloatArray
from identification.logs.units import UNITS

_TIMES = ("time", "t", "timestamp", "stamp", "secs", "sec", "seconds", "ms", "us", "ns")
_STEPS = ((0.5, "s"), (200.0, "ms"), (2e5, "us"), (np.inf, "ns"))  # largest usual step in a unit
_DEGREES = 10 * np.pi  # an angle that goes farther than five turns is rather one in degrees
_BRACKETS = re.compile(r"[\[(]([^\])]+)[\])]")


def family(name: str) -> str:
    """Returns what the columns of one list have in common: joint_states.position, or angle."""
    return name.rpartition(".")[0] or group(name)


def unit_of(name: str, farthest: float) -> tuple[str, str]:
    """Returns the unit of a column as a word of `UNITS`, and why it is believed; "" for unknown.

    `farthest` is the largest number of its family.
    """
    if unknown_unit(name):
        return "", ""
    brackets = _BRACKETS.search(name)
    last = re.split(r"[_.\s]", name)[-1]
    for word in ([brackets[1].strip()] if brackets else []) + [last]:
        if word in UNITS and (brackets or len(word) > 1):
            return word, "its name ends in it"
    if unit := name_and_unit(name)[1]:
        return unit, "its name ends in it"
    unit = unit_by_words(name)
    if unit == "rad" and farthest > _DEGREES:
        return "deg", "it goes too far for radians"
    return unit, "its name" if unit else ""


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
