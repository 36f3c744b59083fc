"""Findings of one study's records: rates and values by the points of its grid, and more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from identification.report.page import Section, Table
from identification.sweep.method import Findings, Record, told_in_method
from identification.sweep.power import axes, grouped, word
from identification.sweep.power_section import power_section
from identification.sweep.statistics import said, wilson
from identification.sweep.task import Study
from identification.sweep.words import Heads, about_of


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
            "rates": {n: _share([r[n] for r in mine]) for n in flags},
            "quantiles": {n: _quantiles([r[n] for r in mine]) for n in numbers},
        })  # fmt: skip
    sections = [s for s in (_rates(study, names, groups), _medians(study, names, groups)) if s]
    record: dict[str, Any] = {
        "name": study.name, "method": study.word, "tasks": study.points * study.count,
        "records": len(rows), "failed": len(rows) - len(done), "groups": groups,
    }  # fmt: skip
    power, more = power_section(study, done)
    sections += more
    if power:
        record["power"] = power
    sentences: list[str] = []
    if study.method.summary is not None and done:
        with told_in_method(study.reference, "has no summary of its records"):
            own = study.method.summary(done)
        record["summary"] = own.record
        sections += [_titled(study, section) for section in own.sections]
        sentences = [f"{study.name}: {sentence}" for sentence in own.sentences]
    return Findings(record, sections, sentences)


def _share(flags: Sequence[bool | None]) -> dict[str, Any]:
    known = [flag for flag in flags if flag is not None]
    return wilson(sum(known), len(known))


def _titled(study: Study, section: Section) -> Section:
    return replace(section, title=f"{study.name}: {section.title}")


def _quantiles(values: Sequence[float | None]) -> dict[str, float | None]:
    known = [v for v in values if v is not None and np.isfinite(v)]
    if not known:
        return {"low": None, "median": None, "high": None}
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    return {"low": float(low), "median": float(middle), "high": float(high)}


def _rates(study: Study, names: Sequence[str], groups: Sequence[Record]) -> Section | None:
    flags = [*groups[0]["rates"]] if groups else []
    if not flags:
        return None
    rows = tuple(
        (*_cells(group), group["tasks"], *(said(group["rates"][n]) for n in flags))
        for group in groups
    )
    text = "Counts with Wilson's 95 % intervals. " + _meaning(study, flags)
    return Section(f"{study.name}: rates", text, table=Table(_heads(study, names, flags), rows))


def _medians(study: Study, names: Sequence[str], groups: Sequence[Record]) -> Section | None:
    numbers = [*groups[0]["quantiles"]] if groups else []
    if not numbers:
        return None
    rows = tuple(
        (*_cells(group), group["tasks"], *(_range(group["quantiles"][n]) for n in numbers))
        for group in groups
    )
    text = "Medians, and in brackets the 5 % and 95 % quantiles. " + _meaning(study, numbers)
    return Section(f"{study.name}: values", text, table=Table(_heads(study, names, numbers), rows))


def _meaning(study: Study, names: Sequence[str]) -> str:
    return "; ".join(_columns(study).meaning(n) for n in names) + "."


def _heads(study: Study, names: Sequence[str], columns: Sequence[str]) -> tuple[str, ...]:
    """Returns heads of a table: settings, the count of tasks, and columns, in words with units."""
    settings = Heads(about_of(study.method.settings))
    return (*map(settings.head, names), "tasks", *map(_columns(study).head, columns))


def _columns(study: Study) -> Heads:
    return Heads({name: column.about for name, column in study.method.columns.items()})


def _cells(group: Record) -> list[str]:
    return [word(value) for value in group["settings"].values()]


def _range(q: Mapping[str, float | None]) -> str:
    if q["median"] is None:
        return "-"
    return f"{q['median']:.4g} [{q['low']:.3g}, {q['high']:.3g}]"
