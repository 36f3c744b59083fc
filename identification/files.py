"""Files are refused before they are read, and written whole or not at all."""

from __future__ import annotations

import errno
import os
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from difflib import get_close_matches
from pathlib import Path
from typing import Any
from uuid import uuid4

from identification.errors import InputError

_BY_HAND = 2**20  # bytes
_ALIKE = 0.75  # share of letters of a file that may be meant
_SAID = 120  # letters of another library's message
MAX_BYTES = 512 * 2**20  # hours at 1 kHz; more would fill the memory before it failed


def is_file(path: Path) -> bool:
    """Whether there is a regular file of this name; a name that no file can have is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long, or not to be looked at
        return False


LOG = "log file (.csv or .mat)"  # what a path should have been, in messages
MODEL = "model file (MJCF or URDF)"


def read_bytes(path: Path, largest: int = MAX_BYTES, what: str = LOG) -> bytes:
    """The bytes of a regular file of a sane size.

    Args:
        path: of the file.
        largest: sane size [bytes].
        what: kind of file that is wanted, for messages.

    Raises:
        InputError: there is no such file, it is something else, too large, or cannot be read.
    """
    try:
        check_file(path, largest, what)
        return path.read_bytes()
    except OSError as error:
        raise _unreadable(path, error) from error


def check_file(path: Path, largest: int = MAX_BYTES, what: str = LOG) -> None:
    """Refuse what is no regular file of a sane size, without reading it.

    Args:
        path: of the file.
        largest: sane size [bytes].
        what: kind of file that is wanted, for messages.

    Raises:
        InputError: there is no such file, it is something else, or too large.
    """
    try:
        if not path.exists():
            raise InputError(_missing(path))
        if path.is_dir():
            raise InputError(f"{path} is a folder; give the path of a {what}")
        if not path.is_file():
            raise InputError(f"{path} is not a regular file; give the path of a {what}")
        size = path.stat().st_size
        if size > largest:
            cure = "cut it into shorter logs" if what == LOG else f"give the path of a {what}"
            raise InputError(
                f"{path} has {size / 2**20:.0f} MB, more than the {largest / 2**20:.0f} MB that "
                f"are read at once; {cure}"
            )
    except OSError as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: OSError) -> InputError:
    reason = error.strerror or type(error).__name__
    return InputError(f"cannot read {path}: {reason}; check its name and permissions")


def _refuse_long(value: Any) -> None:
    """Refuse whole numbers beyond the 64 bits that TOML has."""
    if isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            _refuse_long(part)
    elif isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise ValueError("a whole number has more than 64 bits")


def read_toml(path: Path, what: str = "TOML file") -> dict[str, Any]:
    """The content of a TOML file that was written by hand.

    Args:
        path: of the file.
        what: kind of file that is wanted, for messages.

    Raises:
        InputError: there is no such file, it is too large for one that was written by hand, or it
            is not TOML.
    """
    try:
        content = tomllib.loads(read_bytes(path, _BY_HAND, what).decode("utf-8-sig"))
        _refuse_long(content)
        return content
    except (ValueError, RecursionError) as error:  # digits without end are a ValueError too
        if isinstance(error, InputError):
            raise
        letters = "".join(c if c.isprintable() else "?" for c in str(error))[:_SAID]
        said = "nested too deeply" if isinstance(error, RecursionError) else letters
        raise InputError(f"{path} is not TOML ({said}); correct it there") from error


def _missing(path: Path) -> str:
    if not path.parent.is_dir():
        return f"no such folder: {path.parent}; check the path of {path.name}"
    near = get_close_matches(path.name, [f.name for f in path.parent.iterdir()], n=3, cutoff=_ALIKE)
    hint = f"did you mean {' or '.join(near)}?" if near else "check its name and folder"
    return f"no such file: {path}; {hint}"


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside `path` that becomes `path` when the block ends well.

    Raises:
        InputError: the folder does not exist or cannot be written to.
    """
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
    """Bring a file, or the names in a folder, to the disk, so that a loss of power loses nothing.

    Args:
        path: of the file or folder.

    Raises:
        OSError: the disk is full or broken.
    """
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
        draft.write_text(text, encoding="utf-8", newline="")
    return Path(path)
