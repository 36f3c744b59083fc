"""Figures of runs, comparisons and cross-checks, with units on every axis."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from identification.files import whole_file
from inca_mj.colours import GREY, INK, SERIES, SIMULATED
from inca_mj.run import Run

_MARKERS = "osD^vPX*"
_STYLE: Any = {
    "font.size": 9,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.titlesize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E4E7EB",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "svg.hashsalt": "inca_mj",  # the same figure gives the same bytes
}


def simulation_figures(run: Run) -> dict[str, Figure]:
    """The four figures of the thesis' Figure 2.16, by name.

    The thesis' caption of its part (d) repeats "angles of the motors"; its text speaks of roll,
    pitch and yaw, and so does this.
    """
    drives = range(1, run.motor_angle.shape[1] + 1)
    series: dict[str, tuple[str, np.ndarray, list[str]]] = {
        "motor_angles": ("motor angle φ [rad]", run.motor_angle, [f"motor {k}" for k in drives]),
        "cable_tensions": ("cable tension T [N]", run.tension, [f"cable {k}" for k in drives]),
        "platform_position": ("platform position [m]", run.position, ["x", "y", "z"]),
        "platform_angles": ("platform angle [rad]", run.angles, ["roll", "pitch", "yaw"]),
    }
    return {name: _over_time(run.time, *what) for name, what in series.items()}


def compare_figure(
    time: np.ndarray,
    measured: np.ndarray,
    simulated: np.ndarray,
    fit_percent: np.ndarray,
    names: Sequence[str],
    unit: str = "rad",
) -> Figure:
    """Measured and simulated outputs, one panel each with its fit, and the residual below it.

    Args:
        time: shape (N,) [s].
        measured: shape (N, ny) [unit].
        simulated: shape (N, ny) [unit].
        fit_percent: of each output, shape (ny,) [%]; NaN where the output never moves.
        names: of the outputs, ny of them.
        unit: of the outputs.
    """
    channels = len(names)
    columns = min(2, channels)
    rows = -(-channels // columns)
    with matplotlib.rc_context(_STYLE):
        figure = Figure((9.0, 0.6 + 1.75 * rows), layout="constrained")
        axes = figure.subplots(
            2 * rows, columns, sharex=True, squeeze=False, height_ratios=[3, 1] * rows
        )
        panels = [
            (axes[2 * row, column], axes[2 * row + 1, column])
            for column in range(columns)
            for row in range(rows)
        ]
        for k, (upper, lower) in enumerate(panels):
            if k >= channels:
                upper.set_axis_off()
                lower.set_axis_off()
                continue
            upper.plot(time, measured[:, k], color=INK, lw=2.2, alpha=0.45, label="measured")
            upper.plot(time, simulated[:, k], color=SIMULATED, lw=1.1, label="simulated")
            fit = f"{fit_percent[k]:.2f} %" if np.isfinite(fit_percent[k]) else "none: constant"
            upper.set_title(f"{names[k]}   fit {fit}", loc="left", color=INK)
            upper.set_ylabel(f"[{unit}]")
            lower.plot(time, measured[:, k] - simulated[:, k], color=SERIES[0], lw=0.8)
            lower.set_ylabel(f"residual\n[{unit}]", fontsize=7)
            lower.tick_params(labelsize=7)
            lower.locator_params(axis="y", nbins=3)
            lower.set_xlim(time[0], time[-1])
        for lower in axes[-1]:
            lower.set_xlabel("time [s]")
        figure.legend(*panels[0][0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
    return figure


def crosscheck_figure(rows: Sequence[Mapping[str, Any]], order: float | None) -> Figure:
    """Largest difference of the two models over the step, with the slope of a 4th-order method.

    Args:
        rows: one of each case and step: `case`, `step` [s], `max_angle_error` [rad],
            `max_position_error` [m], `max_tension_error` [N].
        order: the order of convergence observed; None when it could not be.
    """
    cases = list(dict.fromkeys(str(row["case"]) for row in rows))
    with matplotlib.rc_context(_STYLE):
        figure = Figure((9.5, 3.6), layout="constrained")
        for ax, (kind, unit) in zip(
            figure.subplots(1, 3),
            (("angle", "rad"), ("position", "m"), ("tension", "N")),
            strict=True,
        ):
            error = f"max_{kind}_error"
            for number, case in enumerate(cases):
                # No error at all has no place on a logarithmic axis: a gap.
                points = sorted((r["step"], r[error] or np.nan) for r in rows
                                if str(r["case"]) == case)  # fmt: skip
                ax.plot(*zip(*points, strict=True), color=SERIES[number % len(SERIES)],
                        marker=_MARKERS[number % len(_MARKERS)], ms=4.5, label=case)  # fmt: skip
            _slope(ax, rows, error)
            ax.set(xscale="log", xlabel="step [ms]")
            if any(row[error] for row in rows):
                ax.set_yscale("log")
            steps = sorted({row["step"] for row in rows})
            ax.set_xticks(steps, [f"{1e3 * step:g}" for step in steps])
            ax.minorticks_off()
            ax.set_title(f"largest {kind} error [{unit}]", loc="left", color=INK)
        observed = "" if order is None else f": observed order {order:.2f}"
        figure.suptitle(f"twin against reference{observed}", color=INK, fontsize=10.5)
        handles, labels = ax.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=min(5, len(labels)))
    return figure


def save_png(figure: Figure, path: str | Path, dpi: float = 150) -> Path:
    """Write a figure as PNG, whole or not at all.

    Raises:
        InputError: the file cannot be written.
    """
    with whole_file(path) as draft, draft.open("wb") as stream:
        figure.savefig(stream, format="png", dpi=dpi)
    return Path(path)


def svg(figure: Figure) -> str:
    """A figure as an `<svg>` element that stands in HTML: no XML header, no foreign address."""
    stream = io.StringIO()
    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    with matplotlib.rc_context(_STYLE):
        figure.savefig(stream, format="svg", metadata=nothing)
    text = stream.getvalue()
    return re.sub(r"<metadata>.*?</metadata>\s*", "", text[text.index("<svg") :], flags=re.DOTALL)


def _over_time(time: np.ndarray, label: str, values: np.ndarray, names: list[str]) -> Figure:
    with matplotlib.rc_context(_STYLE):
        figure = Figure((6.4, 3.4), layout="constrained")
        ax = figure.subplots()
        for k, name in enumerate(names):
            ax.plot(time, values[:, k], color=SERIES[k], ls="-" if k < 4 else "--", label=name)
        ax.set(xlabel="time [s]", ylabel=label, xlim=(time[0], time[-1]))
        figure.legend(loc="outside upper center", ncols=min(4, len(names)))
    return figure


def _slope(ax: Axes, rows: Sequence[Mapping[str, Any]], error: str) -> None:
    """A dashed line error ~ step⁴ just below the largest errors."""
    steps = np.array(sorted({row["step"] for row in rows}))
    largest = max((row[error] or 0.0 for row in rows if row["step"] == steps[-1]), default=0.0)
    if largest > 0:
        guide = 0.4 * largest * (steps / steps[-1]) ** 4
        ax.plot(steps, guide, color=GREY, ls="--", lw=1, label="slope 4")
