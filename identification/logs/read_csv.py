"""CSV to a table: one header row of names, then one row of numbers for each sample.

A correct file is read by one call of numpy's parser. Only a file that it refuses is read again,
cell by cell, to say which line is wrong.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from identification.errors import InputError, repeated
from identification.logs.names import listed, quoted
from identification.logs.sampling import FloatArray
from identification.logs.table import Table

_WRONG_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "spaces"}


def parse_csv(raw: bytes, path: Path) -> Table:
    """The table in a CSV file.

    Comment lines above the header, a byte order mark, CRLF and blank lines are accepted.

    Raises:
        InputError: it is empty, not text, not separated by commas, has rows of different lengths,
            or has a cell that is not a number.
    """
    text = _decoded(raw, path).replace("\r\n", "\n").replace("\r", "\n")
    lines = text.split("\n")
    filled = [k for k, line in enumerate(lines) if line and not line.isspace()]
    start = next((i for i, k in enumerate(filled) if not lines[k].startswith("#")), None)
    if start is None:
        raise InputError(f"{path} is empty; it needs a header row and one row for each sample")
    names = _header(lines[filled[start]], filled[start] + 1, path)
    rows = filled[start + 1 :]
    if not rows:
        raise InputError(
            f"{path} has a header and no rows under it; record the log again, or export its samples"
        )
    body = [lines[k] for k in rows]
    return Table(
        path, names, _numbers(body, rows, names, path), lambda row: _place(rows[row], path)
    )


def _place(line: int, path: Path) -> str:
    return f"line {line + 1} of {path}"


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
            "time,input,output and without #, above them"
        )
    twice = repeated(names)
    if twice:
        raise InputError(f"{path} has {listed(twice)} more than once; keep one column of each name")
    return names


def _numbers(body: list[str], rows: list[int], names: tuple[str, ...], path: Path) -> FloatArray:
    try:
        data = np.loadtxt(body, delimiter=",", comments=None, ndmin=2)
    except ValueError:
        data = None
    if data is not None and data.shape == (len(body), len(names)):
        return data
    return np.array(
        [_row(line, k, names, path) for line, k in zip(body, rows, strict=True)], dtype=np.float64
    )


def _row(line: str, k: int, names: tuple[str, ...], path: Path) -> list[float]:
    cells = line.split(",")
    if len(cells) != len(names):
        raise InputError(
            f"{_place(k, path)} has {len(cells)} cells and the header has {len(names)}; "
            "complete that row, or cut the log there"
        )
    for name, cell in zip(names, cells, strict=True):
        if not _is_number(cell):
            what = f"{quoted(cell)} is not a number" if cell.strip() else "the cell is empty"
            raise InputError(
                f"{_place(k, path)}, column {quoted(name)}: {what}; write a number there, or "
                "cut the log"
            )
    return [float(cell) for cell in cells]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell  # Python reads 1_000 as a number; no instrument writes it
