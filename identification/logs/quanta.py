"""The quantum of each stamp of a log: its last printed digit, or the tick of its clock.

    q_k = 10^-d                  where stamps are multiples of it, in each decade
    q_k = tick (+ 10^-d)         where rows share stamps: the clock ticks slower than rows come, so
                                 that stamps which follow each other are one tick apart

A tick that is no multiple of the last digit, such as 15.625 ms printed as 0.0156, 0.0313, ...,
makes steps that differ by that digit.
"""

from __future__ import annotations

import numpy as np

from identification.logs.sampling import FloatArray, float_resolution

DECIMALS = range(-3, 13)
GAP = 1.5  # times the usual step of the stamps: from there a tick is missing between two of them


def quanta_of(time: FloatArray) -> FloatArray:
    """Returns the quantum of each stamp, shape (n,) [s].

    "%g" prints larger stamps with fewer decimals, so that each decade has a quantum of its own,
    and none a larger one than the decade above it. Where rows share stamps, a clock ticks slower
    than they come, and all steps are multiples of its tick; without such rows even sampling itself
    makes all steps multiples of one.

    Args:
        time: stamps, shape (n,) [s], none smaller than the one before.
    """
    size = np.abs(time)
    decade = np.floor(np.log10(np.where(size > 0, size, np.inf), where=size > 0,
                               out=np.full(len(time), -np.inf)))  # fmt: skip
    quanta, above = np.empty(len(time)), np.inf
    for each in np.unique(decade)[::-1]:
        rows = decade == each
        above = min(above, _decimal(time[rows]))
        quanta[rows] = above
    steps, finest, least = np.diff(time), float(quanta.min()), float_resolution(time)
    if np.any(steps == 0):
        if finest > least:
            ticks = np.rint(steps / finest).astype(np.int64)
            quanta = np.maximum(quanta, finest * np.gcd.reduce(ticks))
        quanta = np.maximum(quanta, _printed_tick(steps, max(finest, least)))
    return np.maximum(quanta, least)


def _printed_tick(steps: FloatArray, digit: float) -> float:
    """Returns a tick with what digits it lost [s]; zero where the stamps show none.

    Ticks differ by one digit at most. Rounding alone puts stamps that rows share one digit apart,
    so that a tick must be two digits at least.

    Args:
        steps: of the stamps [s], some of them zero.
        digit: the last one that is printed [s].
    """
    apart = steps[steps > 0]
    if not apart.size:
        return 0.0
    each = apart[apart < GAP * np.median(apart)]
    spread = float(np.ptp(each))
    if spread > 1.5 * digit or each.min() < 1.5 * digit:
        return 0.0
    return float(each.mean()) + (digit if spread > 0.5 * digit else 0.0)


def _decimal(time: FloatArray) -> float:
    """Returns the largest decimal step [s] of which stamps are multiples; zero where none is."""
    spacing = float_resolution(time)
    for decimals in DECIMALS:
        scaled = time * 10.0**decimals
        tolerance = max(1e-6, spacing * 10.0**decimals)
        if tolerance < 0.1 and np.all(np.abs(scaled - np.rint(scaled)) <= tolerance):
            return float(10.0**-decimals)
    return 0.0
