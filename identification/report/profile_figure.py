"""Figures of a fit."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.estimation.profiles import PROFILE_LEVEL, Profile
from identification.report.style import SERIES, STYLE, literal


def profile_figure(known: Profile, unit: str) -> Figure:
    """Returns a figure of the rise of the cost against one parameter, with the line of 95 %."""
    with matplotlib.rc_context(STYLE):
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
