"""Summary of a sweep's records: counts, rates, medians, power curves, times; as a report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from identification.progress import duration
from identification.report.page import Section, Table
from identification.sweep.method import Record
from identification.sweep.rows import RUN, digest
from identification.sweep.study_summary import summarise_study
from identification.sweep.task import Sweep

SHOWN = 8  # kinds of errors in the report


@dataclass(frozen=True)
class Summary:
    """The summary of a sweep.

    Attributes:
        record: plain values for result.json.
        sections: of the report.
        sentences: the most important first.
    """

    record: Mapping[str, Any]
    sections: Sequence[Section]
    sentences: Sequence[str]


def summarise(sweep: Sweep, rows: Iterable[Record]) -> Summary:
    """Count the records.

    Args:
        sweep: whose they are.
        rows: in the order of their tasks.
    """
    every = [*rows]
    failed = Counter(row["error"] for row in every if row["error"] is not None)
    sections: list[Section] = []
    studies, sentences = [], list[str]()
    for study in sweep.studies:
        mine = [row for row in every if row["study"] == study.name]
        found = summarise_study(study, mine)
        studies.append(found.record)
        sections += found.sections
        sentences += found.sentences
    first = f"{len(every)} of {len(sweep)} tasks have a record"
    first += f"; {failed.total()} of them met an error{_most(failed)}." if failed else "."
    if failed:
        sections.append(_errors(failed))
    record = {
        "about": sweep.about, "tasks": len(sweep), "records": len(every),
        "errors": dict(failed.most_common(SHOWN)), "failed": failed.total(),
        "digest": digest(every), "studies": studies,
    }  # fmt: skip
    return Summary(record, [*sections, _times(sweep, every)], [first, *sentences])


def _most(failed: Counter[str]) -> str:
    """Returns the text of the error that most tasks met, and how many of them where not all."""
    ((text, count),) = failed.most_common(1)
    return f" ({text})" if len(failed) == 1 else f", {count} of these ({text})"


def _errors(failed: Counter[str]) -> Section:
    rows = tuple((text, count) for text, count in failed.most_common(SHOWN))
    return Section(
        "Errors", "What tasks met; --again runs them once more.",
        table=Table(("error", "tasks"), rows),
    )  # fmt: skip


def _times(sweep: Sweep, rows: Sequence[Record]) -> Section:
    """Returns times by study, and on how many machines; they are no part of the result."""
    cells = []
    for study in sweep.studies:
        mine = [row for row in rows if row["study"] == study.name]
        if mine:
            each = np.array([row[RUN + "processor_seconds"] for row in mine])
            cells.append(
                (study.name, len(mine), float(np.median(each)), float(each.max()),
                 duration(float(each.sum())), max(row[RUN + "memory"] for row in mine) / 2**20,
                 len({row[RUN + "host"] for row in mine}))
            )  # fmt: skip
    head = ("study", "tasks", "median [s]", "longest [s]", "all", "memory of a worker [MiB]",
            "machines")  # fmt: skip
    return Section("Times", "Processor time of a task.", table=Table(head, tuple(cells)))
