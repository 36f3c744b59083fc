"""Changes of an input on its way to the model, step by step; u is held over a step h.

    delay        u(t - τ)                     τ = (n + f) h
                   m_k = (1 - f) u_(k-n) + f u_(k-n-1),  D_k = ½ f (1 - f) (u_(k-n) - u_(k-n-1))
    time shift   u(t - τ)                     the same, τ of either sign; u(0) before, u(T) after
    lag          τ ẋ = u - x                  c = x - u, s = τ/h, k = e^(-1/s)
                   m = u + c s (1 - k),  D = c s (s - (s + 1) k - ½ (1 - k)),  x(t + h) = u + c k
    saturation   u + c (clip(u, ±u_max) - u)  c = 1 where there is a limit
    gain drift   (1 - α t) u                  t: of the record, in the middle of the step

Before the first sample p u(0) comes: nothing (p = 0), or what had been there (p = 1). Mean m and
moment D of a step (see `identification.native.input_filter`) are exact for delay, shift and lag,
for every τ. Each function takes the state of an input and the effect's parameters, sizes first.
"""

from __future__ import annotations

from math import exp, floor

from numba import njit

from identification.native.input_filter import past, shifted


@njit
def delayed(s, p):  # type: ignore[no-untyped-def]
    """The input τ later: its mean over the step, and moment."""
    tau, before = p
    if tau <= 0.0:
        return s.u, 0.0
    n = floor(tau / s.step)
    f = tau / s.step - n
    new, old = past(s, n, before), past(s, n + 1, before)
    return (1 - f) * new + f * old, f * (1 - f) / 2 * (new - old)


@njit
def time_shift(s, p):  # type: ignore[no-untyped-def]
    """The input τ later, or earlier where τ < 0: its mean over the step, and moment."""
    n = floor(p[0] / s.step)
    f = p[0] / s.step - n
    new, old = shifted(s, n), shifted(s, n + 1)
    return (1 - f) * new + f * old, f * (1 - f) / 2 * (new - old)


@njit
def lagged(s, p):  # type: ignore[no-untyped-def]
    """The input through a first-order filter, whose state is x: mean over the step, and moment."""
    tau = p[0]
    if tau <= 0.0:
        return s.u, 0.0
    c, r, keep = s.x - s.u, tau / s.step, exp(-s.step / tau)
    return s.u + c * r * (1 - keep), c * r * (r - (r + 1) * keep - (1 - keep) / 2)


@njit
def lag_start(s, p):  # type: ignore[no-untyped-def]
    """x(0) = p u(0)."""
    return p[1] * s.u


@njit
def lag_next(s, p):  # type: ignore[no-untyped-def]
    """x(t + h) = u + c k."""
    keep = exp(-s.step / p[0])
    return (1 - keep) * s.u + keep * s.x


@njit
def clipped(s, p):  # type: ignore[no-untyped-def]
    """The input within ±u_max, as far as c says."""
    c, u_max = p
    return s.u + c * (max(-u_max, min(u_max, s.u)) - s.u), 0.0


@njit
def drifting(s, p):  # type: ignore[no-untyped-def]
    """The input of a drive whose gain falls with time."""
    return (1 - p[0] * s.time) * s.u, 0.0


DELAY = {"input": delayed}
LAG = {"input": lagged, "start": lag_start, "next": lag_next}
