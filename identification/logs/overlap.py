"""Tests whether logs are different records of one robot: same columns, and no sample in two.

Sensors' noise never repeats, so that as many samples in a row that are equal to the bit were
measured once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from identification.errors import InputError
from identification.logs.log import Log

ROW = 20  # samples
MOVING = 10  # of them, at least, that differ from one another: robots at rest are all alike


def refuse_different(logs: Sequence[Log]) -> None:
    """Refuse logs that are not different records of one robot."""
    first = logs[0]
    for k, log in enumerate(logs):
        if any(_is_same(log, other) for other in logs[:k]):
            raise InputError(
                f"log {log.name!r} is given twice; a record counts once, and confirms nothing when"
                " it was fitted: leave one of them out"
            )
        for what in ("input_names", "output_names", "hold"):
            mine, others = getattr(log, what), getattr(first, what)
            if mine != others:
                raise InputError(
                    f"log {log.name!r} has the {what.replace('_', ' ')} {mine} where"
                    f" {first.name!r} has {others}; give records of one robot and one set of"
                    " columns"
                )
        for other in logs[:k]:
            if share_samples(log, other):
                raise InputError(
                    f"logs {log.name!r} and {other.name!r} hold the same samples; what was fitted"
                    " confirms nothing, and what is given twice counts twice: give parts that do"
                    " not overlap"
                )


def share_samples(a: Log, b: Log) -> bool:
    """Returns whether some samples in a row stand in both logs, to the bit."""
    rows = [np.hstack([log.inputs, log.outputs]) for log in (a, b)]
    if min(map(len, rows)) < ROW:
        return False
    _, names = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    names = names.ravel()
    first, second = (_stretches(n) for n in np.split(names, [len(rows[0])]))
    return bool(np.isin(first, second).any())


def _stretches(names: np.ndarray) -> np.ndarray:
    """Returns samples in a row by their names, one entry a stretch, those at rest left out."""
    each = np.ascontiguousarray(sliding_window_view(names, ROW))
    different = (np.diff(np.sort(each, axis=1), axis=1) != 0).sum(axis=1) + 1
    return each[different >= MOVING].view(f"V{ROW * each.itemsize}").ravel()


def _is_same(a: Log, b: Log) -> bool:
    """Returns whether two logs are one record, to the bit."""
    return a is b or (np.array_equal(a.inputs, b.inputs) and np.array_equal(a.outputs, b.outputs))
