"""Power curves of a study as a section of the report: figures, and a table of thresholds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from identification.quantities import finite_or_none
from identification.report.page import Section, Table
from identification.sweep.method import Record
from identification.sweep.power import (
    IN_WORDS,
    Curve,
    Threshold,
    axes,
    curves,
    numeric,
    thresholds,
    word,
)
from identification.sweep.task import Study
from identification.sweep.words import Heads, about_of, in_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def power_section(
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
    return [_power_json(axis, c, t) for c, t in zip(found, at, strict=True)], [section]


def _power_json(axis: str, curve: Curve, at: Threshold) -> dict[str, Any]:
    return {
        "axis": axis, "settings": dict(curve.others), "x": list(curve.x),
        "rates": [dict(r) for r in curve.rates],
        "threshold": {"value": finite_or_none(at.value), "low": finite_or_none(at.low),
                      "high": finite_or_none(at.high)},
    }  # fmt: skip
