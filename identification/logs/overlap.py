"""Whether two logs hold the same measurement, in whole or in part.

Sensors' noise never repeats, so that as many samples in a row that are equal to the bit were
measured once.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from identification.logs.log import Log

ROW = 20  # samples
MOVING = 10  # of them, at least, that differ from one another: robots at rest are all alike


def share_samples(a: Log, b: Log) -> bool:
    """Whether some samples in a row stand in both logs, to the bit.

    Args:
        a: a log.
        b: another one, with the same columns.
    """
    rows = [np.hstack([log.inputs, log.outputs]) for log in (a, b)]
    if min(map(len, rows)) < ROW:
        return False
    _, names = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    names = names.ravel()
    first, second = (_stretches(n) for n in np.split(names, [len(rows[0])]))
    return bool(np.isin(first, second).any())


def _stretches(names: np.ndarray) -> np.ndarray:
    """Samples in a row by their names, one entry a stretch, those at rest left out."""
    each = np.ascontiguousarray(sliding_window_view(names, ROW))
    different = (np.diff(np.sort(each, axis=1), axis=1) != 0).sum(axis=1) + 1
    return each[different >= MOVING].view(f"V{ROW * each.itemsize}").ravel()
