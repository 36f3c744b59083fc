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


class HiddenFrictionDrift(HiddenDrift):
    """b_c: grease gets warm."""

    name, parameter = "friction_drift", base.B_C
    largest = 0.025  # half of it in 20 s [1/s]


class HiddenViscousFrictionDrift(HiddenDrift):
    """b_v: grease gets warm."""

    name, parameter = "viscous_friction_drift", base.B_V
    largest = 0.025  # half of it in 20 s [1/s]


class HiddenCableElasticityDrift(HiddenDrift):
    """λ: fibres settle."""

    name, parameter = "cable_elasticity_drift", base.LAMBDA
    largest = 0.015  # 30 % in 20 s [1/s]


class HiddenDrumSpringDrift(HiddenDrift):
    """k_s: a spring settles."""

    name, parameter = "drum_spring_drift", base.K_S
    largest = 0.015  # 30 % in 20 s [1/s]


class HiddenFrictionJump(HiddenJump):
    """b_c: something begins to rub."""

    name, parameter, largest = "friction_jump", base.B_C, 0.5


class HiddenViscousFrictionJump(HiddenJump):
    """b_v: something begins to rub."""

    name, parameter, largest = "viscous_friction_jump", base.B_V, 1.0


class HiddenCableElasticityJump(HiddenJump):
    """λ: strands break."""

    name, parameter, largest = "cable_elasticity_jump", base.LAMBDA, 0.3


class HiddenDrumSpringJump(HiddenJump):
    """k_s: a coil of the spring sticks."""

    name, parameter, largest = "drum_spring_jump", base.K_S, 0.3


class HiddenTorqueConstantJump(HiddenJump):
    """K_t: an amplifier loses a part of its current."""

    name, parameter, largest = "torque_constant_jump", base.K_T, 0.2
