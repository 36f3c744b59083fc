"""Effects of cables, of the geometry and on the platform.

    T   = max(0, λ ε (1 + κ ε^n) + c λ (ε − ε_v) + b (ḋ − ḋ₀))        hardening, creep
    τ ε̇_v = ε − ε_v,  ε_v(0) = ε(0)                                   Maxwell branch, relaxed
    −½ ρ g d  along z, on the connector of each cable                 weight
    d + d (ρ g d_h)²/(24 T²)  for d in ε                              sag, where asked for
    A_i + r_p        swivelling pulley, `equations.path`
    A_k + (x, y, z)                                                   anchor offset
    A_k + (x, y, z) sin(2πf t + φ₀)                                   vibration of the frame
    b_i − c, start at p + R_AB c                                      centre of mass at c
    (x, y, z) [N] in O, at the platform's origin                      external force
    −c |v|^(n−1) v                                                    air drag

d_h is the horizontal span of the cable; the sag is the parabola's lengthening, solved with T.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from inca_mj.studies.worlds import layout as at
from inca_mj.studies.worlds.effect import (
    HiddenDriveEffect,
    HiddenEffect,
    HiddenNumbers,
    HiddenOneDriveEffect,
    shape,
    size,
)


@dataclass(frozen=True, kw_only=True)
class HiddenCableHardening(HiddenDriveEffect):
    """λ ε (1 + κ ε^n)."""

    name = "cable_hardening"
    acts_on = "all cables"
    largest = 2.0  # at a strain of 0.1 %: three times as stiff
    reach = 1e-3
    kappa: float = size(200.0, at.CABLE_HARD)
    exponent: float = shape(1.0, at.CABLE_POWER)


@dataclass(frozen=True, kw_only=True)
class HiddenCableCreep(HiddenDriveEffect):
    """A spring of c λ in series with a dashpot, time constant τ [s], relaxed at the start."""

    name = "cable_creep"
    acts_on = "all cables"
    largest = 0.5  # a new braid that gives half as much again
    fraction: float = size(0.1, at.MAXWELL)
    tau: float = shape(1.0, at.MAXWELL_TIME)


@dataclass(frozen=True, kw_only=True)
class HiddenCableWeight(HiddenDriveEffect):
    """ρ [kg/m]: half of each cable hangs on its connector, and sags where `sag` is True.

    Where `balanced` is False the pretension carries the platform alone and the weight acts from the
    first instant on, as an external force does.
    """

    name = "cable_weight"
    acts_on = "all cables"
    largest = 5e-3  # steel of 1 mm weighs 4 g/m [kg/m]
    rho: float = size(6e-4, at.LINE_WEIGHT)
    sag: bool = shape(False, at.SAG, positive=False)
    balanced: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write ρ and its options."""
        super().put(numbers)
        numbers.weight_carried = self.balanced


@dataclass(frozen=True, kw_only=True)
class HiddenPulleyRadius(HiddenDriveEffect):
    """A swivelling pulley of radius r_p [m] at A_i."""

    name = "pulley_radius"
    acts_on = "all cables"
    largest = 0.03  # the largest pulley that fits [m]
    r_p: float = size(0.01, at.PULLEY)


@dataclass(frozen=True, kw_only=True)
class HiddenAnchorOffset(HiddenOneDriveEffect):
    """A_k moved by (x, y, z) [m]."""

    name = "anchor_offset"
    largest = 0.03  # an exit point in the next hole [m]
    x: float = size(0.01)
    y: float = size(-0.01)
    z: float = size(0.0)

    def put(self, numbers: HiddenNumbers) -> None:
        """Move A_k."""
        if self.drive is not None:
            numbers.A[self.drive - 1] += (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenFrameVibration(HiddenOneDriveEffect):
    """A_k moved by (x, y, z) sin(2πf t + φ₀) [m]; f [Hz], φ₀ [rad]. In no catalogue."""

    name = "frame_vibration"
    largest = 2e-3  # a soft frame [m]
    x: float = size(3e-4, at.SHAKE_X)
    y: float = size(3e-4, at.SHAKE_Y)
    z: float = size(0.0, at.SHAKE_Z)
    frequency: float = shape(6.3, at.SHAKE_RATE, times=2 * pi)
    phase: float = shape(0.0, at.SHAKE_PHASE, positive=False)


@dataclass(frozen=True, kw_only=True)
class HiddenComOffset(HiddenEffect):
    """Centre of mass at (x, y, z) of the platform frame [m]; its inertia is about that point."""

    name = "com_offset"
    is_part = True  # all connectors deviate alike
    largest = 0.02  # a payload on one side of the handle [m]
    x: float = size(2e-3)
    y: float = size(0.0)
    z: float = size(-3e-3)

    def put(self, numbers: HiddenNumbers) -> None:
        """Move the centre; the connectors move the other way."""
        numbers.centre += (self.x, self.y, self.z)
        numbers.B -= (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenExternalForce(HiddenEffect):
    """A constant force (x, y, z) [N] in O; the pretension carries it where `balanced`."""

    name = "external_force"
    largest = 1.0  # two thirds of the weight of the platform [N]
    x: float = size(0.06)
    y: float = size(-0.03)
    z: float = size(0.0)
    balanced: bool = False

    def put(self, numbers: HiddenNumbers) -> None:
        """Write the force."""
        numbers.force += (self.x, self.y, self.z)
        if self.balanced:
            numbers.carried += (self.x, self.y, self.z)


@dataclass(frozen=True, kw_only=True)
class HiddenAirDrag(HiddenEffect):
    """−c |v|^(n−1) v on the centre of mass; c [N (s/m)^n]."""

    name = "air_drag"
    largest = 0.5  # a sheet on the handle [N s²/m²]
    c: float = size(0.15, at.DRAG)
    exponent: float = shape(2.0, at.DRAG_POWER)
