"""Measured over simulated outputs."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.style import INK, SERIES, SIMULATED, STYLE, literal


def compare_figure(
    time: np.ndarray,
    measured: np.ndarray,
    simulated: np.ndarray,
    fit_percent: np.ndarray,
    names: Sequence[str],
    unit: str = "rad",
    labels: tuple[str, str] = ("measured", "simulated"),
) -> Figure:
    """Returns a figure of measured and simulated outputs, with fits, and the residuals below.

    Args:
        time: shape (N,) [s].
        measured: shape (N, ny) [unit].
        simulated: shape (N, ny) [unit].
        fit_percent: of each output, shape (ny,) [%]; NaN where the output never moves.
        names: of the outputs, ny of them.
        unit: of the outputs.
        labels: what the two are called.
    """
    channels = len(names)
    columns = min(2, channels)
    rows = -(-channels // columns)
    with matplotlib.rc_context(STYLE):
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
            upper.plot(time, measured[:, k], color=INK, lw=2.2, alpha=0.45, label=labels[0])
            upper.plot(time, simulated[:, k], color=SIMULATED, lw=1.1, label=labels[1])
            fit = f"{fit_percent[k]:z.2f} %" if np.isfinite(fit_percent[k]) else "none: constant"
            upper.set_title(literal(f"{names[k]}   fit {fit}"), loc="left", color=INK)
            upper.set_ylabel(literal(f"[{unit}]"))
            lower.plot(time, measured[:, k] - simulated[:, k], color=SERIES[0], lw=0.8)
            lower.set_ylabel(literal(f"residual\n[{unit}]"), fontsize=7)
            lower.tick_params(labelsize=7)
            lower.locator_params(axis="y", nbins=3)
            lower.set_xlim(time[0], time[-1])
        for lower in axes[-1]:
            lower.set_xlabel("time [s]")
        figure.legend(*panels[0][0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
    return figure
