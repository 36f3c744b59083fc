"""The file of a robot with another spread than its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from identification.errors import InputError
from identification.files import is_file, read_toml
from identification.robot.alike import read_alike
from identification.robot.file import RobotFile
from identification.robot.file_checks import check_table
from identification.robot.file_keys import KEYS


def with_spread(file: RobotFile, word: str) -> RobotFile:
    """Returns a robot's file with its own spread ("usual"), no deviations ("none"), or another.

    Args:
        file: of the robot.
        word: one of these words, or the path of a TOML with tables [spread.NAME].

    Raises:
        InputError: there is no such file, or it holds anything else.
    """
    if word == "usual":
        return file
    alike = tuple(replace(a, deviates=False) for a in file.spread)
    if word != "none":
        if not is_file(Path(word)):
            raise InputError(f"no spread {word!r}; give none, usual, or a TOML file")
        content = read_toml(Path(word))
        check_table(content, {"spread": KEYS["spread"]}, word)
        alike = read_alike(content, Path(word), file.by_itself)
    free = (*file.by_itself, *(n for a in alike for n in a.names))
    records = {n: r for n, r in file.records.items() if n in free}
    return replace(file, free=free, records=records, spread=alike)
