"""Folders of results: written whole or not at all, and nothing of anybody else is replaced.

Results are put together in a hidden folder. Together with what others keep in the old folder, they
take its place in a single step: whoever looks, and whatever is killed, finds the old results or the
new ones. Where there is no such step the files are moved one by one
(`identification.storage.made`).

The files that the program made before go, also those of which there is no new one. A file that it
did not make, or that was changed since, belongs to somebody else: a folder with such a file is
refused.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree

from identification.errors import InputError
from identification.storage.exchange import (
    IMPOSSIBLE,
    alone,
    exchange,
    free_beside,
    make_alike,
    make_folders,
    make_hidden,
    make_hidden_beside,
    make_hidden_inside,
    remove_empty,
)
from identification.storage.files import to_disk
from identification.storage.made import (
    MADE,
    Content,
    finish_moves,
    list_content,
    move_all,
    write_made,
)

_TRIED = 4096  # bytes that are written to try a folder, a page of most disks
_SHOWN = 3  # names in a message
_RESULTS = ("result.json", "report.html", MADE)  # no folder may bear these names


def refuse_foreign(folder: Path) -> None:
    """Refuse a folder with files of others, which results could replace."""
    try:
        if not folder.is_dir():
            return
        with alone(folder.resolve().parent):
            finish_moves(folder)
        now = list_content(folder)
    except OSError as error:
        raise InputError(
            f"cannot read folder {folder}: {_reason(error)}; choose another"
        ) from error
    for name in _RESULTS:
        if name in now.folders:
            raise InputError(
                f"{folder / name} is a folder, and results have a file of this name; choose"
                " another folder"
            )
    if foreign := now.foreign:
        more = f" and {len(foreign) - _SHOWN} more" if len(foreign) > _SHOWN else ""
        raise InputError(
            f"the folder {folder} holds {', '.join(foreign[:_SHOWN])}{more}, not made there by this"
            " program or changed since; choose a new or an empty folder"
        )


@dataclass
class Draft:
    """Results that are put together before they are saved."""

    folder: Path  # where files are written; hidden
    place: Path  # where they are saved
    taken: tuple[str, ...] = ()  # files of others in the way, so `place` is another folder

    def save(self) -> None:
        """Save what the draft holds so far; more may be added to it and saved again."""
        try:
            self.place.mkdir(parents=True, exist_ok=True)  # somebody may have removed it meanwhile
            with alone(self.place.resolve().parent):
                finish_moves(self.place)
                now = list_content(self.place)
                taken = {f.name for f in self.folder.iterdir()} & (now.others | now.folders)
                if taken:
                    self.taken, self.place = tuple(sorted(taken)), free_beside(self.place)
                    self.place.mkdir()
                    now = Content()
                place = self.place.resolve()
                if not _replace(self.folder, place, now):
                    with _filled(self.folder, make_hidden_inside(place)) as fresh:
                        move_all(fresh, place)
        except OSError as error:
            raise InputError(
                f"cannot write folder {self.place}: {_reason(error)}; choose a folder with room and"
                " permission"
            ) from error


@contextmanager
def draft_of(path: str | os.PathLike[str]) -> Iterator[Draft]:
    """Yields a draft of the results of a folder, made when missing; it is saved when asked."""
    path = Path(path)
    refuse_foreign(path)
    made: list[Path] = []
    try:
        make_folders(path.parent, made)
        with alone(path.resolve().parent):
            make_folders(path, made)
            folder = make_hidden(path)
            if folder.parent != path.resolve():
                remove_empty(made[-1:])  # a program that is killed leaves no empty folder
    except OSError as error:
        remove_empty(made)
        raise InputError(f"cannot make folder {path}: {_reason(error)}; choose another") from None
    draft = Draft(folder, path)
    try:
        yield draft
    except InputError as error:  # a file that cannot be written has the name that is known
        if str(folder) not in str(error):
            raise
        raise InputError(str(error).replace(str(folder), str(draft.place))) from error.__cause__
    finally:
        rmtree(folder, ignore_errors=True)
        remove_empty(made)
    if draft.taken:
        raise InputError(
            f"{', '.join(draft.taken[:_SHOWN])} came into {path} or changed there while the program"
            f" ran; nothing of it was replaced, and the results are in {draft.place}"
        )


@contextmanager
def whole_folder(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yields a temporary folder whose files are saved in `path` when the block ends well."""
    with draft_of(path) as draft:
        yield draft.folder
        draft.save()


def try_folder(path: Path) -> None:
    """Refuse a folder in which no results can be saved: a file is written for it and removed."""
    with draft_of(path) as draft:
        try:
            file = draft.folder / "result.json"
            file.write_bytes(bytes(_TRIED))
            to_disk(file)
        except OSError as error:
            raise InputError(
                f"cannot write folder {path}: {_reason(error)}; choose a folder with room and"
                " permission"
            ) from error


def _replace(draft: Path, place: Path, now: Content) -> bool:
    """Put a copy of a draft in the place of a folder in one step; False where this cannot be."""
    if now.folders or _stands_in(place):
        return False  # folders cannot be in two places until the step is done
    try:
        with _filled(draft, make_hidden_beside(place)) as fresh:
            for name in now.others:
                os.link(place / name, fresh / name, follow_symlinks=False)
            make_alike(fresh, place)
            to_disk(fresh)
            if now == Content():
                fresh.replace(place)  # which every file system knows, where the old one is empty
            else:
                exchange(fresh, place)
                if not _is_still(now, fresh, place):
                    exchange(fresh, place)
                    return False
    except OSError as error:
        if error.errno in IMPOSSIBLE:
            return False
        raise
    with suppress(OSError):  # all is in its place, and the disk will know it a little later
        to_disk(place.parent)
    return True


def _is_still(now: Content, old: Path, new: Path) -> bool:
    """Returns whether nobody put or changed a file in the old folder while it was replaced."""
    try:
        same = list_content(old) == now
        return same and all(os.path.samestat((old / n).lstat(), (new / n).lstat())
                            for n in now.others)  # fmt: skip
    except OSError:
        return False


def _stands_in(folder: Path) -> bool:
    """Returns whether the current directory of this program is in the folder."""
    try:
        return Path.cwd().is_relative_to(folder)
    except OSError:  # where it stands is no more
        return False


@contextmanager
def _filled(draft: Path, fresh: Path) -> Iterator[Path]:
    """Yields a hidden folder with a draft's files and their record; it is removed at the end."""
    try:
        for file in draft.iterdir():
            try:
                os.link(file, fresh / file.name)
            except OSError as error:
                if error.errno not in IMPOSSIBLE:
                    raise
                shutil.copy2(file, fresh / file.name)
        write_made(fresh)
        yield fresh
    finally:
        rmtree(fresh, ignore_errors=True)


def _reason(error: OSError) -> str:
    return error.strerror or type(error).__name__
