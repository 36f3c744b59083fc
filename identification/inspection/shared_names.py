"""Which column is whose where an actuator bears the name of the joint that it drives.

In many models the actuator `elbow` drives the joint `elbow`. Then a column `elbow` may be what the
actuator is told or what was measured, and its name does not say which. The columns beside it do:

    elbow_cmd, elbow         elbow is what was measured
    elbow, elbow_pos         elbow is the command
    elbow, elbow_2           the one that comes late is what was measured, if it answers the other
    elbow                    what was measured: without it a log says nothing of the joint

Nothing is in doubt where a sensor of the joint has a column of its own name.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.inspection.channels import Channel, Match
from identification.inspection.inspected import Inspection
from identification.logs.headers.column_words import is_force, is_rate, name_words, role_of

ALONE = "guessed: no column beside it is a command"  # how such a column was found


def shared_matches(channels: Sequence[Channel], found: Inspection) -> tuple[Match, ...]:
    """Returns the actuators whose name does not say which column is theirs, and their sensors."""
    columns = [c.name for c in found.columns]
    out: list[Match] = []
    for actuator in channels:
        sensors = _sensors(actuator, channels)
        named = {s.name for s in sensors} & {*columns}
        if actuator.is_input and actuator.name in columns and sensors and not named:
            out += _judged(actuator, sensors[0], channels, found)
    return tuple(out)


def _sensors(actuator: Channel, channels: Sequence[Channel]) -> list[Channel]:
    """Returns the sensors of position that may be meant where an actuator's name is a column."""
    words = name_words(actuator.name)
    if role_of(actuator.name) == "input" or not words:  # its name says that it is what is told
        return []
    return [
        c for c in channels
        if not (c.is_input or c.is_rate) and c.joint == actuator.joint
        and words <= name_words(c.joint or c.name)
    ]  # fmt: skip


def _judged(
    actuator: Channel, sensor: Channel, channels: Sequence[Channel], found: Inspection
) -> list[Match]:
    """Returns the columns of an actuator and of its sensor; nothing where its name is its column.

    Of several columns that may be a command none is taken, because each may be the right one.
    """
    plain = actuator.name
    beside = _beside(actuator, sensor, channels, found)
    roles = {c: _role(c, actuator, found) for c in beside}
    told = [c for c in beside if roles[c] == "input" and _may_tell(c, actuator)]
    measured = [c for c in beside if roles[c] == "output" and not is_rate(c)]
    if not told and (measured or _others_may_be(sensor, channels, found)):
        return []
    command = told[0] if len(told) == 1 else ""
    if measured:  # what bears the plain name is then something else
        position = measured[0] if len(measured) == 1 else ""
        return [Match(actuator, command, "guessed by the words of its name"),
                Match(sensor, position, "guessed by the words of its name")]  # fmt: skip
    how = f"guessed: column {command} is the command" if command else ALONE
    if len(told) > 1:
        how = f"guessed: one of {' and '.join(told)} is the command"
    return [Match(actuator, command, f"guessed: column {plain} is what was measured"),
            Match(sensor, plain, how)]  # fmt: skip


def _beside(
    actuator: Channel, sensor: Channel, channels: Sequence[Channel], found: Inspection
) -> list[str]:
    """Returns the columns whose words are those of an actuator or its joint, and some more.

    `wrist_pitch_cmd` belongs to `wrist_pitch` and not to `pitch`: the longer name counts.
    """
    own = {name_words(n) for c in (actuator, sensor) for n in (c.name, c.joint)} - {frozenset()}
    every = {name_words(n) for c in channels for n in (c.name, c.joint)} - {frozenset()}
    names = {c.name for c in channels}
    out = []
    for column in (c.name for c in found.columns if c.name not in names):
        inside = [words for words in every if words <= name_words(column)]
        longest = max(map(len, inside), default=0)
        if longest and all(words in own for words in inside if len(words) == longest):
            out.append(column)
    return out


def _role(column: str, actuator: Channel, found: Inspection) -> str:
    """Returns what the words beside the name tell of a column, or else which answers the other."""
    role = role_of(" ".join(name_words(column) - name_words(actuator.name)))
    answers = {(a.output, a.input) for a in found.answers}
    if role or column == actuator.name:
        return role
    if (actuator.name, column) in answers:
        return "input"
    return "output" if (column, actuator.name) in answers else ""


def _may_tell(column: str, actuator: Channel) -> bool:
    """Returns whether a column that looks like an input is of the kind that an actuator takes."""
    if actuator.follows == "position":
        return not is_force(column) and not is_rate(column)
    return not (actuator.follows == "velocity" and is_force(column))


def _others_may_be(sensor: Channel, channels: Sequence[Channel], found: Inspection) -> bool:
    """Returns whether a column that names no other joint may be what a sensor measured."""
    names, own = {c.name for c in channels}, name_words(sensor.joint or sensor.name)
    known = {name_words(c.joint or c.name) for c in channels} - {own, frozenset()}
    return any(
        c.role == "output" and not is_rate(c.name) and c.name not in names
        and not any(words <= name_words(c.name) for words in known)
        for c in found.columns
    )  # fmt: skip
