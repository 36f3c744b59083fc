"""Measured over simulated outputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from identification.report.page.style import INK, SERIES, SIMULATED, literal, styled

if TYPE_CHECKING:
    from identification.estimation.profiles import Profile
    from identification.logs.log import Log
    from identification.model.predictor import Plant


@styled
def profile_figure(known: Profile, unit: str) -> Figure:
    """Returns a figure of the rise of the cost against one parameter, with the line of 95 %."""
    from identification.estimation.profiles import PROFILE_LEVEL  # slow to import

    figure = Figure((5.2, 3.2), layout="constrained")
    ax = figure.subplots()
    seen = np.isfinite(known.rise)
    ax.plot(known.values[seen], known.rise[seen], "o-", color=SERIES[0], label="profile")
    ax.axhline(PROFILE_LEVEL, color=SERIES[1], linestyle="--", label="95 %")
    ax.axvline(known.estimate, color=SERIES[2], linestyle=":", label="estimate")
    ax.set_xlabel(literal(f"{known.name} [{unit}]" if unit else known.name))
    ax.set_ylabel("rise of the cost, in s²")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


@styled
def windows_figure(
    plant: Plant, log: Log, length: float, models: Mapping[str, Mapping[str, float]]
) -> Figure:
    """Returns a figure of the first output, predicted from windows' best states, and the errors.

    Args:
        plant: the model.
        log: what was measured.
        length: of a window [s].
        models: values of parameters by what they are called in the legend.

    Raises:
        InputError: the windows do not fit the log, or a name is unknown.
        DivergenceError: a model cannot be simulated.
    """
    from identification.windows.window_error import window_error  # slow to import
    from identification.windows.windows import windows

    name = log.output_names[0]
    unit = log.units.get(name, "")
    errors = {label: window_error(plant, log, length, values)[..., 0]
              for label, values in models.items()}  # fmt: skip
    cut = windows(log, length)
    rows = cut.starts[:, None] + np.arange(cut.outputs.shape[1])
    t, y = log.time[rows], cut.outputs[..., 0]
    gap = np.full((len(rows), 1), np.nan)  # between windows
    figure = Figure((7.5, 4.5), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot(log.time, log.outputs[:, 0], color=INK, lw=2.2, alpha=0.45, label="measured")
    for k, (label, error) in enumerate(errors.items()):
        for axis, line in ((upper, y - error), (lower, error)):
            axis.plot(
                np.hstack([t, gap]).ravel(), np.hstack([line, gap]).ravel(),
                color=SERIES[k % len(SERIES)], lw=1, label=literal(label),
            )  # fmt: skip
    of = f"{log.name}: predicted" if log.name else "Predicted"
    upper.set(ylabel=literal(f"{name} [{unit}]"))
    upper.set_title(literal(f"{of} over {length:g} s"), loc="left", color=INK)
    lower.set(ylabel=literal(f"error [{unit}]"), xlabel="time [s]")
    handles = upper.get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper right", ncols=len(handles[0]), fontsize=8)
    return figure


@styled
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
