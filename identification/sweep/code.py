"""The code that computed a record: the version of the package and, in a checkout, its commit."""

from __future__ import annotations

import subprocess
from functools import cache
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).parent


@cache
def commit() -> str:
    """Returns the commit of the checkout of this file, "-dirty" where files differ from it.

    It is empty where there is no git, or where the file is not one of a checkout.
    """
    try:
        subprocess.run(
            ["git", "ls-files", "--error-unmatch", Path(__file__).name], cwd=HERE,
            capture_output=True, check=True,
        )  # fmt: skip
        said = subprocess.run(
            ["git", "describe", "--always", "--dirty"], cwd=HERE, capture_output=True, text=True,
            check=True,
        )  # fmt: skip
    except (OSError, subprocess.CalledProcessError):
        return ""
    return said.stdout.strip()


@cache
def code() -> str:
    """Returns the version of the package, and its commit in a checkout: "0.2.0, c7d7b26"."""
    return ", ".join(filter(None, (version("inca-mj"), commit())))
