"""The errors of two models of a robot on a record, both over the same horizon."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from identification.effects.jointed import JointPlant
from identification.logs.log import Log
from identification.model.predictor import Plant, Predictor
from identification.quantities import alike
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
        unit: unit of the errors; empty where the outputs have several.
        models: what the two models are, in words.
    """

    log: str
    before: float
    after: float
    unit: str
    models: tuple[str, str]

    def __str__(self) -> str:
        change = 100 * ((self.after / self.before) ** 2 - 1) if self.before else 0.0
        before, after = alike([self.before, self.after], self.unit)
        first, second = self.models
        return (
            f"On {self.log}: {before} rms {first}, {after} {second}; mean square {change:+z.0f} %."
        )


def compare_values(
    robot: Robot,
    log: Log,
    before: Mapping[str, float],
    after: Mapping[str, float],
    models: tuple[str, str] = (AS_WRITTEN, FITTED),
) -> Confirmation:
    """Compare two sets of values on a record, over the robot's horizon or in a free run.

    Args:
        robot: the robot, with its plant and its horizon.
        log: the record; free parameters of the start get its first measured values.
        before: values of the first model that are not the plant's own.
        after: values of the second model that are not the plant's own.
        models: what the two models are, in words.

    Raises:
        InputError: the windows do not fit the record.
        DivergenceError: one of the models cannot be simulated.
    """
    a, b = (_rms(robot, log, values) for values in (before, after))
    return Confirmation(log.name, a, b, log.output_unit, models)


def compare_unseen(
    robot: Robot,
    before: Mapping[str, float],
    after: Mapping[str, float],
    models: tuple[str, str] = (AS_WRITTEN, FITTED),
) -> Confirmation:
    """Compare two sets of values on the unseen part of the robot's own log, in a free run of all.

    Args:
        robot: the robot, without a horizon.
        before: values of the first model that are not the plant's own.
        after: values of the second model that are not the plant's own.
        models: what the two models are, in words.

    Raises:
        DivergenceError: one of the models cannot be simulated.
    """
    log = robot.log
    part = log.part("validation")
    rows, own = np.isin(log.time, part.time), robot.values_of(log)
    a, b = (
        float(np.sqrt(np.mean(_free_run(robot, log, {**v, **own})[rows] ** 2)))
        for v in (before, after)
    )
    return Confirmation(part.name, a, b, part.output_unit, models)


def _rms(robot: Robot, log: Log, values: Mapping[str, float]) -> float:
    horizon, here = robot.file.horizon, {**values, **robot.values_of(log), **robot.started(log)}
    if horizon is None:
        error = _free_run(robot, log, here)
    else:
        error = window_error(_plant(robot, log, here), log, horizon, here)
    return float(np.sqrt(np.mean(error**2)))


def _plant(robot: Robot, log: Log, values: Mapping[str, float]) -> Plant:
    """The plant of a record, with the states that the effects among some values need."""
    plant = robot.plant_of(log)
    if not isinstance(plant, JointPlant):
        return plant
    return plant.with_states_of(n for n, v in values.items() if v != 0)


def _free_run(robot: Robot, log: Log, values: Mapping[str, float]) -> np.ndarray:
    predictor = Predictor(_plant(robot, log, values), log, (), dict(values))
    return np.asarray(log.outputs - predictor.predict(np.empty((1, 0)))[0])
