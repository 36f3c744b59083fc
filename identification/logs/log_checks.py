"""The checks of a new log; see `identification.logs.log.Log`."""

from __future__ import annotations

from collections.abc import Mapping
from math import isnan

import numpy as np

from identification.errors import InputError
from identification.logs.sampling import MIN_ROWS, FloatArray, rows_between

HOLDS = ("zoh", "foh")


def check_array(log: str, what: str, array: FloatArray, shape: tuple[int, ...]) -> None:
    """Refuse an array of another shape, or with a number that is not finite.

    Args:
        log: name of the log.
        what: name of the array.
        array: the numbers, in any shape.
        shape: the shape that it should have.
    """
    if array.shape != shape:
        raise InputError(
            f"log {log!r}: {what} has shape {array.shape} and should have {shape}; "
            "give one row for each sample and one column for each name"
        )
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        raise InputError(
            f"log {log!r}: {what}{bad[0].tolist()} is {array[tuple(bad[0])]}; "
            "a log holds finite numbers only"
        )


def check_splits(log: str, time: FloatArray, splits: Mapping[str, tuple[float, float]]) -> None:
    """Refuse a named part that is empty, and parts for estimation and validation that overlap.

    Args:
        log: name of the log.
        time: its time stamps, shape (n,) [s].
        splits: its named parts [start, end) [s].
    """
    span = f"[{time[0]:g}, {time[-1]:g}] s"
    for name, (start, end) in splits.items():
        first, last = rows_between(time, start, end)
        if isnan(start) or isnan(end) or last - first < MIN_ROWS:
            raise InputError(
                f"split {name!r} = [{start:g}, {end:g}) s of log {log!r} holds fewer than "
                f"{MIN_ROWS} samples; choose a part of {span}"
            )
    if {"estimation", "validation"} <= set(splits):
        (a, b), (c, d) = (rows_between(time, *splits[n]) for n in ("estimation", "validation"))
        if max(a, c) < min(b, d):
            raise InputError(
                f"splits 'estimation' and 'validation' of log {log!r} overlap; keep the data "
                "that confirm a model apart from those that made it"
            )
