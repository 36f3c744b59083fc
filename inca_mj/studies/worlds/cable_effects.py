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
    kind,
    shape,
    size,
)


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


KINDS = (
    # at a strain of 0.1 % three times as stiff
    kind("cable_hardening", HiddenDriveEffect, 2.0, acts_on="all cables", reach=1e-3,
         kappa=size(200.0, at.CABLE_HARD), exponent=shape(1.0, at.CABLE_POWER)),
    # a new braid that gives half as much again; the branch has the time constant τ [s]
    kind("cable_creep", HiddenDriveEffect, 0.5, acts_on="all cables",
         fraction=size(0.1, at.MAXWELL), tau=shape(1.0, at.MAXWELL_TIME)),
    # the largest pulley that fits [m]
    kind("pulley_radius", HiddenDriveEffect, 0.03, acts_on="all cables",
         r_p=size(0.01, at.PULLEY)),
    HiddenCableWeight,
    HiddenAnchorOffset,
    # a soft frame [m]; f [Hz], φ₀ [rad]
    kind("frame_vibration", HiddenOneDriveEffect, 2e-3,
         x=size(3e-4, at.SHAKE_X), y=size(3e-4, at.SHAKE_Y), z=size(0.0, at.SHAKE_Z),
         frequency=shape(6.3, at.SHAKE_RATE, times=2 * pi),
         phase=shape(0.0, at.SHAKE_PHASE, positive=False)),
    HiddenComOffset,
    HiddenExternalForce,
    # a sheet on the handle [N s²/m²]; c [N (s/m)^n], at the centre of mass
    kind("air_drag", HiddenEffect, 0.5, c=size(0.15, at.DRAG), exponent=shape(2.0, at.DRAG_POWER)),
)  # fmt: skip
