"""Files are written whole or not at all."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from identification.errors import InputError


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yields a temporary path beside `path` that becomes `path` when the block ends well."""
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError(f"no such folder: {path.parent}; make it before {path.name} is written")
    draft = path.with_name(f".{uuid4().hex}{path.suffix}")
    try:
        yield draft
        to_disk(draft)
        draft.replace(path)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(
            f"cannot write {path}: {reason}; choose a folder with room and permission"
        ) from error
    finally:
        with suppress(OSError):
            draft.unlink(missing_ok=True)


def to_disk(path: Path) -> None:
    """Bring a file, or the names in a folder, to the disk: a loss of power then loses nothing."""
    if os.name != "posix":  # other systems bring nothing to the disk that is open to be read
        return
    number = os.open(path, os.O_RDONLY)
    try:
        os.fsync(number)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.EROFS, errno.EOPNOTSUPP):  # no such step here
            raise
    finally:
        os.close(number)


def write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write UTF-8 text to a file, whole or not at all; returns its path."""
    with whole_file(path) as draft:
        draft.write_text(text, encoding="utf-8", errors="backslashreplace", newline="")
    return Path(path)
