"""A record, and what models predict of it over windows."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.logs.log import Log
from identification.model.predictor import Plant
from identification.report.style import INK, SERIES, STYLE, literal
from identification.windows.window_error import window_error
from identification.windows.windows import windows


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
    name = log.output_names[0]
    unit = log.units.get(name, "")
    errors = {label: window_error(plant, log, length, values)[..., 0]
              for label, values in models.items()}  # fmt: skip
    cut = windows(log, length)
    rows = cut.starts[:, None] + np.arange(cut.outputs.shape[1])
    t, y = log.time[rows], cut.outputs[..., 0]
    gap = np.full((len(rows), 1), np.nan)  # between windows
    with matplotlib.rc_context(STYLE):
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
        upper.legend(loc="upper left", fontsize=8)
    return figure
