"""Summary of a sweep's records: counts, rates, medians, power curves, times; as a report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from identification.quantities import finite_or_none
from identification.report.page.page import Section, Table
from identification.runtime.progress import duration
from identification.sweep.method import Findings, Record, told_in_method
from identification.sweep.power import IN_WORDS, axes, curves, grouped, numeric, thresholds, word
from identification.sweep.rows import RUN, digest
from identification.sweep.settings import Heads, about_of, in_words
from identification.sweep.statistics import rate, said
from identification.sweep.task import Study, Sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure


SHOWN = 8  # kinds of errors in the report


def summarise(sweep: Sweep, rows: Iterable[Record]) -> Findings:
    """Returns counts, rates and times of all records."""
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
    if failed:
        ((most, count),) = failed.most_common(1)
        which = "" if len(failed) == 1 else f", {count} of these"
        first += f"; {failed.total()} of them met an error{which} ({most})"
        rows_of_errors = tuple(failed.most_common(SHOWN))
        text = "What tasks met; --again runs them once more."
        sections.append(Section("Errors", text, table=Table(("error", "tasks"), rows_of_errors)))
    record = {
        "about": sweep.about, "tasks": len(sweep), "records": len(every),
        "errors": dict(failed.most_common(SHOWN)), "failed": failed.total(),
        "digest": digest(every), "studies": studies,
    }  # fmt: skip
    return Findings(record, [*sections, _times(sweep, every)], [f"{first}.", *sentences])


def summarise_study(study: Study, rows: Sequence[Record]) -> Findings:
    """Returns rates, medians and power curves of a study, and what its method says beyond them."""
    done, names = [row for row in rows if row["error"] is None], axes(study.grid)
    columns = study.method.columns
    flags = [n for n, c in columns.items() if c.kind is bool]
    numbers = [n for n, c in columns.items() if c.kind in (int, float)]
    groups = []
    for values, mine in grouped(done, names).items():
        groups.append({
            "settings": dict(zip(names, values, strict=True)), "tasks": len(mine),
            "rates": {
                n: rate([r[n] for r in mine if r[n] is not None], bool) for n in flags
            },
            "quantiles": {n: _quantiles([r[n] for r in mine]) for n in numbers},
        })  # fmt: skip
    sections = _tables(study, names, groups)
    record: dict[str, Any] = {
        "name": study.name, "method": study.word, "tasks": study.points * study.count,
        "records": len(rows), "failed": len(rows) - len(done), "groups": groups,
    }  # fmt: skip
    power, more = _power_section(study, done)
    sections += more
    if power:
        record["power"] = power
    sentences: list[str] = []
    if study.method.summary is not None and done:
        with told_in_method(study.reference, "has no summary of its records"):
            found = study.method.summary(done)
        record["summary"] = found.record
        sections += [replace(s, title=f"{study.name}: {s.title}") for s in found.sections]
        sentences = [f"{study.name}: {sentence}" for sentence in found.sentences]
    return Findings(record, sections, sentences)


def _quantiles(values: Sequence[float | None]) -> dict[str, float | None]:
    known = [v for v in values if v is not None and np.isfinite(v)]
    if not known:
        return {"low": None, "median": None, "high": None}
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    return {"low": float(low), "median": float(middle), "high": float(high)}


def _range(q: Mapping[str, float | None]) -> str:
    if q["median"] is None:
        return "-"
    return f"{q['median']:.4g} [{q['low']:.3g}, {q['high']:.3g}]"


# What a group of tasks has by column: title of its section, how to read it, what a cell shows.
_TABLES: dict[str, tuple[str, str, Callable[[Any], str]]] = {
    "rates": ("rates", "Counts with Wilson's 95 % intervals.", said),
    "quantiles": ("values", "Medians, and in brackets the 5 % and 95 % quantiles.", _range),
}


def _tables(study: Study, names: Sequence[str], groups: Sequence[Record]) -> list[Section]:
    """Returns tables of rates and of medians by the points of the grid, where there are any."""
    of, columns = Heads(about_of(study.method.settings)), study.method.columns
    heads, out = Heads({name: column.about for name, column in columns.items()}), []
    for kind, (title, text, show) in _TABLES.items():
        shown = [*groups[0][kind]] if groups else []
        if shown:
            rows = tuple(
                (*map(word, group["settings"].values()), group["tasks"],
                 *(show(group[kind][n]) for n in shown))
                for group in groups
            )  # fmt: skip
            head = (*map(of.head, names), "tasks", *map(heads.head, shown))
            text += " " + "; ".join(map(heads.meaning, shown)) + "."
            out.append(Section(f"{study.name}: {title}", text, table=Table(head, rows)))
    return out


def _power_section(
    study: Study, done: Sequence[Record]
) -> tuple[list[dict[str, Any]], list[Section]]:
    """Returns power curves over the method's own axis, and their thresholds over other numbers."""
    method, numbers = study.method, numeric(study.grid)
    if not method.success or not numbers or not done:
        return [], []
    axis = method.against if method.against in numbers else numbers[0]
    others = [name for name in axes(study.grid) if name != axis]
    of, out = Heads(about_of(method.settings)), in_words(method.success)
    found = [c for c in curves(done, method.success, axis, others, of) if len(c.x) > 1]
    if not found:
        return [], []
    from identification.sweep.figures import power_figure, threshold_figure

    figures: list[tuple[str, Figure]] = [
        (f"{study.name}, {out} over {in_words(axis)}", power_figure(found, of.head(axis), out))
    ]
    for other in numeric(study.grid):
        if other != axis:
            lines = thresholds(found, other)
            figures.append((f"{study.name}, smallest {in_words(axis)} over {in_words(other)}",
                            threshold_figure(lines, of.head(other), of.head(axis))))  # fmt: skip
    at = [curve.threshold(0.0) for curve in found]
    rows = tuple(
        (*map(word, curve.others.values()), sum(r["of"] for r in curve.rates),
         f"above {t.largest:g}" if t.value is None else f"{t.value:.3g}",
         "-" if t.low is None else f"{t.low:.3g}",
         f"above {t.largest:g}" if t.high is None else f"{t.high:.3g}")
        for curve, t in zip(found, at, strict=True)
    )  # fmt: skip
    head = (*map(of.head, others), "tasks", f"{of.head(axis)} found in {IN_WORDS}", "from", "to")
    text = (
        f"The share of tasks with {out} ({method.columns[method.success].about}) over"
        f" {of.meaning(axis)}; with Wilson's 95 % intervals. The table has the smallest"
        f" {in_words(axis)} at which it reaches {IN_WORDS}, made to rise and interpolated; its"
        " interval is from the ends of Wilson's intervals. A triangle stands where the largest"
        " value is not found so often. An axis on which the values are far apart is logarithmic,"
        " and says so."
    )
    section = Section(f"{study.name}: power", text, tuple(figures), Table(head, rows))
    record = [
        {"axis": axis, "settings": dict(curve.others), "x": list(curve.x),
         "rates": [dict(r) for r in curve.rates],
         "threshold": {end: finite_or_none(getattr(t, end)) for end in ("value", "low", "high")}}
        for curve, t in zip(found, at, strict=True)
    ]  # fmt: skip
    return record, [section]


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
