"""Candidate effects of a robot's inputs; their laws are in `input_laws`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.effects.effect import BEFORE, Effect, Shape, Size
from identification.effects.input_laws import DELAY, LAG, clipped, drifting, time_shift
from identification.effects.places import places
from identification.errors import InputError
from identification.logs.log import Log

SHIFT = 0.08  # largest shift of a record's clocks against each other, four cycles of 50 Hz [s]
SHIFTS = (1.0, 5.0, 20.0, -5.0, -20.0)  # of 2 ms, to try: a shift past a wave's half is not linear
LIMITS = (0.5, 0.6, 0.7, 0.8, 0.9, 0.97)  # to try, of the largest input


@dataclass(frozen=True)
class Drive:
    """An actuator and how far a log drives it.

    Attributes:
        actuator: its name.
        largest: largest input [unit].
        unit: SI unit of the input, "" when not known.
    """

    actuator: str
    largest: float
    unit: str = ""

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
               places=at, phrase="input: its clock is not the outputs'", probes=SHIFTS, own=True,
               hooks={"input": time_shift}),
        Effect("saturation", "u clipped at ±u_max", (share,), (limit,), places=at,
               phrase="input: clipped", hooks={"input": clipped}),
        Effect("lag", "τ u̇' = u - u'", (Size("tau", "s", 0.01, 5e-4, 1, tau),), (BEFORE,),
               places=at, phrase="input: lags", probes=(1.0, 20**0.5, 20.0), hooks=LAG),
        Effect("gain_drift", "(1 - α t) u",
               (Size("alpha", "1/s", 0.01, 2e-4, about="relative loss a second"),), places=at,
               phrase="input: gain drifts", hooks={"input": drifting}),
    )  # fmt: skip
