"""Hardening drum spring: stiffer the farther it is wound."""

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import DRIVES_EACH

WAY = 0.05  # s₁, at which k₃ means the same for every power [m]


@njit
def torque(s, p):  # type: ignore[no-untyped-def]
    """Δτ = R_s ΔF_s, ΔF_s = -k_s k₃ s³ |s/s₁|^(n-2), s = R_s φ [N m]; it never pushes."""
    k_3, n = p
    way = s.R_s * s.phi
    return s.R_s * max(-s.F_s, -s.k_s * k_3 * WAY * way * abs(way) * (abs(way) / WAY) ** (n - 1))


SPRING_HARDENING = DriveEffect(
    Effect(
        "spring_hardening",
        "F_s with k_s (1 + k₃ s²), or with |s|; s = R_s φ",
        (Size("k_3", "1/m²", 500.0, 2.0, about="growth of the stiffness"),),
        (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the way"),),
        places=DRIVES_EACH,
        phrase="drum spring: stiffness not constant",
        reference="thesis 2.41",
    ),
    torque=torque,
)
