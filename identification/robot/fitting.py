"""The free parameters of a robot, fitted to one log or to several.

The fit of a free run minimises its error over the first half of one log. If the robot's file gives
a horizon, the fit minimises the errors in windows of that length, each of which begins at a state
of its own, over all logs; it is the fit of a discovery's nominal model
(`identification.prediction.records_fit`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from identification.errors import InputError, refuse_kind
from identification.estimation.estimation import estimate
from identification.estimation.fit import Fit, assess
from identification.prediction.records_fit import RecordsFit, fit_records
from identification.quantities import quantity
from identification.robot.blame import told_of_factors
from identification.robot.checks import refuse_horizon
from identification.robot.record_error import AS_WRITTEN, FITTED, Confirmation, of_record
from identification.robot.robot import Robot

FEWEST = 10  # measured values for each parameter


@dataclass(frozen=True)
class RobotFit:
    """The result of `fit`.

    Attributes:
        robot: the robot that was fitted.
        found: a fit of a free run, or of windows of one or several records.
    """

    robot: Robot
    found: Fit | RecordsFit

    def __repr__(self) -> str:
        parameters = self.robot.plant.parameters
        units = {n: parameters[n.partition(" [")[0]].unit for n in self.values}
        return ", ".join(
            f"{n} = {quantity(v, self.std[n], units[n])}" + ", on its bound" * self.at_bound[n]
            for n, v in self.values.items()
        )

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by name, in their units; a record's own ones are `name [record]`."""
        return self.found.values

    @property
    def shared(self) -> dict[str, float]:
        """The fitted values that hold for all records."""
        return self.found.shared

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """The values that each record has for itself, by record and by name, in their units."""
        return self.found.own_values

    @property
    def std(self) -> dict[str, float]:
        """Std of the values by name, in their units; inf where a free run does not tell them."""
        return dict(zip(self.values, self.found.std.tolist(), strict=True))

    @property
    def start(self) -> dict[str, float]:
        """The values with which the fit began, by name, in their units."""
        return dict(zip(self.values, map(float, self.found.start), strict=True))

    @property
    def at_bound(self) -> dict[str, bool]:
        """True where a value lies on a bound, by name."""
        return dict(zip(self.values, map(bool, self.found.at_bound), strict=True))

    @property
    def converged(self) -> bool:
        """Returns whether the search ended by itself."""
        return self.found.converged

    @property
    def stopped(self) -> bool:
        """Returns whether the user stopped the search of a free run; its best values are kept."""
        return self.found.stopped

    @property
    def is_worse(self) -> bool:
        """Returns whether it predicts unseen records worse than the values with which it began.

        Such values are not to be used. Only a fit over a horizon is compared in this way.
        """
        return self.found.worse is not None

    @property
    def unseen(self) -> tuple[Confirmation, ...]:
        """The values of the robot's file and the fitted ones on what the fit has not seen.

        One comparison for each record over the horizon; none for a free run, whose `found` has the
        error on the part that was not fitted.
        """
        if self.found.horizon is None:
            return ()
        return tuple(
            of_record(e, self.found.unit, (AS_WRITTEN, FITTED))
            for e in self.found.errors
            if e.role == "confirm"
        )


def fit(robot: Robot, progress: Callable[[str], None] | None = None) -> RobotFit:
    """Estimate the free parameters of a robot from its logs.

    Without a horizon in the robot's file, a free run of the part `estimation` of its only log (or
    of its first half) is fitted. With one, the windows of all logs are; where no records confirm,
    those of the same part of each log, and the rest of it confirms.

    Args:
        robot: the result of `read_robot`.
        progress: is told one line per accepted step.

    Raises:
        InputError: there are several logs and no horizon, a log is too short, the horizon does not
            fit into it, or a free parameter has no effect.
        DivergenceError: the model cannot be simulated with the values at which the fit begins.
    """
    refuse_kind(robot, Robot, "fit takes a robot (read_robot)")
    file, logs = robot.file, (robot.log, *robot.others)
    is_whole = file.horizon is not None and bool(robot.records)
    if file.horizon is None and robot.others:
        raise InputError(
            f"{len(logs)} logs are fitted together over a horizon, and none is given; write"
            f" horizon = 0.2 (in seconds) into {file.path}"
        )
    parts = logs if is_whole else [log.part("estimation") for log in logs]
    count = sum(part.outputs.size for part in parts)
    if count < FEWEST * len(file.free):
        raise InputError(
            f"the log has {count} values to fit {len(file.free)} parameters to; it needs {FEWEST}"
            " for each: record longer, or free fewer parameters"
        )
    model = robot.nominal_model
    if file.horizon is None:
        # A free run is fitted without priors: a common value cannot be told from its deviations.
        common = {a.name for a in file.spread if a.deviates}
        names = [name for name in file.free if name not in common]
        estimated = estimate(model.plant, parts[0], names, progress=progress)
        return RobotFit(robot, assess(estimated, robot.log))
    for log in (*logs, *robot.records):
        refuse_horizon(file, log, is_whole)
    with told_of_factors(robot):
        return RobotFit(robot, fit_records(model, logs, robot.records, progress))
