"""Values of effects' parameters that a robot's TOML gives under `fixed`."""

from __future__ import annotations

from collections.abc import Sequence

from identification.effects.effect import Effect
from identification.effects.joint_plant import JointPlant
from identification.effects.named import damping_of, means_effect, unknown_number
from identification.errors import InputError, told_of
from identification.robot.file import RobotFile


def with_fixed(file: RobotFile, plant: JointPlant, effects: Sequence[Effect]) -> JointPlant:
    """Returns the plant with the values of effects' parameters that are not free."""
    with told_of(f"fixed in {file.path}"):
        for name in file.fixed:
            if name in plant.parameters.values():
                continue
            if (path := damping_of(name, effects)) is not None:
                raise InputError(
                    f"{name!r} is no number of an effect; it is {path} in {file.model}: write its"
                    f" value there, or name {path} under free"
                )
            if means_effect(name, effects):
                raise unknown_number(name, effects, is_free=False)
            raise InputError(
                f"{name!r} is no number of an effect; write its value into {file.model}, or name"
                " it under free"
            )
        return plant.with_values(file.fixed)
