"""Write a `Log` to a file that `read_log` reads back to the last bit."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

from identification.errors import InputError
from identification.files import write_text
from identification.logs.log import Log
from identification.logs.names import group


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
    said = _toml(log)
    write_text(path, _csv(log, digits))
    if said or sidecar.exists():
        write_text(sidecar, said)


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
        lines.append(f"hold = {_quote(log.hold)}")
    if log.notes:
        lines.append(f"notes = {_quote(log.notes)}")
    if log.units:
        lines += ["", "[units]"]
        lines += [f"{_quote(name)} = {_quote(unit)}" for name, unit in _grouped(log)]
    if log.splits:
        lines += ["", "[splits]"]
        lines += [f"{_quote(name)} = [{a!r}, {b!r}]" for name, (a, b) in log.splits.items()]
    if log.values:
        lines += ["", "[values]"]
        lines += [f"{_quote(name)} = {float(value)!r}" for name, value in log.values.items()]
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


def _quote(text: str) -> str:
    # A JSON string is also a TOML string, except that TOML wants DEL escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
