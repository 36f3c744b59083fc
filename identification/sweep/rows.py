"""Records as rows of one table: its columns, a row of an outcome, and when two tables are equal.

task, study, method, draw     which task
set.NAME                      its settings, as the TOML writes them
NAME                          what the method returned
error                         the error that it met instead; else null
run.NAME                      times, host, memory: no two runs have them in common
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from identification.errors import InputError
from identification.runtime.lazy import needed
from identification.sweep.method import Record
from identification.sweep.settings import about_of, kinds_of
from identification.sweep.task import Sweep
from identification.sweep.work import Outcome

RUN = "run."
SET = "set."
_FIRST = {
    "task": (int, "number of the task in the sweep"),
    "study": (str, "name of the study"),
    "method": (str, "its method"),
    "draw": (int, "number of the task at its point of the grid"),
}
_LAST = {
    "error": (str, "the error that the task met, or null"),
    "run.seconds": (float, "wall time [s]"),
    "run.processor_seconds": (float, "processor time [s]"),
    "run.ended": (float, "when it ended [s since 1970]"),
    "run.host": (str, "machine"),
    "run.process": (int, "number of the worker's process"),
    "run.memory": (int, "the most memory that the worker had held by then [bytes]"),
    "run.code": (str, "version of the package and commit of its checkout"),
    "run.trace": (str, "where in the code the error was, or null"),
}


def columns(sweep: Sweep) -> dict[str, tuple[Any, str]]:
    """Returns kind and meaning of every column of a sweep's table; refuses one of two kinds."""
    out: dict[str, tuple[Any, str]] = dict(_FIRST)

    def add(name: str, kind: Any, about: str) -> None:
        if name in out and out[name][0] != kind:
            raise InputError(
                f"{name} is of two kinds in the methods of {sweep.path}; write two sweeps"
            )
        out.setdefault(name, (kind, about))

    for study in sweep.studies:
        about = about_of(study.method.settings)
        for name, kind in kinds_of(study.method.settings).items():
            add(SET + name, str if kind is Path else kind, about[name] or "a setting")
    for study in sweep.studies:
        for name, column in study.method.columns.items():
            if name in (*_FIRST, "error") or name.startswith((RUN, SET)):
                raise InputError(f"method {study.word} has a column {name!r}; rename it")
            add(name, column.kind, column.about)
    return {**out, **_LAST}


def row(sweep: Sweep, outcome: Outcome) -> dict[str, Any]:
    """Returns the row of an outcome; what it does not have is null."""
    s, _, draw = sweep.locate(outcome.number)
    study = sweep.studies[s]
    return {
        "task": outcome.number, "study": study.name, "method": study.word, "draw": draw,
        **{SET + name: value for name, value in sweep.shown(outcome.number).items()},
        **(outcome.record or {}),
        "error": outcome.error,
        **{RUN + name: value for name, value in outcome.run.items()},
    }  # fmt: skip


def schema(sweep: Sweep) -> Any:
    """Returns the schema of the table, as pyarrow has it."""
    pa = needed("pyarrow", "sweep", "a sweep")
    plain = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}

    def arrow(kind: Any) -> Any:
        inner = getattr(kind, "__args__", None)
        return pa.list_(plain[inner[0]]) if inner else plain[kind]

    return pa.schema(
        [pa.field(n, arrow(k), metadata={"about": a}) for n, (k, a) in columns(sweep).items()],
        metadata={"sweep": sweep.digest()},
    )


def comparable(rows: Iterable[Record]) -> Iterator[str]:
    """Yields each row as text without times, the same where the row is the same to the bit.

    A float is written with as many digits as tell it from every other.
    """
    for each in rows:
        kept: Mapping[str, Any] = {k: v for k, v in each.items() if not k.startswith(RUN)}
        yield json.dumps(kept, sort_keys=True)


def digest(rows: Iterable[Record]) -> str:
    """Returns a digest of rows in the order of their tasks; it tells records equal to the bit."""
    total = sha256()
    for text in comparable(rows):
        total.update(text.encode() + b"\n")
    return total.hexdigest()
