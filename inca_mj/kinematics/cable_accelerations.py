"""Accelerations of the cables: connectors, lengths, and the turning (thesis 2.2.3).

    v̇_bi = v̇_p + ω̇_p × b_i + ω_p × (ω_p × b_i)                          connector   (thesis 2.17)
    ⁱv̇_bi = ᴬR_iᵀ v̇_bi                                                                    (2.18)
    v̇_bi = d̈ s + d ω̇ × s + d ω × (ω × s) + 2 ḋ ω × s                                      (2.19)
    d̈_i = ⁱv̇_biz + d_i |ω_i|² = ⁱv̇_biz + (ⁱv_bix² + ⁱv_biy²)/d_i          length    (2.20, 2.21)
    ⁱω̇_i = (ⁱs_i × ⁱv̇_bi - 2 ḋ_i ⁱω_i)/d_i                              the cable turns   (2.22)

Misprint of the thesis: 2.20 writes ω_i² for the square of the vector's length; 2.21 says the same
without doubt. 2.22 is right as printed. For straight cables; `jacobian_rate` gives d̈ over pulleys
as well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.cable_rates import into_frames, rates
from inca_mj.kinematics.inverse_geometry import Cables

Array = np.ndarray


@dataclass(frozen=True)
class CableAccelerations:
    """Accelerations of the connectors, of the lengths, and of the cables' turning.

    Attributes:
        connectors: v̇_bi, in O, shape (..., 8, 3) [m/s^2].
        lengths: d̈_i, shape (..., 8) [m/s^2].
        turns: ⁱω̇_i, in the frame of the cable, shape (..., 8, 3) [rad/s^2].
    """

    connectors: Array
    lengths: Array
    turns: Array


def accelerations(cables: Cables, twist: Array, twist_rate: Array) -> CableAccelerations:
    """Returns the accelerations of straight cables (thesis 2.17 - 2.22).

    Args:
        cables: of a pose, from `inverse`.
        twist: v_p and ω_p of the platform, along O, shape (..., 6) [m/s, rad/s].
        twist_rate: v̇_p and ω̇_p, along O, shape (..., 6) [m/s^2, rad/s^2].

    Raises:
        InputError: the cables run over pulleys.
    """
    if cables.pulleys is not None:
        raise InputError(
            "these accelerations are those of straight cables; use jacobian_rate with pulleys"
        )
    twist, twist_rate = np.asarray(twist, float), np.asarray(twist_rate, float)
    ω, b, d = twist[..., None, 3:], cables.arms, cables.lengths
    moved = rates(cables, twist)
    v_b_rate = (
        twist_rate[..., None, :3]
        + np.cross(twist_rate[..., None, 3:], b)
        + np.cross(ω, np.cross(ω, b))
    )
    ax, ay, az = np.moveaxis(into_frames(cables, v_b_rate), -1, 0)
    vx, vy, _ = np.moveaxis(into_frames(cables, moved.connectors), -1, 0)
    s_cross_a = np.stack([-ay, ax, np.zeros_like(ax)], -1)
    return CableAccelerations(
        connectors=v_b_rate,
        lengths=az + (vx**2 + vy**2) / d,
        turns=(s_cross_a - 2 * moved.lengths[..., None] * moved.turns) / d[..., None],
    )
