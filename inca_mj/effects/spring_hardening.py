"""Hardening drum spring: stiffer the farther it is wound."""

from numba import njit

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = R_s ΔF_s, ΔF_s = -k_s k₃ s³, s = R_s φ [N m]; the spring never pushes."""
    way = s.R_s * s.phi
    return s.R_s * max(-s.F_s, -s.k_s * p[0] * way**3)


SPRING_HARDENING = DriveEffect(
    Effect(
        "spring_hardening",
        "F_s with k_s (1 + k₃ s²), s = R_s φ",
        (Size("k_3", "1/m²", 500.0, 2.0, about="growth of the stiffness"),),
        places=DRIVES_EACH,
        phrase="drum spring: stiffness not constant",
        reference="thesis 2.41",
    ),
    torque=torque,
)
