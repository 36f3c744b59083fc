"""Columns whose headers give a unit that nobody knows here, such as `pos [counts]`.

The header of a column that a user maps says its unit. What stands there in brackets and is no known
unit may be one all the same, and then the numbers are not in SI units, as they are read. This is
told, and how to give the unit, unless the log's TOML gives the column a unit or a factor.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence

from identification.logs.headers.headers import name_and_unit, split_header
from identification.logs.names import listed, lookup, quoted
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.logs.units import UNITS, dimension
from identification.storage.files import toml_key


def unknown_unit(column: str) -> str:
    """Returns what stands in brackets behind a column's name and is no known unit; "" for none.

    A number there counts columns, such as `pos [0]`.
    """
    word = split_header(column)[1]
    return "" if name_and_unit(column)[1] or not any(map(str.isalpha, word)) else word


def by_unknown_unit(columns: Iterable[str]) -> dict[str, list[str]]:
    """Returns the columns that have an unknown unit, by this unit."""
    found: dict[str, list[str]] = {}
    for column in columns:
        if word := unknown_unit(column):
            found.setdefault(word, []).append(column)
    return found


def told_of_unknown_units(
    table: Table, sidecar: Sidecar, units: Mapping[str, str], mapped: Collection[str]
) -> Table:
    """Returns a table that tells of columns in units that nobody knows, and how to give them.

    Args:
        table: as it stands in its file.
        sidecar: what its TOML says.
        units: SI unit of each column or group, by its new name, where it is known.
        mapped: columns that a user has written for others elsewhere than in this TOML.
    """
    names = {c: sidecar.columns.get(c, c) for c in table.names if c not in sidecar.ignore}
    told = [
        column
        for column, name in names.items()
        if (column in sidecar.columns or column in mapped)
        and lookup(sidecar.units, name) is None
        and lookup(sidecar.factors, name) is None
    ]
    for word, columns in by_unknown_unit(told).items():
        by_si: dict[str, list[str]] = {}
        for column in columns:
            by_si.setdefault(lookup(units, names[column]) or "", []).append(column)
        for si, same in by_si.items():
            text = _sentence(table, word, same, si, names[same[0]], sidecar)
            table = table.told(text)
    return table


def unknown_sentence(word: str, columns: Sequence[str]) -> str:
    """Returns one sentence on columns of which nobody has said yet what they are."""
    return (
        f"{quoted(word)} in the header{'s' * (len(columns) > 1)} of {listed(columns)} is no known"
        f" unit; known: {known_units()}."
    )


def known_units(si: str = "") -> str:
    """Returns the units that a log may use, in words: of one quantity, or of all."""
    return ", ".join(word for word, (of, _) in UNITS.items() if si in ("", of))


def _sentence(
    table: Table, word: str, columns: list[str], si: str, name: str, sidecar: Sidecar
) -> str:
    """Returns one sentence on columns with one unknown unit, the first of which is called so."""
    key, in_si = toml_key(name), si or "its SI unit"
    given, wanted = dimension(word), dimension(si)
    is_alike = given is not None and wanted is not None and given.powers == wanted.powers
    size = f"{given.factor:.9g}" if given is not None and (is_alike or not si) else "0.001"
    read, each = "column is", ""
    if len(columns) > 1:
        read, each = "columns are", " (a line for each)"
    word, where = quoted(word), sidecar.file_of("units")
    return (
        f"{word} in the header{'s' * bool(each)} of {listed(columns)} of log {table.path.stem!r} is"
        f" no known unit, and the {read} read in {si or 'SI units'}. If {word} is one, write"
        f' {key} = "UNIT" under [units] in {where}{each}, with one of {known_units(si)}; or write'
        f" what 1 {word} is in {in_si} under [factors] there, such as {key} = {size}."
    )
