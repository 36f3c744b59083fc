"""Hardening cable: braids stiffen as they are pulled."""

from numba import njit

from identification.effects.effect import Effect, Shape, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import CABLES

STRAIN = 1e-3  # ε₁, at which κ means the same for every power


@njit
def tension(s, p):  # type: ignore[no-untyped-def]
    """ΔT = λ κ ε² (ε/ε₁)^(n-1) of a taut cable [N]: λ ε (1 + κ ε) in all where n = 1."""
    kappa, n = p
    strain = max(0.0, s.strain)
    return s.lambda_ * kappa * strain**2 * (strain / STRAIN) ** (n - 1)


CABLE_HARDENING = DriveEffect(
    Effect(
        "cable_hardening",
        "λ ε (1 + κ ε), or with ε²",
        (Size("kappa", "", 2000.0, 200.0, sign=1, about="growth of the stiffness per strain"),),
        (Shape("n", "", (1.0, 2.0), 0.5, 4.0, free=False, about="power of the strain", usual=1.0),),
        places=CABLES,
        phrase="cable: stiffer when pulled",
        reference="Miermeister, Kraus, Lan, Pott 2015",
    ),
    tension=tension,
)
