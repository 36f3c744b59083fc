"""Settings of a method from plain values: names, kinds and missing ones are checked."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from identification.errors import InputError, unknown_name
from identification.files import is_file
from identification.sweep.words import file_words

Plain = bool | int | float | str | None
_WORDS = {bool: "true or false", int: "a whole number", float: "a number", str: "text in quotes",
          Path: "a path in quotes"}  # fmt: skip


def kinds_of(settings: type) -> dict[str, type]:
    """Returns the kind of each field of a settings dataclass, without None.

    Raises:
        InputError: a field is of a kind that a TOML cannot give.
    """
    hints, kinds = get_type_hints(settings), {}
    for field in fields(settings):
        kind = hints[field.name]
        if get_origin(kind) in (Union, UnionType):
            (kind,) = (k for k in get_args(kind) if k is not NoneType)
        if kind not in _WORDS:
            raise InputError(f"{settings.__name__}.{field.name} is no plain value, but {kind}")
        kinds[field.name] = kind
    return kinds


def check_values(settings: type, values: Mapping[str, Plain], where: str) -> dict[str, Plain]:
    """Returns the values of all fields, defaults among them, in the right kind.

    Args:
        settings: the dataclass.
        values: by name, as a TOML gives them.
        where: they stand, for messages.

    Raises:
        InputError: a name is unknown, a value is of another kind, or one is missing.
    """
    kinds = kinds_of(settings)
    for name, value in values.items():
        if name not in kinds:
            raise unknown_name(f"setting in {where}:", name, kinds)
        if not _fits(value, kinds[name]):
            raise InputError(f"{name} in {where} must be {_WORDS[kinds[name]]}, not {value!r}")
    out: dict[str, Plain] = {}
    for field in fields(settings):
        name, kind = field.name, kinds[field.name]
        if name not in values and field.default is MISSING:
            raise InputError(f"{where} does not say {name!r}; give {_WORDS[kind]}")
        given: Any = values.get(name, field.default)
        if given is not None:
            given = str(given) if kind is Path else float(given) if kind is float else given
        out[name] = given
    return out


def _fits(value: Any, kind: type) -> bool:
    if kind in (str, Path):
        return isinstance(value, str)
    if kind is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    return type(value) is kind


def resolve(settings: type, values: Mapping[str, Plain], folder: Path) -> dict[str, Plain]:
    """Returns the values with whole paths in place of those that are relative to a TOML.

    Args:
        settings: the dataclass.
        values: of all its fields.
        folder: of the TOML.

    Raises:
        InputError: a path names a variable of the environment that is not set.
    """
    kinds, words = kinds_of(settings), file_words(settings)
    return {
        name: str(place(value, folder))
        if isinstance(value, str)
        and (kinds[name] is Path or (name in words and value not in words[name]))
        else value
        for name, value in values.items()
    }


def refuse_missing_files(settings: type, values: Mapping[str, Plain], where: str) -> None:
    """Refuse files that tasks would read and that are not there.

    Args:
        settings: the dataclass.
        values: of all its fields, paths whole.
        where: they stand, for messages.

    Raises:
        InputError: there is no such file.
    """
    for name, words in file_words(settings).items():
        value = values[name]
        if not isinstance(value, str) or value in words or is_file(Path(value)):
            continue
        path = Path(value)
        wrong = "is a folder" if path.is_dir() else "does not exist"
        cure = "correct the path"
        if "*" in path.name:
            cure = f'a pattern stands in [study.grid], as {name} = {{ files = "{path.name}" }}'
        elif words:
            cure += f", or give {' or '.join(words)}"
        raise InputError(f"{name} in {where} names the file {path}, which {wrong}; {cure}")


def place(text: str, folder: Path) -> Path:
    """Returns a path of a TOML: `$NAME` is from the environment, the rest is relative to the TOML.

    Args:
        text: the path.
        folder: of the TOML.

    Raises:
        InputError: the variable is not set.
    """
    expanded = os.path.expandvars(text)
    if left := re.search(r"\$\{?(\w+)", expanded):
        raise InputError(
            f"the path {text} needs the variable {left[1]}; write export {left[1]}=FOLDER before"
        )
    return folder / Path(expanded).expanduser()


def build(settings: type, values: Mapping[str, Plain]) -> Any:
    """Returns the settings as their dataclass.

    Args:
        settings: the dataclass.
        values: of all fields, paths as text.

    Raises:
        InputError: the dataclass refuses them.
    """
    kinds = kinds_of(settings)
    return settings(
        **{
            name: Path(value) if kinds[name] is Path and isinstance(value, str) else value
            for name, value in values.items()
        }
    )
