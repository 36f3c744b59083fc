"""Numbers that are too large are most often numbers in another unit.

A limit of the size finds milliamperes that were taken for amperes. A limit of the speed finds
degrees that were taken for radians, even when the angles are small: the speed too is 57 times too
large.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from identification.errors import InputError
from identification.logs.names import group, lookup
from identification.logs.table import Table
from identification.logs.units import units_that_fit

TURN = 0.1  # of a turn: a jump of a wrapped angle differs from a whole turn by less


def check_plausible(
    table: Table,
    factors: Mapping[str, float],
    units: Mapping[str, str],
    limits: Mapping[str, float],
    rates: Mapping[str, float],
    sidecar: Path,
) -> None:
    """Refuse a column that is too large, or moves too fast, and name the unit that would fit.

    Args:
        table: columns in SI, with a time column.
        factors: by column, the factor by which its numbers in the file were multiplied.
        units: SI unit by column, where known.
        limits: largest plausible size by column or group [SI].
        rates: largest plausible speed by column or group [SI/s].
        sidecar: the TOML file that may give the unit.

    Raises:
        InputError: a column exceeds its limit.
    """
    for name in table.names:
        size, rate = lookup(limits, name), lookup(rates, name)
        column, unit = table[name], units.get(name, "")
        if size is not None:
            row = int(np.argmax(np.abs(column)))
            if abs(column[row]) > size:
                raise InputError(
                    f"{table.place(row)}: {name} is {column[row]:.4g} {unit}".rstrip()
                    + f", beyond the plausible {size:g} {unit}".rstrip()
                    + _cure(name, unit, column[row] / factors[name], size, sidecar)
                )
        if rate is not None:
            with np.errstate(over="ignore"):
                speed = np.abs(np.diff(column) / np.diff(table["time"]))
            row = int(np.argmax(speed))
            if speed[row] > rate:
                raise InputError(
                    f"{table.place(row + 1)}: {name} changes by {speed[row]:.4g} {unit}/s, "
                    f"more than the plausible {rate:g} {unit}/s"
                    + (
                        _wrapped(unit, column[row + 1] - column[row])
                        or _cure(name, unit, speed[row] / factors[name], rate, sidecar)
                    )
                )


def _wrapped(unit: str, jump: float) -> str:
    """The advice for an angle that jumps by a whole turn."""
    if unit != "rad" or abs(abs(jump) - 2 * np.pi) > TURN * 2 * np.pi:
        return ""
    return ", a jump of a whole turn: the angle is wrapped; unwrap it (numpy.unwrap)"


def _cure(name: str, unit: str, raw: float, limit: float, sidecar: Path) -> str:
    fitting = units_that_fit(unit, raw, limit)
    if not fitting:
        return "; repair or cut the log there"
    return (
        f"; if the file is in {' or '.join(fitting)}, write units.{group(name)} = "
        f'"{fitting[0]}" in {sidecar}, else repair that row'
    )
