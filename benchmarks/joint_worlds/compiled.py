"""Compilation of the equations of hidden joints, all of which lie in this folder."""

from pathlib import Path

from identification.kept_code import kept_code

compiled = kept_code(Path(__file__).parent)
