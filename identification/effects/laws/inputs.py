"""Effects of a robot's inputs, step by step on their way to the model; u is held over a step h.

    delay        u(t - τ)                     τ = (n + f) h
                   m_k = (1 - f) u_(k-n) + f u_(k-n-1),  D_k = ½ f (1 - f) (u_(k-n) - u_(k-n-1))
    time shift   u(t - τ)                     the same, τ of either sign; u(0) before, u(T) after
    saturation   u + c (clip(u, ±u_max) - u)  c = 1 where there is a limit
    lag          τ ẋ = u - x                  c = x - u, s = τ/h, k = e^(-1/s)
                   m = u + c s (1 - k),  D = c s (s - (s + 1) k - ½ (1 - k)),  x(t + h) = u + c k
    gain drift   (1 - α t) u                  t: of the record, in the middle of the step

Before the first sample p u(0) comes: nothing (p = 0), or what had been there (p = 1). Mean m and
moment D of a step (see `identification.native.input_filter`) are exact for delay, shift and lag,
for every τ. Each function takes the state of an input and the effect's parameters, sizes first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, floor

import numpy as np
from numba import njit

from identification.effects.effect import Effect, places
from identification.effects.sizes import Shape, Size
from identification.errors import InputError
from identification.logs.log import Log
from identification.native.input_filter import past, shifted

# Of an input that comes late: its first value times this had been there before the log. It was
# mostly nothing or that value; whatever else it was costs one more number and no second search.
BEFORE = Shape("before", "", (0.0, 1.0), -2.0, 2.0, usual=0.0, of_log=True,
               about="share of the first value that had been there before the log")  # fmt: skip
SHIFT = 0.08  # largest shift of a record's clocks against each other, four cycles of 50 Hz [s]
SHIFTS = (1.0, 5.0, 20.0, -5.0, -20.0)  # of 2 ms, to try: a shift past a wave's half is not linear
LIMITS = (0.5, 0.6, 0.7, 0.8, 0.9, 0.97)  # to try, of the largest input


@njit
def delayed(s, p):
    tau, before = p
    if tau <= 0.0:
        return s.u, 0.0
    n = floor(tau / s.step)
    f = tau / s.step - n
    new, old = past(s, n, before), past(s, n + 1, before)
    return (1 - f) * new + f * old, f * (1 - f) / 2 * (new - old)


@njit
def time_shift(s, p):
    n = floor(p[0] / s.step)
    f = p[0] / s.step - n
    new, old = shifted(s, n), shifted(s, n + 1)
    return (1 - f) * new + f * old, f * (1 - f) / 2 * (new - old)


@njit
def lagged(s, p):
    tau = p[0]
    if tau <= 0.0:
        return s.u, 0.0
    c, r, keep = s.x - s.u, tau / s.step, exp(-s.step / tau)
    return s.u + c * r * (1 - keep), c * r * (r - (r + 1) * keep - (1 - keep) / 2)


@njit
def lag_start(s, p):
    return p[1] * s.u


@njit
def lag_next(s, p):
    keep = exp(-s.step / p[0])
    return (1 - keep) * s.u + keep * s.x


@njit
def clipped(s, p):
    c, u_max = p
    return s.u + c * (max(-u_max, min(u_max, s.u)) - s.u), 0.0


@njit
def drifting(s, p):
    return (1 - p[0] * s.time) * s.u, 0.0


DELAY = {"input": delayed}
LAG = {"input": lagged, "start": lag_start, "next": lag_next}


@dataclass(frozen=True)
class Drive:
    """An actuator and how far a log drives it."""

    actuator: str  # its name
    largest: float  # largest input [unit]
    unit: str = ""  # SI unit of the input, "" when not known

    def __post_init__(self) -> None:
        if not (np.isfinite(self.largest) and self.largest > 0):
            raise InputError(
                f"input {self.actuator!r} is {self.largest:g} at most; leave it out, or take a log"
                " that drives it"
            )


def drives(log: Log) -> tuple[Drive, ...]:
    """Returns the inputs of a log that are not zero throughout."""
    largest = np.abs(log.inputs).max(axis=0)
    return tuple(
        Drive(name, float(u), log.units.get(name, ""))
        for name, u in zip(log.input_names, largest, strict=True)
        if u > 0
    )


def input_effects(drives: Sequence[Drive]) -> tuple[Effect, ...]:
    """Returns all candidates of inputs of one unit, in the order in which an input passes them.

    What an amplifier limits is what its loop is asked for, so that a limit comes before a lag.
    A free swing has no input that moves, and so no candidate of an input.

    Args:
        drives: the inputs.
    """
    if not drives:
        return ()
    at = places("input", tuple(d.actuator for d in drives))
    u = max(d.largest for d in drives)
    limit = Shape("u_max", drives[0].unit, tuple(u * s for s in LIMITS), 0.05 * u, 2 * u,
                  about="the limit")  # fmt: skip
    share = Size("c", "", 1.0, 0.02, 1, "share of the clipping, 1 when there is a limit", 1.0)
    tau = "time constant"
    return (
        Effect("delay", "u(t - τ)", (Size("tau", "s", 0.02, 5e-4, 1, "delay"),), (BEFORE,),
               places=at, phrase="input: comes late", probes=(1.0, 40**0.5, 40.0), hooks=DELAY),
        Effect("time_shift", "u(t - τ), τ of each record's own, of either sign",
               (Size("tau", "s", SHIFT, 2e-3, 0, "how much later it acts than its stamps say"),),
               places=at, phrase="input: its time stamps are shifted", probes=SHIFTS, own=True,
               of_records="input: its time stamps are shifted", hooks={"input": time_shift}),
        Effect("saturation", "u clipped at ±u_max", (share,), (limit,), places=at,
               phrase="input: clipped", hooks={"input": clipped}),
        Effect("lag", "τ u̇' = u - u'", (Size("tau", "s", 0.01, 5e-4, 1, tau),), (BEFORE,),
               places=at, phrase="input: lags", probes=(1.0, 20**0.5, 20.0), hooks=LAG),
        Effect("gain_drift", "(1 - α t) u",
               (Size("alpha", "1/s", 0.01, 2e-4, about="relative loss a second"),), places=at,
               phrase="input: gain drifts", hooks={"input": drifting}),
    )  # fmt: skip
