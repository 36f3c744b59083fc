"""The search over the windows of a log, by Levenberg-Marquardt.

`search_windows` fits the parameters q and the initial states of all windows together: they share
one step and one damping. `search_states` fits the initial states alone. The windows are then
independent, and each has its own damping: where a joint sticks, the outputs hardly feel its rate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import Cost, Damping, levenberg_marquardt
from identification.estimation.options import Progress
from identification.windows.shooting import Shooting, Tangent, tangent

# relative to the squared norms of the columns of X and S
DAMPING = Damping(first=1e-2, raised=5.0, lowered=10.0, least=1e-12, floor=1e-12)
MOST_DAMPING = 1e8
# relative to the squared norms of the columns of X
DAMPING_OF_STATES = Damping(first=1e-9, raised=10.0, lowered=10.0, least=1e-9, floor=1e-9)
MOST_DAMPING_OF_STATES = 1e2
STEPS_OF_STATES = 20  # largest number of steps
ENDED_OF_STATES = 1e-3  # relative change of the mean squared error at which a window is finished


@dataclass(frozen=True)
class WindowsAtPoint:
    """The criterion of the parameters and the initial states, linearised at a point.

    Attributes:
        shooting: the windows.
        q: the parameters, shape (p,).
        d: changes of the initial states, shape (W, nx).
        tangent: the linearisation of the windows at q and d.
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
        """The step Δq (p,), which `after` clips to the bounds, and Δd (W, nx)."""
        return self.tangent.step(float(μ))

    def after(self, step: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """q, clipped to its bounds, and d after a step."""
        space = self.shooting.space
        return np.clip(self.q + step[0], space.lower, space.upper), self.d + step[1]

    def cost_after(self, step: tuple[np.ndarray, np.ndarray]) -> float:
        """The sum of squares after a step."""
        try:
            return float(np.sum(self.shooting.residual(*self.after(step)) ** 2))
        except InputError:  # the simulation diverged, or the robot has no such start
            return np.inf

    def bend(self, step: tuple[np.ndarray, np.ndarray], after: Cost, μ: Cost) -> None:
        """The steps are never bent."""

    def moved(self, step: tuple[np.ndarray, np.ndarray], taken: np.ndarray) -> WindowsAtPoint:
        """The criterion after a step."""
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
        at: the criterion at the last point.
        converged: false where the search ran out of linearisations or of damping.
        tangents: number of linearisations of all windows.
    """

    at: WindowsAtPoint
    converged: bool
    tangents: int


def search_windows(
    begun: WindowsAtPoint, tolerance: float, most: int, progress: Progress | None
) -> WindowsEnd:
    """Fit q and the initial states of all windows.

    Args:
        begun: the criterion where the search begins.
        tolerance: relative change of cost and of q at which the search stops.
        most: largest number of linearisations after the first.
        progress: receives one line per linearisation.
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
    """The criteria of the initial states alone, one per window; no parameter is free.

    Attributes:
        shooting: the windows.
        d: changes of the initial states, shape (W, nx).
        tangent: the linearisation of the windows at d.
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

    def bend(self, step: np.ndarray, after: Cost, μ: Cost) -> None:
        """The steps are never bent."""

    def moved(self, step: np.ndarray, taken: np.ndarray) -> EachWindow:
        """The criteria after a step of those windows that accept it."""
        part, d = self.shooting.rows(taken), self.d[taken] + step[taken]
        return self.with_rows(taken, EachWindow(part, d, tangent(part, np.zeros(0), d)))

    def rows(self, keep: np.ndarray) -> EachWindow:
        """Some of the windows, by mask or by index."""
        return EachWindow(self.shooting.rows(keep), self.d[keep], self.tangent.rows(keep))

    def with_rows(self, at: np.ndarray, other: EachWindow) -> EachWindow:
        """The same with other states of the windows `at`, a mask or indices."""
        d = np.array(self.d)
        d[at] = other.d
        return replace(self, d=d, tangent=self.tangent.with_rows(at, other.tangent))


def search_states(shooting: Shooting, d: np.ndarray) -> EachWindow:
    """Fit the initial state of each window, beginning with the changes d (W, nx).

    A window that is finished is no longer simulated.

    Returns:
        The windows at the fitted states, and their linearisation there.

    Raises:
        DivergenceError: the simulation of a window diverged.
    """
    at = EachWindow(shooting, d, tangent(shooting, np.zeros(0), d))
    part, going, μ = at, np.arange(len(d)), None
    enough = ENDED_OF_STATES * float(np.mean(at.cost))
    for _ in range(STEPS_OF_STATES):
        trial = next(levenberg_marquardt(part, EachWindow.moved, DAMPING_OF_STATES, μ))
        part, μ = trial.criterion, trial.next
        if trial.taken.any():
            at = at.with_rows(going, part)
        small = np.abs(trial.after - trial.before) <= enough
        keep = ~(small | (μ > MOST_DAMPING_OF_STATES))
        if not keep.any():
            break
        if not keep.all():
            part, going, μ = part.rows(keep), going[keep], μ[keep]
    return at
