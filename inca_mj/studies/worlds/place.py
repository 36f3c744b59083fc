"""Geometry and platform: where points truly are, and what pushes the platform.

A_i + r_p        swivelling pulley, see `inca_mj.studies.worlds.pulley`
A_k + (x, y, z)                                               anchor offset
A_k + (x, y, z) sin(2πf t + φ₀)                               vibration of the frame
b_i − c, start at p + R_AB c                                  centre of mass at c
(x, y, z) [N] in O, at the platform's origin                  external force
−c |v|^(n−1) v                                                air drag
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import ClassVar

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
)


@dataclass(frozen=True, kw_only=True)
class HiddenPulleyRadius(HiddenDriveEffect):
    """A swivelling pulley of radius r_p [m] at A_i."""

    name: ClassVar[str] = "pulley_radius"
    acts_on: ClassVar[str] = "all cables"
    sizes: ClassVar[tuple[str, ...]] = ("r_p",)
    largest: ClassVar[float] = 0.03  # the largest pulley that fits [m]
    r_p: float = 0.01

    def put(self, numbers: HiddenNumbers) -> None:
        """Write r_p."""
        self.column(numbers, at.PULLEY)[:] += self.r_p


@dataclass(frozen=True, kw_only=True)
class HiddenAnchorOffset(HiddenOneDriveEffect):
    """A_k moved by (x, y, z) [m]."""

    name: ClassVar[str] = "anchor_offset"
    sizes: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    largest: ClassVar[float] = 0.03  # an exit point in the next hole [m]
    x: float = 0.01
    y: float = -0.01
    z: float = 0.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Move A_k."""
        if self.drive is not None:
            numbers.A[self.drive - 1] += (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenFrameVibration(HiddenOneDriveEffect):
    """A_k moved by (x, y, z) sin(2πf t + φ₀) [m]; f [Hz], φ₀ [rad]. In no catalogue."""

    name: ClassVar[str] = "frame_vibration"
    sizes: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    largest: ClassVar[float] = 2e-3  # a soft frame [m]
    positive: ClassVar[tuple[str, ...]] = ("frequency",)
    x: float = 3e-4
    y: float = 3e-4
    z: float = 0.0
    frequency: float = 6.3
    phase: float = 0.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write the motion of A_k."""
        for column, value in zip(
            (at.SHAKE_X, at.SHAKE_Y, at.SHAKE_Z), (self.x, self.y, self.z), strict=True
        ):
            self.column(numbers, column)[:] += value
        self.column(numbers, at.SHAKE_RATE)[:] = 2 * pi * self.frequency
        self.column(numbers, at.SHAKE_PHASE)[:] = self.phase


@dataclass(frozen=True, kw_only=True)
class HiddenComOffset(HiddenEffect):
    """Centre of mass at (x, y, z) of the platform frame [m]; its inertia is about that point."""

    name: ClassVar[str] = "com_offset"
    is_part: ClassVar[bool] = True  # all connectors deviate alike
    acts_on: ClassVar[str] = "platform"
    sizes: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    largest: ClassVar[float] = 0.02  # a payload on one side of the handle [m]
    x: float = 2e-3
    y: float = 0.0
    z: float = -3e-3

    def put(self, numbers: HiddenNumbers) -> None:
        """Move the centre; the connectors move the other way."""
        numbers.centre += (self.x, self.y, self.z)
        numbers.B -= (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenExternalForce(HiddenEffect):
    """A constant force (x, y, z) [N] in O; the pretension carries it where `balanced`."""

    name: ClassVar[str] = "external_force"
    acts_on: ClassVar[str] = "platform"
    sizes: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    largest: ClassVar[float] = 1.0  # two thirds of the weight of the platform [N]
    x: float = 0.06
    y: float = -0.03
    z: float = 0.0
    balanced: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write the force."""
        numbers.force += (self.x, self.y, self.z)
        if self.balanced:
            numbers.carried += (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenAirDrag(HiddenEffect):
    """−c |v|^(n−1) v on the centre of mass; c [N (s/m)^n]."""

    name: ClassVar[str] = "air_drag"
    acts_on: ClassVar[str] = "platform"
    sizes: ClassVar[tuple[str, ...]] = ("c",)
    largest: ClassVar[float] = 0.5  # a sheet on the handle [N s²/m²]
    positive: ClassVar[tuple[str, ...]] = ("exponent",)
    c: float = 0.15
    exponent: float = 2.0

    def put(self, numbers: HiddenNumbers) -> None:
        """Write c and n."""
        numbers.P[at.DRAG] += self.c
        numbers.P[at.DRAG_POWER] = self.exponent
