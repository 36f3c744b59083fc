"""Read a user's robot from its files, and check it against its logs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from identification.effects.axes import axes
from identification.logs.log import Log
from identification.robot.file import RobotFile, read_robot_file
from identification.robot.robot import Robot, read_robot_log, robot_of
from identification.robot.step_error import refuse_coarse_steps
from identification.robot.wiring import refuse_miswired


def read_robot(
    path: str | Path,
    log: str | Path | Log | Sequence[str | Path | Log],
    confirm: Sequence[str | Path | Log] = (),
) -> Robot:
    """Read a robot and the logs that it is to explain; refuse files that do not belong together.

    Args:
        path: path of its TOML, which names the model (`identification.robot.file` lists every key).
        log: what was measured: a CSV (with a TOML beside it), a MATLAB file with u, y and Ts, or a
            `Log` whose columns bear the names of the model's actuators and sensors. Several of
            them are fitted together.
        confirm: records of the same robot to which nothing will be fitted.

    Raises:
        InputError: a file cannot be what it should be, a name is unknown, a sensor froze, the
            model's steps are too coarse for the log's noise, or another unit, sign or order of a
            log's columns would explain it far better.
        DivergenceError: the model cannot be simulated.
    """
    file = read_robot_file(path)
    records = tuple(_log(file, record) for record in confirm)
    first, *others = (
        _log(file, each) for each in ([log] if isinstance(log, str | Path | Log) else log)
    )
    robot = replace(robot_of(file, first, others), records=records)
    refuse_coarse_steps(robot)
    for record in records:
        axes(robot.plant.model, record)  # a sensor that froze is refused
    for measured in (robot.log, *robot.others, *records):
        refuse_miswired(robot, measured)
    return robot


def _log(file: RobotFile, log: str | Path | Log) -> Log:
    return log if isinstance(log, Log) else read_robot_log(file, log)
