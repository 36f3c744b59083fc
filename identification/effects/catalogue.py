"""All candidate effects of a robot: of its joints, its bodies, its inputs and its sensors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import pi

import mujoco

from identification.effects.axes import Axis
from identification.effects.effect import Effect, places
from identification.effects.laws.bodies import body_effects
from identification.effects.laws.curves import curve_effects
from identification.effects.laws.forces import force_effects, time_effects
from identification.effects.laws.friction import drag_effects, friction_effects
from identification.effects.laws.inputs import drives, input_effects
from identification.effects.laws.joint_group import groups
from identification.effects.laws.rotors import rotor_effects
from identification.effects.laws.sensors import sensor_effects
from identification.effects.laws.servos import rate_limits, servo_effects
from identification.effects.laws.state_effects import state_effects
from identification.logs.log import Log

TURNS = (*map(float, range(1, 13)), 14.0, 16.0, 18.0, 20.0, 24.0, 28.0)  # harmonics of a turn
_OF_JOINTS = (
    friction_effects, drag_effects, force_effects, time_effects, curve_effects, state_effects,
    servo_effects,
)  # fmt: skip


# Laws that grow with the angle itself. On a shaft that turns on and on an angle is no place: where
# the runs go one way, it is the time or the direction by another name.
OF_ANGLE = (
    "stiffness", "hardening", "position_dependent_friction", "position_dependent_damping",
    "curve_position",
)  # fmt: skip
MOST_TURNS = 3.0  # of a hinge in the records, for which these laws are candidates


def all_effects(
    spec: mujoco.MjSpec, axes: Sequence[Axis], log: Log, turns: Sequence[float] = TURNS,
    asked: Sequence[str] = (),
) -> tuple[Effect, ...]:  # fmt: skip
    """Returns every candidate of a robot.

    Args:
        spec: of the model.
        axes: the joints.
        log: with the inputs and the outputs.
        turns: periods in a turn of a hinge that are tried.
        asked: names of effects that act wherever they may, also on shafts that turn on and on, and
            on sensors of joints that hardly turn.
    """
    compiled = spec.copy().compile()
    return (
        *joint_effects(axes, turns, asked),
        *(e for g in groups(axes, turns) for e in rotor_effects(g, compiled.opt.timestep)),
        *body_effects(spec),
        *input_effects(drives(log)),
        *(e for g in groups(axes, turns) for e in rate_limits(g)),
        *sensor_effects(compiled, log.output_names, axes, asked),
    )


def joint_effects(
    axes: Sequence[Axis], turns: Sequence[float] = TURNS, asked: Sequence[str] = ()
) -> tuple[Effect, ...]:
    """Returns all candidates of some joints.

    Hinges and slides have units of their own; where a robot has both, the names of the slides'
    effects begin with `slide_` (see `joint_group`). Friction under load needs drives whose force is
    gain·u + bias; what changes with time needs the duration of the records. Names of curves begin
    with `curve`.

    Args:
        axes: the joints.
        turns: periods in a turn of a hinge that are tried; a motor's are multiples of its poles
            and of its slots.
        asked: names of effects that act wherever they may, also on shafts that turn on and on.
    """
    every = (
        effect if effect.name in asked else _without(effect, turning(group.axes))
        for group in groups(axes, turns)
        for make in _OF_JOINTS
        for effect in make(group)
    )  # fmt: skip
    return tuple(effect for effect in every if effect.places)


def turning(axes: Iterable[Axis]) -> tuple[Axis, ...]:
    """Returns the hinges that turn on and on in the records."""
    return tuple(a for a in axes if a.kind == "hinge" and a.travel > MOST_TURNS * 2 * pi)


def _without(effect: Effect, turns_on: Sequence[Axis]) -> Effect:
    """Returns an effect without places at shafts that turn on, if it grows with the angle."""
    if effect.name not in OF_ANGLE or not turns_on:
        return effect
    left_out = {f"@{a.joint}" for a in turns_on}
    named = [at[1:] for at in effect.places.values() if at and at not in left_out]
    alike = "" in effect.places.values()
    kept = places("joint", tuple(named))
    return replace(effect, places={w: at for w, at in kept.items() if at or alike})
