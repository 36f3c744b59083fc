"""The content of a folder of results: what the program made there, and what belongs to others.

The hidden file `.made.json` lists what was made, each file with the hash of its content. A file
that is not listed, or that was changed since, belongs to somebody else.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from identification.errors import InputError
from identification.files import digest as digest_of
from identification.files import read_json
from identification.writing import write_text

MADE = ".made.json"


@dataclass(frozen=True)
class Content:
    """The names in a folder, without that of its record.

    Attributes:
        made: files that the program made there and nobody changed.
        others: all other files, hidden ones among them.
        folders: folders, hidden ones among them.
    """

    made: frozenset[str] = frozenset()
    others: frozenset[str] = frozenset()
    folders: frozenset[str] = frozenset()

    @property
    def foreign(self) -> list[str]:
        """Files of others that are not hidden."""
        return sorted(name for name in self.others if not name.startswith("."))


def list_content(folder: Path, records: Iterable[Mapping[str, str]] = ()) -> Content:
    """Returns what lies in a folder."""
    known = [read_made(folder), *records]
    made, others, folders = set(), set(), set()
    for entry in folder.iterdir():
        name = entry.name
        if name == MADE and entry.is_file():
            continue
        if entry.is_dir():
            folders.add(name)
        elif any(name in k for k in known) and digest(entry) in {k.get(name) for k in known}:
            made.add(name)
        else:
            others.add(name)
    return Content(frozenset(made), frozenset(others), frozenset(folders))


def read_made(folder: Path) -> dict[str, str]:
    """Returns the record of a folder, hashes by name; empty if there is none that can be read."""
    try:
        made = read_json(folder / MADE, "list of results", "remove it")["files"]
        return {str(name): str(digest) for name, digest in made.items()}
    except (InputError, TypeError, KeyError, AttributeError):
        return {}  # then nothing is known to be ours


def write_made(folder: Path) -> None:
    """Write the record of a folder in which the program has made all files."""
    made = {file.name: digest(file) for file in sorted(folder.iterdir()) if file.name != MADE}
    write_text(folder / MADE, json.dumps({"files": made}, indent=1) + "\n")


def digest(file: Path) -> str:
    """Returns the hash of a file; "" if it cannot be read, because then it is not ours."""
    try:
        return digest_of(file)
    except InputError:
        return ""
