"""The search over the windows of a log, by Levenberg-Marquardt.

The parameters q and the initial states of all windows are fitted together: they share one step and
one damping. `identification.windows.settling` fits the initial states alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.estimation.levenberg_marquardt import Cost, Damping, levenberg_marquardt
from identification.estimation.options import Progress
from identification.progress import Advance, stage
from identification.windows.shooting import Shooting, tangent
from identification.windows.tangents import Tangent

# relative to the squared norms of the columns of X and S
DAMPING = Damping(first=1e-2, raised=5.0, lowered=10.0, least=1e-12, floor=1e-12)
MAX_SEARCH_DAMPING = 1e8  # beyond it a search has ended


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
        """Returns the step Δq (p,), which `after` clips to the bounds, and Δd (W, nx)."""
        return self.tangent.step(float(μ))

    def after(self, step: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Returns q, clipped to its bounds, and d after a step."""
        space = self.shooting.space
        return np.clip(self.q + step[0], space.lower, space.upper), self.d + step[1]

    def cost_after(self, step: tuple[np.ndarray, np.ndarray]) -> float:
        """Returns the sum of squares after a step."""
        try:
            return float(np.sum(self.shooting.residual(*self.after(step)) ** 2))
        except InputError:  # the simulation diverged, or the robot has no such start
            return np.inf

    def bend(self, step: tuple[np.ndarray, np.ndarray], after: Cost, μ: Cost) -> None:
        """Does nothing: the steps are never bent."""

    def moved(self, step: tuple[np.ndarray, np.ndarray], taken: np.ndarray) -> WindowsAtPoint:
        """Returns the criterion after a step."""
        return windows_at(self.shooting, *self.after(step))


def windows_at(shooting: Shooting, q: np.ndarray, d: np.ndarray) -> WindowsAtPoint:
    """Returns all windows, linearised at q (p,) and d (W, nx).

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    return WindowsAtPoint(shooting, q, d, tangent(shooting, q, d))


@dataclass(frozen=True)
class WindowsEnd:
    """The end of a search.

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
    with stage("steps of a fit") as advance:
        return _search(begun, tolerance, most, progress, advance)


def _search(
    begun: WindowsAtPoint, tolerance: float, most: int, progress: Progress | None, advance: Advance
) -> WindowsEnd:
    at, tangents = begun, 1
    trials = levenberg_marquardt(begun, WindowsAtPoint.moved, DAMPING)
    _tell(at, tangents, progress)
    while True:
        trial = next(trials)
        if not trial.taken:
            if trial.μ > MAX_SEARCH_DAMPING or np.abs(trial.step[0]).max() < tolerance:
                return WindowsEnd(at, bool(trial.μ <= MAX_SEARCH_DAMPING), tangents)
            continue
        before, at, tangents = at, trial.criterion, tangents + 1
        advance()
        gain = trial.before - trial.after
        small = np.abs(at.q - before.q).max() < tolerance or gain < tolerance * trial.before
        if small or tangents > most:
            return WindowsEnd(at, bool(small), tangents)
        _tell(at, tangents, progress)


def _tell(at: WindowsAtPoint, tangents: int, progress: Progress | None) -> None:
    if progress is not None:
        rms = float(np.sqrt(np.mean(at.shooting.error(at.tangent.r) ** 2)))
        progress(f"windows: rms {rms:.4g} after {tangents} linearisations")
