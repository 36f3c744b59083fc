"""Windows sought again from states at which other models begin them with less error.

    d_w <- the better of d_w and what a search from d'_w finds      where another model's V'_w < V_w

Where a joint sticks in a window, its criterion has several minima.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.windows.held_records import HeldRecords
from identification.windows.settling import Settled, search


@dataclass(frozen=True)
class Starts:
    """The starts of a record's windows under a model.

    Attributes:
        d: changes of the initial states, shape (W, nx).
        squares: of the errors of each window, shape (W,).
    """

    d: np.ndarray
    squares: np.ndarray


def best_starts(own: Starts, others: Sequence[Starts]) -> tuple[np.ndarray, np.ndarray]:
    """Returns each window's start by the model with the least error, and whether it is another one.

    Args:
        own: of a model.
        others: of others, which may have more states or fewer: the first ones are the same.

    Returns:
        Changes of the initial states, shape (W, nx), and a mask, shape (W,).
    """
    best = np.argmin([own.squares, *(o.squares for o in others)], axis=0)
    d = np.array(own.d)
    for k, other in enumerate(others):
        n, rows = min(d.shape[1], other.d.shape[1]), best == k + 1
        d[rows, :n] = other.d[rows, :n]
    return d, best > 0


def sought_from_others(
    held: HeldRecords, moves: Sequence[np.ndarray],
    starts: Sequence[tuple[np.ndarray, np.ndarray]], known: Sequence[np.ndarray] | None = None,
) -> tuple[Settled, ...]:  # fmt: skip
    """Returns windows at given states, some sought again from other states: the better of both.

    Args:
        held: the windows.
        moves: their states, one array (W, nx) a record.
        starts: of each record, other states and the mask of the windows that are sought from there.
        known: residuals at the given states, one array (W, m) a record; they are computed when
            None.

    Returns:
        The windows of each record; NaN in the residual of one that diverges at given states.
    """
    out: dict[int, Settled] = {}
    for records, windows in held.groups:
        d = np.concatenate([moves[k] for k in records])
        r = windows.residual(d) if known is None else np.concatenate([known[k] for k in records])
        begun = np.concatenate([starts[k][0] for k in records])
        at = np.flatnonzero(np.concatenate([starts[k][1] for k in records]))
        first = windows.rows(at).residual(begun[at]) if at.size else r[at]
        finite = np.isfinite(first).all(axis=1)
        at, first = at[finite], first[finite]
        if at.size:
            there, left = search(windows.rows(at), begun[at], first)
            better = ~(np.sum(left**2, axis=1) >= np.sum(r[at] ** 2, axis=1))
            d[at[better]], r[at[better]] = there[better], left[better]
        for i, k in enumerate(records):
            own = windows.record == i
            out[k] = Settled(d[own], r[own])
    return tuple(out[k] for k in range(len(held.parts)))
