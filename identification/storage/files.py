"""The files of a program: refused before they are read, and written whole or not at all."""

from __future__ import annotations

import errno
import io
import json
import os
import re
import stat
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from difflib import get_close_matches
from hashlib import file_digest
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO
from uuid import uuid4
from zipfile import ZipFile

from identification.errors import InputError

if TYPE_CHECKING:
    import numpy as np

BY_HAND = 2**20  # bytes of a file that a person writes
BY_PROGRAM = 64 * 2**20  # bytes of a JSON file that a program writes
MAX_BYTES = 512 * 2**20  # hours at 1 kHz; more would fill the memory before it failed
_ALIKE = 0.75  # share of letters of a file that may be meant
_ALIKE_STEM = 0.6  # likewise of its name without the ending
_AT = re.compile(r" \(at line (\d+), column (\d+)\)$")  # in the words of tomllib
_SAID = 120  # letters of another library's message
_BARE = re.compile(r"[A-Za-z0-9_-]+")  # a key that TOML takes without quotes
_UNPACKED = 8  # times as large an archive of arrays may be as the largest file
# Opening a pipe waits for a writer unless it is told not to; Windows has no such flag.
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
# What a path should have been, in messages.
LOG = "log file (.csv, .mat, .npz, .parquet, .mcap, .db3 or .bag)"
MODEL = "model file (MJCF or URDF)"


def is_file(path: Path) -> bool:
    """Returns whether a regular file has this name; a name that no file can have is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long, or not to be looked at
        return False


def exists(path: Path) -> bool:
    """Returns whether anything has this name; a name that nothing can have is none."""
    try:
        return path.exists()
    except (OSError, ValueError):  # too long, or not to be looked at
        return False


def readable(name: str) -> str:
    """Returns a name that every file and screen can hold: bytes that are no text are escaped."""
    try:
        return name.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    except UnicodeEncodeError:  # half a letter that is no byte either
        return name.encode("utf-8", "backslashreplace").decode("utf-8")


@contextmanager
def opened(path: Path, largest: int = MAX_BYTES, what: str = LOG) -> Iterator[BinaryIO]:
    """Opens a regular file of a sane size for reading; nothing else is ever waited for.

    Every file that the program reads is opened here. A pipe, a device or a socket in its place is
    refused, also where it takes that place after `check_file` has looked.

    Args:
        path: of the file.
        largest: sane size [bytes].
        what: kind of file that is wanted, for messages.
    """
    check_file(path, largest, what)
    try:
        with os.fdopen(os.open(path, _FLAGS), "rb") as stream:
            if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
                raise InputError(_irregular(path, what))
            yield stream
    except OSError as error:
        raise _unreadable(path, error) from error


def read_bytes(path: Path, largest: int = MAX_BYTES, what: str = LOG) -> bytes:
    """Returns the bytes of a regular file of a sane size."""
    with opened(path, largest, what) as stream:
        content = stream.read(largest + 1)
    if len(content) > largest:  # it grew, or its system does not tell its size
        raise InputError(_too_large(path, len(content), largest, what))
    return content


def read_text(path: Path, largest: int = BY_PROGRAM, what: str = "text file") -> str:
    """Returns the text of a UTF-8 file of a sane size.

    Args:
        path: of the file.
        largest: sane size [bytes].
        what: kind of file that is wanted, for messages.
    """
    try:
        return read_bytes(path, largest, what).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is no UTF-8 text; give the path of a {what}") from error


def read_json(path: Path, what: str, cure: str) -> Any:
    """Returns the content of a JSON file that a program wrote."""
    text = read_text(path, what=what)
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} cannot be read as JSON ({_said(error)}); {cure}") from error


def read_toml(path: Path, what: str = "TOML file") -> dict[str, Any]:
    """Returns the content of a TOML file that was written by hand."""
    text = ""
    try:
        text = read_bytes(path, BY_HAND, what).decode("utf-8-sig")
        content = tomllib.loads(text)
        _refuse_long(content)
        return content
    except (ValueError, RecursionError) as error:  # digits without end are a ValueError too
        if isinstance(error, InputError):
            raise
        said = _said(error)
        if at := _AT.search(said):
            line = "".join(text.splitlines()[int(at[1]) - 1 : int(at[1])]).strip()
            reads = f", which reads {_short(line)}" if line else ""
            said = f"line {at[1]}, column {at[2]}{reads}: {said[: at.start()]}"
        raise InputError(f"{path} is not TOML ({said}); correct it, or give a {what}") from error


def read_archive(path: Path, what: str) -> dict[str, np.ndarray]:
    """Returns the arrays of an .npz by name."""
    import numpy as np

    raw = io.BytesIO(read_bytes(path, what=what))
    try:
        with ZipFile(raw) as archive:
            unpacked = sum(part.file_size for part in archive.infolist())
        if unpacked > _UNPACKED * MAX_BYTES:
            raise InputError(_too_large(path, unpacked, _UNPACKED * MAX_BYTES, what))
        with np.load(raw, allow_pickle=False) as file:
            return {name: file[name] for name in file}
    except InputError:
        raise
    except Exception as error:  # zip and numpy raise different errors
        raise InputError(
            f"{path} is no {what}, or is damaged ({type(error).__name__}); write it again"
        ) from error


def digest(path: Path, largest: int = 8 * MAX_BYTES, what: str = "file") -> str:
    """Returns the SHA-256 of a regular file, which is read a part at a time."""
    with opened(path, largest, what) as stream:
        return file_digest(stream, "sha256").hexdigest()  # type: ignore[arg-type]


def check_file(path: Path, largest: int = MAX_BYTES, what: str = LOG) -> None:
    """Refuses what is no regular file of a sane size, without opening it.

    Args:
        path: of the file.
        largest: sane size [bytes].
        what: kind of file that is wanted, for messages.
    """
    try:
        state = path.stat()
    except (FileNotFoundError, NotADirectoryError, ValueError):  # of a name with a zero byte
        raise InputError(_missing(path)) from None
    except OSError as error:
        raise _unreadable(path, error) from error
    if stat.S_ISDIR(state.st_mode):
        raise InputError(f"{path} is a folder; give the path of a {what}")
    if not stat.S_ISREG(state.st_mode):
        raise InputError(_irregular(path, what))
    if state.st_size > largest:
        raise InputError(_too_large(path, state.st_size, largest, what))


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


def _irregular(path: Path, what: str) -> str:
    return f"{path} is not a regular file; give the path of a {what}"


def _too_large(path: Path, size: int, largest: int, what: str) -> str:
    cure = "cut it into shorter logs" if what == LOG else f"give the path of a {what}"
    return (
        f"{path} has {size / 2**20:.0f} MB, more than the {largest / 2**20:.0f} MB that are read at"
        f" once; {cure}"
    )


def _unreadable(path: Path, error: OSError) -> InputError:
    reason = error.strerror or type(error).__name__
    return InputError(f"cannot read {path}: {reason}; check its name and permissions")


def _said(error: Exception) -> str:
    """Returns another library's message in one short line."""
    letters = "".join(c if c.isprintable() else "?" for c in str(error))[:_SAID]
    return "nested too deeply" if isinstance(error, RecursionError) else letters


def _short(line: str) -> str:
    return repr(line if len(line) <= _SAID else line[: _SAID - 3] + "...")


def _refuse_long(value: Any) -> None:
    """Refuse whole numbers beyond the 64 bits that TOML has."""
    if isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            _refuse_long(part)
    elif isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise ValueError("a whole number has more than 64 bits")


def _missing(path: Path) -> str:
    try:
        if not path.parent.is_dir():
            return f"no such folder: {path.parent}; check the path of {path.name}"
        others = [file.name for file in path.parent.iterdir()]
    except (OSError, ValueError):  # a folder that may not be listed, or that no folder can be
        others = []
    near = [  # a common ending makes no name alike
        name for name in get_close_matches(path.name, others, n=3, cutoff=_ALIKE)
        if get_close_matches(path.stem, [Path(name).stem], cutoff=_ALIKE_STEM)
    ]  # fmt: skip
    hint = f"did you mean {' or '.join(near)}?" if near else "check its name and folder"
    return f"no such file: {path}; {hint}"


def toml_value(value: object) -> str:
    """Returns a text, a number, a list or a table as TOML in one line."""
    if isinstance(value, str):  # escapes of JSON are valid in TOML, which also wants DEL escaped
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{toml_value(k)} = {toml_value(v)}' for k, v in value.items())}}}"
    return repr(value).lower() if isinstance(value, bool) else repr(value)


def toml_key(name: str) -> str:
    """Returns a name as a key of TOML, in quotes where it needs them."""
    return name if _BARE.fullmatch(name) else toml_value(name)


def toml_table(title: str, table: Mapping[str, object]) -> list[str]:
    """Returns the lines of a table of TOML, with an empty one before them; none of an empty one."""
    lines = [f"{toml_key(key)} = {toml_value(value)}" for key, value in table.items()]
    return ["", f"[{title}]", *lines] if lines else []
