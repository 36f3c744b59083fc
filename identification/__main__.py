"""The program `identification`, also as `python -m identification`, for any robot."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    return run_command("identification.commands.cli", "identification", arguments)


def program() -> int:
    """Run one command as a process of its own, which ends with the exit code."""
    return run_process(main)


def run_command(cli: str, name: str, arguments: Sequence[str] | None) -> int:
    """Run a command by `main` of a module, whose import can be stopped; returns the exit code."""
    try:
        return int(import_module(cli).main(arguments))  # the import takes a fifth of a second
    except KeyboardInterrupt:  # while that is imported
        sys.stderr.write(f"{name}: stopped\n")
        return 130


def run_process(run: Callable[[], int]) -> int:
    """Run a program as a process of its own, which ends with the exit code."""
    try:
        from identification.commands.streams import settle_streams

        settle_streams()
    except KeyboardInterrupt:  # while that is imported
        return 130
    code = run()
    from identification.commands.stopping import at_end

    at_end(code)
    return code


if __name__ == "__main__":
    sys.exit(program())
