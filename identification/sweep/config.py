"""A sweep as its TOML describes it: studies, each of a method, over a grid of settings.

seed = 1                              # of the whole sweep
about = "False names in null worlds"  # the title of the report; may be left out
[[study]]
method = "null-score"                 # registered, or "file.py:NAME" of a method of your own
name = "white"                        # the method's if not given; each study has another
count = 10                            # tasks for each point of the grid, each with its own seed
paired = false                        # true: the k-th task has the same seed at all points
[study.settings]                      # of the method, the same for all tasks
duration = 20.0
[study.grid]                          # settings that vary; every combination is a point
robot = { first = 1000, count = 200 }

Seeds depend on nothing but this file (`identification.sweep.task`).
"""

from __future__ import annotations

from collections.abc import Mapping
from glob import glob
from math import prod
from pathlib import Path
from typing import Any

from identification.errors import InputError, repeated, told_of
from identification.robot.file.file_checks import Kinds, check_table
from identification.storage.files import read_json, read_toml
from identification.sweep.method import Registry, load_method, reference_of, told_in_method
from identification.sweep.settings import Plain, build, place, refuse_missing_files
from identification.sweep.task import Study, Sweep

MOST = 100_000  # values of an axis
_ROW: Kinds = {"first": (int, "a whole number"), "count": (int, "a whole number above zero")}
_FILES: Kinds = {"files": (str, "a pattern in quotes"), "label": (dict, "a table")}


def axis(value: Any, folder: Path, where: str) -> tuple[Plain, ...]:
    """Returns the values of an axis, or refuses what is no axis or has no values."""
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
    """Returns the files of a pattern, written as the pattern is, in the order of their names."""
    above, slash, name = pattern.rpartition("/")
    base = place(above, folder) if slash else folder
    found = sorted(Path(path).name for path in glob(str(base / name)))
    if not found:
        raise InputError(f"{where}: no file matches {base / name}; correct the pattern")
    if label:
        labels = read_json(base / "labels.json", "JSON file of labels", "leave label out")
        labels = labels if isinstance(labels, dict) else {}

        def says(told: Mapping[str, Any]) -> bool:  # a list in a label must hold the value
            return all(
                value == told.get(key) or (isinstance(told.get(key), list) and value in told[key])
                for key, value in label.items()
            )

        found = [f for f in found if says(labels.get(Path(f).stem, {}))]
        if not found:
            raise InputError(
                f"{where}: {base / 'labels.json'} describes no file of {name} by {dict(label)};"
                " correct label, or leave it out"
            )
    return tuple(f"{above}{slash}{file}" for file in found)


POINTS = 100_000  # of a grid; each is checked before anything runs
TASKS = 10**9  # numbers of nine digits
_SWEEP: Kinds = {
    "seed": (int, "a whole number, 0 or more"),
    "about": (str, "text in quotes"),
    "study": (list, "tables [[study]]"),
}
_STUDY: Kinds = {
    "method": (str, "the name of a method in quotes"),
    "name": (str, "text in quotes"),
    "count": (int, "a whole number, 1 or more"),
    "paired": (bool, "true or false"),
    "settings": (dict, "a table of settings"),
    "grid": (dict, "a table of axes"),
}


def read_sweep(path: str | Path, known: Registry, *, files: bool = True) -> Sweep:
    """Read the TOML of a sweep; every point of every grid is checked before anything runs.

    Args:
        path: of the TOML.
        known: reference of each registered method, by name.
        files: whether the files that tasks read must be there; a summary of records needs none.

    Raises:
        InputError: it cannot be read, has an unknown key, method or setting, or a wrong value, or
            names a file that is not there.
    """
    path = Path(path).absolute()
    content = read_toml(path, "config file of a sweep, such as sweep.toml")
    check_table(content, _SWEEP, str(path))
    tables = content.get("study", [])
    if not tables or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{path} has no [[study]]; give one or more, each with a method")
    seed = content.get("seed", 0)
    if seed < 0:
        raise InputError(f"seed in {path} is negative; give 0 or more")
    studies = tuple(_study(table, known, path) for table in tables)
    if twice := repeated([study.name for study in studies]):
        raise InputError(f"two studies in {path} are called {twice[0]!r}; give each a name")
    sweep = Sweep(path=path, seed=seed, about=content.get("about", path.stem), studies=studies)
    first = 0
    for study in studies:  # what a point would be refused for in each of its tasks
        where = f"study {study.name!r}"
        for point in range(study.points):
            settings = sweep.task(first + point * study.count).settings
            with told_of(where), told_in_method(study.reference, "refuses its settings"):
                build(study.method.settings, settings)
            if files:
                refuse_missing_files(study.method.settings, settings, where)
        first += study.points * study.count
    return sweep


def _study(table: dict[str, Any], known: Registry, path: Path) -> Study:
    where = f"[[study]] in {path}"
    check_table({k: v for k, v in table.items() if k != "paired"}, _STUDY, where)
    paired = table.get("paired", False)
    if not isinstance(paired, bool):
        raise InputError(f"paired in {where} must be true or false; correct it there")
    if "method" not in table:
        raise InputError(f"{where} does not say 'method'; known: {', '.join(sorted(known))}")
    word = table["method"]
    reference = reference_of(word, known, path.parent)
    name, count = table.get("name", word.rpartition(":")[2]), table.get("count", 1)
    if count < 1:
        raise InputError(f"count in {where} must be 1 or more; correct it there")
    settings = table.get("settings", {})
    grid = {
        key: axis(value, path.parent, f"grid.{key} of study {name!r}")
        for key, value in table.get("grid", {}).items()
    }
    if both := sorted(set(settings) & set(grid)):
        raise InputError(f"study {name!r} has {both[0]} in settings and in grid; keep one of both")
    if (points := prod(map(len, grid.values()))) > POINTS or points * count > TASKS:
        raise InputError(
            f"study {name!r} has {points} points and {points * count} tasks; give {POINTS} points"
            f" and {TASKS} tasks at most"
        )
    return Study(
        name=name, word=word, reference=reference, method=load_method(reference), count=count,
        paired=paired, settings=settings, grid=grid,
    )  # fmt: skip
