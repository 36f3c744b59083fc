"""A force recovered from the data, over what it follows, with the named law and its rivals."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.discovery.recovered_force import LawLine, RecoveredForce
from identification.report.effect_words import describe_effect
from identification.report.style import GREY, INK, MEASURED, SERIES, STYLE, literal

SURE = 1.96  # std on each side of 95 %
RIVALS = 2  # that are drawn, the likeliest
SMALL = 0.5  # a force that stays below it is told in thousandths
DASHES = ((0, (5, 2)), (0, (1.5, 1.5)))
FOLLOWS = {
    "rate": "rate", "position": "position", "phase": "angle within one period", "time": "time",
    "drive": "force of the drive", "reading": "reading of the sensor",
}  # fmt: skip


def law_figure(of: RecoveredForce) -> Figure:
    """The recovered points with their bars, the law with its band, and up to two rivals.

    Args:
        of: the recovered force.
    """
    x_unit, unit = of.units
    top = max(np.abs(of.law.force).max(), np.abs(of.points.force).max(initial=0.0))
    factor, said = (1e3, f"m{unit}") if top < SMALL and unit else (1.0, unit)
    with matplotlib.rc_context(STYLE):
        figure = Figure((7.0, 3.8), layout="constrained")
        ax = figure.subplots()
        for (candidate, line), dash in zip(of.rivals[:RIVALS], DASHES, strict=False):
            x, f, _ = _drawn(line, of)
            label = literal(f"rival: {describe_effect(candidate)}")
            ax.plot(x, factor * f, color=SERIES[1], lw=1.2, ls=dash, label=label)
        x, f, std = _drawn(of.law, of)
        low, high = factor * (f - SURE * std), factor * (f + SURE * std)
        ax.fill_between(x, low, high, color=MEASURED, alpha=0.25, lw=0, label="its 95 % band")
        ax.plot(x, factor * f, color=MEASURED, lw=1.8, label="the law that is named")
        p = of.points
        ax.errorbar(
            p.x, factor * p.force, factor * SURE * p.std, color=INK, fmt="o", ms=4, lw=1,
            capsize=2, label="recovered from the data",
        )  # fmt: skip
        ax.axhline(0, color=GREY, lw=0.6)
        ax.set_xlabel(literal(_follows(of) + (f" [{x_unit}]" if x_unit else "")))
        ax.set_ylabel(literal(_force(of) + (f" [{said}]" if said else "")))
        figure.legend(loc="outside upper center", ncols=2, fontsize=8)
    return figure


def _drawn(line: LawLine, of: RecoveredForce) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A line, cut where the motion turns and a friction jumps."""
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
