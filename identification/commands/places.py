"""Is the folder for the results one that may be written? Asked before a command computes anything.

Nothing that a user made is replaced: neither an input of the command nor another file.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from identification.commands.common import Output


def refuse_empty(arguments: Sequence[str]) -> None:
    """Refuse `--out ""`, which would be the folder in which the user stands.

    Raises:
        InputError: it is among the arguments.
    """
    from identification.errors import InputError

    if "--out=" in arguments or ("--out", "") in pairwise(arguments):
        raise InputError('--out is given as ""; name a folder, such as --out out/run')


def refuse_place(command: Any) -> None:
    """Refuse a folder for the results that cannot be made, or that holds files of others.

    Args:
        command: with its fields; without an `output` nothing is written.

    Raises:
        InputError: the folder, or what is above it, is a file or cannot be written; an input of the
            command lies in it; or another file that the program did not make there.
    """
    from identification.errors import InputError
    from identification.files import exists
    from identification.folders import refuse_foreign

    output = getattr(command, "output", None)
    out = output.out if isinstance(output, Output) else None
    if out is None:
        return
    there = next(p for p in (out, *out.absolute().parents) if os.path.lexists(p))
    if not exists(there):
        raise InputError(
            f"cannot make folder {out}: {there} is a link that leads nowhere; choose another"
        )
    if not there.is_dir():
        raise InputError(f"cannot make folder {out}: {there} is a file; choose another")
    try:  # permissions do not tell it of every file system
        os.rmdir(tempfile.mkdtemp(prefix=".inca-", dir=there))
    except OSError as error:
        raise InputError(
            f"cannot make folder {out}: {there} cannot be written ({error.strerror}); choose"
            " another"
        ) from error
    for path in _inputs(command):
        if os.path.realpath(path.parent) == os.path.realpath(out):
            raise InputError(
                f"{path} is read by this command and lies in {out}, the folder for its results;"
                " give --out another folder"
            )
    refuse_foreign(out)


def _inputs(value: Any) -> Iterator[Path]:
    """The files that a command's fields name."""
    from identification.files import is_file

    if isinstance(value, Output):
        return
    if is_dataclass(value):
        for field in fields(value):
            yield from _inputs(getattr(value, field.name))
    elif isinstance(value, tuple | list):
        for each in value:
            yield from _inputs(each)
    elif isinstance(value, Path | str) and is_file(Path(value)):
        yield Path(value)
