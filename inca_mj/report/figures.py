"""Figures of runs and cross-checks, with units on every axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from identification.report.style import GREY, INK, SERIES, STYLE
from inca_mj.twin.run import Run

_MARKERS = "osD^vPX*"
STRIP = 0.72  # height of a current's strip, of the distance between strips


def simulation_figures(run: Run) -> dict[str, Figure]:
    """Returns the currents, and the four figures of the thesis' Figure 2.16, by name.

    The caption of part (d) in the thesis repeats "angles of the motors", but its text speaks of
    roll, pitch and yaw; these are shown here.
    """
    drives = range(1, run.motor_angle.shape[1] + 1)
    series: dict[str, tuple[str, np.ndarray, list[str]]] = {
        "motor_angles": ("motor angle φ [rad]", run.motor_angle, [f"motor {k}" for k in drives]),
        "cable_tensions": ("cable tension T [N]", run.tension, [f"cable {k}" for k in drives]),
        "platform_position": ("platform position [m]", run.position, ["x", "y", "z"]),
        "platform_angles": ("platform angle [rad]", run.angles, ["roll", "pitch", "yaw"]),
    }
    drawn = {name: over_time(run.time, *what) for name, what in series.items()}
    return {"motor_currents": currents_figure(run.time, run.currents), **drawn}


def currents_figure(
    time: np.ndarray, currents: np.ndarray, size: tuple[float, float] = (6.4, 3.4)
) -> Figure:
    """Returns a figure of each motor's current in a strip of its own; all strips have one scale.

    Args:
        time: shape (N,) [s].
        currents: each holds until the next sample, shape (N, 8) [A].
        size: of the figure [inch].
    """
    low, high = float(currents.min()), float(currents.max())
    strips = np.arange(currents.shape[1])
    height = STRIP * (currents - low) / (high - low if high > low else 1.0)
    with matplotlib.rc_context(STYLE):
        figure = Figure(size, layout="constrained")
        ax = figure.subplots()
        for k in strips:
            ax.plot(time, height[:, k] - k, color=SERIES[k], drawstyle="steps-post")
        ax.set_yticks(-strips + STRIP / 2, [f"motor {k + 1}" for k in strips])
        ax.set(xlabel="time [s]", xlim=(time[0], time[-1]))
        ax.set_ylabel(f"currents, each strip from {low:g} to {high:g} [A]")
        ax.grid(visible=False, axis="y")
    return figure


def crosscheck_figure(rows: Sequence[Mapping[str, Any]], order: float | None) -> Figure:
    """Returns a figure of the largest difference of the two models over the step, with slope 4.

    Args:
        rows: one row for each case and step: `case`, `step` [s], `max_angle_error` [rad],
            `max_position_error` [m], `max_tension_error` [N].
        order: the observed order of convergence; None when it could not be observed.
    """
    cases = list(dict.fromkeys(str(row["case"]) for row in rows))
    with matplotlib.rc_context(STYLE):
        figure = Figure((9.5, 3.6), layout="constrained")
        for ax, (kind, unit) in zip(
            figure.subplots(1, 3),
            (("angle", "rad"), ("position", "m"), ("tension", "N")),
            strict=True,
        ):
            error = f"max_{kind}_error"
            for number, case in enumerate(cases):
                # An error of zero cannot stand on a logarithmic axis, so a gap is left.
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


def over_time(
    time: np.ndarray, label: str, values: np.ndarray, names: list[str],
    size: tuple[float, float] = (6.4, 3.4),
) -> Figure:  # fmt: skip
    """Returns a figure of curves over time.

    Args:
        time: shape (N,) [s].
        label: of the vertical axis, with its unit.
        values: shape (N, n).
        names: of the n curves.
        size: of the figure [inch].
    """
    with matplotlib.rc_context(STYLE):
        figure = Figure(size, layout="constrained")
        ax = figure.subplots()
        for k, name in enumerate(names):
            ax.plot(time, values[:, k], color=SERIES[k], ls="-" if k < 4 else "--", label=name)
        ax.set(xlabel="time [s]", ylabel=label, xlim=(time[0], time[-1]))
        figure.legend(loc="outside upper center", ncols=min(4, len(names)))
    return figure


def _slope(ax: Axes, rows: Sequence[Mapping[str, Any]], error: str) -> None:
    """Draws a dashed line with error ~ step⁴, just below the largest errors."""
    steps = np.array(sorted({row["step"] for row in rows}))
    largest = max((row[error] or 0.0 for row in rows if row["step"] == steps[-1]), default=0.0)
    if largest > 0:
        guide = 0.4 * largest * (steps / steps[-1]) ** 4
        ax.plot(steps, guide, color=GREY, ls="--", lw=1, label="slope 4")
