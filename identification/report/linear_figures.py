"""Figures of linear systems: their eigenvalues, and what outputs answer to inputs."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.linear.modes import modes
from identification.linear.system import LinearSystem
from identification.report.style import GREY, INK, SERIES, STYLE, literal

POINTS = 200  # of a frequency response
BEYOND = 10.0  # factor by which it reaches beyond the slowest and the fastest mode
WIDEST = 1e8  # ratio of its highest frequency to its lowest


def eigenvalue_figure(systems: Sequence[LinearSystem], labels: Sequence[str]) -> Figure:
    """Frequency and damping ratio of the modes that decay, one colour per system.

    Args:
        systems: continuous.
        labels: what each is called.
    """
    with matplotlib.rc_context(STYLE):
        figure = Figure((7.5, 3.4), layout="constrained")
        axis = figure.subplots()
        for k, (system, label) in enumerate(zip(systems, labels, strict=True)):
            moving = [m for m in modes(system) if m.damping is not None]
            axis.semilogx(
                [m.frequency for m in moving], [m.damping for m in moving], "o", ms=5, alpha=0.7,
                color=SERIES[k % len(SERIES)], label=literal(label),
            )  # fmt: skip
        axis.set(xlabel="|λ|/2π [Hz]", ylabel="damping ratio")
        axis.axhline(0, color=GREY, lw=0.8)
        if len(systems) > 1:
            axis.legend(fontsize=8)
    return figure


def response_figure(system: LinearSystem, discrete: LinearSystem | None = None) -> Figure:
    """Gains of the outputs from the inputs with the same number, over frequency.

    Args:
        system: continuous.
        discrete: the same for inputs that are held, shown up to half its rate.
    """
    rates = [m.frequency for m in modes(system) if m.frequency > 0] or [1.0]
    top = max(rates) * BEYOND
    f = np.geomspace(max(min(rates) / BEYOND, top / WIDEST), top, POINTS)
    pairs = min(len(system.inputs), len(system.outputs), len(SERIES))
    with matplotlib.rc_context(STYLE):
        figure = Figure((7.5, 3.4), layout="constrained")
        axis = figure.subplots()
        for of, style in ((system, "-"), (discrete, "--")):
            if of is None:
                continue
            at = f if of.sampling_time is None else f[f < 0.5 / of.sampling_time]
            gain = np.abs(of.response(at)) if len(at) else np.zeros((0, pairs, pairs))
            for k in range(pairs):
                name = f"{system.outputs[k]} / {system.inputs[k]}"
                label = literal(name) if style == "-" else None
                axis.loglog(at, gain[:, k, k], style, color=SERIES[k], lw=1, label=label)
        axis.set(xlabel="frequency [Hz]", ylabel="gain")
        title = "dashed: inputs held between samples" if discrete is not None else ""
        axis.set_title(title, loc="left", color=INK)
        axis.legend(fontsize=7)
    return figure
