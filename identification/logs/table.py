"""Named columns of numbers, as they stand in a file and as they are in SI units."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from math import inf, isfinite
from pathlib import Path

import numpy as np

from identification.errors import InputError, repeated, told_of, unknown_name
from identification.logs.names import listed, lookup, quoted
from identification.logs.sampling import FloatArray
from identification.logs.sidecar import Sidecar
from identification.logs.units import to_si
from identification.storage.files import toml_key

HUGE = 1e15  # of any SI unit: no angle, way, force, voltage or current of a robot is so large


@dataclass(frozen=True)
class Table:
    """Columns (n, c) of a file, their names (c), and a function that says where a row stands.

    `unread` are the names of columns that nobody asked for; they are not read. `remarks` tell what
    was taken for granted when it was read, a sentence each.
    """

    path: Path
    names: tuple[str, ...]
    data: FloatArray
    place: Callable[[int], str]
    unread: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the columns of the file."""
        return (*self.names, *self.unread)

    def told(self, remark: str) -> Table:
        """Returns the table with one more sentence on what was taken for granted."""
        return replace(self, remarks=(*self.remarks, remark))

    def __getitem__(self, name: str) -> FloatArray:
        return self.data[:, self.names.index(name)]


class MissingColumnsError(InputError):
    """A log lacks columns, whose names are its `missing`."""

    def __init__(self, message: object = "", missing: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.missing = tuple(missing)


def renamed(table: Table, sidecar: Sidecar) -> Table:
    """Returns the table without the columns of `sidecar.ignore`, those of `columns` renamed."""
    for what, wanted in (("columns", tuple(sidecar.columns)), ("ignore", sidecar.ignore)):
        for name in wanted:
            if name not in table.all_names:
                raise unknown_name(
                    f"column under {what!r} in {sidecar.file_of(what)}:",
                    name,
                    map(quoted, table.all_names),
                )
    keep = [k for k, name in enumerate(table.names) if name not in sidecar.ignore]
    names = tuple(sidecar.columns.get(table.names[k], table.names[k]) for k in keep)
    twice = repeated(names)
    if twice:
        raise InputError(
            f"{table.path} has {listed(twice)} more than once; keep one column of each name"
        )
    return replace(table, names=names, data=table.data[:, keep])


def check_columns(
    table: Table,
    needed: Sequence[str],
    optional: Sequence[str],
    sidecar: Sidecar,
    named_in: Path | None = None,
) -> None:
    """Refuse a table that lacks a needed column, or has one that is neither needed nor optional.

    `named_in` is another file than the sidecar whose [columns] say what is needed.
    """
    good = [*needed, *optional]
    unknown = [n for n in table.names if n not in good]
    missing = [n for n in needed if n not in table.names]
    if missing and missing[0] == "time":
        raise InputError(_without_time(table, missing, sidecar))
    if missing:
        close = get_close_matches(missing[0], (*unknown, *table.unread), n=1)
        slip = f" (is {missing[0]} its column {quoted(close[0])}?)" if close else ""
        where = sidecar.path if named_in is None else named_in
        raise MissingColumnsError(
            f"{table.path} lacks {_columns(missing)}{slip}; it has {listed(table.all_names)};"
            f" correct its names or map them under [columns] in {where}",
            missing,
        )
    if unknown:
        close = get_close_matches(unknown[0], good, n=1)
        slip = f" (is {quoted(unknown[0])} meant to be {close[0]}?)" if close else ""
        raise InputError(
            f"{table.path} has unknown {_columns(unknown)}{slip}; good names are {listed(good)}; "
            f"remove the others or list them under 'ignore' in {sidecar.path}"
        )


def check_finite(table: Table) -> None:
    """Refuse a cell that is not a finite number."""
    _refuse_cells(table, ~np.isfinite(table.data))


def check_stamps(table: Table) -> None:
    """Refuse a stamp of time that is no finite number, and a cell that is infinite."""
    bad = np.isinf(table.data)
    bad[:, table.names.index("time")] |= ~np.isfinite(table["time"])
    _refuse_cells(table, bad)


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
    """Returns the table in SI units, each column from its zero on."""
    zeros = [lookup(sidecar.zeros, name) or 0.0 for name in table.names]
    # What overflows without a factor is refused with its row.
    with np.errstate(over="ignore", invalid="ignore"):
        data = (table.data - zeros) * [factors[name] for name in table.names]
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


def _without_time(table: Table, missing: Sequence[str], sidecar: Sidecar) -> str:
    """Says what to write where no column is called time, as that of the likely column."""
    names = [*table.unread, *table.names]
    likely = [
        *get_close_matches("time", names, n=1),
        *(
            n
            for n in names
            if "time" in n.lower()
            or "stamp" in n.lower()
            or "date" in n.lower()
            or n.lower() == "t"
        ),
    ]
    called = likely[0] if likely else "stamp"
    which = f"if {quoted(called)} is it" if likely else "if it is called stamp"
    return (
        f"{table.path} lacks {_columns(missing)}; it has {listed(table.all_names)}; the column of"
        f' time is named in the log\'s TOML: {which}, write {toml_key(called)} = "time" under'
        f' [columns] in {sidecar.path}, with time = "ns" under [units] there where its numbers'
        " are in ns, or else give sampling_time there"
    )


def _columns(names: Sequence[str]) -> str:
    return ("column " if len(names) == 1 else "columns ") + listed(names)


def _refuse_cells(table: Table, refused: np.ndarray) -> None:
    bad = np.argwhere(refused)
    if bad.size:
        row, column = bad[0]
        raise InputError(
            f"{table.place(int(row))}, column {quoted(table.names[column])}: "
            f"{table.data[row, column]} is not a finite number; fill the gap or cut the log there"
        )
