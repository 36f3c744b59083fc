"""The laws of effects of joints that change with time t of the record.

    r(x) = clip(½ + x/w, 0, 1)                  from none to all within w about x = 0

    b = + f_t t                                 Coulomb friction that drifts
        + f_j r(t - t_j)                        ... that jumps
    f = - d_t t v                               viscous friction that drifts
        - d_j r(t - t_j) v                      ... that jumps
        + f_p (r(t - t_0) - r(t - t_0 - t_p))   a push that begins and ends

b: largest friction, f: force (see `identification.effects.joint_laws`). A jump takes a short time w
so that the outputs follow its time smoothly, and its time can be searched.
"""

from __future__ import annotations

from numba import njit


@njit
def risen(x, w):  # type: ignore[no-untyped-def]
    """Returns how much of a change that takes w about x = 0 has happened at x, 0 to 1."""
    return min(1.0, max(0.0, 0.5 + x / w))


@njit
def friction_drift(s, p):  # type: ignore[no-untyped-def]
    """f_t t."""
    return p[0] * s.time


@njit
def friction_jump(s, p):  # type: ignore[no-untyped-def]
    """f_j r(t - t_j)."""
    f_j, t_j, w = p
    return f_j * risen(s.time - t_j, w)


@njit
def viscous_friction_drift(s, p):  # type: ignore[no-untyped-def]
    """-d_t t v."""
    return -p[0] * s.time * s.v


@njit
def viscous_friction_jump(s, p):  # type: ignore[no-untyped-def]
    """-d_j r(t - t_j) v."""
    d_j, t_j, w = p
    return -d_j * risen(s.time - t_j, w) * s.v


@njit
def push(s, p):  # type: ignore[no-untyped-def]
    """f_p (r(t - t_0) - r(t - t_0 - t_p))."""
    f_p, t_0, t_p, w = p
    return f_p * (risen(s.time - t_0, w) - risen(s.time - t_0 - t_p, w))
