"""The laws of the effects with states of their own: the numbers of a joint's gear and grip.

    series   (c, ε, J, ζ, side)     of the motor behind the gear: compliance, half the gap, inertia,
                                    damping ratio, and where the encoder sits (1: motor, 0: link)
    slip     c                      compliance of the friction before it slips

J = ρ I, I being the inertia that the joint's drive feels. What these numbers do is said by
`identification.native.joint_states`; with sizes of zero they do nothing. Sources: Spong (1987) for
elastic joints, Nordin and Gutman (2002) for gaps, Dahl (1968) for presliding.
"""

from __future__ import annotations

from numba import njit


@njit
def joint_elasticity(s, p):  # type: ignore[no-untyped-def]
    """c, with the motor's share ρ, its damping ratio and its encoder."""
    c, rho, zeta, link = p
    return c, 0.0, rho * s.inertia, zeta, 1.0 - link


@njit
def gear_backlash(s, p):  # type: ignore[no-untyped-def]
    """ε, with the motor's share ρ and its encoder; the teeth are stiff and hardly rebound."""
    eps, rho, link = p
    return 0.0, eps, rho * s.inertia, 0.0, 1.0 - link


@njit
def presliding(s, p):  # type: ignore[no-untyped-def]
    """c = 1/σ."""
    return p[0]
