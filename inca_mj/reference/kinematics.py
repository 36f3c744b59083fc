"""Directions of the eight cables and rotation of the platform, thesis 2.1 to 2.8, in the frame O.

    R_AB = Rz(ψ) Ry(θ) Rx(φ)                                                       (2.1)
    a + d s = p + b,  b = R_AB ᴮb                                             (2.6 - 2.8)

Rates of the cables follow in the equations themselves (2.15).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.reference import equations
from inca_mj.robot.geometry import Geometry


@dataclass(frozen=True)
class CablePose:
    """The arms, lengths and directions of the cables."""

    arms: np.ndarray  # b_i, from P to B_i, in O, shape (8, 3) [m]
    lengths: np.ndarray  # d_i, shape (8,) [m]
    directions: np.ndarray  # s_i, from A_i to B_i, in O, shape (8, 3)


def rotation(euler: np.ndarray) -> np.ndarray:
    """Returns R_AB from roll, pitch, yaw [rad], shape (3, 3) (2.1)."""
    return np.array(list(equations.rotation(equations.vector(np.asarray(euler, float)))))


def geometric(p: np.ndarray, R_AB: np.ndarray, geometry: Geometry) -> CablePose:
    """Returns the cables of a platform at p in O (3,) [m], turned by R_AB (2.6 - 2.8)."""
    b = geometry.B @ R_AB.T
    ds = p + b - geometry.A
    d = np.linalg.norm(ds, axis=1)
    return CablePose(b, d, ds / d[:, None])
