"""The free parameters of a robot, fitted to one log or to several.

The fit of a free run minimises its error over the first half of one log, whose beginning is
estimated too (`identification.robot.beginning`). If the robot's file gives
a horizon, the fit minimises the errors in windows of that length, each of which begins at a state
of its own, over all logs; it is the fit of a discovery's nominal model
(`identification.prediction.records_fit`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification.errors import DivergenceError, InputError, refuse_kind
from identification.estimation.estimation import estimate
from identification.estimation.fit import Fit, assess
from identification.estimation.search import Options
from identification.logs.log import Log
from identification.prediction.records_fit import fit_records
from identification.robot.beginning import with_free_beginning
from identification.robot.blame import told_of_factors
from identification.robot.file.checks import refuse_horizon
from identification.robot.file.file import refuse_nothing_free
from identification.robot.results.results import RobotFit
from identification.robot.robot import Robot
from identification.storage.written import Files

FEWEST = 10  # measured values for each parameter


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
    refuse_nothing_free(file)
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
        return RobotFit(robot, _free_run(robot, parts[0], names, progress), _files)
    for log in (*logs, *robot.records):
        refuse_horizon(file, log, is_whole)
    with told_of_factors(robot):
        return RobotFit(robot, fit_records(model, logs, robot.records, progress), _files)


def _free_run(
    robot: Robot, part: Log, names: Sequence[str], progress: Callable[[str], None] | None
) -> Fit:
    """Returns the fit of a free run and its beginning, or from where the log shows it to begin.

    The latter where the former ends at values beside which the model cannot be simulated: a log
    that contradicts the model may take a value anywhere.
    """
    plant, begun = with_free_beginning(robot)
    if begun:
        try:
            options = Options(priors=begun)
            every = [*names, *begun]
            found = estimate(plant, part, every, options=options, progress=progress)
            return assess(found, robot.log, len(names))
        except DivergenceError:
            pass
    found = estimate(robot.nominal_model.plant, part, names, progress=progress)
    return assess(found, robot.log)


def _files(fitted: RobotFit) -> Files:
    from identification.robot.results.fit_files import RobotFitFiles  # what draws is slow to import

    return RobotFitFiles(fitted)
