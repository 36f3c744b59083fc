"""A force recovered from the data, over what it follows, with the named law and its rivals."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from identification.discovery.recovered_force import LawLine, RecoveredForce
from identification.report.effect_words import describe_effect
from identification.report.style import GREY, INK, MEASURED, SERIES, STYLE, literal

SURE = 1.96  # std on each side of 95 %
RIVALS = 2  # that are drawn, the likeliest
SMALL = 0.5  # a force that stays below it is told in thousandths
NARROW = 0.4  # share of the range, below which a law's bends have a panel
DASHES = ((0, (5, 2)), (0, (1.5, 1.5)))
FOLLOWS = {
    "rate": "rate", "position": "position", "phase": "angle within one period", "time": "time",
    "drive": "force of the drive", "reading": "reading of the sensor",
}  # fmt: skip


def law_figure(of: RecoveredForce) -> Figure:
    """Returns a figure of recovered points with bars, the law with its band, and up to two rivals.

    A law that changes in a small part of the range has a second panel of that part.

    Args:
        of: the recovered force.
    """
    x_unit, unit = of.units
    top = max(np.abs(of.law.force).max(), np.abs(of.points.force).max(initial=0.0))
    factor, said = (1e3, f"m{unit}") if top < SMALL and unit else (1.0, unit)
    near = _bends(of)
    with matplotlib.rc_context(STYLE):
        figure = Figure((9.0 if near else 7.0, 3.8), layout="constrained")
        panels = figure.subplots(1, 2 if near else 1, squeeze=False)[0]
        for ax in panels:
            _draw(ax, of, factor)
            ax.set_xlabel(literal(_follows(of) + (f" [{x_unit}]" if x_unit else "")))
        if near:
            panels[0].set_title("all of it", loc="left", color=INK)
            panels[1].set_title("where it bends", loc="left", color=INK)
            panels[1].set_xlim(*near)
        panels[0].set_ylabel(literal(_force(of) + (f" [{said}]" if said else "")))
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize=8
        )
    return figure


def _draw(ax: Axes, of: RecoveredForce, factor: float) -> None:
    for (candidate, line), dash in zip(of.rivals[:RIVALS], DASHES, strict=False):
        x, f, _ = _drawn(line, of)
        label = literal(f"rival: {describe_effect(candidate)}")
        ax.plot(x, factor * f, color=SERIES[1], lw=1.2, ls=dash, label=label)
    x, f, std = _drawn(of.law, of)
    low, high = factor * (f - SURE * std), factor * (f + SURE * std)
    label = "95 % band of the named law"
    ax.fill_between(x, low, high, color=MEASURED, alpha=0.3, lw=0, label=label)
    ax.plot(x, factor * f, color=MEASURED, lw=1.5, label="the law that is named")
    p = of.points
    ax.errorbar(
        p.x, factor * p.force, factor * SURE * p.std, color=INK, fmt="o", ms=3.5, lw=1, capsize=2,
        label="recovered from the data",
    )  # fmt: skip
    ax.axhline(0, color=GREY, lw=0.6)


def _bends(of: RecoveredForce) -> tuple[float, float] | None:
    """Returns the part of the range where a law changes, with room; None where that is most."""
    x, f, _ = _drawn(of.law, of)
    change = np.nan_to_num(np.abs(np.diff(f)))
    total = np.concatenate([[0.0], np.cumsum(change)])
    first, last = np.interp(np.array([0.01, 0.99]) * total[-1], total, np.nan_to_num(x))
    room = 0.4 * (last - first)
    part = (float(first - room), float(last + room))
    return part if part[1] - part[0] < NARROW * (x[-1] - x[0]) else None


def _drawn(line: LawLine, of: RecoveredForce) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns a line, cut where the motion turns and a friction jumps."""
    cut = int(np.searchsorted(line.x, 0.0))
    parts = (line.x, line.force, line.std)
    if of.along != "rate" or not 0 < cut < len(line.x):
        return parts
    return tuple(np.insert(part, cut, np.nan) for part in parts)  # type: ignore[return-value]


def _follows(of: RecoveredForce) -> str:
    if of.along == "law":
        return f"what the law multiplies by {of.candidate.effect.sizes[0].name}"
    return FOLLOWS[of.along]


def _force(of: RecoveredForce) -> str:
    if "reading" in of.candidate.effect.hooks:
        return "error of the sensor"
    kind = "torque" if of.units[1] == "N m" else "force"
    return f"missing {kind}, against the motion" if of.resists else f"missing {kind}"
