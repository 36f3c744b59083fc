"""The keys that the TOML of a robot has, and whether their values are of the right kinds."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, isfinite
from pathlib import Path
from typing import Any

from identification.errors import InputError, unknown_name

Kinds = Mapping[str, tuple[type | tuple[type, ...], str]]  # by key: the types, and what they are
TEXT, NUMBER = (str, "text in quotes"), ((int, float), "a number")
KEYS: Kinds = {
    "model": (str, "a path in quotes"),
    "outputs": (list, "a list of sensors"),
    "free": (list, "a list of parameters"),
    "held": (list, "a list of parameters"),
    "own": (list, "a list of free parameters"),
    "horizon": ((int, float), "a number of seconds"),
    "every": (int, "a whole number of samples"),
    "trust": (list, "a list of words in quotes"),
    "start": (dict, "a table of numbers"),
    "log": (dict, "a table"),
    "columns": (dict, "a table"),
    "fixed": (dict, "a table of numbers"),
    "parameters": (dict, "a table of tables"),
    "own_values": (dict, "a table of tables, one for each log"),
    "spread": (dict, "a table of tables"),
    "effects": (dict, "a table"),
    "fitted": (dict, "a table of text in quotes"),
}
PARAMETER_KEYS: Kinds = {  # of [parameters.NAME]
    **dict.fromkeys(("path", "unit", "about"), TEXT),
    **dict.fromkeys(("value", "std", "prior", "known", "lower", "upper", "scale"), NUMBER),
}
EFFECTS_KEYS: Kinds = {  # of [effects]
    **dict.fromkeys(("joints", "only", "own"), (list, "a list of names")),
    "turns": (list, "a list of numbers above zero"),
}
POSITIVE = ("every", "known", "scale", "std")
TINY, HUGE = 1e-50, 1e50  # of any unit: their squares, and what is divided by these, are numbers


def check_table(table: Mapping[str, Any], kinds: Kinds, where: str) -> None:
    """Refuse a table with an unknown key or a value of a wrong kind."""
    for key, value in table.items():
        if key not in kinds:
            raise unknown_name(f"key in {where}:", key, kinds)
        kind, words = kinds[key]
        number = isinstance(value, int | float) and not isinstance(value, bool)
        good = isinstance(value, kind) and not isinstance(value, bool)
        if good and number:
            good = isfinite(value) and (key not in POSITIVE or value > 0)
            if good and key in POSITIVE and not TINY <= value <= HUGE:
                raise InputError(
                    f"{key} in {where} is {value:g}, which no robot has; write a number between"
                    f" {TINY:g} and {HUGE:g}"
                )
        if not good:
            raise InputError(f"{key} in {where} must be {words}; correct it there")


def read_own(content: Mapping[str, Any], path: Path) -> tuple[str, ...]:
    """Returns the names of the free parameters of which each log has a value of its own."""
    names = texts(content.get("own", []), "own", path)
    for name in names:
        if name not in content["free"]:
            raise unknown_name(f"free parameter under own in {path}:", name, content["free"])
    if names and "horizon" not in content:
        raise InputError(
            f"own in {path} is for records that are predicted over a horizon; write horizon = 0.2"
            " (in seconds) into it"
        )
    return names


def read_own_values(content: Mapping[str, Any], path: Path) -> dict[str, dict[str, float]]:
    """Returns, by log, the values at which the search of its own values begins."""
    found = content.get("own_values", {})
    for log, values in found.items():
        where = f"own_values.{log} in {path}"
        if not isinstance(values, dict):
            raise InputError(f"{where} must be a table of numbers")
        check_table(values, dict.fromkeys(content.get("own", []), NUMBER), where)
    return {log: {n: float(v) for n, v in values.items()} for log, values in found.items()}


def numbers_of(table: Mapping[str, Any], where: str) -> dict[str, float]:
    """Returns a table of numbers; refuses one that has anything else."""
    check_table(table, dict.fromkeys(table, NUMBER), where)
    return {name: float(value) for name, value in table.items()}


def words_of(table: Mapping[str, Any], where: str) -> dict[str, str]:
    """Returns a table of text; refuses one that has anything else."""
    check_table(table, dict.fromkeys(table, TEXT), where)
    return dict(table)


def texts(values: list[Any], key: str, path: Path) -> tuple[str, ...]:
    """Returns names as a tuple; refuses one that is no text or stands there twice."""
    if not all(isinstance(v, str) for v in values):
        raise InputError(f"{key} in {path} must be names in quotes")
    if twice := [v for v in values if values.count(v) > 1]:
        raise InputError(f"{key} in {path} has {twice[0]!r} twice; keep one")
    return tuple(values)


def numbers(values: list[Any], key: str, path: Path) -> tuple[float, ...]:
    """Returns numbers as a tuple; refuses one that is not above zero."""
    for v in values:
        if isinstance(v, bool) or not isinstance(v, int | float) or not 0 < v < inf:
            raise InputError(f"{key} in {path} must be numbers above zero")
    return tuple(map(float, values))
