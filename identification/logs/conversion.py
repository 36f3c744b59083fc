"""From the numbers of a log's file to SI: their units, and the factors that its TOML gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import inf, isfinite

import numpy as np

from identification.errors import InputError, told_of
from identification.logs.names import lookup
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.logs.units import to_si

HUGE = 1e15  # of any SI unit: no angle, way, force, voltage or current of a robot is so large


def conversions(
    table: Table, sidecar: Sidecar, units: Mapping[str, str]
) -> tuple[dict[str, str], dict[str, float]]:
    """Returns the SI unit of each column, where known, and the factor from its numbers to SI."""
    si: dict[str, str] = {}
    factors: dict[str, float] = {}
    for name in table.names:
        expected, given = lookup(units, name), lookup(sidecar.units, name)
        with told_of(f"units of {name} in {sidecar.file_of('units')}"):
            unit, factors[name] = to_si(given) if given is not None else (expected, 1.0)
        if expected and unit != expected:
            raise InputError(
                f"{sidecar.file_of('units')} gives {name} in {given}, which measures {unit} and"
                f" not {expected}; correct it there"
            )
        if unit:
            si[name] = unit
        factors[name] *= lookup(sidecar.factors, name) or 1.0
    return si, factors


def converted(table: Table, sidecar: Sidecar, factors: Mapping[str, float]) -> Table:
    """Returns the table in SI units."""
    # What overflows without a factor is refused with its row.
    with np.errstate(over="ignore", invalid="ignore"):
        data = table.data * [factors[name] for name in table.names]
    for k, name in enumerate(table.names):
        given = lookup(sidecar.factors, name)
        largest = _largest(data[:, k]) if isfinite(factors[name]) else inf
        if given is not None and _largest(table.data[:, k]) <= HUGE < largest:
            raise InputError(
                f"the factor {given:g} of {name} under 'factors' in {sidecar.file_of('factors')}"
                f" makes numbers beyond {HUGE:g}, which no robot has; write what turns its numbers"
                " into those of the right sign and unit, such as -1"
            )
    return replace(table, data=data)


def _largest(column: np.ndarray) -> float:
    """Returns the largest absolute number of a column, shape (n,), whose empty cells are NaN."""
    return float(np.abs(column).max(initial=0.0, where=~np.isnan(column)))
