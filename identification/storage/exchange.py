"""A folder takes the place of another one in a single step; hidden folders in which it is made.

Linux and macOS exchange two names in one step, so that a reader finds the old folder or the new
one, and a program that is killed leaves one of them whole.

A hidden folder, a draft, lies beside the folder of its results, or in it where that is another
disk. Its name has the number of its process, so that the next run removes what a process left that
was killed.
"""

from __future__ import annotations

import ctypes
import errno
import os
import shutil
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import rmtree
from uuid import uuid4

_DRAFT = ".draft-"
_OLD = 86400.0  # [s] after which the draft of an unknown process is left over
_TAIL = 80  # bytes of a folder's name in that of its draft; a name may have 255
_AT_FDCWD, _RENAME_EXCHANGE, _RENAME_SWAP = -100, 2, 2  # of linux/fs.h and of macOS' sys/stdio.h
_PATIENCE = 10.0  # [s] to wait for another program, which holds the lock for milliseconds
# What a file system or a system says that does not know a step, as FAT and NFS do of an exchange,
# or that refuses it at this place, as at a mount point. A full or broken disk is not among them.
IMPOSSIBLE = frozenset(
    {
        errno.EACCES, errno.EBUSY, errno.EINVAL, errno.EMLINK, errno.ENAMETOOLONG, errno.ENOSYS,
        errno.ENOTEMPTY, errno.EOPNOTSUPP, errno.EPERM, errno.EROFS, errno.EXDEV,
    }
)  # fmt: skip


def exchange(one: Path, other: Path) -> None:
    """Exchange the names of two folders of one file system in one step, or change nothing."""
    sys.audit("os.rename", str(one), str(other), -1, -1)  # as for the renames of Python itself
    names = os.fsencode(one), os.fsencode(other)
    library = ctypes.CDLL(None, use_errno=True) if os.name == "posix" else None
    if library is not None and hasattr(library, "renameat2"):
        failed = library.renameat2(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _RENAME_EXCHANGE)
    elif library is not None and hasattr(library, "renamex_np"):
        failed = library.renamex_np(*names, _RENAME_SWAP)
    else:
        raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))
    if failed:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number), str(one), None, str(other))


def make_alike(folder: Path, model: Path) -> None:
    """Give a folder the owner and the permissions of another one."""
    state, now = model.stat(), folder.stat()
    if (state.st_uid, state.st_gid) != (now.st_uid, now.st_gid):
        os.chown(folder, state.st_uid, state.st_gid)
    shutil.copystat(model, folder)
    os.utime(folder)  # the rest is as of the other one, but it was written now


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Wait until no other program is in this block with this folder, where locks can be had."""
    try:
        import fcntl

        number = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):  # another system, or a folder that cannot be read
        yield
        return
    try:
        end = time.monotonic() + _PATIENCE
        while time.monotonic() < end:
            try:
                fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                time.sleep(0.01)
            except OSError:  # a file system without locks
                break
        yield
    finally:
        os.close(number)  # the lock ends with it


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
        hidden = make_hidden_beside(path)
    except OSError as error:
        if error.errno in IMPOSSIBLE:
            return inside
        rmtree(inside, ignore_errors=True)
        raise
    rmtree(inside, ignore_errors=True)
    return hidden


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
