"""A free swing or a drop test: no input moves, so that it does not tell every parameter.

    M(q) q̈ + h(q, q̇) = B u,   u = 0        what acts through B u alone, such as a gear, is not felt

Nothing sets how large forces are, too: where masses, inertias, frictions and stiffnesses grow
together, the motion stays as it is. Which parameters are not felt is computed from sensitivities.
Those that an input would show are held at their values, and the rest is fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import sensitivity, without_effect
from identification.robot.robot import Robot, robot_of

FEW = 100  # samples under inputs that show what inputs would tell; one step of them would do


def without_untold(robot: Robot) -> Robot:
    """Returns the robot without those free parameters that its free swing does not tell.

    A robot with an input that moves in one of the logs that are fitted is returned as it is. So is
    one with a parameter that no input would show either: it is refused where it is fitted.
    """
    logs = (robot.log, *robot.others)
    if any(log.inputs.any() for log in logs):
        return robot
    idle = set.intersection(*(_idle(robot, log) for log in logs))
    untold = idle - _idle(robot, _driven(robot.log)) if idle else set()
    file = robot.file
    untold &= set(file.by_itself)
    if not untold:
        return robot
    names = [n for n in file.free if n in untold]
    which = f"no input moves in {listed(repr(log.name) for log in logs)}, and a free swing"
    if len(names) == len(file.free):
        raise InputError(
            f"{which} does not tell {listed(names)}; free what it tells, such as the damping of a"
            f" joint, in {file.path}, or take a log with inputs that are not all zero"
        )
    told = replace(
        file,
        free=tuple(n for n in file.free if n not in untold),
        own=tuple(n for n in file.own if n not in untold),
        records={n: record for n, record in file.records.items() if n not in untold},
    )
    fitted = robot_of(told, robot.log, robot.others, robot.records)
    it, keeps = ("it", "keeps its value") if len(names) == 1 else ("they", "keep their values")
    remark = f"{which[0].upper()}{which[1:]} does not tell {listed(names)}: {it} {keeps}."
    return replace(fitted, remarks=(*fitted.remarks, remark))


def _idle(robot: Robot, log: Log) -> set[str]:
    """Returns free parameters that no output of a log feels; none where it cannot be simulated."""
    names, plant = robot.file.free, robot.plant_of(log)
    values = plant.parameters.values()
    first = np.array([values[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    try:
        J = sensitivity(Predictor(plant, log, names), space, space.encode(first))
    except (DivergenceError, InputError):  # whoever fits it says why
        return set()
    found: Sequence[bool] = without_effect(J, log.outputs).tolist()
    return {name for name, idle in zip(names, found, strict=True) if idle}


def _driven(log: Log) -> Log:
    """Returns the first samples of a log, with inputs of one throughout."""
    rows = slice(0, FEW)
    inputs = np.ones_like(log.inputs[rows])
    return replace(log, time=log.time[rows], inputs=inputs, outputs=log.outputs[rows],
                   extras={}, splits={})  # fmt: skip
