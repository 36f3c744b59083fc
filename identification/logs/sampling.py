"""Constant sampling: t_k = t_0 + k h, as exactly as the digits of a file allow.

A predictor steps over a regular grid. So it matters how far each time stamp lies from this grid,
and not how much neighbouring steps differ: small differences may add up to a drift.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from identification.errors import InputError
from identification.shares import ratio_of

FloatArray = NDArray[np.float64]

MIN_ROWS = 3  # two intervals are the fewest that can show constant sampling

# A joint at 50 rad/s moves 0.5 mrad, the noise of its encoder, in 1e-3 of a 10 ms step.
JITTER = 1e-3
# Rounding of the printed stamps is forgiven up to this part of a step ...
_ROUNDING = 0.02
# ... or this, when the user has said what the sampling time is.
_ROUNDING_DECLARED = 0.5
# A step that is so many times the usual one is a gap, if there are only a few of them.
_JUMP, _FEW = 1.5, 5


def sampling_time(time: FloatArray) -> float:
    """Returns the mean step [s], in which the rounding errors of the stamps average out.

    It is rounded to twelve digits, to remove the rounding error of the division: 0.01 stays 0.01.
    """
    return float(f"{(float(time[-1]) - float(time[0])) / (len(time) - 1):.12g}")


def grid(start: float, step: float, n: int) -> FloatArray:
    """Returns the n stamps start + k step [s]; infinite where they exceed the largest float."""
    with np.errstate(over="ignore"):
        return start + step * np.arange(n, dtype=np.float64)


def off_grid(time: FloatArray, step: float) -> FloatArray:
    """Returns t_k - t_0 - k T of stamps [s], shape (n,); infinite where they exceed all floats."""
    with np.errstate(over="ignore"):
        return np.asarray(time - time[0] - step * np.arange(len(time)))


def rows_between(time: FloatArray, start: float, end: float) -> tuple[int, int]:
    """Returns the first row of [start, end) [s] and the row after its last.

    Stamps are rounded, so a sample counts from a tenth of a step before its stamp.
    """
    early = 0.1 * sampling_time(time)
    first, last = np.searchsorted(time, [start - early, end - early])
    return int(first), int(last)


def snapped(time: FloatArray) -> FloatArray:
    """Returns the regular grid next to stamps that `check_time` accepts, shape (n,) [s].

    Stamps that are a regular grid already, but for the rounding of a float, stay as they are.
    """
    step = (float(time[-1]) - float(time[0])) / (len(time) - 1)
    off, least = np.abs(time - grid(time[0], step, len(time))), float_resolution(time)
    if np.all(off <= least) and least <= 0.5 * JITTER * step:
        return time
    return grid(time[0], sampling_time(time), len(time))


def float_resolution(time: FloatArray) -> float:
    """Returns how far floats leave a grid [s]: stamp, step, k h and their sum are rounded."""
    return 4.0 * float(np.spacing(np.abs(time).max()))


def check_time(
    time: FloatArray, place: Callable[[int], str], declared: float | None = None
) -> None:
    """Refuse time stamps (n,) [s] that are no regular grid, of a declared sampling time if given.

    `place` says in words where a row stands.
    """
    if len(time) < MIN_ROWS:
        raise InputError(
            f"{place(0)}: a log needs at least {MIN_ROWS} rows, and this one has {len(time)}; "
            "record for longer, or take a wider part"
        )
    # Stamps near the largest float overflow here, and are then refused as uneven.
    with np.errstate(over="ignore", invalid="ignore"):
        _check_increasing(time, place)
        _check_even(time, place, declared)


def refuse_alike(time: FloatArray, place: Callable[[int], str], cure: str) -> None:
    """Refuse time stamps (n,) [s] that are all the same, with what to do about it."""
    if len(time) >= MIN_ROWS and bool(np.all(time == time[0])):
        raise InputError(
            f"{place(0)} and all {len(time) - 1} rows after it have one stamp, {time[0]:.9g} s:"
            f" time does not advance; {cure}"
        )


def _check_increasing(time: FloatArray, place: Callable[[int], str]) -> None:
    refuse_alike(time, place, "give each row the time at which it was sampled")
    stuck = np.flatnonzero(time[1:] <= time[:-1])
    if stuck.size:
        row = int(stuck[0]) + 1
        raise InputError(
            f"{place(row)}: time does not increase ({time[row]:.9g} s follows "
            f"{time[row - 1]:.9g} s); sort the rows and drop repeated ones"
        )


def _check_even(time: FloatArray, place: Callable[[int], str], declared: float | None) -> None:
    step = declared or (float(time[-1]) - float(time[0])) / (len(time) - 1)
    off = np.abs(time - grid(time[0], step, len(time)))
    forgiven = _ROUNDING_DECLARED if declared else _ROUNDING
    rounding = min(_printed_resolution(time), forgiven * step)
    if np.all(off <= JITTER * step + rounding + float_resolution(time)):
        return
    steps = np.diff(time)
    usual, jump = float(np.median(steps)), int(np.argmax(steps)) + 1
    if steps[jump - 1] > _JUMP * usual and np.sum(steps > _JUMP * usual) <= _FEW:
        raise InputError(
            f"{place(jump)}: samples are missing: time jumps from {time[jump - 1]:.9g} s to"
            f" {time[jump]:.9g} s where the step is {usual:.6g} s; cut the log there"
        )
    row = int(np.argmax(off))
    share = ratio_of(float(off[row] / step), f"the {step:.6g} s step")
    size = f"{off[row]:.3g} s, {share},"
    if declared:
        raise InputError(
            f"{place(row)}: time is {size} away from what sampling_time says; "
            "correct sampling_time, or leave it out"
        )
    raise InputError(
        f"{place(row)}: sampling is not even: time is {size} off a regular grid (allowed: "
        f"{100 * JITTER:g} %); resample the log to a constant step"
    )


def _printed_resolution(time: FloatArray) -> float:
    """Returns the size of the last printed decimal of the larger stamps [s]; 0 if it is not seen.

    "%g" prints the largest stamps with the fewest decimals, so the coarser half decides.
    """
    late = time[np.abs(time) >= 0.5 * np.abs(time).max()]
    for decimals in range(10):
        scaled = late * 10.0**decimals
        if np.all(np.abs(scaled - np.rint(scaled)) <= 1e-6):
            return float(10.0**-decimals)
    return 0.0
