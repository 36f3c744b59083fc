"""Samples that repeat the one before while a joint moves on: an encoder that was read twice.

    Δ_k = y_k - y_k-1,     v = (Δ_k-1 + Δ_k+2)/2     the motion about sample k
    Δ_k = 0 and Δ_k+1 nearer to 2 v than to v,  where Δ_k-1 and Δ_k+2 have one sign and are large

No joint stands still for one sample and makes up for it in the next. An encoder may, where its
steps q are coarse or its noise is as large as the motion, but it then shows Δ_k = ±q about twice as
often as 0. So "large" means many q, and repeats are told where they are far more than the steps of
at most q that are made up for in the same way.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.logs.table import Table
from identification.shares import percent

ROUNDED = 1e-6  # of the width of a channel, below which a difference is rounding
FEW = 0.1  # of the differences may be smaller than a step of the encoder
MANY = 4.0  # steps of the encoder by which a joint moves on
SHARE = 0.01  # of the samples in motion: fewer repeats hardly raise the noise
FEWEST = 8  # repeats that are no chance
BEYOND = 4.0  # times the steps of at most q, which repeats must be
_READ_TWICE = "repeat the one before to the last digit while"


def repeated_share(y: np.ndarray) -> float:
    """Returns the share of repeats among the samples in motion of a channel.

    Args:
        y: the channel, shape (n,), in a unit of its own; NaN where nothing stands.

    Returns:
        The share, no unit; 0 where repeats may be chance, or steps of an encoder.
    """
    y = y[np.isfinite(y)]
    steps = np.diff(y)
    if len(steps) < 4 or not np.ptp(y):
        return 0.0
    size = np.abs(steps)
    least = ROUNDED * np.ptp(y)
    encoder = max(least, float(np.quantile(size[size > least], FEW)))
    before, at, behind, then = steps[:-3], steps[1:-2], steps[2:-1], steps[3:]
    motion = (before + then) / 2
    moves = (np.minimum(np.abs(before), np.abs(then)) > MANY * encoder) & (before * then > 0)
    made_up = moves & (np.abs(behind - 2 * motion) < np.abs(behind - motion))
    repeats = int(np.sum(made_up & (np.abs(at) <= least)))
    small = int(np.sum(made_up & (np.abs(at) > least) & (np.abs(at) <= encoder)))
    if repeats < max(FEWEST, BEYOND * small, SHARE * moves.sum()):
        return 0.0
    return repeats / float(moves.sum())


def repeat_sentence(what: str, share: float) -> str:
    """Returns one sentence on the repeats of a column, which names it so."""
    return (
        f"{percent(share)} of the samples of {what} {_READ_TWICE} it moves on, as an encoder that"
        " is read again before it has a new value: they raise the noise; read the encoder once a"
        " sample, or empty these cells of the log."
    )


def told_of_repeats(table: Table, names: Sequence[str]) -> Table:
    """Returns a table that tells of those of its columns that repeat samples in motion."""
    for name in names:
        if share := repeated_share(table[name]):
            table = table.told(repeat_sentence(f"{name} of log {table.path.stem!r}", share))
    return table


def repeats_told(remarks: Sequence[str]) -> list[str]:
    """Returns those remarks on a log that tell of repeats."""
    return [remark for remark in remarks if _READ_TWICE in remark]
