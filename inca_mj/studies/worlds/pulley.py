"""The path of a cable from its exit point to its connector, straight or over a pulley.

A pulley of radius r swivels about the vertical through A, where the cable enters it along that
vertical; the pulley stands in the vertical plane of A and the connector, its centre at r u, with u
horizontal towards the connector. In that plane, from A: ρ along u, z along the vertical (upwards
for an exit point that is high, downwards for a low one: the cable runs over the side away from
the platform), the cable leaves the pulley where the normal has the angle α:

    w = (ρ − r, z),  l = √(|w|² − r²)                        tangent from the pulley to B
    α = atan2(z, ρ − r) + atan2(l, r)                        w = r n(α) + l t(α)
    d = r (π − α) + l,  ∂d/∂B = t = (sin α, −cos α)          arc and tangent
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

import numpy as np

from inca_mj.reference.compiled import compiled
from inca_mj.reference.equations import Vector


@compiled
def path(ds: Vector, r: float, side: float) -> tuple[float, Vector]:
    """Returns the length of the path [m], and its gradient by the connector, a unit vector in O.

    Args:
        ds: from A to the connector, in O [m].
        r: radius of the pulley [m]; 0 is a straight cable.
        side: +1 for a cable over the top of its pulley, −1 for one under it.
    """
    if r == 0.0:
        d = sqrt(ds[0] * ds[0] + ds[1] * ds[1] + ds[2] * ds[2])
        return d, (ds[0] / d, ds[1] / d, ds[2] / d)
    ρ = sqrt(ds[0] * ds[0] + ds[1] * ds[1])
    wx, wz = ρ - r, side * ds[2]
    square = wx * wx + wz * wz - r * r
    l = sqrt(square) if square > 0.0 else np.nan  # the connector is inside the pulley
    α = atan2(wz, wx) + atan2(l, r)
    tx, tz = sin(α), -cos(α)
    return r * (pi - α) + l, (tx * ds[0] / ρ, tx * ds[1] / ρ, side * tz)
