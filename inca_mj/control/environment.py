"""The robot as a dm_control environment: eight currents in; angles, and what is asked, out.

    env = inca_mj.load_environment("track", random=0)

There are three tasks (`inca_mj.control.tasks`). `hold`: keep the platform where it starts, while a
hand pulls at it with a constant force that is not observed. `reach`: bring the platform to a
target. `track`: follow a circle. The module needs dm_control: pip install inca-mj[control]. To
draw without a display, set MUJOCO_GL=egl before MuJoCo is imported.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from dm_control.rl import control

from identification.errors import InputError, unknown_name
from inca_mj.control.controller import CONTROL_TIMESTEP
from inca_mj.control.tasks import TASKS, physics_of
from inca_mj.effects.values import present
from inca_mj.twin.twin import Twin, build_twin

TIME_LIMIT = 10.0  # of an episode [s]
OUTSIDE = ("input", "reading")  # hooks that act outside the law, before and after the steps


def load_environment(
    task: str = "hold",
    random: int | np.random.Generator | None = None,
    time_limit: float = TIME_LIMIT,
    environment_kwargs: Mapping[str, Any] | None = None,
    *,
    robot: Twin | None = None,
    privileged: bool = False,
    encoder_noise: float = 0.0,
) -> control.Environment:
    """Returns an environment with a robot, the law of its cables, and a task.

    Args:
        task: "hold", "reach" or "track".
        random: seed, or a generator to draw from.
        time_limit: of an episode [s].
        environment_kwargs: further arguments of `dm_control.rl.control.Environment`.
        robot: the twin that is driven, such as one with an effect; the nominal twin when None.
        privileged: whether position, orientation and tensions are observed, which the real robot
            cannot measure.
        encoder_noise: std of the noise of the motor angles [rad].

    Raises:
        InputError: there is no such task, the noise is negative, another library holds MuJoCo's
            callbacks, or the robot has an effect that acts outside its law (a delay, a lag, an
            error of an encoder), which an environment does not simulate.
    """
    if task not in TASKS:
        raise unknown_name("task", task, TASKS)
    if not (np.isfinite(encoder_noise) and encoder_noise >= 0):
        raise InputError(f"an encoder noise of {encoder_noise:g} rad; give 0 or more")
    robot = robot or build_twin()
    values = robot.parameters.values()
    for effect in robot.effects:
        if set(OUTSIDE) & effect.hooks.keys() and present(effect, values):
            raise InputError(
                f"{effect.name} acts outside the robot's law and is not simulated in an"
                " environment; leave it out, or use inca_mj.track, which simulates it"
            )
    settings = {"control_timestep": CONTROL_TIMESTEP, **(environment_kwargs or {})}
    drawn = TASKS[task](robot, random, privileged=privileged, encoder_noise=encoder_noise)
    return control.Environment(physics_of(robot), drawn, time_limit, **settings)
