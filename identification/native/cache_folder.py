"""The folder of the cache: one file an entry, read only where nobody else can have written it.

    $XDG_CACHE_HOME/inca_mj, or ~/.cache/inca_mj

Machine code is run without a question, so an entry counts only when it and the folder belong to
the user, nobody else may write to them, and neither is a link. Files are opened inside the opened
folder: what was checked is what is read. A file is replaced whole, so that two processes may write
at once. Beyond `LARGEST` bytes the entries that were used longest ago are removed.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from uuid import uuid4

LARGEST = 64 * 2**20  # bytes of all entries together; the law with all effects has 75 000


def folder() -> Path:
    """Returns the folder of this user's cache."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(base):  # the standard says to ignore what is not
        home = os.path.expanduser("~")
        if not os.path.isabs(home):
            raise FileNotFoundError("no home folder")
        base = os.path.join(home, ".cache")
    return Path(base, "inca_mj")


def read(name: str) -> bytes:
    """Returns the content of an entry."""
    with _opened() as inside:
        flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
        with os.fdopen(os.open(name, flags, dir_fd=inside), "rb") as file:
            state = os.fstat(file.fileno())
            if not stat.S_ISREG(state.st_mode) or state.st_nlink != 1:
                raise PermissionError(f"{name} is not a file of its own")
            _refuse_foreign(state, name)
            content = file.read(LARGEST)
        with suppress(OSError):  # a folder that is only read works too
            os.utime(name, dir_fd=inside, follow_symlinks=False)  # used now
        return content


def write(name: str, content: bytes) -> None:
    """Write an entry, whole or not at all, in the place of whatever bears its name."""
    os.makedirs(folder(), mode=0o700, exist_ok=True)
    with _opened() as inside:
        draft = f"{name}.{uuid4().hex}"
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
        try:
            with os.fdopen(os.open(draft, flags, 0o600, dir_fd=inside), "wb") as file:
                file.write(content)
            os.replace(draft, name, src_dir_fd=inside, dst_dir_fd=inside)
        except BaseException:
            _remove(draft, inside)
            raise
        _remove_oldest(inside)


@contextmanager
def alone(name: str) -> Iterator[None]:
    """Lets one process at a time make an entry, so that others find it made.

    A process that ends in whatever way lets the next one in. Where no lock can be had, nobody
    waits, and several may make the same entry at once.
    """
    with ExitStack() as held:
        with suppress(ImportError, OSError):
            import fcntl  # not on every system

            os.makedirs(folder(), mode=0o700, exist_ok=True)
            inside, lock = held.enter_context(_opened()), f"{name}.lock"
            flags = os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
            file = held.enter_context(os.fdopen(os.open(lock, flags, 0o600, dir_fd=inside), "wb"))
            fcntl.flock(file, fcntl.LOCK_EX)
            held.callback(_remove, lock, inside)
        yield


def _remove(name: str, inside: int) -> None:
    with suppress(OSError):
        os.unlink(name, dir_fd=inside)


@contextmanager
def _opened() -> Iterator[int]:
    """Opens the folder, found safe, and yields its file descriptor."""
    place = folder()
    flags = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
    inside = os.open(place, flags)
    try:
        _refuse_foreign(os.fstat(inside), str(place))
        yield inside
    finally:
        os.close(inside)


def _refuse_foreign(state: os.stat_result, name: str) -> None:
    if state.st_uid != os.getuid():
        raise PermissionError(f"{name} belongs to another user")
    if state.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise PermissionError(f"others may write to {name}")


def _remove_oldest(inside: int) -> None:
    """Remove what was used longest ago, until the rest is small enough."""
    entries = []
    for name in os.listdir(inside):
        with suppress(FileNotFoundError):  # another process has removed it
            state = os.stat(name, dir_fd=inside, follow_symlinks=False)
            entries.append((state.st_mtime, name, state.st_size))
    size = sum(bytes_ for _, _, bytes_ in entries)
    for _, name, bytes_ in sorted(entries):
        if size <= LARGEST:
            return
        _remove(name, inside)
        size -= bytes_
