"""The free parameters of a robot, fitted to the first half of its log.

The fit minimises the error of a free run. If the robot's file gives a horizon, it minimises the
errors in windows of that length, each of which begins at a state of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from identification.errors import InputError, refuse_kind
from identification.estimation.estimation import estimate
from identification.estimation.fit import Fit, assess
from identification.robot.checks import refuse_horizon
from identification.robot.record_error import Confirmation, compare_unseen
from identification.robot.robot import Robot
from identification.windows.window_estimate import WindowEstimate, estimate_windows

FEWEST = 10  # measured values for each parameter


@dataclass(frozen=True)
class RobotFit:
    """The result of `fit`.

    Attributes:
        robot: the robot that was fitted.
        found: a fit of a free run, or an estimate over windows.
        unseen: the values of the robot's file compared with the fitted ones, on the part of the log
            that was not fitted; None for a fit of a free run, which contains this comparison.
    """

    robot: Robot
    found: Fit | WindowEstimate
    unseen: Confirmation | None = None

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by name, in their units."""
        return self.found.estimate.values if isinstance(self.found, Fit) else self.found.values

    @property
    def std(self) -> dict[str, float]:
        """Their std by name, in the same units; inf where the log does not determine them."""
        return dict(zip(self.values, self.found.std.tolist(), strict=True))


def fit(robot: Robot, progress: Callable[[str], None] | None = None) -> RobotFit:
    """Estimate the free parameters of a robot on the part `estimation` of its log, or on its half.

    Args:
        robot: the result of `read_robot`.
        progress: is told one line per accepted step.

    Raises:
        InputError: the log is too short, the horizon does not fit into it, or a free parameter has
            no effect.
        DivergenceError: the model cannot be simulated with the values at which the fit begins.
    """
    refuse_kind(robot, Robot, "fit takes a robot (read_robot)")
    file, log = robot.file, robot.log
    if robot.others:
        raise InputError(
            "fit takes one log; discover takes several, and gives the fitted values with them"
        )
    part = log.part("estimation")
    if part.outputs.size < FEWEST * len(file.free):
        raise InputError(
            f"the log has {part.outputs.size} values to fit {len(file.free)} parameters to; it"
            f" needs {FEWEST} for each: record longer, or free fewer parameters"
        )
    refuse_horizon(file, log)
    if file.horizon is None:
        estimated = estimate(robot.plant, part, file.free, progress=progress)
        return RobotFit(robot, assess(estimated, log))
    names = tuple(n for n in file.free if n not in robot.starts)
    found = estimate_windows(robot.plant, part, names, float(file.horizon), progress=progress)
    return RobotFit(robot, found, compare_unseen(robot, {}, found.values))
