"""Settings of a method: their fields, their values from a TOML, and how a reader sees them.

What a setting or a column is about ends with its unit in brackets, as in "length of a log [s]".
Tables and axes take the unit from there, so that it is written once.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

from identification.errors import InputError, unknown_name
from identification.storage.files import is_file

Plain = bool | int | float | str | None
_WORDS = {bool: "true or false", int: "a whole number", float: "a number", str: "text in quotes",
          Path: "a path in quotes"}  # fmt: skip
LOGARITHMIC = ", logarithmic axis"


def setting(about: str, default: Any = MISSING) -> Any:
    """Returns a field of a settings dataclass that says what it is.

    Args:
        about: what it is, with its unit in brackets at the end.
        default: its value where a sweep gives none; without it a sweep must give one.
    """
    return field(default=default, metadata={"about": about})


def file_setting(about: str, default: Any = MISSING, *, words: tuple[str, ...] = ()) -> Any:
    """Returns a setting that names a file which tasks read, to be there before the first task.

    Args:
        about: what the file is.
        default: as of `setting`.
        words: that stand for no file of the user.
    """
    return field(default=default, metadata={"about": about, "file": True, "words": words})


def about_of(settings: type) -> dict[str, str]:
    """Returns what each field of a settings dataclass is about; "" where it does not say."""
    return {f.name: f.metadata.get("about", "") for f in fields(settings)}


def file_words(settings: type) -> dict[str, tuple[str, ...]]:
    """Returns the fields that name a file that tasks read, with words that may stand instead."""
    return {f.name: f.metadata["words"] for f in fields(settings) if f.metadata.get("file")}


def kinds_of(settings: type) -> dict[str, type]:
    """Returns the kind of each field of a settings dataclass, without None; refuses any other."""
    hints, kinds = get_type_hints(settings), {}
    for f in fields(settings):
        kind = hints[f.name]
        if get_origin(kind) in (Union, UnionType):
            (kind,) = (k for k in get_args(kind) if k is not NoneType)
        if kind not in _WORDS:
            raise InputError(f"{settings.__name__}.{f.name} is no plain value, but {kind}")
        kinds[f.name] = kind
    return kinds


def check_values(settings: type, values: Mapping[str, Plain], where: str) -> dict[str, Plain]:
    """Returns the values of all fields in the right kind, defaults among them, or refuses one."""
    kinds = kinds_of(settings)
    for name, value in values.items():
        if name not in kinds:
            raise unknown_name(f"setting in {where}:", name, kinds)
        if not _fits(value, kinds[name]):
            raise InputError(f"{name} in {where} must be {_WORDS[kinds[name]]}, not {value!r}")
    out: dict[str, Plain] = {}
    for f in fields(settings):
        name, kind = f.name, kinds[f.name]
        if name not in values and f.default is MISSING:
            raise InputError(f"{where} does not say {name!r}; give {_WORDS[kind]}")
        given: Any = values.get(name, f.default)
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
    """Returns the values with whole paths in place of those that are relative to a TOML."""
    kinds, words = kinds_of(settings), file_words(settings)
    return {
        name: str(place(value, folder))
        if isinstance(value, str)
        and (kinds[name] is Path or (name in words and value not in words[name]))
        else value
        for name, value in values.items()
    }


def refuse_missing_files(settings: type, values: Mapping[str, Plain], where: str) -> None:
    """Refuses files that tasks would read and that are not there."""
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
    """Returns a path of a TOML: `$NAME` is of the environment, the rest relative to the TOML."""
    expanded = os.path.expandvars(text)
    if left := re.search(r"\$\{?(\w+)", expanded):
        raise InputError(
            f"the path {text} needs the variable {left[1]}; write export {left[1]}=FOLDER before"
        )
    return folder / Path(expanded).expanduser()


def build(settings: type, values: Mapping[str, Plain]) -> Any:
    """Returns the settings as their dataclass, which may refuse them."""
    kinds = kinds_of(settings)
    return settings(
        **{
            name: Path(value) if kinds[name] is Path and isinstance(value, str) else value
            for name, value in values.items()
        }
    )


@dataclass(frozen=True)
class Heads:
    """Names of settings and columns in words."""

    about: Mapping[str, str]  # what each is about, by name; a name that is missing has no unit

    def unit(self, name: str) -> str:
        """Returns the unit of a name, or ""."""
        found = re.search(r"\[([^\]]+)\]", self.about.get(name, ""))
        return found[1] if found else ""

    def head(self, name: str) -> str:
        """Returns a name in words with its unit in brackets, for a column or an axis."""
        unit = self.unit(name)
        return f"{in_words(name)} [{unit}]" if unit else in_words(name)

    def meaning(self, name: str) -> str:
        """Returns a name in words, and what it is about."""
        about = self.about.get(name, "")
        return f"{in_words(name)}: {about}" if about else in_words(name)


def in_words(name: str) -> str:
    """Returns the name of a setting or a column without the underscores of code."""
    return name.replace("_", " ")
