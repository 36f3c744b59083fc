"""The TOML file beside a log, with the same stem; it says what the columns cannot say.

`docs/robot/keys.md` has every key with its type, unit, default and meaning. Units,
factors and zeros are given by column or by group; a factor comes on top of the unit, and a zero is
the number of the file that stands for zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import isfinite, isnan
from pathlib import Path
from typing import Any

from identification.errors import InputError, unknown_name
from identification.logs.log import HOLDS
from identification.storage.files import read_toml


@dataclass(frozen=True, kw_only=True)
class Sidecar:
    """The content of a sidecar; every key may be left out, and the file too."""

    path: Path
    sampling_time: float | None = None
    hold: str = "zoh"
    notes: str = ""
    ignore: tuple[str, ...] = ()
    header: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    zeros: Mapping[str, float] = field(default_factory=dict)
    splits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    elsewhere: Mapping[str, Path] = field(default_factory=dict)  # files of keys that it lacks

    def file_of(self, key: str) -> Path:
        """Returns the file that gives a key: that beside the log, or another, such as a robot's."""
        return self.elsewhere.get(key, self.path)


def read_sidecar(
    path: Path, given: Mapping[str, Any] | None = None, given_in: Path | None = None
) -> Sidecar:
    """Read the TOML beside a log; the defaults when there is none.

    A table [log] in it says the same as the keys themselves.
    """
    values = _values(given or {}, f"[log] of {given_in or path}")
    elsewhere = dict.fromkeys(given or {}, given_in or path)
    if path.exists():
        content = read_toml(path)
        inner = content.pop("log", {})
        if not isinstance(inner, dict):
            raise InputError(f"log in {path} must be a table; correct it there")
        values |= _values(inner, f"[log] of {path}") | _values(content, str(path))
        given_here = {**inner, **content}
        elsewhere = {key: file for key, file in elsewhere.items() if key not in given_here}
    return Sidecar(path=path, elsewhere=elsewhere, **values)


def _values(content: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Returns the values of the keys of a file, checked; a list of columns is a header."""
    values = {}
    for key, value in content.items():
        if key == "columns" and isinstance(value, list):
            values["header"] = _checked(value, f"{key} in {where}", _is_names, _COLUMNS)
        elif key in _TABLES:
            of_table, is_good, of_entry = _TABLES[key]
            _checked(value, f"{key} in {where}", lambda v: isinstance(v, dict), of_table)
            values[key] = {
                name: _checked(entry, f"{name} under {key} in {where}", is_good, of_entry)
                for name, entry in value.items()
            }
        elif key in _KEYS:
            values[key] = _checked(value, f"{key} in {where}", *_KEYS[key])
        else:
            raise unknown_name(f"key in {where}:", key, (*_KEYS, *_TABLES))
    return values


def _checked(value: Any, what: str, is_good: Callable[[Any], bool], kind: str) -> Any:
    """Returns a value with floats and tuples in the place of numbers and lists, if it is good."""
    if not is_good(value):
        raise InputError(f"{what} must be {kind}; correct it there")
    if isinstance(value, list):
        return tuple(float(v) if _is_number(v) else v for v in value)
    return float(value) if _is_number(value) else value


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_names(value: Any) -> bool:
    return isinstance(value, list) and all(map(_is_text, value))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and not isnan(value)


def _is_finite(value: Any) -> bool:
    return _is_number(value) and isfinite(value)


_KEYS: dict[str, tuple[Callable[[Any], bool], str]] = {  # whether it is good, what it must be
    "sampling_time": (lambda v: _is_finite(v) and v > 0, "a positive number of seconds"),
    "hold": (lambda v: v in HOLDS, " or ".join(f'"{h}"' for h in HOLDS)),
    "notes": (_is_text, "text in quotes"),
    "ignore": (_is_names, 'a list of columns, such as ["temperature"]'),
}
_COLUMNS = 'a table of names, such as q1 = "angle_1", or a list of them'
# What the table must be, whether an entry is good, and what it must be.
_TABLES: dict[str, tuple[str, Callable[[Any], bool], str]] = {
    "units": (
        'a table of units, such as current = "mA"', _is_text, 'a unit in quotes, such as "mA"'
    ),
    "columns": (_COLUMNS, _is_text, "a name in quotes"),
    "factors": (
        "a table of numbers", lambda v: _is_finite(v) and v != 0,
        "a number other than zero, such as -1",
    ),
    "zeros": ("a table of numbers", _is_finite, "a finite number, such as 2048"),
    "splits": (
        "a table of parts in seconds, such as estimation = [0, 10]",
        lambda v: isinstance(v, list) and len(v) == 2 and all(map(_is_number, v)),
        "two times, such as [0, 10]",
    ),
    "values": (
        'a table of numbers, such as "body/weight.mass" = 1.0', _is_finite, "a finite number"
    ),
}  # fmt: skip
