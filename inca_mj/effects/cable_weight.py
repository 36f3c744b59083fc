"""Weight of the cables: half of each hangs on its connector, half on its exit point."""

from math import sqrt

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import CABLES
from inca_mj.robot.parameters import GRAVITY


@njit
def force(s, p):  # type: ignore[no-untyped-def]
    """F = (0, 0, -ρ g d/2) on the connector [N]."""
    d = sqrt(s.rx**2 + s.ry**2 + s.rz**2)
    return 0.0, 0.0, -0.5 * GRAVITY * p[0] * d


CABLE_WEIGHT = DriveEffect(
    Effect(
        "cable_weight",
        "ρ d/2 of each cable hangs on its connector",
        (Size("rho", "kg/m", 0.005, 1e-3, sign=1, about="mass of the cable per length"),),
        places=CABLES,
        phrase="cable: has weight",
        reference="Irvine 1981, Cable Structures",
    ),
    force=force,
)
