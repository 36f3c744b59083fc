"""Figures of linear systems: their eigenvalues, and what outputs answer to inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.linear.modes import modes
from identification.linear.system import LinearSystem
from identification.quantities import per
from identification.report.style import GREY, INK, SERIES, STYLE, literal

POINTS = 200  # of a frequency response
BEYOND = 10.0  # factor by which it reaches beyond the slowest and the fastest mode
WIDEST = 1e8  # ratio of its highest frequency to its lowest


def eigenvalue_figure(systems: Sequence[LinearSystem], labels: Sequence[str]) -> Figure:
    """Returns a figure of frequency and damping ratio of decaying modes, one colour per system.

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


def response_figure(
    system: LinearSystem,
    discrete: LinearSystem | None = None,
    units: Mapping[str, str] | None = None,
) -> Figure:
    """Returns a figure of the responses of outputs to inputs of the same number, over frequency.

    Args:
        system: continuous.
        discrete: the same for inputs that are held, shown up to half its rate.
        units: of inputs and outputs by name, as far as they are known.
    """
    rates = [m.frequency for m in modes(system) if m.frequency > 0] or [1.0]
    top = max(rates) * BEYOND
    f = np.geomspace(max(min(rates) / BEYOND, top / WIDEST), top, POINTS)
    pairs = list(zip(system.outputs, system.inputs, SERIES, strict=False))
    with matplotlib.rc_context(STYLE):
        figure = Figure((7.5, 5.4), layout="constrained")
        magnitude, phase = figure.subplots(2, 1, sharex=True)
        for of, style in ((system, "-"), (discrete, "--")):
            at = f if of is None or of.sampling_time is None else f[f < 0.5 / of.sampling_time]
            if of is None or not len(at):
                continue
            G = of.response(at)
            for k, (output, driven, color) in enumerate(pairs):
                label = literal(f"{output} / {driven}") if style == "-" else None
                magnitude.loglog(at, np.abs(G[:, k, k]), style, color=color, lw=1, label=label)
                turned = np.degrees(np.unwrap(np.angle(G[:, k, k])))
                phase.semilogx(at, turned, style, color=color, lw=1)
        magnitude.set_ylabel(literal(f"magnitude [{_unit_of(pairs, units or {})}]"))
        phase.set(xlabel="frequency [Hz]", ylabel="phase [°]")
        title = "dashed: inputs held between samples" if discrete is not None else ""
        magnitude.set_title(title, loc="left", color=INK)
        figure.legend(loc="outside lower center", ncols=4, fontsize=7)
    return figure


def _unit_of(pairs: Sequence[tuple[str, str, str]], units: Mapping[str, str]) -> str:
    """Returns the unit that all pairs of output and input share, else what it is made of."""
    told = {(units.get(output, ""), units.get(driven, "")) for output, driven, _ in pairs}
    over, under = told.pop() if len(told) == 1 else ("", "")
    if not (over and under):
        return "unit of the output / unit of the input"
    return per(over, under)
