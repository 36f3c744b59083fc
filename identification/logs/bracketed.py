"""Columns that bear their unit behind their name: `time [s]`, `angle (deg)`.

Exports of spreadsheets and of measuring programs write names so. Where a log has no column of a
name that is asked for, the column of that name with a known unit in brackets is it, in this unit.
A column that the log's TOML names otherwise has its unit too. What the TOML says of units comes
before.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from identification.errors import InputError, repeated
from identification.logs.names import listed, lookup
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.logs.units import UNITS
from identification.storage.files import toml_key, toml_value

_BRACKETED = re.compile(r"(?P<name>[^\[(]+?)\s*[\[(]\s*(?P<unit>[^\])]+?)\s*[\])]")


def bracketed(
    names: Sequence[str], asked: Collection[str], sidecar: Sidecar
) -> Mapping[str, tuple[str, str]]:
    """Returns name and unit of each column of a file that bears both, and is asked for.

    Args:
        names: of the columns of the file.
        asked: names of the columns that are read.
        sidecar: what the log's TOML says.
    """
    found: dict[str, tuple[str, str]] = {}
    known = {*(sidecar.columns.get(n, n) for n in names)}
    for column in names:
        match = _BRACKETED.fullmatch(column)
        if match is None or match["unit"] not in UNITS or column in {*asked, *sidecar.ignore}:
            continue
        name = sidecar.columns.get(match["name"], match["name"])
        if column in sidecar.columns:
            found[column] = (sidecar.columns[column], match["unit"])
        elif name in {*asked} - known:
            found[column] = (name, match["unit"])
    return found


def with_bracketed(table: Table, asked: Collection[str], sidecar: Sidecar) -> tuple[Table, Sidecar]:
    """Returns a table that tells which columns are so, and what its TOML then would say of them.

    Args:
        table: as it stands in its file.
        asked: names of the columns that are read.
        sidecar: what the log's TOML says.

    Raises:
        InputError: two columns have one name, and differ in their unit.
    """
    found = bracketed(table.all_names, asked, sidecar)
    if not found:
        return table, sidecar
    columns = {column: name for column, (name, _) in found.items()}
    for name in repeated([*columns.values()]):
        both = [column for column, other in columns.items() if other == name]
        raise InputError(
            f"{table.path} has {name} in several columns: {listed(both)}; write"
            f" {toml_key(both[0])} = {toml_value(name)}, or another one of them, under [columns] in"
            f" {sidecar.path}"
        )
    units = {n: unit for n, unit in found.values() if lookup(sidecar.units, n) is None}
    others = {old: new for old, new in sidecar.columns.items() if new not in columns.values()}
    sidecar = replace(sidecar, columns={**others, **columns}, units={**sidecar.units, **units})
    told = [column for column, name in columns.items() if name in units]
    if not told:
        return table, sidecar
    return table.told(
        f"Columns {listed(told)} of log {table.path.stem!r} are read as {listed(units)}, in the"
        " units that stand in brackets."
    ), sidecar
