"""A folder takes the place of another one in a single step of the file system.

Linux and macOS exchange two names in one step, so that a reader finds the old folder or the new
one, and a program that is killed leaves one of them whole.
"""

from __future__ import annotations

import ctypes
import errno
import os
import shutil
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

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
