"""Figures of where a model fails over a horizon: over time, in the worst windows, and by force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from identification.quantities import held
from identification.report.horizon_gap import FailedWindow, NeededForce, RecordWindows
from identification.report.style import GREY, INK, MEASURED, SERIES, SIMULATED, literal, styled

SURE = 1.96  # std on each side of 95 %
WIDTH, PANEL = 7.0, 1.7  # [in] of a figure, and the height of a panel
FAR = 10.0  # errors that differ by more are drawn on a logarithmic axis


@styled
def windows_over_time(records: Sequence[RecordWindows], is_named: bool) -> Figure:
    """Returns a figure of the error of each window over time, one panel a record.

    Args:
        records: in the order of the panels.
        is_named: whether the final model has effects, so that both models are drawn.
    """
    columns = 2 if len(records) > 2 else 1
    rows = -(-len(records) // columns)
    figure = Figure((WIDTH, 0.6 + PANEL * rows), layout="constrained")
    panels = [*figure.subplots(rows, columns, squeeze=False).T.ravel()]
    for ax in panels[len(records) :]:
        ax.set_axis_off()
    panels = panels[: len(records)]
    every = np.concatenate([e for r in records for e in (r.before, r.after)])
    known = every[np.isfinite(every) & (every > 0)]
    is_far = bool(len(known)) and known.max() > FAR * known.min()
    for ax, r in zip(panels, records, strict=True):
        label, colour = "nominal model, fitted", SIMULATED
        if is_named:
            ax.plot(r.time, r.before, ".", ms=4, color=colour, label=label)
            label, colour = "with what was missing", MEASURED
        ax.plot(r.time, r.after, ".", ms=4, color=colour, label=label)
        ax.axhline(1.0, color=INK, ls="--", lw=1, label="noise of the sensors")
        ax.set_title(literal(f"{r.name} ({r.role})"), loc="left", color=INK)
        if is_far:
            ax.set_yscale("log")
            ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
            ax.yaxis.set_minor_formatter(NullFormatter())
        else:
            ax.set_ylim(bottom=0.0)
    figure.supylabel("error of a window, times the noise", fontsize=9, color=INK)
    for ax in {panels[rows - 1], panels[-1]}:  # the lowest of each column
        ax.set_xlabel("begin of the window [s]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


@styled
def worst_windows(windows: Sequence[FailedWindow]) -> Figure:
    """Returns a figure of measured and predicted motion in some windows, a panel each."""
    figure, axes = _panels(len(windows))
    for ax, w in zip(axes, windows, strict=True):
        ax.plot(w.time, w.measured, ".", ms=3, color=MEASURED, label="measured")
        ax.plot(w.time, w.predicted, color=SIMULATED, lw=1.2, label="predicted by the final model")
        ax.set_title(
            literal(f"{w.record}: {w.output}, {held(w.ratio)} × noise"), loc="left", color=INK
        )
        ax.set_ylabel(literal(f"[{w.unit}]") if w.unit else "")
        ax.set_xlabel("time [s]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


@styled
def needed_forces(forces: Sequence[NeededForce]) -> Figure:
    """Returns a figure of the force that each joint would need, over what it follows."""
    figure, axes = _panels(len(forces))
    for ax, needed in zip(axes, forces, strict=True):
        _draw(ax, needed)
    return figure


def _panels(count: int) -> tuple[Figure, list[Axes]]:
    """Returns a figure with so many panels, in up to two columns."""
    rows = -(-count // 2)
    figure = Figure((WIDTH, 0.6 + 2.1 * rows), layout="constrained")
    axes = [*figure.subplots(rows, min(2, count), squeeze=False).ravel()]
    for ax in axes[count:]:
        ax.set_axis_off()
    return figure, axes[:count]


def _draw(ax: Axes, needed: NeededForce) -> None:
    at, order = needed.nodes.at, np.argsort(needed.nodes.at)
    told = order[needed.known[order]]
    ax.plot(at[told], needed.force[told], color=SERIES[0], lw=1.0)
    ax.errorbar(at[told], needed.force[told], SURE * needed.std[told], color=INK, fmt="o", ms=3.5,
                lw=1, capsize=2)  # fmt: skip
    ax.axhline(0, color=GREY, lw=0.6)
    ax.set_title(literal(f"joint {needed.nodes.joint}"), loc="left", color=INK)
    ax.set_xlabel(literal(f"{needed.nodes.reads} [{needed.nodes.unit}]"))
    ax.set_ylabel(literal(f"force [{needed.unit}]"))
