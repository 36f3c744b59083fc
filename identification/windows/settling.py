"""The initial states of windows that are best at given parameters, by Levenberg-Marquardt.

The windows are independent, and each has its own damping: where a joint sticks, the outputs hardly
feel its rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.levenberg_marquardt import (
    KEPT_GAIN,
    Damping,
    levenberg_marquardt,
)
from identification.windows.each_window import EachWindow
from identification.windows.held import HeldWindows
from identification.windows.held_records import HeldRecords
from identification.windows.tangents import Tangent

# Relative to the squared norms of the columns of X. It begins at one part in ten thousand: a
# direction that the outputs feel by a tenth of the others loses one per cent a step, and a window
# in which a joint sticks, which takes no step before its damping is about one, is soon there.
DAMPING = Damping(first=1e-4, raised=10.0, lowered=10.0, least=1e-4, floor=1e-4)
MAX_STATE_DAMPING = 1e2  # beyond it a window's state no longer moves
MAX_STATE_STEPS = 20  # of the search of a window's state
# Of the mean of the sums of squares: a window that changes by less is finished.
FINISHED_CHANGE = 1e-3
# Of a window's sum of squares to their median: above it the window is sought again.
WORSE_RATIO = 4.0
RESTART_SHARES = (0.0, 0.5)  # of its changes, where such a window begins again


@dataclass(frozen=True)
class Settled:
    """Windows of a record at their best states.

    Attributes:
        d: changes of the initial states, shape (W, nx).
        r: residual there, shape (W, L ny + nx).
    """

    d: np.ndarray
    r: np.ndarray


def settle(
    held: HeldRecords,
    moves: Sequence[np.ndarray],
    near: Sequence[Tangent] | None = None,
    is_thorough: bool = False,
    known: Sequence[np.ndarray] | None = None,
    expected: Sequence[np.ndarray] | None = None,
) -> tuple[Settled, ...]:
    """Fit the initial state of each window of some records, none of which has a free parameter.

    Args:
        held: the windows.
        moves: where the search begins, one array (W, nx) a record.
        near: the windows linearised at parameters nearby, one a record; when None, slopes are
            computed.
        is_thorough: whether windows that end far worse than the others are sought again.
        known: residuals where the search begins, one array (W, m) a record; they are computed when
            None.
        expected: sums of squares, one array (W,) a record; windows whose known residuals are as
            small stay as they are.

    Raises:
        DivergenceError: the simulation of a window diverged where the search begins.
    """
    out: dict[int, Settled] = {}
    for records, windows in held.groups:
        d = np.concatenate([moves[k] for k in records])
        slopes = None if near is None else _joined([near[k] for k in records], d)
        first = (
            windows.residual(d) if known is None else np.concatenate([known[k] for k in records])
        )
        hoped = None if expected is None else np.concatenate([expected[k] for k in records])
        d, r = _searched(_begun(windows, d, first, slopes), hoped)
        if is_thorough:
            d, r = _sought_again(windows, d, r)
        for i, k in enumerate(records):
            own = windows.record == i
            out[k] = Settled(d[own], r[own])
    return tuple(out[k] for k in range(len(held.parts)))


def search(held: HeldWindows, d: np.ndarray, r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the best states of windows and the residuals there, sought from d (W, nx) with r.

    Raises:
        DivergenceError: the simulation of a window diverged beside where the search begins.
    """
    return _searched(_begun(held, d, r, None))


def _begun(
    held: HeldWindows, d: np.ndarray, r: np.ndarray, near: Tangent | None
) -> EachWindow:  # fmt: skip
    if not np.isfinite(r).all():
        raise DivergenceError(
            "the simulation of a window diverged; use a smaller step, or values nearer to the"
            " nominal ones"
        )
    if near is None:
        return EachWindow(held, d, held.slopes(d, r), np.ones(len(d), bool))
    return EachWindow(held, d, replace(near, r=r), np.zeros(len(d), bool))


def _joined(each: Sequence[Tangent], d: np.ndarray) -> Tangent | None:
    """Returns slopes of the states of all windows; None where they are of fewer states."""
    if any(t.s.shape[1] != d.shape[1] for t in each):
        return None
    names = ("r", "U", "s", "Vt", "size")
    parts = {n: np.concatenate([getattr(t, n) for t in each]) for n in names}
    return Tangent(**parts, S=np.zeros((*parts["r"].shape, 0)))


def _searched(
    at: EachWindow, expected: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Returns the best states and the residuals there; a finished window is no longer simulated.

    Args:
        at: the windows where the search begins.
        expected: sums of squares, shape (W,), that are small enough.
    """
    d, r = np.array(at.d), np.array(at.tangent.r)
    part, going, μ = at, np.arange(len(d)), None
    if expected is not None:
        going = np.flatnonzero(at.cost - expected > FINISHED_CHANGE * float(np.mean(at.cost)))
        part = at.rows(going)
    for _ in range(MAX_STATE_STEPS if going.size else 0):
        enough = FINISHED_CHANGE * float(np.mean(np.sum(r**2, axis=1)))
        fresh = part.is_fresh
        trial = next(levenberg_marquardt(part, EachWindow.moved, DAMPING, μ))
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


def _sought_again(held: HeldWindows, d: np.ndarray, r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns states and residuals after windows that ended far worse are sought from elsewhere.

    Where a joint sticks in a window, its criterion has several minima.
    """
    squares = np.sum(r**2, axis=1)
    far = np.flatnonzero(squares > WORSE_RATIO * np.median(squares))
    if not far.size:
        return d, r
    begun = np.concatenate([share * d[far] for share in RESTART_SHARES])
    part = held.rows(np.tile(far, len(RESTART_SHARES)))
    first = part.residual(begun)
    if not np.isfinite(first).all():  # elsewhere it diverges: the states found stand
        return d, r
    at = EachWindow(part, begun, part.slopes(begun, first), np.ones(len(begun), bool))
    for other, left in zip(*(np.split(x, len(RESTART_SHARES)) for x in _searched(at)), strict=True):
        better = np.sum(left**2, axis=1) < np.sum(r[far] ** 2, axis=1)
        d[far[better]], r[far[better]] = other[better], left[better]
    return d, r
