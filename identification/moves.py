"""Results that are moved into their folder one by one, where no single step can put them there.

This is so where the folder cannot take the place of the old one: it holds folders of the user or
the records of a sweep, it is a mount point, somebody stands in it, or the file system has no such
step. The results lie in a hidden folder, `.draft-…`. From the moment when this is called
`.moving-…` they count: a program that is killed from then on leaves the rest to the next run, which
finishes the moves before it looks at anything else. The old `result.json` goes first and the new
one comes last, so that nobody takes a part for a result.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from shutil import rmtree

from identification.made import MADE, digest, list_content, read_made

MOVING = ".moving-"
_OLD = ".old"
_LAST = "result.json"


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
