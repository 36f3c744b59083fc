"""Swivelling pulley of radius r_p at the exit point.

The cable enters the pulley at A along the vertical and leaves along the tangent towards the
connector B; the pulley swivels about that vertical. It enters upwards into a low pulley and
downwards into a high one, or, where it runs over, the other way: then it turns farther. With h the
horizontal and z the vertical distance from A to B, z in the direction of the entering cable:

    D² = (h - r_p)² + z²,  ℓ = √(D² - r_p²)                  tangent
    β  = angle over which the cable lies on the pulley
    Δd = r_p β + ℓ - √(h² + z²)

Its gradient is the tangent's direction less that of B - A.
"""

from math import atan2, cos, sin, sqrt

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import CABLES


@njit
def path(s, p):  # type: ignore[no-untyped-def]
    """Δd and ∂Δd/∂r, r = B - A."""
    r_p, over = p
    across = sqrt(s.rx**2 + s.ry**2)
    sign = 1.0 if (s.rz >= 0.0) != (over != 0.0) else -1.0  # low drives look up, high ones down
    z = sign * s.rz
    straight = sqrt(across**2 + z**2)
    tangent = sqrt((across - r_p) ** 2 + z**2 - r_p**2)
    # B from the centre: tangent (sin β, cos β) + r_p (-cos β, sin β)
    beta = atan2(tangent * (across - r_p) + r_p * z, tangent * z - r_p * (across - r_p))
    out, up = sin(beta), sign * cos(beta)
    return (
        r_p * beta + tangent - straight,
        (out / across - 1.0 / straight) * s.rx,
        (out / across - 1.0 / straight) * s.ry,
        up - s.rz / straight,
    )


PULLEY_RADIUS = DriveEffect(
    Effect(
        "pulley_radius",
        "swivelling pulley of radius r_p at A_i",
        (Size("r_p", "m", 0.03, 1e-3, sign=1, about="radius of the pulley"),),
        (Shape("over", "", (0.0, 1.0), 0.0, 1.0, free=False, about="1: over it", usual=0.0),),
        places=CABLES,
        phrase="cable: pulley at the exit point",
        reference="Pott 2012, Influence of pulley kinematics on cable-driven parallel robots",
    ),
    path=path,
)
