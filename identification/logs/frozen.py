"""Sensors that freeze: from some sample on an output repeats itself while its joint is driven on.

A joint that rests repeats itself too, but not while its inputs go on as before; nor does an encoder
whose steps have become too coarse for the motion freeze all at once.
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log

FEWEST = 50  # samples that repeat
SHARE = 0.2  # of the log that repeats
AS_BEFORE = 0.5  # of the std before: a signal that varies so much goes on
STEPS = 3  # that an encoder crosses in the samples before, as many as `FEWEST`


def refuse_frozen(log: Log, output: int, inputs: np.ndarray, others: np.ndarray) -> None:
    """Refuse an output that froze.

    Args:
        log: what was measured.
        output: column of the output.
        inputs: all that drives its joint, shape (n, k); it goes on where all of them do.
        others: other outputs of its joint, shape (n, m); it goes on where one of them does.

    Raises:
        InputError: it froze.
    """
    y = log.outputs[:, output]
    moved = np.flatnonzero(np.diff(y))
    first = int(moved[-1]) + 1 if moved.size else 0
    if first == 0 or len(y) - first < max(FEWEST, SHARE * len(y)):
        return
    step = np.abs(np.diff(y))[moved].min()
    abrupt = np.ptp(y[max(0, first - FEWEST) : first]) > STEPS * step
    driven, seen = _goes_on(inputs, first), _goes_on(others, first)
    if abrupt and ((driven.size and driven.all()) or seen.any()):
        raise InputError(
            f"{log.output_names[output]} of log {log.name!r} repeats {y[first]:g} from"
            f" {log.time[first]:.6g} s to the end while its joint is driven on: a frozen sensor;"
            " delete the log's rows from there on, or record again"
        )


def _goes_on(signals: np.ndarray, first: int) -> np.ndarray:
    """Which signals vary from a sample on as they did before it, shape (k,)."""
    before, after = signals[:first].std(axis=0), signals[first:].std(axis=0)
    return np.asarray((after > 0) & (after >= AS_BEFORE * before))
