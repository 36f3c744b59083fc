"""A parameter of a drive that does not stay what it was. At most one of a drive changes.

    p (1 − α t), or p (1 − α ∫ i² dt) with heat      drift, of all drives or of one
    p (1 + δ) from t_s on                            jump, of one drive

Where t_s is the time of a sample, a step of the integrator ends there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from identification.errors import InputError
from inca_mj.reference import layout as base
from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
    kind,
    shape,
    size,
)


def _take(effect: HiddenDriveEffect, numbers: HiddenNumbers, parameter: int) -> None:
    """Note which parameter changes.

    Raises:
        InputError: another change of the drive has been noted before.
    """
    changed = effect.column(numbers, at.CHANGED)
    if changed.any():
        raise InputError(f"{effect.name}: another parameter of {effect.where} changes already")
    changed[:] = parameter + 1


@dataclass(frozen=True, kw_only=True)
class HiddenDrift(HiddenDriveEffect):
    """p (1 − α t), α [1/s]; where `heat` is True p (1 − α ∫ i² dt), α [1/(A^2 s)]."""

    parameter: ClassVar[int]
    alpha: float = size(2e-3)
    heat: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write α where the shape reads it."""
        _take(self, numbers, self.parameter)
        self.column(numbers, at.CHANGE_HEAT if self.heat else at.CHANGE_RATE)[:] = self.alpha


@dataclass(frozen=True, kw_only=True)
class HiddenJump(HiddenOneDriveEffect):
    """p (1 + δ) from t_s [s] on."""

    parameter: ClassVar[int]
    delta: float = size(0.05, at.JUMP)
    t_s: float = shape(0.5, at.JUMP_TIME, positive=False)

    def put(self, numbers: HiddenNumbers) -> None:
        """Write δ and t_s."""
        _take(self, numbers, self.parameter)
        super().put(numbers)


KINDS = (
    # grease gets warm: half of it in 20 s [1/s]
    kind("friction_drift", HiddenDrift, 0.025, parameter=base.B_C),
    kind("viscous_friction_drift", HiddenDrift, 0.025, parameter=base.B_V),
    # fibres and a spring settle: 30 % in 20 s [1/s]
    kind("cable_elasticity_drift", HiddenDrift, 0.015, parameter=base.LAMBDA),
    kind("drum_spring_drift", HiddenDrift, 0.015, parameter=base.K_S),
    # something begins to rub
    kind("friction_jump", HiddenJump, 0.5, parameter=base.B_C),
    kind("viscous_friction_jump", HiddenJump, 1.0, parameter=base.B_V),
    # strands break; a coil of the spring sticks; an amplifier loses a part of its current
    kind("cable_elasticity_jump", HiddenJump, 0.3, parameter=base.LAMBDA),
    kind("drum_spring_jump", HiddenJump, 0.3, parameter=base.K_S),
    kind("torque_constant_jump", HiddenJump, 0.2, parameter=base.K_T),
)
