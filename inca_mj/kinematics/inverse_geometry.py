"""The cables of a pose: lengths, directions, Euler angles (inverse geometry, thesis 2.2.1).

    a_i + d_i s_i = p + b_i,   b_i = ᴬR_B ᴮb_i          loop closure                    (thesis 2.6)
    s_i = (p + b_i - a_i)/d_i                           direction, from A_i to B_i            (2.7)
    d_i = |p + b_i - a_i|                               length                                (2.8)
    ᴬR_i = Rz(φ_i) Ry(θ_i),   s_i = ᴬR_i (0, 0, 1)ᵀ     frame of the cable              (2.9, 2.10)
    θ_i = atan2(√(s_x² + s_y²), s_z),  φ_i = atan2(s_y, s_x)

φ_i is 0 for a vertical cable, of which it cannot be known. With pulleys, s_i is the direction of
the straight part and d_i the length of the whole path (`inca_mj.kinematics.pulleys`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.pulleys import Pulleys, paths
from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.geometry import Geometry

Array = np.ndarray


@dataclass(frozen=True, kw_only=True)
class Cables:
    """The cables at a pose, or at many poses.

    Attributes:
        arms: b_i, from P to B_i, in O, shape (..., 8, 3) [m].
        lengths: d_i, shape (..., 8) [m].
        directions: s_i, in O, shape (..., 8, 3), without unit.
        bends: ∂s_i/∂B_i, in O, shape (..., 8, 3, 3) [1/m].
        wraps: angle over which the cables lie on their pulleys, shape (..., 8) [rad].
        pulleys: at the exit points; None for straight cables.
    """

    arms: Array
    lengths: Array
    directions: Array
    bends: Array
    wraps: Array
    pulleys: Pulleys | None = None

    @property
    def angles(self) -> Array:
        """Euler angles φ_i, θ_i of the cables, shape (..., 8, 2) [rad]."""
        x, y, z = np.moveaxis(self.directions, -1, 0)
        return np.stack([np.arctan2(y, x), np.arctan2(np.hypot(x, y), z)], -1)

    @property
    def frames(self) -> Array:
        """ᴬR_i, from the frame of cable i to O, shape (..., 8, 3, 3) (thesis 2.9)."""
        φ, θ = np.moveaxis(self.angles, -1, 0)
        return rotation(np.zeros_like(φ), θ, φ)


def inverse(pose: Array, geometry: Geometry, pulleys: Pulleys | None = None) -> Cables:
    """Returns the cables at a pose, or at many (thesis 2.6 - 2.10).

    Args:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (..., 6).
        geometry: exit points and connectors.
        pulleys: at the exit points; straight cables without.

    Raises:
        InputError: the pose is not six finite numbers, a cable has no length, or a connector is
            inside its pulley.
    """
    pose = np.asarray(pose, float)
    if pose.shape[-1:] != (6,) or not np.isfinite(pose).all():
        raise InputError(
            "a pose is six finite numbers: x, y, z [m], roll, pitch, yaw [rad]; not shape"
            f" {pose.shape}" + ("" if np.isfinite(pose).all() else " with what is not finite")
        )
    R = rotation(*np.moveaxis(pose[..., 3:], -1, 0))
    return cables_at(pose[..., :3], R, geometry, pulleys)


def cables_at(
    position: Array, R: Array, geometry: Geometry, pulleys: Pulleys | None = None
) -> Cables:
    """Returns `inverse` from positions, shape (..., 3) [m], and rotations, shape (..., 3, 3)."""
    b = geometry.B @ np.swapaxes(R, -1, -2)
    path = paths(position[..., None, :] + b - geometry.A, pulleys)
    return Cables(
        arms=b,
        lengths=path.lengths,
        directions=path.directions,
        bends=path.bends,
        wraps=path.wraps,
        pulleys=pulleys,
    )


def cables(position: Array, R: Array, geometry: Geometry) -> tuple[Array, Array]:
    """Returns lengths d (8,) [m] and unit vectors s (8, 3) to the connectors (thesis 2.7, 2.8)."""
    span = position + geometry.B @ R.T - geometry.A
    d = np.linalg.norm(span, axis=1)
    return d, span / d[:, None]
