"""All candidate effects of a robot: of its joints, its bodies, its inputs and its sensors."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco

from identification.effects.axes import Axis
from identification.effects.body_catalogue import body_effects
from identification.effects.effect import Effect
from identification.effects.input_effects import drives, input_effects
from identification.effects.joint_catalogue import TURNS, joint_effects
from identification.effects.sensor_catalogue import sensor_effects
from identification.logs.log import Log


def all_effects(
    spec: mujoco.MjSpec, axes: Sequence[Axis], log: Log, turns: Sequence[float] = TURNS
) -> tuple[Effect, ...]:
    """Returns every candidate of a robot.

    Args:
        spec: of the robot, which is not changed.
        axes: its joints whose effects are sought.
        log: names its sensors, and its inputs say what is plausible of them.
        turns: see `joint_effects`.
    """
    own = spec.copy().compile()
    return (
        *joint_effects(axes, turns),
        *body_effects(spec),
        *input_effects(drives(log)),
        *sensor_effects(own, log.output_names, axes),
    )
