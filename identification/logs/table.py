"""Named columns of numbers as they stand in a file, before units are converted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from identification.errors import InputError, repeated, unknown_name
from identification.logs.cures import toml_key
from identification.logs.names import listed, quoted
from identification.logs.sampling import FloatArray
from identification.logs.sidecar import Sidecar


@dataclass(frozen=True)
class Table:
    """Columns (n, c) of a file, their names (c), and a function that says where a row stands.

    `left` are the names of columns that nobody asked for; they are not read.
    """

    path: Path
    names: tuple[str, ...]
    data: FloatArray
    place: Callable[[int], str]
    left: tuple[str, ...] = ()

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the columns of the file."""
        return (*self.names, *self.left)

    def __getitem__(self, name: str) -> FloatArray:
        return self.data[:, self.names.index(name)]


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


class MissingColumnsError(InputError):
    """A log lacks columns, whose names are its `missing`."""

    def __init__(self, message: object = "", missing: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.missing = tuple(missing)


def check_columns(
    table: Table,
    needed: Sequence[str],
    optional: Sequence[str],
    sidecar: Sidecar,
    named_in: Path | None = None,
) -> None:
    """Refuse a table that lacks a needed column, or has an unknown one.

    Args:
        table: the table of the file.
        needed: columns that it must have.
        optional: columns that it may have.
        sidecar: the TOML beside the file.
        named_in: another file whose [columns] say what is needed; the sidecar when None.
    """
    good = [*needed, *optional]
    unknown = [n for n in table.names if n not in good]
    missing = [n for n in needed if n not in table.names]
    if missing and missing[0] == "time":
        raise InputError(_without_time(table, missing, sidecar))
    if missing:
        close = get_close_matches(missing[0], (*unknown, *table.left), n=1)
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


def _without_time(table: Table, missing: Sequence[str], sidecar: Sidecar) -> str:
    """Says what to write where no column is called time, as that of the likely column."""
    names = [*table.left, *table.names]
    likely = [
        *get_close_matches("time", names, n=1),
        *(n for n in names if "time" in n.lower() or "stamp" in n.lower() or n.lower() == "t"),
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


def check_finite(table: Table) -> None:
    """Refuse a cell that is not a finite number."""
    _refuse_cells(table, ~np.isfinite(table.data))


def check_stamps(table: Table) -> None:
    """Refuse a stamp of time that is no finite number, and a cell that is infinite."""
    bad = np.isinf(table.data)
    bad[:, table.names.index("time")] |= ~np.isfinite(table["time"])
    _refuse_cells(table, bad)


def _refuse_cells(table: Table, refused: np.ndarray) -> None:
    bad = np.argwhere(refused)
    if bad.size:
        row, column = bad[0]
        raise InputError(
            f"{table.place(int(row))}, column {quoted(table.names[column])}: "
            f"{table.data[row, column]} is not a finite number; fill the gap or cut the log there"
        )
