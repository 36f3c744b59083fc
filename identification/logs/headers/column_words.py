"""The words of a column's name, and what they tell: an input or an output, a force, a unit.

    joint_states.effort_2      joint, states, effort: an input, of a torque
    desired_position           desired, position: an input, which a servo follows
    current_position           current, position: an output, for current means present there

A name proves nothing. Whoever decides by it has to say so.
"""

from __future__ import annotations

import re
from typing import Literal

from identification.logs.units import UNITS

Role = Literal["input", "output", ""]
_COMMANDS = (
    "command", "commands", "commanded", "cmd", "cmds", "action", "actions", "desired", "des",
    "setpoint", "setpoints", "sp", "target", "targets", "reference", "references", "ref", "goal",
    "goals", "wanted", "demand", "sent", "soll",
)  # fmt: skip
_CONTROLS = ("input", "u", "ctrl", "control")
# Words of a name, the role of such a column, and its SI unit ("" where the word does not tell it).
_WORDS: tuple[tuple[tuple[str, ...], Role, str], ...] = (
    ((*_COMMANDS, *_CONTROLS), "input", ""),
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
# Of these, words that mean nothing else, also beside words of motion.
_CLEAR = _FORCES - {"current", "curr", "voltage", "volt", "volts"}
_MOTION = {
    word for words, _, unit in _WORDS if unit in ("rad", "rad/s") for word in words
    if len(word) > 1
} - {"state"}  # fmt: skip
# Words of what drives nothing, whatever stands beside them: a switch, a bound, a supply, a clock.
_IDLE = {
    "enable", "enabled", "limit", "max", "min", "mode", "status", "flag", "id", "index", "error",
    "battery", "batt", "bat", "vbat", "supply", "bus", "vbus", "rail", "temperature", "temp",
    "time", "stamp", "timestamp",
}  # fmt: skip
_OF_FORCES = ("N", "N m", "A")  # SI units of a column that is an input; volts may be a sensor's
_TOKEN = re.compile(r"[A-Za-z]+|°|%")


def words_of(name: str) -> tuple[str, ...]:
    """Returns the words of a column's name in small letters, such as joint, states, position."""
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return tuple(word.lower() for word in _TOKEN.findall(apart))


def name_words(name: str) -> frozenset[str]:
    """Returns the words of a name in small letters, and its numbers."""
    digits = "".join(c if c.isdigit() else " " for c in name).split()
    return frozenset((*words_of(name), *digits))


def role_of(name: str) -> Role:
    """Returns whether a column is an input or an output by its name; "" where it does not tell."""
    words = words_of(name)
    return next((role for known, role, _ in _WORDS if {*known} & {*words}), "")


def is_rate(name: str) -> bool:
    """Tells whether a column is a rate by its name, such as a velocity."""
    return unit_by_words(name) == "rad/s"


def is_force(name: str) -> bool:
    """Tells whether a column is a force or what makes one, such as a current, by its name."""
    return bool(_FORCES & {*words_of(name)})


def unit_by_words(name: str) -> str:
    """Returns the SI unit that the words of a name tell of; "" for none."""
    return next((u for known, _, u in _WORDS if u and {*known} & {*words_of(name)}), "")


def looks_like(name: str, unit: str = "") -> Literal["force", "command", ""]:
    """Returns whether a column looks like an input: a force or what makes one, or a command.

    Args:
        name: of the column, without its unit.
        unit: that its header gives it, "" where it gives none that is known.
    """
    words, si = {*words_of(name)}, UNITS.get(unit, ("", 1.0))[0]
    if words & _IDLE:
        return ""
    if words & _CLEAR:
        return "force"
    if not words & _MOTION and (words & {*_FORCES, *_CONTROLS} or si in _OF_FORCES):
        return "force"
    return "command" if words & {*_COMMANDS} else ""
