"""The search of the initial states of windows, by Levenberg-Marquardt, at given parameters.

    δ_w(μ) = argmin ‖r_w - X_w δ‖² + μ ‖D δ‖²,      D: norms of the columns of X_w

The windows are independent, and each has its own damping: where a joint sticks, the outputs hardly
feel its rate. Slopes cost as many simulations as a window has states, and change little from step
to step: a window keeps them as long as its steps gain what they promise (chord method; Ortega,
Rheinboldt 1970, 7.1), and gets new ones when they do not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.levenberg_marquardt import (
    KEPT_GAIN,
    Cost,
    Criterion,
    Damping,
    levenberg_marquardt,
)
from identification.windows.held import HeldWindows
from identification.windows.shooting import Tangent, along_states

# Relative to the squared norms of the columns of X. It begins at one part in ten thousand: a
# direction that the outputs feel by a tenth of the others loses one per cent a step, and a window
# in which a joint sticks, which takes no step before its damping is about one, is soon there.
DAMPING = Damping(first=1e-4, raised=10.0, least=1e-4)
MAX_STATE_DAMPING = 1e2  # beyond it a window's state no longer moves
MAX_STATE_STEPS = 20  # of the search of a window's state
# Of the mean of the sums of squares: a window that changes by less is finished.
FINISHED_CHANGE = 1e-3
# Of a window's sum of squares to their median: above it the window is sought again.
WORSE_RATIO = 4.0
RESTART_SHARES = (0.0, 0.5)  # of its changes, where such a window begins again


def search(
    at: States, expected: np.ndarray | None = None, most: float = np.inf
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the best states and the residuals there; a finished window is no longer simulated.

    Windows whose sums of squares are near those `expected`, shape (W,), stay as they are. Where the
    finished windows alone have more than `most`, the others no longer matter, and the search ends.
    """
    d, r = np.array(at.d), np.array(at.tangent.r)
    part, going, μ = at, np.arange(len(d)), None
    if expected is not None:
        going = np.flatnonzero(at.cost - expected > FINISHED_CHANGE * float(np.mean(at.cost)))
        part = at.rows(going)
    for _ in range(MAX_STATE_STEPS if going.size else 0):
        squares = np.sum(r**2, axis=1)
        enough = FINISHED_CHANGE * float(np.mean(squares))
        if float(squares.sum() - squares[going].sum()) > most:
            break
        fresh = part.is_fresh
        trial = next(levenberg_marquardt(part, DAMPING, μ))
        part = trial.criterion
        d[going], r[going] = part.d, part.tangent.r
        gain = trial.before - np.where(trial.taken, trial.after, trial.before)
        promised = trial.before - trial.step.promised
        is_old = ~fresh & (promised > enough) & (gain < KEPT_GAIN * promised)
        small = (np.abs(trial.after - trial.before) <= enough) | (promised <= enough)
        μ = np.where(is_old, trial.μ, trial.next)
        keep = is_old | ~(small | (μ > MAX_STATE_DAMPING))
        if not keep.any():
            break
        part, going, μ = part.rows(keep), going[keep], μ[keep]
        part = part.refreshed(is_old[keep])
    return d, r


def search_again(held: HeldWindows, d: np.ndarray, r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns states and residuals after windows that ended far worse are sought from elsewhere."""
    squares = np.sum(r**2, axis=1)
    far = np.flatnonzero(squares > WORSE_RATIO * np.median(squares))
    if not far.size:
        return d, r
    starts = [share * d[far] for share in RESTART_SHARES]
    act = held.first.act[far]
    if act.size:  # what a friction or a gear carries may have begun on the other side
        mirrored = np.array(d[far])
        mirrored[:, -act.shape[1] :] = -2 * act - mirrored[:, -act.shape[1] :]
        starts.append(mirrored)
    begun = np.concatenate(starts)
    part = held.rows(np.tile(far, len(starts)))
    first = part.residual(begun)
    if not np.isfinite(first).all():  # elsewhere it diverges: the states found stand
        return d, r
    found = search(states_at(part, begun, first))
    for other, rest in zip(*(np.split(x, len(starts)) for x in found), strict=True):
        better = np.sum(rest**2, axis=1) < np.sum(r[far] ** 2, axis=1)
        d[far[better]], r[far[better]] = other[better], rest[better]
    return d, r


@dataclass(frozen=True)
class StatesStep:
    """The end of a trial step."""

    d: np.ndarray  # changes of the initial states there, shape (W, nx)
    r: np.ndarray  # residual there, shape (W, m); NaN where a window diverges
    promised: np.ndarray  # sums of squares there by the linearisation, shape (W,)


@dataclass(frozen=True)
class States(Criterion[StatesStep]):
    """The criteria of the initial states, one per window."""

    windows: HeldWindows  # what is simulated
    d: np.ndarray  # changes of the initial states, shape (W, nx)
    tangent: Tangent  # the residual at d, and slopes there or at an earlier d
    is_fresh: np.ndarray  # whether slopes are those at d, shape (W,)

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

    def moved(self, step: StatesStep, taken: np.ndarray) -> States:
        """Returns the criteria after a step of windows that accept it, with slopes before it."""
        d, r = (np.where(taken[:, None], new, old)
                for new, old in ((step.d, self.d), (step.r, self.tangent.r)))  # fmt: skip
        return replace(
            self, d=d, tangent=replace(self.tangent, r=r), is_fresh=self.is_fresh & ~taken
        )

    def refreshed(self, at: np.ndarray) -> States:
        """Returns the criteria with new slopes of the windows `at`, a mask."""
        if not at.any():
            return self
        slopes = self.windows.rows(at).slopes(self.d[at], self.tangent.r[at])
        return replace(self, tangent=self.tangent.with_rows(at, slopes),
                       is_fresh=self.is_fresh | at)  # fmt: skip

    def rows(self, keep: np.ndarray) -> States:
        """Returns some of the windows, by mask or by index."""
        return States(
            self.windows.rows(keep), self.d[keep], self.tangent.rows(keep), self.is_fresh[keep]
        )


def states_at(
    held: HeldWindows, d: np.ndarray, r: np.ndarray, near: Tangent | None = None
) -> States:
    """Returns the criteria at d (W, nx), where the residual is r; slopes are those of `near`."""
    if not np.isfinite(r).all():
        raise DivergenceError(
            "the simulation of a window diverged; use a smaller step, or values nearer to the"
            " nominal ones"
        )
    if near is None:
        return States(held, d, held.slopes(d, r), np.ones(len(d), bool))
    return States(held, d, replace(near, r=r), np.zeros(len(d), bool))
