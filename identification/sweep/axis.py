"""An axis of a grid: values in a list, whole numbers in a row, or the files of a folder.

ratio = [1, 3, 10]
robot = { first = 1000, count = 20 }
log = { files = "logs/*.csv" }
log = { files = "logs/*.csv", label = { kind = "single", ratio = 25 } }

With `label`, only those files are taken that labels.json beside them describes so, by their stem.
"""

from __future__ import annotations

from collections.abc import Mapping
from glob import glob
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.files import read_json
from identification.robot.file_checks import Kinds, check_table
from identification.sweep.settings import Plain, place

MOST = 100_000  # values of an axis
_ROW: Kinds = {"first": (int, "a whole number"), "count": (int, "a whole number above zero")}
_FILES: Kinds = {"files": (str, "a pattern in quotes"), "label": (dict, "a table")}


def axis(value: Any, folder: Path, where: str) -> tuple[Plain, ...]:
    """Returns the values of an axis.

    Args:
        value: as the TOML has it.
        folder: of the TOML.
        where: it stands, for messages.

    Raises:
        InputError: it is no axis, or has no values.
    """
    if isinstance(value, list) and all(isinstance(v, bool | int | float | str) for v in value):
        values: tuple[Plain, ...] = tuple(value)
    elif isinstance(value, dict) and "files" in value:
        check_table(value, _FILES, where)
        values = _files(value["files"], value.get("label", {}), folder, where)
    elif isinstance(value, dict):
        check_table(value, _ROW, where)
        if not {"first", "count"} <= set(value):
            raise InputError(f"{where} must have both first and count; correct it there")
        if value["count"] > MOST:
            raise InputError(f"{where} has {value['count']} values; give {MOST} at most")
        values = tuple(range(value["first"], value["first"] + value["count"]))
    else:
        raise InputError(
            f"{where} must be a list of values, {{ first, count }} or {{ files }}, not {value!r}"
        )
    if not values:
        raise InputError(f"{where} has no values; give one or more")
    if len(set(values)) < len(values):
        raise InputError(f"{where} has a value twice; raise count to repeat a task")
    return values


def _files(pattern: str, label: Mapping[str, Any], folder: Path, where: str) -> tuple[str, ...]:
    """Returns the files of a pattern, written as the pattern is, in the order of their names.

    Raises:
        InputError: no file has such a name, or labels.json describes none so.
    """
    above, slash, name = pattern.rpartition("/")
    base = place(above, folder) if slash else folder
    found = sorted(Path(path).name for path in glob(str(base / name)))
    if not found:
        raise InputError(f"{where}: no file matches {base / name}; correct the pattern")
    if label:
        labels = _labels(base)
        found = [f for f in found if _described(labels.get(Path(f).stem, {}), label)]
        if not found:
            raise InputError(
                f"{where}: {base / 'labels.json'} describes no file of {name} by {dict(label)};"
                " correct label, or leave it out"
            )
    return tuple(f"{above}{slash}{file}" for file in found)


def _labels(folder: Path) -> dict[str, Any]:
    path = folder / "labels.json"
    labels = read_json(path, "JSON file of labels", "leave label out")
    return labels if isinstance(labels, dict) else {}


def _described(told: Mapping[str, Any], label: Mapping[str, Any]) -> bool:
    """Returns whether a label says all that is asked; a list in it must hold the value."""
    return all(
        value == told.get(key) or (isinstance(told.get(key), list) and value in told[key])
        for key, value in label.items()
    )
