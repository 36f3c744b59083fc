"""Errors that an encoder may add to its reading y of a joint at position q with rate v.

    scale           s y                     its counts are not what they are taken for
    offset          c                       its zero is not the joint's
    eccentricity    a cos q + b sin q       its disc turns about another centre
    lag             x - q, τ ẋ = q - x      kind 0: it is filtered
                    q(t - τ) - q            kind 1: it is read or sent too late
    jump            c where t ≥ t_s         counts are lost, within the time w about t_s

Each function takes the state of a sensor (see `identification.native.reading.Reading`) and the
effect's parameters, sizes first.
"""

from __future__ import annotations

from math import cos, sin

from numba import njit

from identification.native.reading import lagged_position, position_at


@njit
def encoder_scale(s, p):  # type: ignore[no-untyped-def]
    """s y."""
    return p[0] * s.y


@njit
def encoder_offset(s, p):  # type: ignore[no-untyped-def]
    """c."""
    return p[0]


@njit
def encoder_eccentricity(s, p):  # type: ignore[no-untyped-def]
    """a cos q + b sin q."""
    return p[0] * cos(s.q) + p[1] * sin(s.q)


@njit
def encoder_lag(s, p):  # type: ignore[no-untyped-def]
    """x - q with τ ẋ = q - x, or q(t - τ) - q; a negative τ is always a time."""
    tau, kind = p
    if kind == 0.0 and tau > 0.0:
        return lagged_position(s, tau) - s.q
    return position_at(s, s.time - tau) - s.q


@njit
def encoder_jump(s, p):  # type: ignore[no-untyped-def]
    """c from the time t_s on, as a ramp that takes the time w."""
    return p[0] * min(1.0, max(0.0, 0.5 + (s.time - p[1]) / p[2]))
