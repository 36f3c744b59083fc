"""Compare models on records to which nothing was fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.discovery.result import Discovery, keep_of_robot
from identification.effects.plant.jointed import JointPlant
from identification.errors import InputError, refuse_kind
from identification.estimation.metrics import rms_by_unit
from identification.logs.log import Log
from identification.model.predictor import Plant, Predictor
from identification.model.rollout import State
from identification.prediction.fits.model import predict_fitted
from identification.prediction.fits.record_errors import record_errors
from identification.prediction.records_fit import RecordsFit
from identification.robot.results.record_error import AS_WRITTEN, FITTED, Confirmation, of_record
from identification.robot.results.results import RobotFit
from identification.robot.robot import Robot
from identification.windows.records import Record
from identification.windows.unseen import predict
from identification.windows.window_error import window_error

WITHOUT = "without what is named", "with it"


def confirm(robot: Robot, found: RobotFit | Discovery) -> tuple[Confirmation, ...]:
    """Compare two models on all that a robot was measured at and to which nothing was fitted.

    These are the records that confirm, or, where there are none, the unseen part of each log.

    For a fit the two models have the values of the robot's file and the fitted values. For a
    discovery they are the fitted model without the named effects and the one with them.

    Args:
        robot: the result of `read_robot`, with the records that confirm, if there are any.
        found: the result of `fit` or of `discover`.

    Returns:
        One comparison for each of them: the rms errors over the robot's horizon, or of a free run.

    Raises:
        InputError: windows of the robot's horizon do not fit a record, or a discovery over a
            horizon was made without it.
        DivergenceError: one of the models cannot be simulated.
    """
    refuse_kind(robot, Robot, "confirm takes a robot (read_robot)")
    refuse_kind(found, (RobotFit, Discovery), "confirm takes what fit or discover found")
    if isinstance(found, RobotFit):
        if found.found.horizon is not None:
            return _over_windows(robot, found, found.found)
        return _over_free_run(robot, found.values, found.begun)
    return _of_discovery(robot, found)


def compare_values(
    robot: Robot,
    log: Log,
    before: Mapping[str, float],
    after: Mapping[str, float],
    models: tuple[str, str] = (AS_WRITTEN, FITTED),
) -> Confirmation:
    """Compare two sets of values on a record, over the robot's horizon or in a free run."""
    return _compared(log, [_errors(robot, log, values) for values in (before, after)], models)


def _over_free_run(
    robot: Robot, values: Mapping[str, float], begun: State | None
) -> tuple[Confirmation, ...]:
    """Compares fitted values with those of the file on the records, or on the rest of the only log.

    On the only log, the fitted values go with the initial state that was estimated with them.
    """
    if not robot.records:
        log, part = robot.log, robot.log.part("validation")
        rows, given = np.isin(log.time, part.time), robot.values_of(log)
        errors = [
            _free_run(robot, log, {**known, **given}, start)[rows]
            for known, start in (({}, None), (values, begun))
        ]
        return (_compared(part, errors, (AS_WRITTEN, FITTED)),)
    kept = keep_of_robot(values, robot.plant.effects)
    return tuple(compare_values(robot, log, {}, kept) for log in robot.records)


def _over_windows(robot: Robot, fit: RobotFit, found: RecordsFit) -> tuple[Confirmation, ...]:
    """Returns the comparison that the fit has made already, or that of other records."""
    if not robot.records or [*map(id, robot.records)] == [*map(id, fit.robot.records)]:
        return fit.unseen
    model, plant = found.model, robot.plant
    records = [Record(log, "confirm", robot.values_of(log)) for log in robot.records]
    each = (
        predict(plant, records, found.horizon, model.scale, {}),
        predict_fitted(plant, records, found.horizon, model.scale, model.fit, {}),
    )
    return tuple(
        of_record(e, found.unit, (AS_WRITTEN, FITTED))
        for e in record_errors(records, model.scale, each, ([], []))
    )


def _of_discovery(robot: Robot, found: Discovery) -> tuple[Confirmation, ...]:
    """Returns what a discovery over a horizon has found on the robot's records."""
    errors = {e.name: e for e in found.errors if e.role == "confirm"}
    for log in robot.records:
        if log.name not in errors:
            raise InputError(
                f"the discovery did not see record {log.name!r}, known: {', '.join(errors)}; give"
                " it to read_robot as one that confirms, and discover again"
            )
    each = [errors[log.name] for log in robot.records] or [*errors.values()]
    return tuple(of_record(e, found.unit, WITHOUT) for e in each)


def _compared(log: Log, errors: Sequence[np.ndarray], models: tuple[str, str]) -> Confirmation:
    """Compares two models by their errors (…, ny)."""
    a, b = (float(np.sqrt(np.mean(e**2))) for e in errors)
    each = [rms_by_unit(e, log) for e in errors]
    return Confirmation(log.name, a, b, log.output_unit, models, *each)


def _errors(robot: Robot, log: Log, values: Mapping[str, float]) -> np.ndarray:
    horizon, here = robot.file.horizon, {**values, **robot.values_of(log), **robot.started(log)}
    if horizon is None:
        return _free_run(robot, log, here)
    return window_error(plant_with(robot, log, here), log, horizon, here)


def plant_with(
    robot: Robot, log: Log, values: Mapping[str, float], begun: State | None = None
) -> Plant:
    """Returns the plant of a record, with the states that the effects among some values need."""
    plant = robot.plant_of(log, begun)
    if not isinstance(plant, JointPlant):
        return plant
    return plant.with_states_of(n for n, v in values.items() if v != 0)


def _free_run(
    robot: Robot, log: Log, values: Mapping[str, float], begun: State | None = None
) -> np.ndarray:
    predictor = Predictor(plant_with(robot, log, values, begun), log, (), dict(values))
    return np.asarray(log.outputs - predictor.predict(np.empty((1, 0)))[0])
