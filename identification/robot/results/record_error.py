"""The errors of two models on an unseen record, and whether it proves anything.

Unseen data judge a model only where a replay of the fitted data (`identification.logs.joined`)
fails. A sine, or a motion that is repeated period by period, confirms a model that is wrong
elsewhere as well as a right one. So does a robot at rest (`identification.logs.rest`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from identification.discovery.effect_results import RecordError
from identification.logs.joined import REPLAYED, replayed_share
from identification.logs.log import Log
from identification.logs.rest import RESTING, is_at_rest, motion_share
from identification.quantities import alike
from identification.report.words.errors import error_words, kind, listed
from identification.report.words.rest import rest_sentences
from identification.robot.robot import Robot
from identification.shares import change, percent

AS_WRITTEN, FITTED = "with the values of the robot's file", "with those that were fitted"


@dataclass(frozen=True)
class Confirmation:
    """The errors of two models on one record.

    Attributes:
        log: name of the record.
        before: rms error of the first model, over all outputs.
        after: rms error of the second model.
        unit: of these two; empty where the outputs have several, or none.
        models: what the two models are, in words.
        before_by_unit: error of the first model by the outputs' units, each in it.
        after_by_unit: likewise of the second model.
    """

    log: str
    before: float
    after: float
    unit: str
    models: tuple[str, str]
    before_by_unit: Mapping[str, float] = field(default_factory=dict)
    after_by_unit: Mapping[str, float] = field(default_factory=dict)

    def __str__(self) -> str:
        first, second = self.models
        if len(self.before_by_unit) > 1:
            return f"On {self.log}: {self._by_unit()}."
        change = _change(self.before, self.after)
        before, after = alike([self.before, self.after], self.unit)
        return f"On {self.log}: {before} rms {first}, {after} {second}; mean square {change}."

    def _by_unit(self) -> str:
        """Returns the errors of outputs of several units in words."""
        first, second = self.models
        pairs = {u: (b, self.after_by_unit[u]) for u, b in self.before_by_unit.items()}
        before, after = error_words([self.before_by_unit, self.after_by_unit], digits=3)
        each = listed([f"{_change(*pair)} ({kind(u)})" for u, pair in pairs.items()])
        return f"{before} {first}, {after} {second}; mean square {each}"


def of_record(error: RecordError, unit: str, models: tuple[str, str]) -> Confirmation:
    """Returns the errors that a fit or a discovery over a horizon has found on a record."""
    e = error
    return Confirmation(e.name, e.before, e.after, unit, models, e.before_by_unit, e.after_by_unit)


def _change(before: float, after: float) -> str:
    """Returns the change of the mean square in words."""
    return change((after / before) ** 2 - 1 if before else 0.0)


@dataclass(frozen=True)
class Repetition:
    """A part of a log, or a record, that repeats what was fitted."""

    log: str  # name of the part or of the record
    share: float  # R, without unit

    def __str__(self) -> str:
        return (
            f"{self.log} repeats what was fitted: a replay of the fitted samples, without any"
            f" model, explains {percent(self.share)} of it, so it confirms less; confirm on"
            " another motion."
        )

    @property
    def finding(self) -> dict[str, str | float]:
        """The repetition as a finding of JSON."""
        return {"kind": "repeated motion", "log": self.log, "share": self.share}


@dataclass(frozen=True)
class Rest:
    """A part of a log, or a record, in which the robot hardly moves."""

    log: str  # name of the part or of the record
    share: float  # of the motion of what was fitted, without unit

    def __str__(self) -> str:
        return " ".join(rest_sentences([self.log]))

    @property
    def finding(self) -> dict[str, str | float]:
        """It as a finding of JSON."""
        return {"kind": "record at rest", "log": self.log, "share": self.share}


def find_repetitions(robot: Robot) -> tuple[Repetition, ...]:
    """Returns the confirming parts and records of a robot that repeat what is fitted.

    Those in which it hardly moves are left out: any rest in what was fitted replays them.
    """
    pieces, unseen = _fitted_and_unseen(robot)
    moving = (log for log in unseen if not is_at_rest(pieces, log))
    shares = ((log.name, replayed_share(pieces, log)) for log in moving)
    return tuple(Repetition(name, share) for name, share in shares if share > REPLAYED)


def find_rests(robot: Robot) -> tuple[Rest, ...]:
    """Returns the confirming parts and records of a robot in which it hardly moves."""
    pieces, unseen = _fitted_and_unseen(robot)
    shares = ((log.name, motion_share(pieces, log)) for log in unseen)
    return tuple(Rest(name, share) for name, share in shares if share < RESTING)


def _fitted_and_unseen(robot: Robot) -> tuple[list[Log], list[Log]]:
    fitted = [log.part("estimation") for log in (robot.log, *robot.others)]
    many = bool(robot.others) or robot.file.horizon is not None
    whole = many and bool(robot.records)  # then each log is fitted from end to end
    unseen = [] if whole else [log.part("validation") for log in (robot.log, *robot.others)]
    pieces = [robot.log, *robot.others] if whole else fitted
    return pieces, [*unseen, *robot.records]
