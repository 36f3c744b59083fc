"""The cables of a pose: lengths, directions, Euler angles (inverse geometry, thesis 2.2.1).

    a_i + d_i s_i = p + b_i,   b_i = ᴬR_B ᴮb_i          loop closure                    (thesis 2.6)
    s_i = (p + b_i - a_i)/d_i                           direction, from A_i to B_i            (2.7)
    d_i = |p + b_i - a_i|                               length                                (2.8)
    ᴬR_i = Rz(φ_i) Ry(θ_i),   s_i = ᴬR_i (0, 0, 1)ᵀ     frame of the cable              (2.9, 2.10)
    θ_i = atan2(√(s_x² + s_y²), s_z),  φ_i = atan2(s_y, s_x)

φ_i is 0 for a vertical cable, of which it cannot be known.

The thesis has straight cables only; it counts the centres of its pulleys as the exit points. A
swivelling pulley at A_i turns about the vertical, along which the cable enters it, and so stands in
the plane of A_i and the connector B_i. The cable lies on it over the wrap angle β and leaves it
along the tangent towards B_i. In that plane, from A_i, with h the horizontal distance and z the
vertical one, z in the direction of the entering cable (upwards into a low pulley, downwards into a
high one; the other way round where the cable runs over the pulley):

    l² = (h - r)² + z² - r²                             tangent from the pulley to B_i
    B_i = r (1 - cos β, sin β) + l (sin β, cos β)       solved for the wrap angle β
    d = r β + l                                         length of the path
    s = (sin β u, ± cos β)                              its gradient, a unit vector; u horizontal
    H = n nᵀ/l + (sin β/h) e eᵀ                         how s turns with B_i: H = ∂s/∂B

n is the normal of s in the plane of the pulley, e the horizontal normal of that plane. At r = 0
this is the straight cable: d = |B - A|, H = (1 - s sᵀ)/d. (Pott 2012, Influence of pulley
kinematics on cable-driven parallel robots.)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.rotations import pose_rotation, rotation
from inca_mj.robot.geometry import DRIVES, Geometry

Array = np.ndarray


@dataclass(frozen=True)
class Pulleys:
    """The pulleys at the exit points.

    Attributes:
        radius: r of each pulley [m]; one number for all, or eight.
        over: whether the cable runs over a low pulley (or under a high one), and so lies on it over
            a larger angle; one value for all, or eight.

    Raises:
        InputError: a radius is negative or not finite, or there are not one or eight.
    """

    radius: float | tuple[float, ...]
    over: bool | tuple[bool, ...] = False

    def __post_init__(self) -> None:
        r = np.asarray(self.radius, float)
        if r.shape not in ((), (DRIVES,)) or np.shape(self.over) not in ((), (DRIVES,)):
            raise InputError(f"pulleys have one radius and one way for all, or {DRIVES} of each")
        if not np.isfinite(r).all() or r.min() < 0:
            raise InputError(f"the radius of a pulley must be 0 or more [m], not {r.min():g}")


@dataclass(frozen=True, kw_only=True)
class Cables:
    """The cables at a pose, or at many poses.

    Attributes:
        arms: b_i, from P to B_i, in O, shape (..., 8, 3) [m].
        spans: from A_i to B_i, in O, shape (..., 8, 3) [m].
        lengths: d_i, shape (..., 8) [m].
        directions: s_i = ∂d_i/∂B_i, in O, shape (..., 8, 3), without unit.
        wraps: angle over which the cables lie on their pulleys, shape (..., 8) [rad].
        pulleys: at the exit points; None for straight cables.
    """

    arms: Array
    spans: Array
    lengths: Array
    directions: Array
    wraps: Array
    pulleys: Pulleys | None = None

    @property
    def L(self) -> Array:
        """Jacobian ∂ḋ/∂(v, ω), rows [s_iᵀ, (b_i × s_i)ᵀ], shape (..., 8, 6) [-, m]."""
        return np.concatenate([self.directions, np.cross(self.arms, self.directions)], -1)

    @property
    def W(self) -> Array:
        """Wrench of the cables on the platform per tension, -Lᵀ, shape (..., 6, 8) [-, m]."""
        return -np.swapaxes(self.L, -1, -2)

    @cached_property
    def bends(self) -> Array:
        """∂s_i/∂B_i, in O, shape (..., 8, 3, 3) [1/m]."""
        s = self.directions
        if self.pulleys is None:
            return (np.eye(3) - s[..., :, None] * s[..., None, :]) / self.lengths[..., None, None]
        u, h, l, _, side = _tangents(self.spans, self.pulleys)
        sin, cos = np.sin(self.wraps), np.cos(self.wraps)
        n = np.concatenate([cos[..., None] * u, (-side * sin)[..., None]], -1)
        e = np.stack([-u[..., 1], u[..., 0], np.zeros_like(h)], -1)
        return (
            n[..., :, None] * n[..., None, :] / l[..., None, None]
            + e[..., :, None] * e[..., None, :] * (sin / h)[..., None, None]
        )

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
    return cables_at(pose[..., :3], pose_rotation(pose), geometry, pulleys)


def cables_at(
    position: Array, R: Array, geometry: Geometry, pulleys: Pulleys | None = None
) -> Cables:
    """Returns `inverse` from positions, shape (..., 3) [m], and rotations, shape (..., 3, 3)."""
    b = geometry.B @ np.swapaxes(R, -1, -2)
    return cables_along(position[..., None, :] + b - geometry.A, b, pulleys)


def cables_along(spans: Array, arms: Array, pulleys: Pulleys | None = None) -> Cables:
    """Returns the cables of given spans and arms.

    Raises:
        InputError: a cable has no length, or a connector is inside its pulley or above or below it.
    """
    if pulleys is None:
        d = np.linalg.norm(spans, axis=-1)
        if (d == 0).any():
            raise InputError(
                f"cable {_first(d == 0)} has no length: its connector is at its exit point"
            )
        return Cables(arms=arms, spans=spans, lengths=d, directions=spans / d[..., None],
                      wraps=np.zeros_like(d))  # fmt: skip
    u, h, l, z, side = _tangents(spans, pulleys)
    r = np.asarray(pulleys.radius, float)
    β = np.arctan2(l * (h - r) + r * z, l * z - r * (h - r))
    β = np.where(β < 0, β + 2 * np.pi, β)
    s = np.concatenate([np.sin(β)[..., None] * u, (side * np.cos(β))[..., None]], -1)
    return Cables(arms=arms, spans=spans, lengths=r * β + l, directions=s, wraps=β,
                  pulleys=pulleys)  # fmt: skip


def _tangents(spans: Array, pulleys: Pulleys) -> tuple[Array, Array, Array, Array, Array]:
    """Returns u, h, l and z of the module's equations, and 1 or -1 where z points down."""
    r, over = np.asarray(pulleys.radius, float), np.asarray(pulleys.over, bool)
    h = np.hypot(spans[..., 0], spans[..., 1])
    side = np.where((spans[..., 2] >= 0) != over, 1.0, -1.0)
    z = side * spans[..., 2]
    square = (h - r) ** 2 + z**2 - r**2
    bad = (square <= 0) | (h <= 0)
    if bad.any():
        raise InputError(
            f"the connector of cable {_first(bad)} is inside its pulley, or right above or below"
            " its exit point; move the pose or make the pulley smaller"
        )
    return spans[..., :2] / h[..., None], h, np.sqrt(square), z, side


def _first(bad: Array) -> int:
    """Returns the number of the first cable that is bad in any of many poses."""
    return int(np.flatnonzero(bad.reshape(-1, bad.shape[-1]).any(axis=0))[0]) + 1
