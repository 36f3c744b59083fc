"""The robot of a TOML file as operating points, at rest or along a log, for its linear model.

Without a log the model is the MJCF with the values that the TOML gives; effects need a log, from
which they take how far and how fast their joints go.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.linear.linearization import input_names
from identification.linear.operating_points import OperatingPoints, along_log, at_rest
from identification.logs.log import Log
from identification.model.parameter import Parameter, ParameterSet
from identification.model.plant import ModelPlant, own_start
from identification.model.predictor import Predictor
from identification.model.protocol import with_numbers
from identification.model.rollout import State
from identification.robot.file.file import RobotFile, read_robot_file
from identification.robot.file.model_file import robot_spec
from identification.robot.file.start import start_of
from identification.robot.reading import read_robot


def operating_points(
    path: str | Path,
    log: str | Path | Log | None = None,
    times: Sequence[float] = (),
    inputs: Mapping[str, float] | None = None,
    trust: Sequence[str] = (),
) -> tuple[OperatingPoints, tuple[str, ...]]:
    """Returns operating points of a robot, and the names of its outputs.

    Args:
        path: of the robot's TOML.
        log: of the robot; with times, they are points along its free run.
        times: of the log [s]; without any, the point is the rest nearest to the start.
        inputs: that act at rest, by actuator, in the units of the model's controls; zero where not
            given.
        trust: judgements that are not to refuse the log, as for `read_robot`.

    Returns:
        The points, and names of sensors, none for all of the model's.

    Raises:
        InputError: a file cannot be what it should be, a name or a time is unknown, times come
            without a log or with inputs, an effect comes without a log, or there is no rest.
        DivergenceError: the simulation left the finite numbers.
    """
    if times and log is None:
        raise InputError("a time is a time of a log, and none is given; write LOG behind the robot")
    if times and inputs:
        raise InputError("along a log its own inputs act; give either times or inputs")
    if log is None:
        file = read_robot_file(Path(path))
        plant = _bare(file)
        names, model, start = file.outputs, plant.model, plant.start or own_start(plant.model)
        return at_rest(model, start, _held(model, inputs or {})), names
    robot = read_robot(path, log, trust=trust)
    predictor = Predictor(robot.plant_of(robot.log), robot.log, ())
    names = robot.log.output_names
    if times:
        return along_log(predictor, times), names
    none = np.empty((1, 0))
    known, numbers = predictor.settings(none)
    first = predictor.begun(none, known)
    model = with_numbers(predictor.plant.model, numbers, 0)
    start = State(*(np.atleast_2d(getattr(first, f))[0] for f in ("qpos", "qvel", "act")))
    return at_rest(model, start, _held(model, inputs or {})), names


def _held(model: mujoco.MjModel, inputs: Mapping[str, float]) -> np.ndarray:
    """Returns inputs by actuator as the model's controls, shape (nu,)."""
    known = input_names(model)
    for name in inputs:
        if name not in known:
            raise unknown_name("actuator", name, known)
    return np.array([inputs.get(name, 0.0) for name in known], float)


def _bare(file: RobotFile) -> ModelPlant:
    """Returns the model of a file with the values of its parameters, without effects."""
    model = robot_spec(file)[0].compile()
    given = []
    for name in (n for n in file.by_itself if "value" in file.records.get(n, {})):
        record = file.records[name]
        given.append(
            Parameter(name=name, value=float(record["value"]), unit=str(record.get("unit", "")),
                      where=str(record.get("path", name)))
        )  # fmt: skip
    effects = [p.name for p in given if "@" in p.where] + [*file.fixed]
    if effects:
        raise InputError(
            f"{file.path} gives {effects[0]}, a number of an effect, which needs a log; write LOG"
            " behind the robot"
        )
    start = start_of(file, model, None)
    return ModelPlant(model, ParameterSet(file.path.stem, tuple(given)), start)
