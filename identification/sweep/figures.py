"""Figures of a sweep: power curves, where they reach a level, confusion, reliability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.page.style import GREY, INK, MEASURED, SERIES, STYLE, literal, styled
from identification.sweep.power import IN_WORDS, LEVEL, Curve, Threshold
from identification.sweep.settings import LOGARITHMIC
from identification.sweep.statistics import wilson

EDGES = (0.0, 0.3, 0.5, 0.7, 0.9, 1.0)  # of confidence
WIDE_RANGE = 8.0  # ratio of the largest to the smallest value above which an axis is logarithmic
TOGETHER = 3  # curves in one panel, whose bands can still be told apart
MANY = 30  # names on an axis that are still read


@styled
def power_figure(curves: Sequence[Curve], axis: str, success: str) -> Figure:
    """Draws the share of successes over a setting, Wilson's 95 % intervals, a line for each curve.

    Many curves have a panel each, with the others in grey.
    """
    panels = [[*curves]] if len(curves) <= TOGETHER else [[curve] for curve in curves]
    across = min(4, len(panels))
    down = -(-len(panels) // across)
    size = (6.4, 3.8) if len(panels) == 1 else (2.6 * across + 0.6, 2.3 * down + 0.4)
    figure = Figure(size, layout="constrained")
    every = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False).flat
    for ax, mine in zip(every, panels, strict=False):
        for curve in curves if len(panels) > 1 else ():
            ax.plot(curve.x, _part(curve, "value"), color=GREY, lw=0.7, alpha=0.5)
        for k, curve in enumerate(mine):
            colour, band = SERIES[k % len(SERIES)], (_part(curve, "low"), _part(curve, "high"))
            ax.plot(
                curve.x, _part(curve, "value"), "o-", ms=4, color=colour, label=literal(curve.label)
            )
            ax.fill_between(curve.x, *band, color=colour, alpha=0.15, lw=0)
        ax.axhline(LEVEL, color=GREY, lw=0.8, ls="--")
        far_apart = _scale(ax, [x for curve in curves for x in curve.x])
        ax.set(ylim=(-0.03, 1.03))
        if len(panels) > 1:
            ax.set_title(literal(mine[0].label))
        elif mine[0].label:
            ax.legend(fontsize=8)
    for ax in [*every][len(panels) :]:
        ax.set_visible(False)
    figure.supxlabel(literal(axis + LOGARITHMIC * far_apart), fontsize=9)
    figure.supylabel(f"share: {literal(success)}", fontsize=9)
    return figure


def _part(curve: Curve, part: str) -> list[float]:
    return [rate[part] for rate in curve.rates]


@styled
def threshold_figure(lines: Mapping[str, Sequence[Threshold]], axis: str, against: str) -> Figure:
    """Draws the smallest value that is found in 80 %, over another setting, with its interval."""
    figure = Figure((5.2, 3.6), layout="constrained")
    ax = figure.subplots()
    places = [t.at for line in lines.values() for t in line]
    beside = 0.012 * (max(places) - min(places))
    for k, (label, line) in enumerate(lines.items()):
        apart = (k - (len(lines) - 1) / 2) * beside  # so that intervals do not hide others
        colour = SERIES[k % len(SERIES)]
        found = [(t.at + apart, t.value, t) for t in line if t.value is not None]
        ax.plot([x for x, _, _ in found], [y for _, y, _ in found], "o-", ms=4, color=colour,
                label=literal(label))  # fmt: skip
        for x, value, t in found:
            ends = (value if t.low is None else t.low, t.high or t.largest)
            ax.plot([x, x], ends, color=colour, lw=1, alpha=0.6)
        never = [t for t in line if t.value is None]
        ax.plot([t.at + apart for t in never], [t.largest for t in never], "^", ms=6, mfc="none",
                color=colour)  # fmt: skip
    far_apart = _scale(ax, places)
    positive = min(t.largest for line in lines.values() for t in line) > 0
    if positive:
        ax.set_yscale("log")
    found_in = f"smallest {against} found in {IN_WORDS}"
    ax.set(xlabel=literal(axis + LOGARITHMIC * far_apart),
           ylabel=literal(found_in + LOGARITHMIC * positive))  # fmt: skip
    if len(lines) > 1:
        ax.legend(fontsize=8)
    return figure


def confusion_figure(confusion: Mapping[str, Mapping[str, int]]) -> Figure:
    """Counts of answers by what is true, one row for each truth."""
    true = list(confusion)
    said = sorted({name for row in confusion.values() for name in row})
    said = [*(name for name in true if name in said), *(n for n in said if n not in true)]
    counts = np.array([[confusion[t].get(s, 0) for s in said] for t in true])
    with matplotlib.rc_context({**STYLE, "axes.grid": False}):
        size = (3.4 + 0.32 * len(said), 2.2 + 0.26 * len(true))
        figure = Figure(size, layout="constrained")
        ax = figure.subplots()
        shares = counts / counts.sum(axis=1, keepdims=True)
        ax.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
        for i, j in zip(*np.nonzero(counts), strict=True):
            colour = "white" if shares[i, j] > 0.6 else INK
            ax.text(j, i, str(counts[i, j]), ha="center", va="center", color=colour, fontsize=8)
        ax.set_xticks(range(len(said)), [literal(s.replace("_", " ")) for s in said], rotation=90)
        ax.set_yticks(range(len(true)), [literal(t.replace("_", " ")) for t in true])
        ax.set(xlabel="answer", ylabel="truth")
    return figure


@styled
def reliability_figure(pairs: Sequence[tuple[float, bool]]) -> Figure:
    """Draws the share of right names over confidence, with Wilson's 95 % intervals and counts."""
    figure = Figure((4.4, 3.9), layout="constrained")
    ax = figure.subplots()
    ax.plot([0, 1], [0, 1], color=GREY, lw=1, ls="--", label="calibrated")
    claimed = np.array([p for p, _ in pairs])
    hit = np.array([r for _, r in pairs], bool)
    at = np.clip(np.digitize(claimed, EDGES) - 1, 0, len(EDGES) - 2)
    for k in np.unique(at):
        mine = at == k
        seen = wilson(int(hit[mine].sum()), int(mine.sum()))
        x, share = claimed[mine].mean(), hit[mine].mean()
        ax.plot([x, x], [seen["low"], seen["high"]], color=MEASURED, lw=2)
        ax.plot(x, share, "o", color=MEASURED)
        ax.annotate(f"{mine.sum()}", (x, share), (5, -12), textcoords="offset points",
                    color=INK)  # fmt: skip
    ax.set(xlim=(0, 1.02), ylim=(-0.04, 1.04), xlabel="confidence", ylabel="share that is right")
    ax.legend(loc="upper left")
    return figure


def _scale(ax: Any, values: Sequence[float]) -> bool:
    """Makes an axis logarithmic where values are positive and far apart; a tick at each of a few.

    Returns whether it is logarithmic, which its label must say.
    """
    different = sorted(set(values))
    far_apart = different[0] > 0 and different[-1] > WIDE_RANGE * different[0]
    if far_apart:
        ax.set_xscale("log")
    if len(different) <= 12:
        ax.set_xticks(different, [f"{x:g}" for x in different])
        ax.set_xticks([], minor=True)
    return far_apart
