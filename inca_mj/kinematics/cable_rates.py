"""Rates of the cables: connectors, lengths, and the turning of the cables (thesis 2.2.2).

    v_bi = v_p + ω_p × b_i                                  velocity of the connector  (thesis 2.11)
    ⁱv_bi = ᴬR_iᵀ v_bi                                      in the frame of the cable         (2.12)
    v_bi = d_i ω_i × s_i + ḋ_i s_i                          two ways to say the same          (2.13)
    ḋ_i = ⁱv_biz = s_iᵀ (v_p + ω_p × b_i)                   rate of the length          (2.14, 2.15)
    ⁱω_i = (ⁱs_i × ⁱv_bi)/d_i = (-ⁱv_biy, ⁱv_bix, 0)/d_i    the cable does not spin           (2.16)

Misprint of the thesis: 2.16 lacks the minus of its first entry. ⁱω_i is the rate of the line from
A_i to B_i; its frame also spins about it, by φ̇_i cos θ_i. With pulleys ω_i = s_i × H_i v_bi,
which is the same thing for a straight cable.

A twist is (v_p, ω_p), both along the axes of O.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.kinematics.inverse_geometry import Cables

Array = np.ndarray


@dataclass(frozen=True)
class CableRates:
    """Rates of the connectors, of the lengths, and of the cables' turning.

    Attributes:
        connectors: v_bi, in O, shape (..., 8, 3) [m/s].
        lengths: ḋ_i, shape (..., 8) [m/s].
        turns: ⁱω_i, in the frame of the cable, shape (..., 8, 3) [rad/s].
    """

    connectors: Array
    lengths: Array
    turns: Array


def rates(cables: Cables, twist: Array) -> CableRates:
    """Returns the rates of the cables (thesis 2.11 - 2.16).

    Args:
        cables: of a pose, from `inverse`.
        twist: v_p and ω_p of the platform, along O, shape (..., 6) [m/s, rad/s].
    """
    twist = np.asarray(twist, float)
    v, ω = twist[..., None, :3], twist[..., None, 3:]
    v_b = v + np.cross(ω, cables.arms)
    s_rate = np.einsum("...ij,...j->...i", cables.bends, v_b)
    return CableRates(
        connectors=v_b,
        lengths=np.sum(cables.directions * v_b, -1),
        turns=into_frames(cables, np.cross(cables.directions, s_rate)),
    )


def into_frames(cables: Cables, vectors: Array) -> Array:
    """Returns ᴬR_iᵀ a_i: vectors in O, shape (..., 8, 3), along the axes of each cable's frame."""
    return np.einsum("...ji,...j->...i", cables.frames, vectors)
