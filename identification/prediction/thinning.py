"""Some of the windows of all records: they screen candidates, and say where a fit of all begins.

    of 2 n neighbouring windows: the first one, and of the others the one with the largest residual

Evenly spread windows show what is always there. What happens seldom, such as a limit that is
reached, is where the model without it errs most.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.prediction.problem import FEWEST_WINDOWS, Problem
from identification.windows.tangents import Tangent

THIN = 3  # n: one window of so many


def picks(tangents: Sequence[Tangent], every: int = THIN) -> tuple[np.ndarray, ...]:
    """Indices of one window of `every` in each record, but of no fewer than `FEWEST_WINDOWS`.

    Args:
        tangents: of a fitted model, one a record.
        every: n.
    """
    return tuple(kept(np.sum(t.r**2, axis=1), every) for t in tangents)


def kept(squares: np.ndarray, every: int) -> np.ndarray:
    """Indices of the windows of a record that are kept, by their sums of squares (W,)."""
    every = max(1, min(every, len(squares) // FEWEST_WINDOWS))
    if every == 1:
        return np.arange(len(squares))
    out = []
    for first in range(0, len(squares), 2 * every):
        out.append(first)
        rest = squares[first + 1 : first + 2 * every]
        if len(rest) >= every:
            out.append(first + 1 + int(np.argmax(rest)))
    return np.array(out)


def thinned(problem_: Problem, at: Sequence[np.ndarray]) -> Problem:
    """Some of the windows of each record, by their indices."""
    parts = zip(problem_.parts, at, strict=True)
    return replace(problem_, parts=tuple(part.rows(rows) for part, rows in parts))


def thinned_moves(moves: Sequence[np.ndarray], at: Sequence[np.ndarray]) -> tuple[np.ndarray, ...]:
    """The moves of the states of these windows."""
    return tuple(d[rows] for d, rows in zip(moves, at, strict=True))


def thinned_tangents(tangents: Sequence[Tangent], at: Sequence[np.ndarray]) -> tuple[Tangent, ...]:
    """The tangents of these windows."""
    return tuple(t.rows(rows) for t, rows in zip(tangents, at, strict=True))
