"""Logs as CSV: read into a table, and written to be read back to the last bit."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path

import numpy as np

from identification.errors import InputError, repeated
from identification.logs.log import Log
from identification.logs.names import group, listed, quoted
from identification.logs.stamps.stamps import WHOLE, dates_as_seconds, exact_stamps, seconds_of
from identification.logs.table import Table
from identification.storage.files import toml_table, toml_value, write_text

_WRONG_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "spaces"}
SKIP = "skip"  # name of a column without a header that nobody needs


def parse_csv(
    raw: bytes,
    path: Path,
    header: Sequence[str] = (),
    wanted: Callable[[Sequence[str]], Collection[str]] | None = None,
    stamps: Collection[str] = ("time",),
) -> Table:
    """Reads the table in the bytes of a CSV file; see `formats.log_table`.

    Comment lines above the header, a byte order mark, CRLF and blank lines are accepted. A given
    header replaces that of the file, where it has one. The empty cells of wanted columns are NaN;
    where nothing says which are wanted, all columns are read, and none may have an empty cell.
    """
    text = _decoded(raw, path).replace("\r\n", "\n").replace("\r", "\n")
    lines = text.split("\n")
    filled = [k for k, line in enumerate(lines) if line and not line.isspace()]
    start = next((i for i, k in enumerate(filled) if not lines[k].startswith("#")), None)
    if start is None:
        raise InputError(f"{path} is empty; it needs a header row and one row for each sample")
    first = lines[filled[start]]
    names = _given(header, first, path) if header else _header(first, filled[start] + 1, path)
    cells = zip(names, first.split(","), strict=True)
    numbers = all(_is_number(cell) or seconds_of(cell) for name, cell in cells if name != SKIP)
    rows = filled[start + (0 if header and numbers else 1) :]
    asked = names if wanted is None else wanted(names)
    keep = [k for k, n in enumerate(names) if n != SKIP and n in asked]
    if wanted is None and not header:
        keep = [*range(len(names))]
    twice = repeated([names[k] for k in keep])
    if twice:
        raise InputError(f"{path} has {listed(twice)} more than once; keep one column of each name")
    if not rows:
        raise InputError(
            f"{path} has a header and no rows under it; record the log again, or export its samples"
        )
    body, gaps = [lines[k] for k in rows], wanted is not None
    dated = [k for k in keep if names[k] in stamps and _as_seconds(lines, rows, k)]
    body = [lines[k] for k in rows] if dated else body
    try:
        data = np.loadtxt(body, delimiter=",", comments=None, ndmin=2)
    except ValueError:
        data = np.empty(0)
    if data.shape == (len(body), len(names)):
        data = data[:, keep]
    else:  # a cell is empty or is no number, or a row has too many of them
        each = zip(body, rows, strict=True)
        data = np.array([_row(line, k, names, path, keep, gaps) for line, k in each])
    unread = tuple(n for k, n in enumerate(names) if k not in keep)
    kept = tuple(names[k] for k in keep)
    for k, column in enumerate(keep):
        # Beyond WHOLE a float lost digits that the file has.
        if names[column] in stamps and WHOLE <= np.abs(data[:, k]).max() < np.inf:
            data[:, k] = exact_stamps([lines[row].split(",")[column] for row in rows])
    table = Table(path, kept, data, lambda row: _place(rows[row], path), unread)
    if not dated:
        return table
    return table.told(f"Stamps of log {path.stem!r} are dates; its time counts from the first one.")


def _as_seconds(lines: list[str], rows: Sequence[int], k: int) -> bool:
    """Writes the dates in cells k of some lines as seconds from the first; False without dates."""
    cells = [lines[row].split(",") for row in rows]
    whole = [n for n, row in enumerate(cells) if len(row) > k]
    seconds = dates_as_seconds([cells[n][k] for n in whole])
    if seconds is None:
        return False
    for n, text in zip(whole, seconds, strict=True):
        cells[n][k] = text
        lines[rows[n]] = ",".join(cells[n])
    return True


def _given(header: Sequence[str], first: str, path: Path) -> tuple[str, ...]:
    """Returns the names that a TOML gives, if the file has as many columns."""
    columns = first.count(",") + 1
    if columns != len(header):
        raise InputError(
            f"{path} has {columns} columns, and {len(header)} are named for it under 'columns';"
            f' name each, and those that are not needed "{SKIP}"'
        )
    return tuple(header)


def _decoded(raw: bytes, path: Path) -> str:
    if b"\0" in raw:
        raise InputError(
            f"{path} is binary, not text (byte {raw.index(0)} is zero); export it as CSV in UTF-8"
        )
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path} is not UTF-8 text (byte {error.start} is 0x{raw[error.start]:02x}); "
            "export it as CSV in UTF-8"
        ) from error


def _header(line: str, number: int, path: Path) -> tuple[str, ...]:
    if "," not in line:
        for separator, word in _WRONG_SEPARATORS.items():
            if separator in line.strip():
                raise InputError(
                    f"{path} separates its columns by {word}; export it with commas between "
                    "columns and points in numbers"
                )
    names = tuple(name.strip().strip('"').strip() for name in line.split(","))
    if all(_is_number(name) for name in names):
        raise InputError(
            f"line {number} of {path} holds numbers and not names; put a header row, such as "
            "time,input,output and without #, above them, or list their names in order as columns"
            f" in {path.with_suffix('.toml')}"
        )
    return names


def _row(
    line: str, k: int, names: tuple[str, ...], path: Path, keep: list[int], gaps: bool
) -> list[float]:
    cells = line.split(",")
    if len(cells) != len(names):
        raise InputError(
            f"{_place(k, path)} has {len(cells)} cells and the header has {len(names)}; "
            "complete that row, or cut the log there"
        )
    for name, cell in ((names[i], cells[i]) for i in keep):
        if not (_is_number(cell) or (gaps and not cell.strip())):
            what = f"{quoted(cell)} is not a number" if cell.strip() else "the cell is empty"
            raise InputError(
                f"{_place(k, path)}, column {quoted(name)}: {what}; write a number there, or "
                "cut the log"
            )
    return [float(cells[i]) if cells[i].strip() else float("nan") for i in keep]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell  # Python reads 1_000 as a number; no instrument writes it


def _place(line: int, path: Path) -> str:
    return f"line {line + 1} of {path}"


def write_log(log: Log, path: str | os.PathLike[str], digits: int | None = None) -> None:
    """Write a CSV, and a TOML beside it if there is something that a CSV cannot say.

    Each file is written whole or not at all. An old TOML is replaced also when the new log needs
    none, because it would describe another log.

    Args:
        log: what to write.
        path: the `.csv` file; an existing one is replaced.
        digits: significant digits of the columns; None for as many as are exact. Time is always
            exact, because rounded stamps would no longer be even.

    Raises:
        InputError: the name is not `.csv`, the folder is missing, or it cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() != ".csv":
        raise InputError(f"a log is written as CSV, so {path} must end in .csv; rename it")
    if digits is not None and digits < 1:
        raise InputError(f"digits = {digits} leaves nothing of a number; give 1 to 17, or None")
    sidecar = path.with_suffix(".toml")
    text = _toml(log)
    write_text(path, _csv(log, digits))
    if text or sidecar.exists():
        write_text(sidecar, text)


def _csv(log: Log, digits: int | None) -> str:
    columns = log.columns
    form = repr if digits is None else f"{{:.{digits}g}}".format
    cells = [map(repr, log.time.tolist())]
    cells += [map(form, column.tolist()) for column in columns.values()]
    lines = [",".join(("time", *columns)), *map(",".join, zip(*cells, strict=True))]
    return "\n".join(lines) + "\n"


def _toml(log: Log) -> str:
    lines = []
    if log.hold != "zoh":
        lines.append(f"hold = {toml_value(log.hold)}")
    if log.notes:
        lines.append(f"notes = {toml_value(log.notes)}")
    lines += toml_table("units", dict(_grouped(log)))
    lines += toml_table("splits", log.splits)
    lines += toml_table("values", {name: float(value) for name, value in log.values.items()})
    return "\n".join(lines).lstrip() + "\n" if lines else ""


def _grouped(log: Log) -> Iterator[tuple[str, str]]:
    """Yields units by group where all columns of a group have the same unit, else by column."""
    members: dict[str, list[str]] = {}
    for name in log.columns:
        members.setdefault(group(name), []).append(name)
    for family, names in members.items():
        words = {log.units.get(name) for name in names}
        unit = words.pop()
        if not words and unit:
            yield family, unit
        else:
            yield from ((name, log.units[name]) for name in names if name in log.units)
