"""Compilation of the equations that check the twin, of the reference and of hidden worlds."""

from __future__ import annotations

from pathlib import Path

from identification.kept_code import kept_code

FOLDERS = (
    "reference",
    "robot",
    "studies/worlds",
)  # of the package, from which the equations import

compiled = kept_code(*(Path(__file__).parents[1] / name for name in FOLDERS))
