"""Folders of results: written whole or not at all, and nothing of anybody else is replaced.

A hidden file of the folder, `.made.json`, lists what was made there, each file with the hash of its
content. A second run replaces these. A file that is not listed, or that was changed since, belongs
to somebody else: a folder with such a file is refused.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp

from identification.errors import InputError
from identification.files import digest, read_json, write_text

MADE = ".made.json"
_DRAFT = ".draft-"
_OLD = 86400.0  # [s] after which the draft of an unknown process is left over
_SHOWN = 3  # names in a message


def list_foreign(folder: Path) -> list[str]:
    """Names of the files of a folder that were not made there, or were changed since."""
    if not folder.is_dir():
        return []
    made = _read_made(folder)
    files = [f for f in folder.iterdir() if not f.name.startswith(".") and not f.is_dir()]
    return sorted(f.name for f in files if f.name not in made or made[f.name] != _digest(f))


def refuse_foreign(folder: Path) -> None:
    """Refuse a folder with files of others, which results could replace.

    Raises:
        InputError: there is such a file.
    """
    foreign = list_foreign(folder)
    if foreign:
        more = f" and {len(foreign) - _SHOWN} more" if len(foreign) > _SHOWN else ""
        raise InputError(
            f"the folder {folder} holds {', '.join(foreign[:_SHOWN])}{more}, not made there by this"
            " program or changed since; give --out a new or an empty folder"
        )


@contextmanager
def whole_folder(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary folder whose files move to `path` when the block ends well; made when missing.

    Raises:
        InputError: the folder cannot be made or written to, or holds files of others. Where these
            came while the block ran, its files lie in a folder beside it, which the message names.
    """
    path = Path(path)
    refuse_foreign(path)
    is_new = not path.exists()
    try:
        path.mkdir(parents=True, exist_ok=True)
        _remove_left_over(path)
        draft = Path(mkdtemp(prefix=f"{_DRAFT}{os.getpid()}-", dir=path))
    except OSError as error:
        raise InputError(f"cannot make folder {path}: {error.strerror}; choose another") from None
    try:
        yield draft
        new = sorted(file.name for file in draft.iterdir())
        taken = [name for name in list_foreign(path) if name in new]
        place = _free_beside(path) if taken else path
        place.mkdir(exist_ok=True)
        for name in new:
            (draft / name).replace(place / name)
        _add_made(place, new)
    finally:
        rmtree(draft, ignore_errors=True)
        if is_new and not any(path.iterdir()):
            path.rmdir()
    if taken:
        raise InputError(
            f"{', '.join(taken[:_SHOWN])} came into {path} or changed there while the program ran;"
            f" nothing of it was replaced, and the results are in {place}"
        )


def _read_made(folder: Path) -> dict[str, str]:
    try:
        made = read_json(folder / MADE, "list of results", "remove it")["files"]
        return {str(name): str(digest) for name, digest in made.items()}
    except (InputError, TypeError, KeyError, AttributeError):
        return {}  # then nothing is known to be ours


def _add_made(folder: Path, names: list[str]) -> None:
    made = {**_read_made(folder), **{name: _digest(folder / name) for name in names}}
    kept = {name: digest for name, digest in sorted(made.items()) if (folder / name).is_file()}
    write_text(folder / MADE, json.dumps({"files": kept}, indent=1) + "\n")


def _digest(file: Path) -> str:
    try:
        return digest(file)
    except InputError:
        return ""  # what cannot be read is not ours


def _free_beside(path: Path) -> Path:
    """The first of path-2, path-3, … that is not there."""
    number = 2
    while path.with_name(f"{path.name}-{number}").exists():
        number += 1
    return path.with_name(f"{path.name}-{number}")


def _remove_left_over(folder: Path) -> None:
    """Remove the drafts of programs that were killed, and of no other program that still runs."""
    for draft in folder.glob(f"{_DRAFT}*"):
        number = draft.name.removeprefix(_DRAFT).partition("-")[0]
        known = number.isdecimal() and number.isascii() and os.name == "posix"
        if not _is_running(int(number)) if known else time.time() - draft.stat().st_mtime > _OLD:
            rmtree(draft, ignore_errors=True)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True
