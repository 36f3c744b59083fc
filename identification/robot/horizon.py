"""The horizon of a search: that of the robot's file, or a part of a swing where it gives none.

A force that is missing moves a robot from where it is; what it has made after many swings depends
on all that it did before, and on where the log began. So a search compares predictions over windows
(`identification.windows`), each of which begins where the robot was.
"""

from __future__ import annotations

from dataclasses import replace

from identification.logs.swing import part_of_swing
from identification.robot.file.start import unused_sentence
from identification.robot.robot import Robot


def with_horizon(robot: Robot) -> Robot:
    """Returns the robot with a horizon, and with a remark where its file gives none.

    Args:
        robot: that is to be searched.
    """
    if robot.file.horizon is not None:
        return robot
    seconds = part_of_swing(robot.log.outputs, robot.log.sampling_time)
    file = replace(robot.file, horizon=seconds)
    told = (
        f"{file.path} gives no horizon: what is missing is sought by predictions over"
        f" {seconds:g} s, a part of a swing. To judge over another time, write it into that file,"
        f" such as horizon = {seconds!r} (in seconds)."
    )
    unused = unused_sentence(file, robot.plant.model, robot.log)
    return replace(robot, file=file, remarks=(*robot.remarks, told, *filter(None, [unused])))
