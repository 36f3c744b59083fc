"""The sampling times T that fit stamps to within their quanta: |t_k - t_0 - k T| <= q_k/2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.logs.quanta import quanta_of
from identification.logs.sampling import JITTER, FloatArray, float_resolution, off_grid

COARSE = 0.5  # of a step: from there the rounding of stamps merges rows and makes gaps
EXACT = 1e-3  # relative, to which the step must be known: values follow its square


@dataclass(frozen=True)
class Stamps:
    """Stamps and what is known of their grid.

    Attributes:
        time: the stamps, shape (n,) [s], none smaller than the one before.
        quanta: quantum of each stamp, shape (n,) [s].
        steps: smallest and largest sampling time that fits all rows [s]; None where none does.
    """

    time: FloatArray
    quanta: FloatArray
    steps: tuple[float, float] | None

    @property
    def mean(self) -> float:
        """The mean step [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    @property
    def is_coarse(self) -> bool:
        """Whether rounding alone may merge rows or make gaps."""
        return bool(self.quanta.max() > COARSE * self.mean)

    @property
    def tick(self) -> float:
        """The coarsest quantum [s], as it shows between stamps that follow each other."""
        return min(float(self.quanta.max()), float(np.diff(self.time).max()))

    def is_exact(self, within: float = EXACT) -> bool:
        """Returns whether one sampling time fits, and is known well enough."""
        return self.steps is not None and self.steps[1] - self.steps[0] <= within * self.steps[1]


def judged(time: FloatArray) -> Stamps:
    """Returns stamps with their quanta and the sampling times that fit them.

    Args:
        time: stamps, shape (n,) [s], none smaller than the one before.
    """
    quanta = quanta_of(time)
    mean = float(time[-1] - time[0]) / (len(time) - 1)
    return Stamps(time, quanta, _fitting_steps(time, quanta / 2 + JITTER * mean))


def fits(time: FloatArray, width: FloatArray, step: float) -> bool:
    """Returns whether some grid of a step comes as near to all stamps as they allow.

    Args:
        time: stamps, shape (n,) [s].
        width: how far each may be off the grid, shape (n,) [s].
        step: of the grid [s].
    """
    off = off_grid(time, step)
    return bool(np.max(off - width) <= np.min(off + width) + float_resolution(time))


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
