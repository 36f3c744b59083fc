"""Some of the windows of all records: they screen candidates, and say where a fit of all begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.prediction.problem import FEWEST_WINDOWS, Problem
from identification.windows.tangents import Tangent

THIN = 3  # one window of so many


def thinned(problem_: Problem, every: int) -> Problem:
    """Some of the windows: one of `every`, but no fewer than `FEWEST_WINDOWS` a record."""
    parts = tuple(p.rows(kept(len(p.cut.starts), every)) for p in problem_.parts)
    return replace(problem_, parts=parts)


def thinned_moves(moves: Sequence[np.ndarray], every: int) -> tuple[np.ndarray, ...]:
    """The moves of the states of the windows that `thinned` keeps."""
    return tuple(d[kept(len(d), every)] for d in moves)


def thinned_tangents(tangents: Sequence[Tangent], every: int) -> tuple[Tangent, ...]:
    """The tangents of the windows that `thinned` keeps."""
    return tuple(t.rows(kept(len(t.r), every)) for t in tangents)


def kept(count: int, every: int) -> np.ndarray:
    """Indices of the windows of a record that `thinned` keeps."""
    return np.arange(0, count, max(1, min(every, count // FEWEST_WINDOWS)))
