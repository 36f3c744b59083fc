"""A column is known by its own name or by its group: `angle_3` belongs to the group `angle`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TypeVar

from identification.errors import InputError, repeated, unknown_name

Value = TypeVar("Value")

_NUMBER = re.compile(r"_\d+$")
_LISTED = 24  # names in one message: enough for a robot's log, short enough for one sentence


def group(name: str) -> str:
    """Returns the name without its trailing number: `angle` of `angle_3`, `x` of `x`."""
    return _NUMBER.sub("", name)


def lookup(table: Mapping[str, Value], name: str) -> Value | None:
    """Returns the entry of `table` for a column: under its own name, or else under its group."""
    return table.get(name, table.get(group(name)))


def check_keys(what: str, keys: Iterable[str], columns: Iterable[str]) -> None:
    """Refuse a key that is neither a column nor a group, because it would have no effect."""
    known = {n for column in columns for n in (column, group(column))}
    for key in keys:
        if key not in known:
            raise unknown_name(what, key, known)


def listed(names: Iterable[str]) -> str:
    """Returns names for a message: always on one line, and shortened when there are too many."""
    every = list(names)
    shown = ", ".join(quoted(n) for n in every[:_LISTED])
    return shown + (f" and {len(every) - _LISTED} more" if len(every) > _LISTED else "")


def quoted(text: str, longest: int = 40) -> str:
    """Returns a file's text for a message: a plain name as it is, else escaped and shortened."""
    if text.isprintable() and 0 < len(text) <= longest and text == text.strip():
        return text
    return repr(text if len(text) <= longest else text[: longest - 3] + "...")


def check_column_names(names: Iterable[str]) -> None:
    """Refuse names that a CSV header could not hold, and names that occur twice."""
    every = list(names)
    for name in every:
        plain = name.isprintable() and name == name.strip() and not set(name) & set(',"')
        if not name or not plain or name.startswith("#") or name == "time":
            raise InputError(
                f"{name!r} cannot name a column of a log; use printable text without commas or "
                "quotes, other than 'time'"
            )
    twice = repeated(every)
    if twice:
        raise InputError(f"the log names {listed(twice)} twice; give each column a name of its own")
