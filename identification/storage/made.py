"""The content of a folder of results: what the program made there, and moves of new files into it.

The hidden file `.made.json` lists what was made, each file with the hash of its content. A file
that is not listed, or that was changed since, belongs to somebody else.

Results are moved into their folder one by one where it cannot take the place of the old one: it
holds folders of the user or the records of a sweep, it is a mount point, somebody stands in it, or
the file system has no such step. They lie in a hidden folder, `.draft-…`. From the moment when this
is called `.moving-…` they count: a program that is killed from then on leaves the rest to the next
run, which finishes the moves first. The old `result.json` goes first and the new one comes last, so
that nobody takes a part for a result.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree

from identification.errors import InputError
from identification.storage.files import digest as digest_of
from identification.storage.files import read_json, write_text

MOVING = ".moving-"
_OLD = ".old"
_LAST = "result.json"
MADE = ".made.json"


@dataclass(frozen=True)
class Content:
    """The names in a folder, without that of its record."""

    made: frozenset[str] = frozenset()  # files that the program made there and nobody changed
    others: frozenset[str] = frozenset()  # all other files, hidden ones among them
    folders: frozenset[str] = frozenset()  # folders, hidden ones among them

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


def move_all(draft: Path, folder: Path) -> None:
    """Move the files of a draft into the folder in which it lies; those made before go."""
    number = draft.name.removeprefix(".").partition("-")[2]
    moving = draft.rename(folder / f"{MOVING}{number}")
    done: list[tuple[Path, Path]] = []
    try:
        for source, target in _steps(moving, folder):
            source.replace(target)
            done.append((source, target))
    except BaseException:
        for source, target in reversed(done):
            target.replace(source)
        moving.rename(draft)  # else the next run would finish the moves
        raise
    rmtree(moving, ignore_errors=True)


def finish_moves(folder: Path) -> None:
    """Finish the moves of programs that were killed while they moved files into a folder."""
    for moving in [each for each in folder.iterdir() if each.name.startswith(MOVING)]:
        if (moving / MADE).is_file():  # it is moved last: without it all is done
            for source, target in _steps(moving, folder):
                source.replace(target)
        rmtree(moving, ignore_errors=True)


def _steps(moving: Path, folder: Path) -> list[tuple[Path, Path]]:
    """Returns the moves that are left, from where to where. A file of others keeps its place."""
    with suppress(FileExistsError):
        (moving / _OLD).mkdir()
    new = read_made(moving)
    now = list_content(folder, [new])
    old = [name for name in now.made if digest(folder / name) != new.get(name)]
    names = [f.name for f in moving.iterdir() if f.name not in (MADE, _OLD)]
    taken = now.others | now.folders
    return [
        *((folder / name, moving / _OLD / name) for name in reversed(_last(old))),
        *((moving / name, folder / name) for name in _last(names) if name not in taken),
        (moving / MADE, folder / MADE),
    ]


def _last(names: Iterable[str]) -> list[str]:
    """Returns the sorted names, with result.json at the end."""
    return sorted(names, key=lambda name: (name == _LAST, name))
