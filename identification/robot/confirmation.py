"""Compare models on records to which nothing was fitted."""

from __future__ import annotations

from identification.discovery.final_values import collect_final_values
from identification.discovery.result import Discovery
from identification.errors import refuse_kind
from identification.prediction.result import RecordsDiscovery
from identification.robot.fitting import RobotFit
from identification.robot.record_error import Confirmation, compare_values
from identification.robot.robot import Robot

WITHOUT = "without what is named", "with it"


def confirm(
    robot: Robot, found: RobotFit | Discovery | RecordsDiscovery
) -> tuple[Confirmation, ...]:
    """Compare two models on every record of a robot to which nothing was fitted.

    For a fit the two models have the values of the robot's file and the fitted values. For a
    discovery that names something they are the fitted model without the named effects and the one
    with them. For any other discovery they have the values of the file and the fitted values.

    Args:
        robot: the result of `read_robot`, with the records.
        found: the result of `fit` or of `discover`.

    Returns:
        One comparison for each record: the rms errors over the robot's horizon, or of a free run.

    Raises:
        InputError: windows of the robot's horizon do not fit a record.
        DivergenceError: one of the models cannot be simulated.
    """
    refuse_kind(robot, Robot, "confirm takes a robot (read_robot)")
    kinds = (RobotFit, Discovery, RecordsDiscovery)
    refuse_kind(found, kinds, "confirm takes what fit or discover found")
    if isinstance(found, RecordsDiscovery):
        return _of_records(robot, found)
    if isinstance(found, RobotFit):
        return tuple(compare_values(robot, log, {}, found.values) for log in robot.records)
    after = collect_final_values(found)
    if not found.named:
        return tuple(compare_values(robot, log, {}, after) for log in robot.records)
    before = found.nominal.point.values
    return tuple(compare_values(robot, log, before, after, WITHOUT) for log in robot.records)


def _of_records(robot: Robot, found: RecordsDiscovery) -> tuple[Confirmation, ...]:
    """The comparison that a discovery on records has made already, where it names something."""
    if not found.named:
        values = found.final.values
        return tuple(compare_values(robot, log, {}, values) for log in robot.records)
    return tuple(
        Confirmation(e.name, e.before, e.after, found.unit, WITHOUT)
        for e in found.errors
        if e.role == "confirm"
    )
