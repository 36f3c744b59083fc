"""Readings of a log: is every column in its unit, with its sign, in its place?

    ε_k = Σ ‖y_k - ŷ_k‖² / Σ ‖y_k - y_k(0)‖²       share of output k that a model leaves unexplained

A model whose parameters are yet to be found may be far off, so a log is refused only where the
model would explain it as another one, and far better: in other units, against a sign, with two
columns exchanged. What only a better model explains is left to the search: `misread` asks its
caller. Where the model's ŷ begins, and over which time, is the caller's: he gives ε as a function
of a log.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from identification.logs.log import Log
from identification.logs.names import listed
from identification.runtime.progress import counted
from identification.shares import percent

UNEXPLAINED = 0.05  # least ε of an output that is not what it says
NEARER = 0.2  # of ε, that another reading must leave
EXPLAINED = 0.5  # ε of all that it changes, at most
SAME = 0.01  # of ε, within which two readings are the same: a factor of 57.3 and the unit deg


@dataclass(frozen=True)
class Reading:
    """Another way to read a log."""

    log: Log  # so read
    columns: Sequence[int]  # outputs that change, with it or with what an input does to them
    words: str  # what it would be, in words
    cure: str  # what to do, were it so
    kinds: tuple[str, ...] = ("wiring",)  # "units", "wiring" or both, which a user may trust


# ε of a reading, shape (ny,); None where none can be had, or where it is not far better
Unexplained = Callable[[Reading], np.ndarray | None]


def is_far_better(reading: Reading, rest: np.ndarray, as_read: np.ndarray) -> bool:
    """Returns whether ε (ny,) of a reading is far below ε of the log in all columns it changes."""
    k = list(reading.columns)
    return bool((rest[k] < np.minimum(EXPLAINED, NEARER * as_read[k])).all())


def misread(
    log: Log,
    as_read: np.ndarray,
    readings: Iterable[Reading],
    unexplained: Unexplained,
    believed: Callable[[Reading, np.ndarray], bool] = lambda reading, rest: True,
    enough: float = 0.0,
) -> tuple[Reading, str] | None:
    """Returns the reading that explains a log far better than the present one, and that in words.

    Args:
        log: as it is read.
        as_read: its ε, shape (ny,), without unit.
        readings: other ones; of several, that which leaves least in all, or else the first, counts.
        unexplained: ε of a reading.
        believed: whether a reading with its ε is what no better model could be.
        enough: ε of a reading behind which no other one is asked.
    """
    best, least = None, np.inf
    for reading in counted(readings, "other readings of the log"):
        rest = unexplained(reading)
        if rest is None or not is_far_better(reading, rest, as_read):
            continue
        if rest.sum() < (1 - SAME) * least and believed(reading, rest):
            best, least = (reading, rest), float(rest.sum())
            if rest.max() < enough:
                break
    if best is None:
        return None
    reading, rest = best
    before, after = (
        percent(max(0.0, 1 - float(e[list(reading.columns)].max()))) for e in (as_read, rest)
    )
    return reading, (
        f"explains {before} of {listed(log.output_names[k] for k in reading.columns)}, and"
        f" {after} {reading.words}; {reading.cure}"
    )


def unexplained_share(y: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Returns ε of each output over W windows, shape (ny,), no unit; 0 where it does not move.

    The measured outputs, (W, L, ny), and the model's error, which may be of a part of these, have
    the same units.
    """
    moved = np.sum((y - y[:, :1]) ** 2, axis=(0, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio: np.ndarray = np.sum(error**2, axis=(0, 1)) / moved
    return np.where(moved > 0, ratio, 0.0)
