"""Power curves: how often something is found, over the settings of a grid.

A curve is the share of successes over one setting, at fixed values of the others. Where it rises,
the smallest value of that setting at which 80 % succeed is its threshold; it has an interval, from
the ends of Wilson's intervals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from identification.sweep.method import Record
from identification.sweep.rows import SET
from identification.sweep.settings import Heads, Plain, in_words
from identification.sweep.statistics import crossing, wilson

LEVEL = 0.8
IN_WORDS = f"{100 * LEVEL:g} %"
FEW = 12  # an axis with more values repeats a task; it is no axis of a curve


@dataclass(frozen=True)
class Curve:
    """Rates over one setting."""

    others: Mapping[str, Plain]  # values of the other settings of the grid
    x: tuple[float, ...]  # values of the setting, ascending
    rates: tuple[Mapping[str, Any], ...]  # at each, as `statistics.wilson` has it
    heads: Heads  # the settings in words

    @property
    def label(self) -> str:
        """The other settings in words."""
        return ", ".join(
            f"{in_words(name)} {word(value)} {self.heads.unit(name)}".rstrip()
            for name, value in self.others.items()
        )

    def threshold(self, at: float) -> Threshold:
        """Returns the smallest value found in 80 %, at a value of another setting."""
        value, low, high = (
            crossing(self.x, [rate[part] for rate in self.rates], LEVEL)
            for part in ("value", "high", "low")
        )
        return Threshold(at, value, low, high, self.x[-1])


@dataclass(frozen=True)
class Threshold:
    """The smallest value of a setting that is found in 80 % of the tasks."""

    at: float  # value of another setting
    value: float | None  # None where not even the largest is found so often
    low: float | None  # end of its interval
    high: float | None  # the other end; None where it is beyond the largest
    largest: float  # the largest value that was tried


def word(value: Plain) -> str:
    """Returns a value of a setting as text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def axes(grid: Mapping[str, Sequence[Plain]]) -> list[str]:
    """Returns the settings of a grid that tell groups of tasks apart: of two values to `FEW`."""
    return [name for name, values in grid.items() if 2 <= len(values) <= FEW]


def numeric(grid: Mapping[str, Sequence[Plain]]) -> list[str]:
    """Returns the settings of `axes` that are numbers."""
    return [
        name for name in axes(grid)
        if all(isinstance(v, int | float) and not isinstance(v, bool) for v in grid[name])
    ]  # fmt: skip


def grouped(rows: Sequence[Record], names: Sequence[str]) -> dict[tuple[Plain, ...], list[Record]]:
    """Returns rows by the values of some settings, in the order in which these come."""
    groups: dict[tuple[Plain, ...], list[Record]] = {}
    for row in rows:
        groups.setdefault(tuple(row[SET + name] for name in names), []).append(row)
    return groups


def curves(
    rows: Sequence[Record], success: str, axis: str, others: Sequence[str], heads: Heads
) -> list[Curve]:
    """Returns a curve for each combination of the other settings."""
    counted = [row for row in rows if row[success] is not None]
    out = []
    for values, mine in grouped(counted, others).items():
        by_x: dict[float, list[bool]] = {}
        for row in mine:
            by_x.setdefault(row[SET + axis], []).append(row[success])
        x = tuple(sorted(by_x))
        rates = tuple(wilson(sum(by_x[v]), len(by_x[v])) for v in x)
        out.append(Curve(dict(zip(others, values, strict=True)), x, rates, heads))
    return out


def thresholds(found: Sequence[Curve], axis: str) -> dict[str, list[Threshold]]:
    """Returns thresholds over one of the other settings; by the rest of the settings, in words."""
    lines: dict[str, list[Threshold]] = {}
    for curve in found:
        rest = Curve({k: v for k, v in curve.others.items() if k != axis}, (), (), curve.heads)
        at = curve.others[axis]
        if isinstance(at, int | float):
            lines.setdefault(rest.label, []).append(curve.threshold(float(at)))
    return {label: sorted(line, key=lambda t: t.at) for label, line in lines.items()}
