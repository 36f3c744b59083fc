"""The program `inca`, also as `python -m inca_mj`; it imports nothing before it can be stopped."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from identification.__main__ import run_command, run_process


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    return run_command("inca_mj.cli", "inca", arguments)


def program() -> int:
    """Run one command as a process of its own, which ends with the exit code."""
    return run_process(main)


if __name__ == "__main__":
    sys.exit(program())
