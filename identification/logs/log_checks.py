"""What a log promises, checked once, at its birth."""

from __future__ import annotations

from collections.abc import Iterable
from math import isnan
from typing import TYPE_CHECKING

import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.names import check_column_names
from identification.logs.sampling import MIN_ROWS, FloatArray, check_time, rows_between
from identification.logs.units import check_si

if TYPE_CHECKING:
    from identification.logs.log import Log

HOLDS = ("zoh", "foh")


def check_log(log: Log) -> None:
    """Refuse a log that breaks a promise of `Log`.

    Raises:
        InputError: see `Log`.
    """
    names = (*log.input_names, *log.output_names, *log.extras)
    check_column_names(names)
    if not (log.input_names or log.output_names):
        raise InputError(f"log {log.name!r} has no columns; name its inputs or outputs")
    _check_numbers(log)
    check_time(log.time, lambda row: f"row {row} of log {log.name!r}")
    for name, unit in log.units.items():
        if name not in names:
            raise unknown_name("column with a unit", name, names)
        check_si(unit)
    if log.hold not in HOLDS:
        raise unknown_name("hold of the input", log.hold, HOLDS)
    _check_splits(log)


def _check_numbers(log: Log) -> None:
    n = log.time.shape[0] if log.time.ndim == 1 else -1
    shapes: Iterable[tuple[str, FloatArray, tuple[int, ...]]] = [
        ("time", log.time, (n,)),
        ("inputs", log.inputs, (n, len(log.input_names))),
        ("outputs", log.outputs, (n, len(log.output_names))),
        *((name, column, (n,)) for name, column in log.extras.items()),
    ]
    for what, array, shape in shapes:
        if array.shape != shape:
            raise InputError(
                f"log {log.name!r}: {what} has shape {array.shape} and should have {shape}; "
                "give one row for each sample and one column for each name"
            )
        bad = np.argwhere(~np.isfinite(array))
        if bad.size:
            raise InputError(
                f"log {log.name!r}: {what}{bad[0].tolist()} is {array[tuple(bad[0])]}; "
                "a log holds finite numbers only"
            )


def _check_splits(log: Log) -> None:
    span = f"[{log.time[0]:g}, {log.time[-1]:g}] s"
    for name, (start, end) in log.splits.items():
        first, last = rows_between(log.time, start, end)
        if isnan(start) or isnan(end) or last - first < MIN_ROWS:
            raise InputError(
                f"split {name!r} = [{start:g}, {end:g}) s of log {log.name!r} holds fewer than "
                f"{MIN_ROWS} samples; choose a part of {span}"
            )
    if {"estimation", "validation"} <= set(log.splits):
        parts = (rows_between(log.time, *log.splits[n]) for n in ("estimation", "validation"))
        (a, b), (c, d) = parts
        if max(a, c) < min(b, d):
            raise InputError(
                f"splits 'estimation' and 'validation' of log {log.name!r} overlap; keep the data "
                "that confirm a model apart from those that made it"
            )
