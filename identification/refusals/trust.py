"""What the checks read of a robot, and which of them its user overrules by knowing better."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from identification.effects.plant.joint_plant import JointPlant
from identification.errors import unknown_name
from identification.logs.log import Log

TRUST = {  # what a user may know better than a check
    "contacts": "geoms that touch all along the log are meant to",
    "gaps": "what is made up across a gap counts as measured",
    "joints": "joints that no sensor measures and nothing holds begin where the model does",
    "limits": "joints were where the log says, also far outside the model's limits",
    "rows": "all rows are of this robot, also a few with one stamp, and those of zeros",
    "sensors": "a sensor that repeats one value is not frozen",
    "start": "simulations begin where the model does, also where the log begins elsewhere",
    "steps": "the model's steps are fine enough",
    "time": "the log's time is in seconds",
    "units": "the columns are in the units that the log says",
    "wiring": "the signs and the order of the columns are right",
}


class RobotFile(Protocol):
    """The part of a robot's file that the checks read; all of it is in
    `identification.robot.file.file`."""

    @property
    def path(self) -> Path:
        """Its TOML."""

    @property
    def model(self) -> Path:
        """The file of its model."""

    @property
    def free(self) -> tuple[str, ...]:
        """Names of its free parameters."""

    @property
    def records(self) -> Mapping[str, Mapping[str, Any]]:
        """Returns what the TOML says of parameters, by name."""

    @property
    def horizon(self) -> float | None:
        """Length of windows [s]; None for a free run."""

    @property
    def trust(self) -> tuple[str, ...]:
        """Words of `TRUST` that the user overrules."""

    @property
    def columns(self) -> Mapping[str, str]:
        """Columns of its logs, by actuator and sensor."""


class Robot(Protocol):
    """A robot whose logs are checked; `identification.robot.robot` has it all."""

    @property
    def file(self) -> RobotFile:
        """Its TOML."""

    @property
    def plant(self) -> JointPlant:
        """Its plant, as it begins in its first log."""

    def plant_of(self, log: Log) -> JointPlant:
        """Returns the plant as it begins in a log."""
        ...


def trusted(words: Sequence[Any], where: str, judged: Mapping[str, str] = TRUST) -> tuple[str, ...]:
    """Returns words of judgements that a user overrules, or refuses one that is unknown.

    `where` says where the words stand, for messages, such as "under trust in robot.toml".
    """
    for word in words:
        if str(word) not in judged:
            raise unknown_name(f"word {where}:", str(word), judged)
    return tuple(words)
