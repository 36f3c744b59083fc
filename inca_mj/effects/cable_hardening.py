"""Hardening cable: braids stiffen as they are pulled."""

from numba import njit

from identification.effect import Effect, Size
from inca_mj.effects.hooks import DriveEffect
from inca_mj.effects.places import CABLES


@njit
def tension(s, p):  # type: ignore[no-untyped-def]
    """ΔT = λ κ ε² of a taut cable [N]: λ ε (1 + κ ε) in all."""
    return s.lambda_ * p[0] * max(0.0, s.strain) ** 2


CABLE_HARDENING = DriveEffect(
    Effect(
        "cable_hardening",
        "λ ε (1 + κ ε)",
        (Size("kappa", "", 2000.0, 200.0, sign=1, about="growth of the stiffness per strain"),),
        places=CABLES,
        phrase="cable: stiffer when pulled",
        reference="Miermeister, Kraus, Lan, Pott 2015",
    ),
    tension=tension,
)
