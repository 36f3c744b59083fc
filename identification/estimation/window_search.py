"""The search over the windows of a log: for parameters and states, or for the states alone.

All windows have one q, so that their steps are one step and share one μ. Where nothing but their
states is free, each window has a damping of its own: where a joint sticks, its first rate is
hardly felt.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import Cost, Damping, levenberg_marquardt
from identification.estimation.options import Progress
from identification.estimation.shooting import Shooting, Tangent, tangent

# of the squared norms of X's and S's columns
DAMPING = Damping(first=1e-2, raised=5.0, lowered=10.0, least=1e-12, silent=1e-12)
MOST_DAMPING = 1e8
# of the squared norms of X's columns
DAMPING_OF_STATES = Damping(first=1e-9, raised=10.0, lowered=10.0, least=1e-9, silent=1e-9)
MOST_DAMPING_OF_STATES = 1e2
STEPS_OF_STATES = 20  # at most
ENDED_OF_STATES = 1e-3  # of the mean squared error: a window that changes by less is at its best


@dataclass(frozen=True)
class WindowsAtPoint:
    """The criterion of parameters and states together.

    Attributes:
        shooting: the windows.
        q: parameters, shape (p,).
        d: moves of the states, shape (W, nx).
        tangent: the windows linearised there.
    """

    shooting: Shooting
    q: np.ndarray
    d: np.ndarray
    tangent: Tangent

    @property
    def cost(self) -> float:
        """The sum of squares of all windows."""
        return float(np.sum(self.tangent.r**2))

    def step(self, μ: Cost) -> tuple[np.ndarray, np.ndarray]:
        """Δq (p,), which may lead out of its bounds, and Δd (W, nx)."""
        return self.tangent.step(float(μ))

    def after(self, step: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """q, which ends at its bounds, and d after a step."""
        space = self.shooting.space
        return np.clip(self.q + step[0], space.lower, space.upper), self.d + step[1]

    def cost_after(self, step: tuple[np.ndarray, np.ndarray]) -> float:
        """The sum of squares after a step."""
        try:
            return float(np.sum(self.shooting.residual(*self.after(step)) ** 2))
        except InputError:  # it diverged, or has no start: it must go elsewhere
            return np.inf

    def bent(self, step: tuple[np.ndarray, np.ndarray], after: Cost, μ: Cost) -> None:
        """Steps are straight."""

    def moved(self, step: tuple[np.ndarray, np.ndarray], taken: np.ndarray) -> WindowsAtPoint:
        """Linearised after a step."""
        return windows_at(self.shooting, *self.after(step))


def windows_at(shooting: Shooting, q: np.ndarray, d: np.ndarray) -> WindowsAtPoint:
    """All windows, linearised at q (p,) and d (W, nx).

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    return WindowsAtPoint(shooting, q, d, tangent(shooting, q, d))


@dataclass(frozen=True)
class WindowsEnd:
    """Where a search ended.

    Attributes:
        at: the windows there.
        converged: whether it ended by itself.
        tangents: how often all windows were linearised.
    """

    at: WindowsAtPoint
    converged: bool
    tangents: int


def search_windows(
    begun: WindowsAtPoint, tolerance: float, most: int, progress: Progress | None
) -> WindowsEnd:
    """Search q and the states of all windows.

    Args:
        begun: where.
        tolerance: relative change of cost and of q at which the search stops.
        most: linearisations of the windows, at most, beside the first.
        progress: is told one line per linearisation.
    """
    at, tangents = begun, 1
    trials = levenberg_marquardt(begun, WindowsAtPoint.moved, DAMPING)
    _tell(at, tangents, progress)
    while True:
        trial = next(trials)
        if not trial.taken:
            if trial.μ > MOST_DAMPING or np.abs(trial.step[0]).max() < tolerance:
                return WindowsEnd(at, bool(trial.μ <= MOST_DAMPING), tangents)
            continue
        before, at, tangents = at, trial.criterion, tangents + 1
        gain = trial.before - trial.after
        small = np.abs(at.q - before.q).max() < tolerance or gain < tolerance * trial.before
        if small or tangents > most:
            return WindowsEnd(at, bool(small), tangents)
        _tell(at, tangents, progress)


def _tell(at: WindowsAtPoint, tangents: int, progress: Progress | None) -> None:
    if progress is not None:
        rms = float(np.sqrt(np.mean(at.shooting.error(at.tangent.r) ** 2)))
        progress(f"windows: rms {rms:.4g} after {tangents} linearisations")


@dataclass(frozen=True)
class EachWindow:
    """The criteria of the states alone, each window by itself, where no parameter is free.

    Attributes:
        shooting: the windows.
        d: moves of the states, shape (W, nx).
        tangent: the windows linearised there.
    """

    shooting: Shooting
    d: np.ndarray
    tangent: Tangent

    @property
    def cost(self) -> np.ndarray:
        """Sums of squares, shape (W,)."""
        return np.sum(self.tangent.r**2, axis=1)

    def step(self, μ: Cost) -> np.ndarray:
        """Δd, shape (W, nx)."""
        at = self.tangent
        damping = np.asarray(μ)[:, None]
        along = np.einsum("wmk,wm->wk", at.U, at.r) * at.s / (at.s**2 + damping)
        return np.einsum("wkx,wk->wx", at.Vt, along) / at.size

    def cost_after(self, step: np.ndarray) -> np.ndarray:
        """Sums of squares after a step, shape (W,)."""
        try:
            return np.sum(self.shooting.residual(np.zeros(0), self.d + step) ** 2, axis=1)
        except DivergenceError:
            return np.full(len(self.d), np.inf)

    def bent(self, step: np.ndarray, after: Cost, μ: Cost) -> None:
        """Steps are straight."""

    def moved(self, step: np.ndarray, taken: np.ndarray) -> EachWindow:
        """Linearised after a step of those windows that take it."""
        d = np.where(taken[:, None], self.d + step, self.d)
        return replace(self, d=d, tangent=tangent(self.shooting, np.zeros(0), d))


def search_states(shooting: Shooting, d: np.ndarray) -> Tangent:
    """The windows linearised at the states that explain each best, from moves d (W, nx) on.

    Raises:
        DivergenceError: a window left the finite numbers at the start.
    """
    at = EachWindow(shooting, d, tangent(shooting, np.zeros(0), d))
    trials = levenberg_marquardt(at, EachWindow.moved, DAMPING_OF_STATES)
    for trial in islice(trials, STEPS_OF_STATES):
        at = trial.criterion
        small = np.abs(trial.after - trial.before) <= ENDED_OF_STATES * trial.before.mean()
        if np.all(small | (trial.next > MOST_DAMPING_OF_STATES)):
            break
    return at.tangent
