"""The Levenberg-Marquardt method, for every search that linearises its criterion by itself.

    δ(μ) = argmin ‖r - F δ‖² + μ ‖D δ‖²,      D: norms of the columns of F
    if ‖r(q ⊕ δ)‖² < ‖r(q)‖²:  q ← q ⊕ δ, F anew, μ ← μ / 10
    else:                        μ ← raised μ

A criterion knows q, r and F, computes its step within the bounds, and evaluates its cost after a
step. A criterion whose valleys are curved may also bend a step whose gain is less than expected;
the bent step is used where its cost is lower. Criteria that are independent of each other, such as
the initial states of the windows of a log, descend together: cost and μ are then arrays, and each
criterion accepts or rejects its own step. The caller receives every trial and decides when to stop.

Source: Marquardt (1963); Moré (1978); for bent steps Transtrum and Sethna (2012).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Generic, Protocol, Self, TypeVar

import numpy as np

# Of the gain that a linearisation promises: a step that keeps less shows that it does not serve.
KEPT_GAIN = 0.5
# Relative error of slopes: a step of Gauss and Newton then misses a hundredth of what it can gain.
SLOPE_ERROR = 0.1
LOWERED = 10.0  # divisor of μ after a step that was accepted (Marquardt 1963)

Step = TypeVar("Step")
Cost = float | np.ndarray  # of one criterion, or of W independent ones, shape (W,)


class Criterion(Protocol[Step]):
    """A sum of squares that is linearised at a point, or several independent ones."""

    @property
    def cost(self) -> Cost:
        """‖r‖² at the point."""

    def step(self, μ: Cost) -> Step:
        """Returns the step δ(μ) within the bounds."""

    def cost_after(self, step: Step) -> Cost:
        """Returns ‖r‖² after a step; infinite where the plant cannot be simulated."""

    def bend(self, step: Step, after: Cost, μ: Cost) -> Step | None:
        """Returns the step with a second-order correction; None where the step stays as it is.

        Args:
            step: δ(μ).
            after: ‖r‖² after it.
            μ: the damping of the step.
        """
        return None

    def apart(self, step: Step, μ: Cost, raised: float) -> Cost:
        """Returns the damping, μ or larger, whose step is not the one that was just rejected.

        Args:
            step: the one that was rejected.
            μ: the damping that would be next.
            raised: the factor by which it is raised.
        """
        return μ

    def moved(self, step: Step, taken: np.ndarray) -> Self:
        """Returns the criterion linearised after a step of those criteria that accept it."""


Linearised = TypeVar("Linearised", bound=Criterion[Any])


@dataclass(frozen=True)
class Damping:
    """The rule by which the damping μ changes from step to step."""

    first: float  # μ of the first step; where it is 0, steps are undamped until one is rejected
    raised: float  # factor of μ after a step that was rejected
    least: float  # smallest positive μ

    def next(self, μ: np.ndarray, taken: np.ndarray) -> np.ndarray:
        """Returns μ of the next step, elementwise, from the last μ and whether it was accepted."""
        low, high = μ / LOWERED, np.maximum(self.raised * μ, self.least)
        floor = self.least if self.first else 0.0
        return np.where(taken, np.where(low < self.least, floor, low), high)


@dataclass(frozen=True, kw_only=True)
class Trial(Generic[Linearised]):
    """One trial step of a descent; arrays have the shape of the criterion's cost."""

    criterion: Linearised  # the criterion, linearised at the point after the trial
    step: Any  # the step that was tried
    before: np.ndarray  # cost before the step
    after: np.ndarray  # cost after the step
    taken: np.ndarray  # true where the step was accepted
    μ: np.ndarray  # damping of the step
    next: np.ndarray  # damping of the next step


def levenberg_marquardt(
    criterion: Linearised, damping: Damping, μ: Cost | None = None
) -> Iterator[Trial[Linearised]]:
    """Yields the trials of a descent; the iterator never ends by itself.

    Args:
        criterion: the criterion, linearised where the search begins.
        damping: how μ changes.
        μ: of the first step; `damping.first` when None.
    """
    μ = np.full(np.shape(criterion.cost), damping.first) if μ is None else np.asarray(μ)
    while True:
        before = np.asarray(criterion.cost)
        step = criterion.step(μ)
        after = np.asarray(criterion.cost_after(step))
        bent = criterion.bend(step, after, μ)
        if bent is not None:
            other = np.asarray(criterion.cost_after(bent))
            if np.all(other < after):
                step, after = bent, other
        taken = np.asarray(after < before)
        following = damping.next(μ, taken)
        if taken.any():
            criterion = criterion.moved(step, taken)
        else:
            following = np.asarray(criterion.apart(step, following, damping.raised))
        yield Trial(
            criterion=criterion, step=step, before=before, after=after, taken=taken,
            μ=μ, next=following,
        )  # fmt: skip
        μ = following
