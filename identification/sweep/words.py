"""Settings and columns as a reader sees them: their names in words, with the unit behind.

What a setting or a column is about ends with its unit in brackets, as in "length of a log [s]".
Tables and axes take the unit from there, so that it is written once.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

LOGARITHMIC = ", logarithmic axis"


@dataclass(frozen=True)
class Heads:
    """Names of settings and columns in words.

    Attributes:
        about: what each is about, by name; a name that is missing has no unit.
    """

    about: Mapping[str, str]

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


NAMES = Heads({})  # names alone, without units


def in_words(name: str) -> str:
    """Returns the name of a setting or a column without the underscores of code."""
    return name.replace("_", " ")


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
