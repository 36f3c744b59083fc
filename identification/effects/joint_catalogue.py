"""Candidate effects of the hinge and slide joints of a robot, gathered by subject."""

from __future__ import annotations

from collections.abc import Sequence

from identification.effects.axes import Axis, Kind
from identification.effects.curve_catalogue import curve_effects
from identification.effects.effect import Effect
from identification.effects.force_catalogue import force_effects
from identification.effects.friction_catalogue import friction_effects
from identification.effects.joint_group import Group
from identification.effects.state_catalogue import state_effects
from identification.effects.time_catalogue import time_effects

TURNS = (*map(float, range(1, 13)), 14.0, 16.0, 18.0, 20.0, 24.0, 28.0)  # harmonics of a turn


def joint_effects(axes: Sequence[Axis], turns: Sequence[float] = TURNS) -> tuple[Effect, ...]:
    """Returns all candidates of some joints.

    Hinges and slides have units of their own; where a robot has both, the names of the slides'
    effects begin with `slide_` (see `kinds`). Friction under load needs drives whose force is
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
        for kind, group in groups
        if group
        for effect in _listed(Group(kind, group, turns, both))
        if effect.places
    )


def _listed(g: Group) -> list[Effect]:
    listed = (friction_effects, force_effects, time_effects, curve_effects, state_effects)
    return [effect for make in listed for effect in make(g)]
