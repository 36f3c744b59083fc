"""The errors of two models of a robot on a record, both over the same horizon."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from identification.discovery.effect_results import RecordError
from identification.effects.jointed import JointPlant
from identification.logs.by_unit import rms_by_unit
from identification.logs.log import Log
from identification.model.predictor import Plant, Predictor
from identification.quantities import alike
from identification.report.error_words import error_words, kind, listed
from identification.robot.robot import Robot
from identification.windows.window_error import window_error

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


def compare_values(
    robot: Robot,
    log: Log,
    before: Mapping[str, float],
    after: Mapping[str, float],
    models: tuple[str, str] = (AS_WRITTEN, FITTED),
) -> Confirmation:
    """Compare two sets of values on a record, over the robot's horizon or in a free run."""
    return _compared(log, [_errors(robot, log, values) for values in (before, after)], models)


def compare_unseen(
    robot: Robot,
    before: Mapping[str, float],
    after: Mapping[str, float],
    models: tuple[str, str] = (AS_WRITTEN, FITTED),
) -> Confirmation:
    """Compare two sets of values on the unseen part of the robot's log, in a free run of all."""
    log = robot.log
    part = log.part("validation")
    rows, own = np.isin(log.time, part.time), robot.values_of(log)
    errors = [_free_run(robot, log, {**v, **own})[rows] for v in (before, after)]
    return _compared(part, errors, models)


def _compared(log: Log, errors: Sequence[np.ndarray], models: tuple[str, str]) -> Confirmation:
    """Compares two models by their errors (…, ny)."""
    a, b = (float(np.sqrt(np.mean(e**2))) for e in errors)
    each = [rms_by_unit(e, log) for e in errors]
    return Confirmation(log.name, a, b, log.output_unit, models, *each)


def _change(before: float, after: float) -> str:
    """Returns the change of the mean square in words."""
    return f"{100 * ((after / before) ** 2 - 1) if before else 0.0:+z.0f} %"


def _errors(robot: Robot, log: Log, values: Mapping[str, float]) -> np.ndarray:
    horizon, here = robot.file.horizon, {**values, **robot.values_of(log), **robot.started(log)}
    if horizon is None:
        return _free_run(robot, log, here)
    return window_error(_plant(robot, log, here), log, horizon, here)


def _plant(robot: Robot, log: Log, values: Mapping[str, float]) -> Plant:
    """Returns the plant of a record, with the states that the effects among some values need."""
    plant = robot.plant_of(log)
    if not isinstance(plant, JointPlant):
        return plant
    return plant.with_states_of(n for n, v in values.items() if v != 0)


def _free_run(robot: Robot, log: Log, values: Mapping[str, float]) -> np.ndarray:
    predictor = Predictor(_plant(robot, log, values), log, (), dict(values))
    return np.asarray(log.outputs - predictor.predict(np.empty((1, 0)))[0])
