"""Columns whose headers say nearly what is asked: `time [s]`, `angle_deg`, `Angle`, `t`.

Exports of spreadsheets and of measuring programs write units behind names, or capitals. Where a log
has no column of a name that is asked for, a column is it whose header differs from it, in this
order,

    by a known unit in brackets                 time [s], angle (deg)
    by a known unit behind an underscore        angle_deg, x_mm
    by capitals, with such a unit or without    Angle, TIME [ms]
    as t does from time                         t, t_ms

and it is read in this unit, which a sentence tells. A column that the log's TOML names otherwise
has its unit too. What the TOML says of units comes before.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from identification.errors import InputError, repeated
from identification.logs.names import listed, lookup
from identification.logs.sidecar import Sidecar
from identification.logs.table import Table
from identification.logs.units import UNITS
from identification.storage.files import toml_key, toml_value

_BRACKETS = re.compile(r"(?P<name>[^\[(]+?)\s*[\[(]\s*(?P<unit>[^\])]+?)\s*[\])]")
# A unit of one letter may be anything else there: q_m is a motor's angle, or a measured one.
_UNDERSCORE = re.compile(r"(?P<name>.+)_(?P<unit>[^_]{2,})|(?P<time>t|time)_s", re.IGNORECASE)
# How units are written beside the words of `UNITS`.
_SPELLED = {
    "Nm": "N m", "N*m": "N m", "N·m": "N m", "N.m": "N m", "mNm": "mN m", "°": "deg",
    "degrees": "deg", "degree": "deg", "radians": "rad", "sec": "s", "seconds": "s", "µs": "us",
    "m/s²": "m/s^2", "RPM": "rpm",
}  # fmt: skip
_OF_TIME = "t"  # what many a log calls its time


def read_headers(
    names: Sequence[str], asked: Collection[str], sidecar: Sidecar, mapped: Collection[str] = ()
) -> Mapping[str, tuple[str, str]]:
    """Returns what each column is that is asked for by nearly this name, and its unit, or "".

    Args:
        names: of the columns of the file.
        asked: names of the columns that are read.
        sidecar: what the log's TOML says.
        mapped: those of `asked` that a user has written, so that their own headers say their unit.
    """
    known = {*(sidecar.columns.get(n, n) for n in names)}
    lacking = {*asked} - known
    rest = [n for n in names if n not in {*asked, *sidecar.ignore} or n in mapped]
    found: dict[str, tuple[str, str]] = {}
    ranks: dict[str, int] = {}
    for column in rest:
        if column in sidecar.columns or column in mapped:
            _, unit = name_and_unit(column)
            if unit:
                found[column] = (sidecar.columns.get(column, column), unit)
            continue
        for rank, (header, unit) in _readings(column):
            name = sidecar.columns.get(header, header)
            same = [n for n in lacking if _is_same(name, n, rank)]
            if len(same) == 1:
                if rank < ranks.get(same[0], rank + 1):  # a header that is nearer comes before
                    found = {c: said for c, said in found.items() if said[0] != same[0]}
                    ranks[same[0]] = rank
                if rank == ranks[same[0]]:
                    found[column] = (same[0], unit)
                break
    return found


def split_header(column: str) -> tuple[str, str]:
    """Returns the name and what stands in brackets behind it, "" where nothing does."""
    match = _BRACKETS.fullmatch(column)
    return (column, "") if match is None else (match["name"], match["unit"])


def name_and_unit(column: str) -> tuple[str, str]:
    """Returns the name that a header gives a column, and its known unit, "" where it has none."""
    return next(_readings(column))[1]


def _readings(column: str) -> Iterator[tuple[int, tuple[str, str]]]:
    """Yields name and unit that a header may mean, each with its place in the order."""
    split = []
    for rank, pattern in enumerate((_BRACKETS, _UNDERSCORE)):
        match = pattern.fullmatch(column)
        if match is not None:
            of_time = match.groupdict().get("time")
            unit = "s" if of_time else _SPELLED.get(match["unit"], match["unit"])
            if unit in UNITS:
                split.append((rank, (of_time or match["name"], unit)))
    yield from split
    each = [said for _, said in split] or [(column, "")]
    for rank in (2, 3):
        yield from ((rank, said) for said in each)


def _is_same(name: str, asked: str, rank: int) -> bool:
    if rank == 3:
        return name.casefold() == _OF_TIME and asked == "time"
    return name == asked if rank < 2 else name.casefold() == asked.casefold()


def with_headers(
    table: Table, asked: Collection[str], sidecar: Sidecar, mapped: Collection[str] = ()
) -> tuple[Table, Sidecar]:
    """Returns a table that tells which columns are so, and what its TOML then would say of them.

    Args:
        table: as it stands in its file.
        asked: names of the columns that are read.
        sidecar: what the log's TOML says.
        mapped: of `read_headers`.

    Raises:
        InputError: several columns are as near to one name.
    """
    found = read_headers(table.all_names, asked, sidecar, mapped)
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
    units = {n: unit for n, unit in found.values() if unit and lookup(sidecar.units, n) is None}
    told = [c for c, n in columns.items() if n in units or sidecar.columns.get(c) != n]
    others = {old: new for old, new in sidecar.columns.items() if new not in columns.values()}
    sidecar = replace(sidecar, columns={**others, **columns}, units={**sidecar.units, **units})
    if not told:
        return table, sidecar
    base = {c: split_header(c)[0] if c == columns[c] else columns[c] for c in told}
    names = [base[c] + (f" [{units[columns[c]]}]" if columns[c] in units else "") for c in told]
    what, are, say = (
        ("Column", "is", "its header says") if len(told) == 1
        else ("Columns", "are", "their headers say")
    )  # fmt: skip
    return table.told(
        f"{what} {listed(told)} of log {table.path.stem!r} {are} read as {listed(names)}, as {say}."
    ), sidecar
