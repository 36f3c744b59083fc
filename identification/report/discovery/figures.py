"""Figures of a discovery: the gap on unseen samples, where it is, and the scores of candidates."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from identification.discovery.free_run import FreeRun
from identification.discovery.result import Discovery, Scored
from identification.estimation.metrics import of_outputs
from identification.report.page.style import (
    GREY,
    INK,
    MEASURED,
    SIMULATED,
    literal,
    styled,
    time_panels,
)
from identification.report.words.effects import describe_there

if TYPE_CHECKING:
    from identification.report.page.page import Figures

BEFORE, AFTER = SIMULATED, MEASURED
BAND = "#C9CED6"
GAIN = "gain: twice the log likelihood that it adds, at once"
NARROW = 5.0  # [in] wide: such a figure fits a telephone
LINE, BAR, GAP = 0.19, 0.12, 0.10  # [in] of a label's line, of its bar, and between candidates
LETTERS = 62  # of a line of such a figure
FAR = 20.0  # a bar shorter than another by this factor needs a logarithmic axis


def gap_figures(found: Discovery, run: FreeRun) -> Figures:
    """Returns the figure of the errors on unseen data."""
    rows, after = run.unseen, run.after[run.unseen] if found.named else None
    figure = gap_figure(
        run.log.time[rows], run.before[rows], after, 2 * of_outputs(found.floor, run.log),
        [*found.outputs], [*found.outputs.values()],
    )  # fmt: skip
    return (("Error on unseen data, before and after", figure),)


def where_figures(found: Discovery, run: FreeRun) -> Figures:
    """Returns figures of the errors of each output, and of the forces that are missing."""
    before, after = (np.sqrt(np.mean(e[run.told] ** 2, axis=0)) for e in (run.before, run.after))
    noise, unit = of_outputs(found.floor, run.log), found.unit
    scale, level = np.ones(len(noise)), float(noise.max())
    if len({*found.outputs.values()}) > 1 and noise.min() > 0:  # unlike outputs have no one axis
        scale, level, unit = noise, 1.0, "times the noise"
    figure = rms_figure(
        before / scale, after / scale if found.named else None, level, [*found.outputs], unit
    )
    forces = (
        (f"Force on {m.where} that the nominal model lacks",
         force_figure(run.log.time[: len(m.force)], m.force, m.names, m.units))
        for m in found.missing_forces
    )  # fmt: skip
    return (("Error by output on unseen data", figure), *forces)


def score_figures(found: Discovery, best: Sequence[Scored], axis: str, caption: str) -> Figures:
    """Returns the figure of the best scores; that of a named effect is of the place of its name."""
    named = [n.candidate for n in found.named]
    # What the data cannot tell from a named effect is named with it.
    named += [r.candidate for n in found.named if n.one_of for r in n.rivals[:1]]
    places = {c.effect.name: c.where for c in reversed(named)}
    at = {s.candidate.key: s for s in reversed(found.scores)}  # the best score there
    names = [s.candidate.effect.name for s in best]
    there = [at.get((n, places.get(n, "")), s) for n, s in zip(names, best, strict=True)]
    shown = sorted(there, key=lambda s: -s.explains)
    figure = gains_figure(
        [describe_there(s.candidate, found.final.plant) for s in shown],
        np.array([s.explains for s in shown]),
        [s.candidate.effect.name in places for s in shown], axis,
    )  # fmt: skip
    return ((caption, figure),)


@styled
def gap_figure(
    time: np.ndarray,
    before: np.ndarray,
    after: np.ndarray | None,
    band: np.ndarray,
    names: Sequence[str],
    units: Sequence[str],
) -> Figure:
    """Returns a figure of the free run's errors, one panel an output, over the band of the noise.

    Times of the unseen samples have shape (N,) [s], and a gap in them is one in the lines. Errors
    of the fitted nominal model and, where effects are named, of that with them, have shape (N, ny),
    in the outputs' units; where these differ, each panel has an axis of its own. Half the band's
    width is two std of the noise of each output.
    """
    alike = len(set(units)) == 1
    step = float(np.median(np.diff(time)))
    cuts = np.flatnonzero(np.diff(time) > 1.5 * step) + 1
    shown = np.insert(time, cuts, np.nan)
    rows = -(-len(names) // 2)
    figure = Figure((7.0, 0.9 + 1.1 * rows), layout=ConstrainedLayoutEngine(wspace=0.05))
    panels = time_panels(figure, len(names), sharey=alike)
    for k, ax in enumerate(panels):
        ax.axhspan(-band[k], band[k], color=BAND, lw=0, label="noise, ± 2 std")
        for e, colour, label in ((before, BEFORE, "nominal model, fitted"),
                                 (after, AFTER, "with what was missing")):  # fmt: skip
            if e is not None:
                ax.plot(shown, np.insert(e[:, k], cuts, np.nan), color=colour, lw=0.9,
                        label=label)  # fmt: skip
        ax.set_title(literal(names[k]), loc="left", color=INK)
        ax.set_xlim(time[0], time[-1])
        if k < rows or not alike:
            ax.set_ylabel(literal(f"error [{units[k]}]") if units[k] else "error")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3
    )  # fmt: skip
    return figure


@styled
def force_figure(
    time: np.ndarray, force: np.ndarray, names: Sequence[str], units: Sequence[str]
) -> Figure:
    """Returns a figure of the forces (N, k) that a model lacks, one panel a degree of freedom."""
    figure = Figure((9.0, 0.4 + max(1.2 * -(-len(names) // 2), 1.8)), layout="constrained")
    for k, ax in enumerate(time_panels(figure, len(names))):
        alike = [u == units[k] for u in units]
        top = 1.05 * float(np.abs(force[:, alike]).max()) or 1.0
        unit, factor = ("mN m", 1e3) if units[k] == "N m" else (units[k], 1.0)
        ax.plot(time, factor * force[:, k], color=SIMULATED, lw=0.9)
        ax.axhline(0, color=GREY, lw=0.6)
        ax.set_ylim(-factor * top, factor * top)
        ax.set_title(literal(f"{names[k].replace('_', ' ')} [{unit}]"), loc="left", color=INK)
        ax.set_xlim(time[0], time[-1])
    return figure


@styled
def rms_figure(
    before: np.ndarray, after: np.ndarray | None, floor: float, names: Sequence[str], unit: str
) -> Figure:
    """Returns bars of each output's rms error before and after, with the noise as a line."""
    place = np.arange(len(names))
    bars = [(before, BEFORE, "nominal model, fitted")]
    if after is not None:
        bars.append((after, AFTER, "with what was missing"))
    width = 0.8 / len(bars)
    figure = Figure((min(max(NARROW, 1.0 + len(names)), 9.0), 3.2), layout="constrained")
    ax = figure.subplots()
    for k, (height, colour, label) in enumerate(bars):
        ax.bar(place + (k - (len(bars) - 1) / 2) * width, height, width, color=colour,
               label=label)  # fmt: skip
    if floor > 0:
        ax.axhline(floor, color=INK, ls="--", lw=1, label="noise")
    ax.set_xticks(place, [literal(name.replace("_", " ")) for name in names], fontsize=8)
    ax.grid(axis="x", visible=False)
    least = min(float(np.min(height)) for height, _, _ in bars)
    if 0 < FAR * least < float(np.max(before)):
        ax.set_yscale("log")
        ax.set_ylim(bottom=0.3 * (min(least, floor) if floor > 0 else least))
        ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    ax.set_ylabel(literal(f"rms of the error [{unit}]") if unit else "rms of the error")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


@styled
def gains_figure(
    labels: Sequence[str], gains: np.ndarray, named: Sequence[bool], what: str = GAIN
) -> Figure:
    """Returns a figure of bars of how much each candidate would explain, the best on top.

    Each label stands above its bar, so that the figure is narrow enough for a telephone. The axis
    is logarithmic where the bars of several candidates would vanish.
    """
    lines = [wrap(label, LETTERS) or [""] for label in labels]
    heights = np.array([LINE * len(each) + BAR + GAP for each in lines])  # of each with its bar
    top = np.concatenate([[0.0], np.cumsum(heights)])[:-1]
    place = top + heights - GAP - BAR / 2
    figure = Figure((NARROW, 0.9 + max(1.0, heights.sum())), layout="constrained")
    ax = figure.subplots()
    shown = np.maximum(np.asarray(gains, float), 0.0)
    colours = [AFTER if is_named else GREY for is_named in named]
    small = (shown > 0) & (FAR * shown < shown.max(initial=0.0))
    if small.sum() > 1:  # bars that would vanish
        ax.set_xscale("log")
        ax.set_xlim(0.5 * shown[shown > 0].min(), 1.5 * shown.max())
        ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    ax.barh(place, shown, BAR, color=colours)
    for y, each in zip(top, lines, strict=True):
        ax.text(0, y + GAP / 2, literal("\n".join(each)), transform=ax.get_yaxis_transform(),
                va="top", color=INK, linespacing=1.1, in_layout=False)  # fmt: skip
    ax.set_ylim(max(1.0, heights.sum()), 0)
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.grid(axis="y", visible=False)
    ax.set_xlabel(what)
    if any(named):
        handles = [matplotlib.patches.Patch(color=c) for c in (AFTER, GREY)]
        figure.legend(handles, ["named", "not named"], loc="outside upper center", ncols=2)
    return figure
