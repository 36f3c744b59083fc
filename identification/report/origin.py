"""The origin of a report: version, command, data and date, for its foot."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGE = "inca-mj"
PROGRAMS = ("inca", "inca_mj", "identification")


def origin(data: Sequence[str] = ()) -> str:
    """Returns lines that say what made a report.

    Args:
        data: names of the logs that it rests on.
    """
    lines = [f"{PACKAGE} {_version(PACKAGE)} with MuJoCo {_version('mujoco')}"]
    if command := _command(sys.argv):
        lines.append(f"Command: {command}")
    if named := [name for name in data if name]:
        lines.append(f"Data: {', '.join(named)}")
    return "\n".join([*lines, f"Date: {date.today().isoformat()}"])


def _command(argv: Sequence[str]) -> str:
    """Returns the command line; empty where another program asked for the report."""
    path = Path(argv[0]) if argv else Path()
    name = path.parent.name if path.name == "__main__.py" else path.name
    if name not in PROGRAMS:
        return ""
    begin = "python -m inca_mj" if name == "inca_mj" else name
    return shlex.join([*begin.split(), *argv[1:]])


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:  # run from a source tree
        return "of a source tree"
