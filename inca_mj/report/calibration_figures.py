"""Figures of a calibration: points that moved, and drives that differ."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.parameter_words import describe_parameter
from identification.report.style import GREY, INK, MEASURED, SERIES, SIMULATED, STYLE, literal
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES
from inca_mj.workflows.calibration import Calibration

VIEWS = ((0, 1), (0, 2), (1, 2))  # axes of the three views
LARGE = 0.12  # length of the longest arrow, as a share of the frame


def points_figure(found: Calibration, point: str = "exit") -> Figure:
    """Returns a figure of the points in three views, with enlarged arrows from nominal places.

    Args:
        found: the calibration.
        point: "exit" or "connector".
    """
    new = found.robot.geometry.A if point == "exit" else found.robot.geometry.B
    move = _grid(found.values, point)
    old, std = new - move, _grid(found.std, point)
    size = float(np.ptp(old, axis=0).max())
    times = LARGE * size / max(float(np.abs(move).max()), 1e-9)
    with matplotlib.rc_context(STYLE):
        figure = Figure((9.5, 3.6), layout="constrained")
        for ax, (i, j) in zip(figure.subplots(1, 3), VIEWS, strict=True):
            ax.plot(old[:, i], old[:, j], "o", color=GREY, ms=4)
            tips = old + times * move
            for k in range(DRIVES):
                arrow = {"arrowstyle": "->", "color": SIMULATED}
                ax.annotate("", tips[k, [i, j]], old[k, [i, j]], arrowprops=arrow)
                ax.errorbar(
                    tips[k, i], tips[k, j], times * std[k, j], times * std[k, i],
                    color=MEASURED, lw=0.8,
                )  # fmt: skip
                ax.annotate(str(k + 1), old[k, [i, j]], xytext=(4, 4), color=INK, fontsize=7,
                            textcoords="offset points")  # fmt: skip
            ax.set(xlabel=f"{AXES[i]} [m]", ylabel=f"{AXES[j]} [m]", aspect="equal")
            ax.margins(0.2)
        figure.suptitle(
            f"{point} points: arrows show {times:.3g} times the displacement, bars its std",
            color=INK, fontsize=10,
        )  # fmt: skip
    return figure


def drives_figure(found: Calibration) -> Figure:
    """Returns a figure of each drive's deviation from the common value, with its std."""
    names, k = [*found.spread.drives], np.arange(1, DRIVES + 1)
    parameters = found.robot.parameters
    columns = min(5, len(names))
    rows = -(-len(names) // columns)
    with matplotlib.rc_context(STYLE):
        figure = Figure((9.5, 2.0 * rows), layout="constrained")
        panels = np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).ravel()
        for ax, name in zip(panels, names, strict=False):
            own = 100 * np.array([found.values[f"{name}@{i}"] for i in k])
            std = 100 * np.array([found.std[f"{name}@{i}"] for i in k])
            ax.errorbar(k, own, std, fmt="o", color=SERIES[0], ms=4, lw=1)
            ax.axhline(0, color=GREY, lw=0.8)
            what = literal(describe_parameter(parameters[name]))
            ax.set_title(f"{what} [%]", loc="left", color=INK, fontsize=8)
            ax.set_xticks(k)
        for ax in panels[len(names) :]:
            ax.set_axis_off()
        figure.supxlabel("drive", fontsize=9)
    return figure


def _grid(values: dict[str, float], point: str) -> np.ndarray:
    """Returns numbers of points by drive and axis, shape (8, 3)."""
    every = range(1, DRIVES + 1)
    return np.array([[values[f"{point}_{axis}@{k}"] for axis in AXES] for k in every])
