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
from identification.logs.conversion import HUGE
from identification.logs.cures import lines_of, toml_key
from identification.logs.names import group, lookup
from identification.logs.table import Table
from identification.logs.units import to_si, units_that_fit

TURN = 0.1  # of a turn: a jump of a wrapped angle differs from a whole turn by less


def check_possible(table: Table) -> None:
    """Refuse a number that no robot has, in whatever unit it is."""
    for name in (n for n in table.names if n != "time"):
        row = int(np.argmax(np.nan_to_num(np.abs(table[name]))))
        if abs(table[name][row]) > HUGE:
            raise InputError(
                f"{table.place(row)}: {name} is {table[name][row]:.4g}, beyond {HUGE:g}, which no"
                " robot has; repair or cut the log there, or correct the unit of the column"
            )


def check_plausible(
    table: Table,
    factors: Mapping[str, float],
    units: Mapping[str, str],
    limits: Mapping[str, float],
    rates: Mapping[str, float],
    sidecar: Path,
    overrule: str = "",
) -> None:
    """Refuse a column that is too large, or moves too fast, and name the unit that would fit.

    Args:
        table: columns in SI, with a time column.
        factors: by column, the factor by which its numbers in the file were multiplied.
        units: SI unit by column, where known.
        limits: largest plausible size by column or group [SI].
        rates: largest plausible speed by column or group [SI/s].
        sidecar: the TOML file that may give the unit.
        overrule: how a user may overrule this, for the message.
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
                    + _cure(table, name, factors, unit, column[row] / factors[name], size, sidecar)
                    + overrule
                )
        if rate is not None:
            with np.errstate(over="ignore"):
                speed = np.abs(np.diff(column) / np.diff(table["time"]))
            row = int(np.argmax(speed))
            if speed[row] > rate:
                moved = speed[row] / factors[name]
                raise InputError(
                    f"{table.place(row + 1)}: {name} changes by {speed[row]:.4g} {unit}/s, "
                    f"more than the plausible {rate:g} {unit}/s"
                    + (
                        _wrapped(unit, column[row + 1] - column[row])
                        or _cure(table, name, factors, unit, moved, rate, sidecar)
                    )
                    + overrule
                )


def _wrapped(unit: str, jump: float) -> str:
    """Returns the advice for an angle that jumps by a whole turn."""
    if unit != "rad" or abs(abs(jump) - 2 * np.pi) > TURN * 2 * np.pi:
        return ""
    return ", a jump of a whole turn: the angle is wrapped; unwrap it (numpy.unwrap)"


def _cure(
    table: Table, name: str, factors: Mapping[str, float], unit: str, raw: float, limit: float,
    sidecar: Path,
) -> str:  # fmt: skip
    """Says which unit to write where numbers are too large: for the column's group, or for some."""
    fitting = units_that_fit(unit, raw, limit)
    if not fitting:
        return "; repair or cut the log there"
    ratio = 1 / to_si(fitting[0])[1]
    like = [n for n in table.names if group(n) == group(name) and factors[n] == factors[name]]
    size = {n: float(np.abs(table[n]).max()) for n in like}
    # Halfway, as factors go, between a column in the same unit and one in the SI unit.
    large = [n for n in like if size[n] * np.sqrt(ratio) > size[name]]
    whole = len(large) == len(like)
    lines = [f'{toml_key(n)} = "{fitting[0]}"' for n in ([group(name)] if whole else large)]
    what = "the file is" if whole else f"{' and '.join(large)} {'are' if large[1:] else 'is'}"
    return (
        f"; if {what} in {' or '.join(fitting)}, write"
        f" {lines_of(lines)} under [units] in {sidecar}, else repair that row"
    )
