"""Mismatch of the torque constant: one motor is stronger, or weaker, than the others."""

from numba import njit

from identification.effects.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import ONE_DRIVE


@njit
def current(s, p):  # type: ignore[no-untyped-def]
    """Δi = δ i [A]: K_t (1 + δ) in all."""
    return p[0] * s.i


TORQUE_CONSTANT_MISMATCH = DriveEffect(
    Effect(
        "torque_constant_mismatch",
        "K_t (1 + δ) on one drive",
        (Size("delta", "", 0.2, 1e-3, about="relative excess of the torque constant"),),
        places=ONE_DRIVE,
        phrase="motor: one torque constant differs",
        reference="thesis Table 3.2",
    ),
    current=current,
)
