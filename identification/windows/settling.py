"""Windows of records at the initial states that are best at given parameters.

    d_w <- the better of d_w and what a search from d'_w finds      where another model's V'_w < V_w

Where a joint sticks in a window its criterion has several minima, and the state at which another
model begins it may lead to the better one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.windows.held import HeldRecords, HeldWindows
from identification.windows.shooting import Tangent
from identification.windows.states import search, search_again, states_at


@dataclass(frozen=True)
class Settled:
    """Windows of a record at their best states."""

    d: np.ndarray  # changes of the initial states, shape (W, nx)
    r: np.ndarray  # residual there, shape (W, L ny + nx)


def settle(
    held: HeldRecords,
    moves: Sequence[np.ndarray],
    near: Sequence[Tangent] | None = None,
    is_thorough: bool = False,
    known: Sequence[np.ndarray] | None = None,
    expected: Sequence[np.ndarray] | None = None,
    most: float = np.inf,
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
        most: sum of squares of all windows above which it does not matter how they begin.

    Raises:
        DivergenceError: the simulation of a window diverged where the search begins.
    """
    out: dict[int, Settled] = {}
    for records, windows in held.groups:
        d = _of(records, moves)
        slopes = None if near is None else _joined([near[k] for k in records], d)
        first = windows.residual(d) if known is None else _of(records, known)
        enough = None if expected is None else _of(records, expected)
        d, r = search(states_at(windows, d, first, slopes), enough, most)
        most -= float(np.sum(r**2))
        if is_thorough:
            d, r = search_again(windows, d, r)
        out |= _by_record(records, windows, d, r)
    return tuple(out[k] for k in range(len(held.parts)))


@dataclass(frozen=True)
class Starts:
    """The starts of a record's windows under a model."""

    d: np.ndarray  # changes of the initial states, shape (W, nx)
    squares: np.ndarray  # of the errors of each window, shape (W,)


def best_starts(starts: Starts, others: Sequence[Starts]) -> tuple[np.ndarray, np.ndarray]:
    """Returns each window's start by the model with the least error, and whether it is another's.

    Other models may have more states or fewer: the first ones are the same. The start is a change
    of the initial states, shape (W, nx), the second a mask, shape (W,).
    """
    best = np.argmin([starts.squares, *(o.squares for o in others)], axis=0)
    d = np.array(starts.d)
    for k, other in enumerate(others):
        n, rows = min(d.shape[1], other.d.shape[1]), best == k + 1
        d[rows, :n] = other.d[rows, :n]
    return d, best > 0


def sought_from_others(
    held: HeldRecords, moves: Sequence[np.ndarray],
    starts: Sequence[tuple[np.ndarray, np.ndarray]], known: Sequence[np.ndarray] | None = None,
) -> tuple[Settled, ...]:  # fmt: skip
    """Returns windows at given states, some sought again from other states: the better of both.

    The residual of a window that diverges at given states is NaN.

    Args:
        held: the windows.
        moves: their states, one array (W, nx) a record.
        starts: of each record, other states and the mask of the windows that are sought from there.
        known: residuals at the given states, one array (W, m) a record; they are computed when
            None.
    """
    out: dict[int, Settled] = {}
    for records, windows in held.groups:
        d = _of(records, moves)
        r = windows.residual(d) if known is None else _of(records, known)
        begun, is_sought = (_of(records, each) for each in zip(*starts, strict=True))
        at = np.flatnonzero(is_sought)
        first = windows.rows(at).residual(begun[at]) if at.size else r[at]
        finite = np.isfinite(first).all(axis=1)
        at, first = at[finite], first[finite]
        if at.size:
            other, rest = search(states_at(windows.rows(at), begun[at], first))
            better = ~(np.sum(rest**2, axis=1) >= np.sum(r[at] ** 2, axis=1))
            d[at[better]], r[at[better]] = other[better], rest[better]
        out |= _by_record(records, windows, d, r)
    return tuple(out[k] for k in range(len(held.parts)))


def _of(records: Sequence[int], each: Sequence[np.ndarray]) -> np.ndarray:
    """Returns the rows of some records, one after the other."""
    return np.concatenate([each[k] for k in records])


def _by_record(
    records: Sequence[int], windows: HeldWindows, d: np.ndarray, r: np.ndarray
) -> dict[int, Settled]:
    """Returns the windows of each record of a group."""
    return {k: Settled(d[windows.record == i], r[windows.record == i])
            for i, k in enumerate(records)}  # fmt: skip


def _joined(each: Sequence[Tangent], d: np.ndarray) -> Tangent | None:
    """Returns slopes of the states of all windows; None where they are of fewer states."""
    if any(t.s.shape[1] != d.shape[1] for t in each):
        return None
    names = ("r", "U", "s", "Vt", "size")
    parts = {n: np.concatenate([getattr(t, n) for t in each]) for n in names}
    return Tangent(**parts, S=np.zeros((*parts["r"].shape, 0)))
