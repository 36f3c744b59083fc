"""Figures of the information that an experiment would give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.style import INK, SERIES, STYLE


def std_figure(names: Sequence[str], stds: Mapping[str, np.ndarray]) -> Figure:
    """Returns bars of the std of each parameter, one colour per experiment, on a logarithmic axis.

    Args:
        names: names of the p parameters.
        stds: std of q (relative where logarithmic) by experiment, each of shape (p,); an infinite
            std has no bar.
    """
    place = np.arange(len(names))
    width = 0.8 / max(1, len(stds))
    with matplotlib.rc_context(STYLE):
        figure = Figure((1.6 + 0.75 * max(4, len(names)), 3.4), layout="constrained")
        ax = figure.subplots()
        for k, (label, std) in enumerate(stds.items()):
            height = np.where(np.isfinite(std), std, np.nan)
            shift = (k - (len(stds) - 1) / 2) * width
            ax.bar(place + shift, height, width, color=SERIES[k % len(SERIES)], label=label)
        ax.set_yscale("log")
        ax.set_xticks(place, list(names), color=INK)
        ax.set_ylabel("least std, relative (poses [m], [rad])")
        figure.legend(loc="outside upper center", ncols=min(3, len(stds)))
    return figure
