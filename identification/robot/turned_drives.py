"""Do all drives of a robot act against the sign that its model gives them?

Gravity and friction may have either sign, so that the balance of forces allows both. But inertias
would be negative (`identification.torques.turned`).
"""

from __future__ import annotations

import copy
from collections.abc import Sequence

import mujoco

from identification.effects.plant.jointed import JointPlant
from identification.logs.log import Log
from identification.quantities import quantity
from identification.refusals.columns import Doubt
from identification.robot.robot import Robot
from identification.torques.equations.base import BaseParameters, find_base
from identification.torques.equations.equations import Equations, Estimate
from identification.torques.equations.others import Others
from identification.torques.equations.rows import make_rows
from identification.torques.passive import fit_base
from identification.torques.turned import find_turned


def turned_drives(robot: Robot) -> str:
    """Returns in words that all drives have the other sign than the model gives them, or "".

    Args:
        robot: the result of `read_robot`.

    Raises:
        InputError: torques say nothing of such a robot or log (`fit_torques`).
    """
    logs = (robot.log, *robot.others, *robot.records)
    model, own = bare_models(robot, logs)
    measured, base = Equations.of(make_rows(model, logs, own)), find_base(model)
    fitted = fit_base(model, measured, base, Others.of((), measured, logs))[1]
    return turned_words(robot, base, fitted.fit)


def turned_words(robot: Robot, base: BaseParameters, fit: Estimate) -> str:
    """Returns in words that a fit wants the inertia of the model with the other sign, or "".

    Args:
        robot: whose logs are fitted.
        base: r combinations of its inertial numbers.
        fit: begins with these.
    """
    r = len(base.names)
    k = find_turned(base, fit.θ[:r], fit.std[:r])
    if k is None:
        return ""
    unit, log = base.units[k], robot.log
    doubt = Doubt.of(log, {n: robot.file.columns.get(n, n) for n in log.input_names})
    return (
        f"the drives' forces of log {log.name!r} have the other sign than those of"
        f" {robot.file.model}: with them {base.names[k]} is"
        f" {quantity(fit.θ[k], fit.std[k], unit=unit)} where the model has"
        f" {quantity(base.values[k], unit=unit)}, and no inertia is negative;"
        f' {doubt.how_to_turn(doubt.inputs)}, or write trust = ["wiring"] into {robot.file.path}'
    )


def bare_models(robot: Robot, logs: Sequence[Log]) -> tuple[mujoco.MjModel, list[mujoco.MjModel]]:
    """Returns the model of a robot, and that of each log, whose joints have no effects."""
    model = _without_effects(robot.plant)
    return model, [_without_effects(robot.plant_of(log)) if log.values else model for log in logs]


def _without_effects(plant: JointPlant) -> mujoco.MjModel:
    """Returns the model of a plant whose joints have no effects."""
    return plain(plant.without_states().model)


def plain(model: mujoco.MjModel) -> mujoco.MjModel:
    """Returns a model whose joints have no effects: without their mark, the law leaves them."""
    out = copy.copy(model)
    if out.nuser_jnt:
        out.jnt_user[:, -1] = 0.0
    return out
