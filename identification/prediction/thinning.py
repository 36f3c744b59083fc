"""Some of the windows of all records: they screen candidates, and say where a fit of all begins.

They are spread evenly, so that shares of the error are those of all windows. Windows that were
chosen by their residual would show rare events, and shares that are not those of the record.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.prediction.problem import MIN_WINDOWS, Problem
from identification.windows.shooting import Tangent

THIN = 3  # n: one window of so many


def picks(tangents: Sequence[Tangent], every: int = THIN) -> tuple[np.ndarray, ...]:
    """Returns indices of one window of `every` a record, but of no fewer than `MIN_WINDOWS`.

    Args:
        tangents: of a fitted model, one a record.
        every: n.
    """
    return tuple(kept(len(t.r), every) for t in tangents)


def kept(count: int, every: int) -> np.ndarray:
    """Returns the indices of the windows that are kept of `count` windows of a record."""
    return np.arange(0, count, max(1, min(every, count // MIN_WINDOWS)))


def thinned(problem_: Problem, at: Sequence[np.ndarray]) -> Problem:
    """Returns the problem with some of the windows of each record, by their indices."""
    parts = zip(problem_.parts, at, strict=True)
    return replace(problem_, parts=tuple(part.rows(rows) for part, rows in parts))


def thinned_moves(moves: Sequence[np.ndarray], at: Sequence[np.ndarray]) -> tuple[np.ndarray, ...]:
    """Returns the moves of the states of these windows."""
    return tuple(d[rows] for d, rows in zip(moves, at, strict=True))


def thinned_tangents(tangents: Sequence[Tangent], at: Sequence[np.ndarray]) -> tuple[Tangent, ...]:
    """Returns the tangents of these windows."""
    return tuple(t.rows(rows) for t, rows in zip(tangents, at, strict=True))
