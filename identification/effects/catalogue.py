"""All candidate effects of a robot: of its joints, its bodies, its inputs and its sensors."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco

from identification.effects.axes import Axis, Kind
from identification.effects.bodies import body_effects
from identification.effects.curves import curve_effects
from identification.effects.effect import Effect
from identification.effects.forces import force_effects, time_effects
from identification.effects.friction import drag_effects, friction_effects
from identification.effects.inputs import drives, input_effects
from identification.effects.joint_group import Group
from identification.effects.sensors import sensor_effects
from identification.effects.state_effects import state_effects
from identification.logs.log import Log

TURNS = (*map(float, range(1, 13)), 14.0, 16.0, 18.0, 20.0, 24.0, 28.0)  # harmonics of a turn
_OF_JOINTS = (
    friction_effects, drag_effects, force_effects, time_effects, curve_effects, state_effects,
)  # fmt: skip


def all_effects(
    spec: mujoco.MjSpec, axes: Sequence[Axis], log: Log, turns: Sequence[float] = TURNS
) -> tuple[Effect, ...]:
    """Returns every candidate of a robot."""
    own = spec.copy().compile()
    return (
        *joint_effects(axes, turns),
        *body_effects(spec),
        *input_effects(drives(log)),
        *sensor_effects(own, log.output_names, axes),
    )


def joint_effects(axes: Sequence[Axis], turns: Sequence[float] = TURNS) -> tuple[Effect, ...]:
    """Returns all candidates of some joints.

    Hinges and slides have units of their own; where a robot has both, the names of the slides'
    effects begin with `slide_` (see `joint_group`). Friction under load needs drives whose force is
    gain·u + bias; what changes with time needs the duration of the records. Names of curves begin
    with `curve`.

    Args:
        axes: the joints.
        turns: periods in a turn of a hinge that are tried; a motor's are multiples of its poles
            and of its slots.
    """
    kinds: list[Kind] = ["hinge", "slide"]
    groups = [(kind, tuple(a for a in axes if a.kind == kind)) for kind in kinds]
    both = all(group for _, group in groups)
    return tuple(
        effect
        for kind, group in groups if group
        for make in _OF_JOINTS
        for effect in make(Group(kind, group, turns, both))
        if effect.places
    )  # fmt: skip
