"""Drift of the torque constant: magnets weaken as the motor warms.

K_t (1 - α t)            kind 0: warms with time
K_t (1 - α ∫(i/1 A)² dt)   kind 1: warms with what its winding dissipates
"""

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def current(s, p):  # type: ignore[no-untyped-def]
    """Δi = -α t i, or -α x i with x the heat [A]."""
    alpha, kind = p
    return -alpha * (s.time if kind == 0.0 else s.x) * s.i


@njit
def rate(s, p):  # type: ignore[no-untyped-def]
    """ẋ = i²: heat, in seconds at 1 A."""
    return s.i * s.i


TORQUE_CONSTANT_DRIFT = DriveEffect(
    Effect(
        "torque_constant_drift",
        "K_t (1 - α t), or with heat ∫i² dt for t",
        (Size("alpha", "1/s", 0.01, 2e-4, sign=1, about="relative loss a second, or at 1 A"),),
        (
            Shape(
                "kind",
                "",
                (0.0, 1.0),
                0.0,
                1.0,
                free=False,
                about="0 with time, 1 with heat",
                usual=0.0,
            ),
        ),
        DRIVES_EACH,
        "motor: torque constant drifts",
        "Krishnan 2010, -0.1 to -0.2 %/K of magnets",
    ),
    current=current,
    rate=rate,
)
