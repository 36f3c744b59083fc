"""Standard streams that a program can write to, whatever its caller has made of them.

A closed stream is no object in Python, and its number goes to the next file that is opened. A full
one raises an error wherever something is written, and so do letters that its encoding lacks. None
of this may end a program after minutes of work, or change its exit code.
"""

from __future__ import annotations

import io
import os
import sys
import warnings
from contextlib import suppress

STREAMS = ("stdin", "stdout", "stderr")
STANDARD_OUTPUT = "standard output"


class _Plain(io.RawIOBase):
    """Writes to a file descriptor; its one error says by its file name that it is standard output.

    What is written after that error is lost: Python would write it again as it ends, and end with
    an exit code of its own.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self._is_full = False

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._number

    def isatty(self) -> bool:
        return os.isatty(self._number)

    def write(self, content: object) -> int:
        data = memoryview(content)  # type: ignore[arg-type]
        if self._is_full:
            return len(data)
        try:
            return os.write(self._number, data)
        except OSError as error:
            self._is_full, error.filename = True, STANDARD_OUTPUT
            raise


class _Lenient(_Plain):
    """Writes to a file descriptor as far as it can, and is silent where it cannot."""

    def write(self, content: object) -> int:
        data = memoryview(content)  # type: ignore[arg-type]
        with suppress(OSError):  # full, or nobody reads it
            done = 0
            while done < len(data):
                done += os.write(self._number, data[done:])
        return len(data)


def settle_streams() -> None:
    """Opens the standard streams that are closed, and makes the others take any text.

    What is said on stderr is lost where that is closed or full. A result that is to be printed on a
    full stdout still ends the program with an error; on a closed one nobody wants it. Warnings of
    libraries reach no user unless Python is asked for them (`python -W`).
    """
    for number, name in enumerate(STREAMS):
        try:
            os.fstat(number)
        except OSError:
            _open_nowhere(number)
        if getattr(sys, name) is None:
            mode = "w" if number else "r"
            setattr(sys, name, os.fdopen(number, mode, encoding="utf-8", closefd=False))
    sys.stdout = io.TextIOWrapper(
        io.BufferedWriter(_Plain(1)), encoding=sys.stdout.encoding, errors="backslashreplace",
        line_buffering=sys.stdout.isatty(),
    )  # fmt: skip
    sys.stderr = io.TextIOWrapper(
        io.BufferedWriter(_Lenient(2)), encoding=sys.stderr.encoding, errors="backslashreplace",
        line_buffering=True, write_through=True,
    )  # fmt: skip
    if not sys.warnoptions:
        warnings.simplefilter("ignore")


def _open_nowhere(number: int) -> None:
    """Gives a free file descriptor to a file that takes everything and holds nothing."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    if nowhere != number:
        os.dup2(nowhere, number)
        os.close(nowhere)
    os.set_inheritable(number, True)
