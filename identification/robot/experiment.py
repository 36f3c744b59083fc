"""The next experiment of a robot: what its logs leave unknown, and a motion that tells it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from identification.errors import InputError, refuse_kind, refuse_negative
from identification.experiment.design import design
from identification.experiment.hypotheses import Hypothesis, fitted
from identification.experiment.limits import limits_of
from identification.experiment.playing import stage_of
from identification.robot.reading import read_robot
from identification.robot.results.results import NextExperiment
from identification.robot.rivals import Model, read_rivals
from identification.robot.robot import Robot
from identification.runtime.pool import one_blas_thread
from identification.storage.results import RESULT, read_result
from identification.storage.written import Files

ROBOT = "robot.toml"  # in the folder of a result: the robot with what was found


@one_blas_thread()
def design_experiment(
    robot: Robot,
    result: str | Path | None = None,
    *,
    seconds: float | None = None,
    widen: float = 0.0,
    form: str = "auto",
    budget: int = 60,
    seed: int = 0,
    progress: Callable[[str], None] | None = None,
) -> NextExperiment:
    """Design the experiment that tells most of what the logs of a robot leave unknown.

    Where a discovery has ended with effects that it could not tell apart, the experiment separates
    them. Otherwise it tells the free values of the robot's file, the worst-known ones first.

    Args:
        robot: the result of `read_robot`; all of its logs count as known.
        result: the folder that a fit or a discovery of these logs has saved.
        seconds: how long the experiment lasts; as long as the first log when None.
        widen: share of itself by which the range of the logs is widened, on each side, where the
            model has no range.
        form: "inputs" plays inputs as they are, "reference" is a motion that a controller follows,
            "auto" takes what the robot needs.
        budget: experiments that the search evaluates.
        seed: of the search.
        progress: is told one line per step.

    Raises:
        InputError: an argument is wrong, the result is not of this robot, or no experiment that
            was tried keeps the limits.
        DivergenceError: the model cannot be simulated.
    """
    refuse_kind(robot, Robot, "design_experiment takes a robot (read_robot)")
    refuse_negative("seed", seed)
    robot = robot if result is None else with_result(robot, result)
    logs = (robot.log, *robot.others, *robot.records)
    rivals = () if result is None else read_rivals(robot, result)
    models: list[Hypothesis] = []
    for model in rivals or (Model("the model", 1.0, robot.nominal_model),):
        scale = models[0].scale if models else None
        models.append(fitted(model.name, model.share, model.nominal, logs, scale, progress))
    plant = models[0].plant
    plant = replace(plant, bare=replace(plant.bare, start=robot.plant.bare.start))
    limits = partial(limits_of, plant.model, plant.axes, logs, widen=widen)
    stage = stage_of(plant, robot.log, limits, seconds or robot.log.duration, form)
    return NextExperiment(robot, design(stage, models, budget, seed, progress), _files)


def with_result(robot: Robot, result: str | Path) -> Robot:
    """Returns a robot with what a fit or a discovery of its logs has found.

    Raises:
        InputError: the folder holds no robot of these logs.
    """
    read_result(result)
    folder = Path(result).parent if Path(result).name == RESULT else Path(result)
    if not (folder / ROBOT).is_file():
        raise InputError(
            f"{folder} has no {ROBOT}; give the folder that identification fit or discover has"
            " written with --out"
        )
    # These logs have passed the checks of wiring already, with the model as it was.
    return read_robot(
        folder / ROBOT,
        [robot.log, *robot.others],
        robot.records,
        trust=(*robot.file.trust, "wiring"),
    )


def _files(found: NextExperiment) -> Files:
    from identification.robot.results.experiment_files import ExperimentFiles  # what draws is slow

    return ExperimentFiles(found)
