"""A swivelling pulley at each exit point: the path of the cable over it.

The cable enters the pulley at A_i along the vertical. The pulley turns about that vertical, so that
it stands in the plane of A_i and the connector B_i. The cable lies on it over the wrap angle β and
leaves it along the tangent towards B_i. In that plane, from A_i, with h the horizontal distance and
z the vertical one, z in the direction of the entering cable (upwards into a low pulley, downwards
into a high one; the other way round where the cable runs over the pulley):

    l² = (h - r)² + z² - r²                             tangent from the pulley to B_i
    B_i = r (1 - cos β, sin β) + l (sin β, cos β)       solved for the wrap angle β
    d = r β + l                                         length of the path
    s = (sin β u, ± cos β)                              its gradient, a unit vector; u horizontal
    H = n nᵀ/l + (sin β/h) e eᵀ                         how s turns with B_i: H = ∂s/∂B

n is the normal of s in the plane of the pulley, e the horizontal normal of that plane. At r = 0
this is the straight cable: d = |B - A|, H = (1 - s sᵀ)/d. The thesis (2.6 - 2.8) has straight
cables only; it counts the centres of its pulleys as the exit points.

Pott (2012), Influence of pulley kinematics on cable-driven parallel robots.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from inca_mj.robot.geometry import DRIVES

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


@dataclass(frozen=True)
class Paths:
    """The paths of cables from their exit points to their connectors.

    Attributes:
        lengths: d, shape (..., 8) [m].
        directions: s = ∂d/∂B, from the frame towards the connector, in O, shape (..., 8, 3).
        bends: H = ∂s/∂B, in O, shape (..., 8, 3, 3) [1/m].
        wraps: β, over which the cables lie on their pulleys, shape (..., 8) [rad].
    """

    lengths: Array
    directions: Array
    bends: Array
    wraps: Array


def paths(spans: Array, pulleys: Pulleys | None = None) -> Paths:
    """Returns the paths of the cables; straight ones without pulleys (thesis 2.7, 2.8).

    Args:
        spans: from the exit points to the connectors, in O, shape (..., 8, 3) [m].
        pulleys: at the exit points.

    Raises:
        InputError: a cable has no length, or a connector is inside its pulley or above or below it.
    """
    if pulleys is not None:
        return _over_pulleys(spans, pulleys)
    d = np.linalg.norm(spans, axis=-1)
    if (d == 0).any():
        raise InputError(
            f"cable {_first(d == 0)} has no length: its connector is at its exit point"
        )
    s = spans / d[..., None]
    H = (np.eye(3) - s[..., :, None] * s[..., None, :]) / d[..., None, None]
    return Paths(d, s, H, np.zeros_like(d))


def _over_pulleys(spans: Array, pulleys: Pulleys) -> Paths:
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
    l = np.sqrt(square)
    β = np.arctan2(l * (h - r) + r * z, l * z - r * (h - r))
    β = np.where(β < 0, β + 2 * np.pi, β)
    sin, cos, zero = np.sin(β), np.cos(β), np.zeros_like(β)
    u = np.stack([spans[..., 0] / h, spans[..., 1] / h], -1)
    s = np.concatenate([sin[..., None] * u, (side * cos)[..., None]], -1)
    n = np.concatenate([cos[..., None] * u, (-side * sin)[..., None]], -1)
    e = np.stack([-u[..., 1], u[..., 0], zero], -1)
    H = (
        n[..., :, None] * n[..., None, :] / l[..., None, None]
        + e[..., :, None] * e[..., None, :] * (sin / h)[..., None, None]
    )
    return Paths(r * β + l, s, H, β)


def _first(bad: Array) -> int:
    """Returns the number of the first cable that is bad in any of many poses."""
    return int(np.flatnonzero(bad.reshape(-1, bad.shape[-1]).any(axis=0))[0]) + 1
