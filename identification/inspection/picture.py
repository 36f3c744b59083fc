"""A picture of a log: each of its columns over time, the inputs above the outputs."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from identification.inspection.inspected import Inspection
from identification.report.page.style import GREY, MEASURED, SIMULATED, literal, styled, time_panels

MOST = 24  # columns that are drawn
POINTS = 4000  # of each


@styled
def log_figure(found: Inspection) -> Figure:
    """Returns a figure of the columns of a log over time, with their guessed units."""
    order = {"input": 0, "output": 1, "": 2}
    columns = sorted(found.columns, key=lambda c: order[c.role])[:MOST]
    figure = Figure((9.0, 0.8 + 1.4 * -(-len(columns) // 2)), layout="constrained")
    colours = {"input": SIMULATED, "output": MEASURED, "": GREY}
    for ax, column in zip(time_panels(figure, len(columns)), columns, strict=True):
        values = found.values[column.name]
        rows = np.flatnonzero(np.isfinite(values))
        rows = rows[:: max(1, len(rows) // POINTS)]
        ax.plot(found.time[rows], values[rows], color=colours[column.role], lw=0.9)
        role = f" ({column.role}?)" if column.role else ""
        ax.set_title(literal(f"{column.name}{role}"), loc="left", fontsize=8)
        ax.set_ylabel(literal(f"[{column.unit}?]" if column.unit else ""))
    return figure
