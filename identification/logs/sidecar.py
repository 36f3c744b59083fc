"""The TOML file beside a log, with the same stem; it says what the columns cannot say.

sampling_time = 0.01                # [s]
hold = "zoh"                        # or "foh"
notes = "third run, warm motors"
ignore = ["temperature"]            # columns of the file to leave out
[units]                             # by column or by group; SI where not given
current = "mA"
[columns]                           # column of the file = name it should have
q1 = "angle_1"                      # or, of a file without a header, columns = ["time", "skip", …]
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
        """The file that gives a key: another one, such as a robot's, or that beside the log."""
        return self.elsewhere.get(key, self.path)


def read_sidecar(
    path: Path, given: Mapping[str, Any] | None = None, given_in: Path | None = None
) -> Sidecar:
    """Read the TOML beside a log; the defaults when there is none.

    A table [log] in it says the same as the keys themselves.

    Args:
        path: of the TOML.
        given: keys that hold where the file does not say otherwise.
        given_in: the file that gives them, for messages.

    Raises:
        InputError: it is not TOML, a key is unknown, or a value is of the wrong kind.
    """
    values = _values(given or {}, given_in or path)
    elsewhere = dict.fromkeys(given or {}, given_in or path)
    if path.exists():
        content = read_toml(path)
        inner = content.pop("log", {})
        if not isinstance(inner, dict):
            raise InputError(f"log in {path} must be a table; correct it there")
        own = {**inner, **content}
        values |= _values(own, path)
        elsewhere = {key: file for key, file in elsewhere.items() if key not in own}
    return Sidecar(path=path, elsewhere=elsewhere, **values)


def _values(content: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """The values of the keys of a file, checked; a list of columns is a header."""
    values = {}
    for key, value in content.items():
        if key not in _KEYS:
            raise unknown_name(f"key in {path}:", key, _KEYS)
        kind, convert = _KEYS[key]
        try:
            if key == "columns" and isinstance(value, list):
                values["header"] = _names(value)
            else:
                values[key] = convert(value)
        except (TypeError, OverflowError) as error:
            raise InputError(f"{key} in {path} must be {kind}; correct it there") from error
    return values


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


def _texts(value: object) -> dict[str, str]:
    if not isinstance(value, dict):
        raise TypeError
    return {name: _text(v) for name, v in value.items()}


def _numbers(value: object) -> dict[str, float]:
    if not isinstance(value, dict):
        raise TypeError
    numbers = {name: _number(v) for name, v in value.items()}
    if not all(map(isfinite, numbers.values())):
        raise TypeError
    return numbers


def _factors(value: object) -> dict[str, float]:
    numbers = _numbers(value)
    if not all(numbers.values()):
        raise TypeError
    return numbers


def _splits(value: object) -> dict[str, tuple[float, float]]:
    if not isinstance(value, dict):
        raise TypeError
    pairs = {}
    for name, pair in value.items():
        if not (isinstance(pair, list) and len(pair) == 2):
            raise TypeError
        pairs[name] = (_number(pair[0]), _number(pair[1]))
    return pairs


_KEYS: dict[str, tuple[str, Callable[[object], Any]]] = {
    "sampling_time": ("a positive number of seconds", _step),
    "hold": (" or ".join(f'"{h}"' for h in HOLDS), _hold),
    "notes": ("text in quotes", _text),
    "ignore": ('a list of columns, such as ["temperature"]', _names),
    "units": ('a table of units, such as current = "mA"', _texts),
    "columns": ('a table of names, such as q1 = "angle_1", or a list of them', _texts),
    "factors": ("a table of numbers other than zero, such as angle_2 = -1", _factors),
    "splits": ("a table of parts in seconds, such as estimation = [0, 10]", _splits),
    "values": ('a table of numbers, such as "body/weight.mass" = 1.0', _numbers),
}
