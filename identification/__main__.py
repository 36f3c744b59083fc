"""The program `identification`, also as `python -m identification`, for any robot."""

from __future__ import annotations

import sys
from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    try:
        from identification.commands.cli import main as run  # takes a fifth of a second

        return run(arguments)
    except KeyboardInterrupt:  # while that is imported
        sys.stderr.write("identification: stopped\n")
        return 130


def program() -> int:
    """Run one command as a process of its own, which ends with the exit code."""
    try:
        from identification.commands.streams import settle_streams

        settle_streams()
    except KeyboardInterrupt:  # while that is imported
        return 130
    code = main()
    from identification.commands.stopping import at_end

    at_end(code)
    return code


if __name__ == "__main__":
    sys.exit(program())
