"""The criteria of the initial states of windows whose parameters are held, one per window.

    δ_w(μ) = argmin ‖r_w - X_w δ‖² + μ ‖D δ‖²,      D: norms of the columns of X_w

Slopes cost as many simulations as a window has states, and change little from step to step: a
window keeps them as long as its steps gain what they promise (chord method; Ortega, Rheinboldt
1970, 7.1), and gets new ones when they do not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.estimation.levenberg_marquardt import Cost
from identification.windows.held import HeldWindows
from identification.windows.tangents import Tangent, along_states


@dataclass(frozen=True)
class StatesStep:
    """The end of a trial step.

    Attributes:
        d: changes of the initial states there, shape (W, nx).
        r: residual there, shape (W, m); NaN where a window diverges.
        promised: sums of squares there by the linearisation, shape (W,).
    """

    d: np.ndarray
    r: np.ndarray
    promised: np.ndarray


@dataclass(frozen=True)
class EachWindow:
    """The criteria of the initial states, one per window.

    Attributes:
        windows: what is simulated.
        d: changes of the initial states, shape (W, nx).
        tangent: the residual at d, and slopes there or at an earlier d.
        is_fresh: whether slopes are those at d, shape (W,).
    """

    windows: HeldWindows
    d: np.ndarray
    tangent: Tangent
    is_fresh: np.ndarray

    @property
    def cost(self) -> np.ndarray:
        """Sums of squares, shape (W,)."""
        return np.asarray(np.sum(self.tangent.r**2, axis=1))

    def step(self, μ: Cost) -> StatesStep:
        """Returns the damped step of each window."""
        at = self.tangent
        damping = np.asarray(μ)[:, None]
        along = np.einsum("wmk,wm->wk", at.U, at.r) * at.s / (at.s**2 + damping)
        dd = np.einsum("wkx,wk->wx", at.Vt, along) / at.size
        promised = np.sum((at.r - along_states(at, dd)) ** 2, axis=1)
        return StatesStep(self.d + dd, self.windows.residual(self.d + dd), promised)

    def cost_after(self, step: StatesStep) -> np.ndarray:
        """Returns sums of squares after a step, shape (W,)."""
        squares = np.sum(step.r**2, axis=1)
        return np.where(np.isfinite(squares), squares, np.inf)

    def bend(self, step: StatesStep, after: Cost, μ: Cost) -> None:
        """Does nothing: the steps are never bent."""

    def moved(self, step: StatesStep, taken: np.ndarray) -> EachWindow:
        """Returns the criteria after a step of windows that accept it, with slopes before it."""
        d, r = (np.where(taken[:, None], new, old)
                for new, old in ((step.d, self.d), (step.r, self.tangent.r)))  # fmt: skip
        return replace(
            self, d=d, tangent=replace(self.tangent, r=r), is_fresh=self.is_fresh & ~taken
        )

    def refreshed(self, at: np.ndarray) -> EachWindow:
        """Returns the criteria with new slopes of the windows `at`, a mask."""
        if not at.any():
            return self
        slopes = self.windows.rows(at).slopes(self.d[at], self.tangent.r[at])
        return replace(self, tangent=self.tangent.with_rows(at, slopes),
                       is_fresh=self.is_fresh | at)  # fmt: skip

    def rows(self, keep: np.ndarray) -> EachWindow:
        """Returns some of the windows, by mask or by index."""
        return EachWindow(
            self.windows.rows(keep), self.d[keep], self.tangent.rows(keep), self.is_fresh[keep]
        )
