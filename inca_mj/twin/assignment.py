"""The assignment of one column to each row, where every column belongs to one row only."""

from __future__ import annotations

import numpy as np


def assigned(likeness: np.ndarray) -> np.ndarray:
    """Returns the columns of all rows for which the likenesses add up to most, shape (n,).

    Args:
        likeness: of each row and column, shape (n, n).

    Raises:
        ValueError: an entry is no number.
    """
    first = likeness.argmax(axis=1)
    if np.isfinite(likeness).all() and len({*first.tolist()}) == len(first):
        return first  # no row can do better
    from scipy.optimize import linear_sum_assignment  # slow to import

    return np.asarray(linear_sum_assignment(-likeness)[1])
