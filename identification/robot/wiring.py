"""Is a log wired as its robot's model is? The windows in which that is judged.

ε of `identification.logs.readings`, summed over windows that each begin in the state that the log
measured first.
"""

from __future__ import annotations

from functools import partial
from itertools import chain

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.log import Log
from identification.logs.readings import (
    UNEXPLAINED,
    input_readings,
    misread,
    output_readings,
    unexplained_share,
    unit_readings,
)
from identification.logs.sampling import MIN_ROWS
from identification.robot.robot import Robot
from identification.windows.window_error import first_error
from identification.windows.windows import windows

READINGS = (unit_readings, output_readings, input_readings)
LENGTHS = (0.1, 1.0)  # of windows, shares of a log, where the robot has no horizon of its own


def refuse_miswired(robot: Robot, log: Log) -> None:
    """Refuse a log that other units, signs or places of its columns would explain far better.

    Args:
        robot: with the values that its file gives.
        log: of the robot.

    Raises:
        InputError: there is such a reading.
    """
    file = robot.file
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    lengths = [s * log.duration for s in LENGTHS] if file.horizon is None else [file.horizon]
    for length in lengths:
        own = _unexplained(robot, length, log)
        if own is None or not (own > UNEXPLAINED).any():
            continue
        bad = own > UNEXPLAINED
        readings = chain(*(r(log, bad, column) for r in READINGS))
        said = misread(log, own, readings, partial(_unexplained, robot, length))
        if said is not None:
            raise InputError(
                f"log {log.name!r}: the model of {file.model} {said}, or give values nearer to the"
                f" robot's in {file.path}"
            )


def _unexplained(robot: Robot, length: float, log: Log) -> np.ndarray | None:
    """ε of each output, shape (ny,); None where nothing can be simulated so."""
    if not MIN_ROWS * log.sampling_time <= length <= log.duration:
        return None  # too short to tell, and whoever fits it will say so
    try:
        error = first_error(robot.plant, log, length)
    except DivergenceError:
        return None
    return unexplained_share(windows(log, length).outputs, error)
