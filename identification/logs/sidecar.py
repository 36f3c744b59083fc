"""The TOML file beside a log, with the same stem; it says what the columns cannot say.

sampling_time = 0.01                # [s]
hold = "zoh"                        # or "foh"
notes = "third run, warm motors"
ignore = ["temperature"]            # columns of the file to leave out
[units]                             # by column or by group; SI where not given
current = "mA"
time = "ns"                         # stamps beyond 2^53 count less the first one
[columns]                           # column of the file = name it should have
q1 = "angle_1"                      # or, of a file without a header, columns = ["time", "skip", …]
stamp_s = "time.sec"                # two columns that make the time, with "time.nanosec"
[factors]                           # by column or by group: what its numbers are multiplied with
angle_2 = -1                        # turns a sign; a factor comes on top of the unit
[splits]                            # [start, end) [s]
estimation = [0, 10]
validation = [10, 20]
[values]                            # of the robot, in this log alone
"body/weight.mass" = 1.0
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import isfinite, isnan
from pathlib import Path
from typing import Any

from identification.errors import InputError, unknown_name
from identification.files import read_toml
from identification.logs.log_checks import HOLDS


@dataclass(frozen=True, kw_only=True)
class Sidecar:
    """The content of a sidecar; every key may be left out, and the file too.

    `elsewhere` are the keys that another file gives, with its path.
    """

    path: Path
    sampling_time: float | None = None
    hold: str = "zoh"
    notes: str = ""
    ignore: tuple[str, ...] = ()
    header: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    splits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    elsewhere: Mapping[str, Path] = field(default_factory=dict)

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
        own = {**inner, **content}
        elsewhere = {key: file for key, file in elsewhere.items() if key not in own}
    return Sidecar(path=path, elsewhere=elsewhere, **values)


def _values(content: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Returns the values of the keys of a file, checked; a list of columns is a header."""
    values = {}
    for key, value in content.items():
        if key in _TABLES and not (key == "columns" and isinstance(value, list)):
            values[key] = _table(key, value, where)
        elif key in _KEYS or key in _TABLES:
            name, (kind, convert) = ("header", _HEADER) if key in _TABLES else (key, _KEYS[key])
            values[name] = _converted(value, convert, f"{key} in {where}", kind)
        else:
            raise unknown_name(f"key in {where}:", key, (*_KEYS, *_TABLES))
    return values


def _table(key: str, value: object, where: str) -> dict[str, Any]:
    """Returns a table with each of its entries converted."""
    example, kind, convert = _TABLES[key]
    if not isinstance(value, dict):
        raise InputError(f"{key} in {where} must be {example}; correct it there")
    return {
        name: _converted(entry, convert, f"{name} under {key} in {where}", kind)
        for name, entry in value.items()
    }


def _converted(value: object, convert: Callable[[object], Any], what: str, kind: str) -> Any:
    try:
        return convert(value)
    except (TypeError, OverflowError) as error:
        raise InputError(f"{what} must be {kind}; correct it there") from error


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _hold(value: object) -> str:
    if value not in HOLDS:
        raise TypeError
    return _text(value)


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or isnan(value):
        raise TypeError
    return float(value)


def _step(value: object) -> float:
    step = _number(value)
    if not (isfinite(step) and step > 0):
        raise TypeError
    return step


def _names(value: object) -> tuple[str, ...]:
    if not isinstance(value, list):
        raise TypeError
    return tuple(_text(v) for v in value)


def _finite(value: object) -> float:
    number = _number(value)
    if not isfinite(number):
        raise TypeError
    return number


def _factor(value: object) -> float:
    if not (factor := _finite(value)):
        raise TypeError
    return factor


def _pair(value: object) -> tuple[float, float]:
    if not (isinstance(value, list) and len(value) == 2):
        raise TypeError
    return _number(value[0]), _number(value[1])


_KEYS: dict[str, tuple[str, Callable[[object], Any]]] = {
    "sampling_time": ("a positive number of seconds", _step),
    "hold": (" or ".join(f'"{h}"' for h in HOLDS), _hold),
    "notes": ("text in quotes", _text),
    "ignore": ('a list of columns, such as ["temperature"]', _names),
}
_COLUMNS = 'a table of names, such as q1 = "angle_1", or a list of them'
_HEADER = (_COLUMNS, _names)
_TABLES: dict[str, tuple[str, str, Callable[[object], Any]]] = {  # with what an entry must be
    "units": ('a table of units, such as current = "mA"', 'a unit in quotes, such as "mA"', _text),
    "columns": (_COLUMNS, "a name in quotes", _text),
    "factors": ("a table of numbers", "a number other than zero, such as -1", _factor),
    "splits": (
        "a table of parts in seconds, such as estimation = [0, 10]", "two times, such as [0, 10]",
        _pair,
    ),
    "values": (
        'a table of numbers, such as "body/weight.mass" = 1.0', "a finite number", _finite
    ),
}  # fmt: skip
