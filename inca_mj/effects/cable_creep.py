"""Creep: a Maxwell branch, spring and damper in series, beside the elastic cable."""

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import CABLES


@njit
def tension(s, p):  # type: ignore[no-untyped-def]
    """ΔT = c λ (ε - x) [N], x the strain of the damper, at which the branch is relaxed."""
    return p[0] * s.lambda_ * (s.strain - s.x)


@njit
def rate(s, p):  # type: ignore[no-untyped-def]
    """ẋ = (ε - x)/τ."""
    return (s.strain - s.x) / p[1]


CABLE_CREEP = DriveEffect(
    Effect(
        "cable_creep",
        "a Maxwell branch beside λ: stiffness c λ, time constant τ",
        (Size("c", "", 0.5, 0.1, sign=1, about="stiffness of the branch over λ"),),
        (Shape("tau", "s", (0.1, 0.3, 1.0, 3.0, 10.0), 0.02, 100.0, about="its time constant"),),
        CABLES,
        "cable: creeps",
        "Miermeister, Kraus, Lan, Pott 2015",
    ),
    tension=tension,
    rate=rate,
    rest="strain",
)
