"""Hidden folders in which results are put together, and folders that are made for them.

A draft lies beside the folder of its results, or in it where that is another disk. Its name has the
number of its process, so that the next run removes what a process left that was killed.
"""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path
from shutil import rmtree
from uuid import uuid4

from identification.exchange import IMPOSSIBLE

_DRAFT = ".draft-"
_OLD = 86400.0  # [s] after which the draft of an unknown process is left over
_TAIL = 80  # bytes of a folder's name in that of its draft; a name may have 255


def make_hidden(path: Path) -> Path:
    """Makes a hidden folder for a draft, and removes those that are left of programs."""
    path = path.resolve()
    for draft in _drafts(path, path.parent):
        number = draft.name.removeprefix(_DRAFT).partition("-")[0]
        known = number.isdecimal() and number.isascii() and os.name == "posix"
        if not _is_running(int(number)) if known else time.time() - draft.stat().st_mtime > _OLD:
            rmtree(draft, ignore_errors=True)
    inside = make_hidden_inside(path)  # the folder itself must be writable, not only its parent
    try:
        beside = make_hidden_beside(path)
    except OSError as error:
        if error.errno in IMPOSSIBLE:
            return inside
        rmtree(inside, ignore_errors=True)
        raise
    rmtree(inside, ignore_errors=True)
    return beside


def make_hidden_beside(path: Path) -> Path:
    """Makes a hidden folder beside a folder, whose place it can take; returns its path."""
    folder = path.parent / f"{_DRAFT}{os.getpid()}-{uuid4().hex[:8]}-{_tail(path)}"
    folder.mkdir()
    return folder


def make_hidden_inside(path: Path) -> Path:
    """Makes a hidden folder in a folder; returns its path."""
    folder = path / f"{_DRAFT}{os.getpid()}-{uuid4().hex[:8]}"
    folder.mkdir()
    return folder


def _tail(path: Path) -> str:
    return os.fsdecode(os.fsencode(path.name)[-_TAIL:])


def _drafts(path: Path, parent: Path) -> list[Path]:
    """Returns the drafts of results of a folder, also those of programs that still run."""
    found = [each for each in path.iterdir() if each.name.startswith(_DRAFT)]
    with suppress(OSError):  # what is above may be written and not read
        found += [
            each
            for each in parent.iterdir()
            if each.name.startswith(_DRAFT) and each.name.endswith(f"-{_tail(path)}")
        ]
    return found


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


def make_folders(path: Path, made: list[Path]) -> None:
    """Makes a folder and those above it."""
    missing = [each for each in (path, *path.parents) if not each.exists()]
    for each in reversed(missing):
        with suppress(FileExistsError):
            each.mkdir()
            made.append(each)
    if not path.is_dir():
        raise NotADirectoryError(20, os.strerror(20))


def remove_empty(made: list[Path]) -> None:
    """Removes folders that were made and stayed empty, the last made first."""
    for each in reversed(made):
        with suppress(OSError):
            each.rmdir()


def free_beside(path: Path) -> Path:
    """Returns the first of path-2, path-3, … that is not there."""
    path = path if path.name.strip(".") else path.resolve()
    number = 2
    while path.with_name(f"{path.name}-{number}").exists():
        number += 1
    return path.with_name(f"{path.name}-{number}")
