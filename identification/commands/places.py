"""Is the folder for the results one that may be written? Asked before a command computes anything.

Nothing that a user made is replaced: neither an input of the command nor another file.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from identification.commands.common import Output
from identification.errors import InputError
from identification.storage.files import exists, is_file
from identification.storage.folders import try_folder


def refuse_place(command: Any) -> None:
    """Refuse a folder for the results that cannot be written, or that holds files of others.

    It is refused where it, or what is above it, is a file or cannot be read or written; where an
    input of the command is it or lies in it; and where the program did not make a file that lies
    there.
    """
    output = getattr(command, "output", None)
    out = output.out if isinstance(output, Output) else None
    if out is None:
        return
    try:
        existing = next(p for p in (out, *out.absolute().parents) if os.path.lexists(p))
        is_folder = existing.is_dir()
    except OSError as error:  # a name that is too long
        raise InputError(f"cannot make folder {out}: {error.strerror}; choose another") from error
    if not exists(existing):  # also where links lead round in a loop
        raise InputError(
            f"cannot make folder {out}: {existing} is a link that leads nowhere; choose another"
        )
    if not is_folder:
        raise InputError(f"cannot make folder {out}: {existing} is a file; choose another")
    real = out.resolve()
    for path in _inputs(command):
        if (path if path.is_dir() else path.parent).resolve() == real:
            raise InputError(
                f"{path} is read by this command and lies in {out}, the folder for its results;"
                " give --out another folder"
            )
    try_folder(out)


def _inputs(value: Any) -> Iterator[Path]:
    """Yields the files and folders that a command's fields name."""
    if isinstance(value, Output):
        return
    if is_dataclass(value):
        for field in fields(value):
            yield from _inputs(getattr(value, field.name))
    elif isinstance(value, tuple | list):
        for each in value:
            yield from _inputs(each)
    elif isinstance(value, Path) and os.path.isdir(value):
        yield value
    elif isinstance(value, Path | str) and is_file(Path(value)):
        yield Path(value)
