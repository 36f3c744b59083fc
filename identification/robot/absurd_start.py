"""A start so far from where the log begins that it is a slip of the pen.

    |given - begin| > 1000 max(|y|_max, 1)        in the unit of the state

A robot whose sensors count from elsewhere than its model may be some metres or turns apart from
where its log begins, but not a kilometre, and not a thousand times as far as it was ever measured.
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.plant import start_place
from identification.model.predictor import output_columns
from identification.robot.robot import Robot
from identification.robot.start import measured_begin
from identification.robot.start_words import given_apart

FAR = 1e3  # of the largest number of the log, or of one unit


def refuse_absurd_start(robot: Robot) -> None:
    """Refuse a start of a free run that is beyond all that the log measured."""
    file, model, log = robot.file, robot.plant.model, robot.log
    if file.horizon is not None or not file.start:
        return
    begins, sensors = measured_begin(model, log), output_columns(model, log.output_names)
    for path, said in given_apart(file, model, log).items():
        place = start_place(path, model)
        begin = begins[place]  # type: ignore[index]
        is_measured = place in sensors
        largest = _largest(log, begin.output, is_measured)
        if abs(file.start[path] - begin.value) > FAR * max(largest, 1.0):
            raise InputError(
                f"start in {file.path}: it gives {said}, more than {FAR:g} times as much as log"
                f" {log.name!r} ever shows; correct {path}, or delete it to begin where the log"
                " does"
            )


def _largest(log: Log, output: str, is_measured: bool) -> float:
    """Returns the largest number of an output, or of its rate where that is not measured."""
    y = log.outputs[:, log.output_names.index(output)]
    return float(np.abs(y if is_measured else np.diff(y) / log.sampling_time).max())
