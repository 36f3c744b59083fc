"""Sensors that freeze: an output repeats one value while its joint is still driven.

The output of a joint at rest repeats one value too, but then its inputs have changed. An encoder
whose steps are too coarse for a slow motion also repeats values, but it does not stop suddenly.
"""

from __future__ import annotations

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log

FEWEST = 50  # a frozen output repeats at least so many samples
SHARE = 0.2  # and at least this share of the log
AS_BEFORE = 0.5  # of the std before; a signal that still varies by as much counts as moving
ROUNDED = 1e-6  # of its width, below which a difference is rounding and no step of an encoder
FEW = 0.1  # of the differences may be smaller than a step
STEPS = 3  # that the encoder crosses in the `FEWEST` samples before it freezes


def stands_still(y: np.ndarray) -> bool:
    """Returns whether a channel, shape (n,), moves by no more than `STEPS` steps of its encoder."""
    width, steps = np.ptp(y), np.abs(np.diff(y))
    crossed = steps[steps > ROUNDED * width]
    if not crossed.size:
        return bool(width == 0)
    # A few steps are smaller where a gap was bridged.
    return bool(width <= STEPS * np.quantile(crossed, FEW))


def still_sentence(log: Log) -> str | None:
    """Tells of outputs that stand still in all of a log; None where there is none.

    It is no refusal: a joint may be braked, or its friction may hold it against its drive.

    Args:
        log: what was measured.
    """
    told = []
    for name, y in zip(log.output_names, log.outputs.T, strict=True):
        if stands_still(y):
            within = f" (within {width:.2g})" if (width := float(np.ptp(y))) else ""
            told.append(f"{name} is {np.median(y):.4g} {log.units.get(name, '')}".rstrip() + within)
    if not told:
        return None
    one = len(told) == 1
    return (
        f"In all of log {log.name!r} {' and '.join(told)}: {'a joint' if one else 'joints'} that"
        f" stood still, or {'a dead sensor' if one else 'dead sensors'}. What is dead belongs out"
        " of the outputs of the robot's file."
    )


def refuse_frozen(
    log: Log, output: int, inputs: np.ndarray, others: np.ndarray, overrule: str = ""
) -> None:
    """Refuse an output that froze.

    Args:
        log: what was measured.
        output: column of the output.
        inputs: everything that drives its joint, shape (n, k); the joint counts as driven where all
            of these vary as before.
        others: other outputs of its joint, shape (n, m); the joint counts as moving where one of
            these varies as before.
        overrule: how a user may overrule this, for the message.

    Raises:
        InputError: the output froze.
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
            f" delete the log's rows from there on, or record again{overrule}"
        )


def _goes_on(signals: np.ndarray, first: int) -> np.ndarray:
    """Which signals vary after a sample as much as before it, shape (k,)."""
    before, after = signals[:first].std(axis=0), signals[first:].std(axis=0)
    return np.asarray((after > 0) & (after >= AS_BEFORE * before))
