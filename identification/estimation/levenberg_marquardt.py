"""The descent of Levenberg and Marquardt, one for all searches that linearise by themselves.

    δ(μ) = argmin ‖r - F δ‖² + μ ‖D δ‖²,      D: norms of F's columns
    taken if ‖r(q ⊕ δ)‖² < ‖r(q)‖², and μ ← μ/lowered;   else μ ← raised μ, and F stays

A criterion knows q, r and F, how a step is found and kept inside its bounds, and what r is
elsewhere. It may bend a step that falls short of what F promised, to follow a curved valley; of
the two, the one that falls further is tried.
Criteria that do not depend on one another, such as the windows of a log, descend together: cost
and μ are then arrays, and each takes its own steps. The caller sees every trial and decides when
it is enough.

Source: Marquardt (1963); Moré (1978); for bent steps Transtrum and Sethna (2012).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

import numpy as np

Step = TypeVar("Step")
Cost = float | np.ndarray  # of one criterion, or of W that descend together, shape (W,)


class Criterion(Protocol[Step]):
    """Sums of squares, linearised at a point."""

    @property
    def cost(self) -> Cost:
        """‖r‖² at the point."""

    def step(self, μ: Cost) -> Step:
        """δ(μ), inside the bounds."""

    def cost_after(self, step: Step) -> Cost:
        """‖r‖² after a step; infinite where nothing can be simulated."""

    def bent(self, step: Step, after: Cost, μ: Cost) -> Step | None:
        """A step that follows the valley; None where the step is good enough, or it cannot say."""


Linearised = TypeVar("Linearised", bound=Criterion)


@dataclass(frozen=True)
class Damping:
    """How μ follows the steps.

    Attributes:
        first: μ of the first step.
        raised: factor after a step that failed.
        lowered: divisor after a step that was taken.
        least: smallest μ but `silent`.
        silent: μ where it would fall below the least: the least itself, or 0 for plain
            Gauss-Newton steps.
    """

    first: float
    raised: float
    lowered: float
    least: float
    silent: float

    def next(self, μ: np.ndarray, taken: np.ndarray) -> np.ndarray:
        """μ of the next step."""
        low, high = μ / self.lowered, np.maximum(self.raised * μ, self.least)
        return np.where(taken, np.where(low < self.least, self.silent, low), high)


@dataclass(frozen=True, kw_only=True)
class Trial(Generic[Linearised, Step]):
    """A step that was tried.

    Attributes:
        criterion: linearised where the search now is.
        step: what was tried.
        before: cost before it.
        after: cost after it.
        taken: whether it was, of each criterion.
        μ: with which it was tried.
        next: μ of the next.
    """

    criterion: Linearised
    step: Step
    before: np.ndarray
    after: np.ndarray
    taken: np.ndarray
    μ: np.ndarray
    next: np.ndarray


def levenberg_marquardt(
    criterion: Linearised,
    move: Callable[[Linearised, Step, np.ndarray], Linearised],
    damping: Damping,
) -> Iterator[Trial[Linearised, Step]]:
    """The trials of a descent, without an end: the caller takes as many as it wants.

    Args:
        criterion: linearised where the search begins.
        move: linearises it anew after a step, of those of its criteria that take it.
        damping: how μ follows the steps.
    """
    μ = np.full(np.shape(criterion.cost), damping.first)
    while True:
        before = np.asarray(criterion.cost)
        step = criterion.step(μ)
        after = np.asarray(criterion.cost_after(step))
        bent = criterion.bent(step, after, μ)
        if bent is not None:
            other = np.asarray(criterion.cost_after(bent))
            if np.all(other < after):
                step, after = bent, other
        taken = np.asarray(after < before)
        following = damping.next(μ, taken)
        if taken.any():
            criterion = move(criterion, step, taken)
        yield Trial(
            criterion=criterion, step=step, before=before, after=after, taken=taken,
            μ=μ, next=following,
        )  # fmt: skip
        μ = following
