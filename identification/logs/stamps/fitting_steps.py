"""Stamps that lost digits: their quanta, the sampling times that fit them, and missing rows.

    |t_k - t_0 - k T| <= q_k/2   T fits: some grid of step T comes as near to each stamp as its
                                 quantum q_k allows
    q_k = 10^-d                  where stamps are multiples of it, in each decade
    q_k = tick (+ 10^-d)         where rows share stamps: the clock ticks slower than rows come, so
                                 that stamps which follow each other are one tick apart
    o_k = t_k - t_0 - k T        jumps ahead where rows are missing, by their number times T; a T
                                 that is too large lets it fall behind, which no missing row does

A tick that is no multiple of the last digit, such as 15.625 ms printed as 0.0156, 0.0313, ...,
makes steps that differ by that digit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.logs.sampling import (
    JITTER,
    MIN_ROWS,
    FloatArray,
    float_resolution,
    off_grid,
)

DECIMALS = range(-3, 13)
GAP = 1.5  # times the usual step of the stamps: from there a tick is missing between two of them
COARSE = 0.5  # of a step: from there the rounding of stamps merges rows and makes gaps
EXACT = 1e-3  # relative, to which the step must be known: values follow its square
FEW_PLACES = 2  # places where rows are missing, of any length
# Of the rows, that may be missing in more places: a wrong step looks like these, too.
MOST_MISSING = 0.05


@dataclass(frozen=True)
class Stamps:
    """Stamps and what is known of their grid."""

    time: FloatArray  # the stamps, shape (n,) [s], none smaller than the one before
    quanta: FloatArray  # quantum of each stamp, shape (n,) [s]
    steps: tuple[float, float] | None  # least and largest T that fits all rows [s], if one does

    @property
    def mean(self) -> float:
        """The mean step [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @property
    def is_coarse(self) -> bool:
        """Returns whether rounding alone may merge rows or make gaps."""
        return bool(self.quanta.max() > COARSE * self.mean)

    @property
    def tick(self) -> float:
        """The coarsest quantum [s], as it shows between stamps that follow each other."""
        return min(float(self.quanta.max()), float(np.diff(self.time).max()))


def judged(time: FloatArray) -> Stamps:
    """Returns stamps (n,) [s], none smaller than the one before, with what tells their grid."""
    quanta = quanta_of(time)
    mean = float(time[-1] - time[0]) / (len(time) - 1)
    return Stamps(time, quanta, _fitting_steps(time, quanta / 2 + JITTER * mean))


def fits(time: FloatArray, width: FloatArray, step: float) -> bool:
    """Returns whether a grid of a step [s] is as near to stamps (n,) [s] as a width (n,) allows."""
    off = off_grid(time, step)
    return bool(np.max(off - width) <= np.min(off + width) + float_resolution(time))


def missing_rows(time: FloatArray, width: FloatArray, step: float) -> list[tuple[int, int]]:
    """Finds the places where missing rows explain that a step does not fit all stamps.

    Stamps (n,) may each be off a grid of this step by a width (n,), all in [s].

    Returns:
        The first row behind each place, and how many rows are missing there, give or take what a
        quantum hides; nothing where missing rows do not explain it.
    """
    off = off_grid(time, step)
    low, high, least = off - width, off + width, float_resolution(time)
    begins, middles = [0], []
    while True:
        begin = begins[-1]
        lowest = np.maximum.accumulate(low[begin:])
        highest = np.minimum.accumulate(high[begin:])
        bad = np.flatnonzero(~(lowest <= highest + least))
        end = int(bad[0]) if bad.size else len(lowest)
        if end < MIN_ROWS:
            return []
        middles.append(float(lowest[end - 1] + highest[end - 1]) / 2)
        if not bad.size:
            break
        begins.append(begin + end)
    counts = np.rint(np.diff(middles) / step).astype(int).tolist()
    if not counts or min(counts) < 1:
        return []
    if len(counts) > FEW_PLACES and sum(counts) > MOST_MISSING * len(time):
        return []
    return [*zip(begins[1:], counts, strict=True)]


def quanta_of(time: FloatArray) -> FloatArray:
    """Returns the quantum of each stamp (n,) [s], none of them smaller than the one before.

    "%g" prints larger stamps with fewer decimals, so that each decade has a quantum of its own, and
    none a larger one than the decade above it. Where rows share stamps, a clock ticks slower than
    they come, and all steps are multiples of its tick; without such rows even sampling itself makes
    all steps multiples of one.
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
    """Returns a tick with what digits it lost [s]; zero where the steps [s] show none.

    Ticks differ by one printed digit at most. Rounding alone puts stamps that rows share one digit
    apart, so that a tick must be two digits at least.
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


def _fitting_steps(time: FloatArray, width: FloatArray) -> tuple[float, float] | None:
    """Returns the smallest and the largest step of a grid that comes near enough to all stamps.

    Two rows bound the step: each bound is put in the place of the step until no two rows object.
    """
    k, t, least = np.arange(len(time)), time - time[0], float_resolution(time)
    low, high = t - width, t + width

    def bound(step: float, is_lower: bool) -> float | None:
        for _ in range(len(time)):
            i, j = int(np.argmax(low - step * k)), int(np.argmin(high - step * k))
            if low[i] - high[j] - step * (i - j) <= least:
                return step
            if i == j or (i > j) != is_lower:
                return None
            step = float((low[i] - high[j]) / (i - j))
        return None

    first = bound(float((low[-1] - high[0]) / k[-1]), is_lower=True)
    last = bound(float((high[-1] - low[0]) / k[-1]), is_lower=False)
    if first is None or last is None or not 0 < first <= last:
        return None
    return first, last
