"""Sections and figures of the report on the next experiment."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from identification.experiment.design import Design
from identification.model.parameter import ParameterSet
from identification.report.experiment_words import limit_unit, value_rows
from identification.report.page import Section, Table
from identification.report.style import GREY, SERIES, literal, styled

HEAD = ("value", "std now", "expected", "random experiment")


def experiment_sections(found: Design, at: ParameterSet) -> list[Section]:
    """Returns the sections: what is played, what it is expected to tell, and the limits."""
    margins = found.best.played.margins
    limits = tuple(
        (f"{m.limit.what} of {m.limit.name}", *(f"{x:z.4g}" for x in (m.limit.low, m.least,
         m.most, m.limit.high)), limit_unit(m, found), m.limit.source)
        for m in margins
    )  # fmt: skip
    return [
        Section("What is played", "The inputs, and the outputs that the model expects.",
                figures=(("The next experiment", motion_figure(found)),)),
        Section("What it tells", "Std of each free value, in its unit.",
                figures=(("Std before and after", std_figure(found)),),
                table=Table(HEAD, tuple(value_rows(found, at)))),
        Section("How near the limits are", "Least and most of the simulated experiment.",
                table=Table(("limit", "low", "least", "most", "high", "unit", "of"), limits)),
    ]  # fmt: skip


@styled
def motion_figure(found: Design) -> Figure:
    """Returns a figure of inputs and expected outputs against time."""
    log = found.best.played.log
    figure = Figure((7.5, 4.5), layout="constrained")
    axes = figure.subplots(2, sharex=True)
    for ax, columns, names in ((axes[0], log.outputs, log.output_names),
                               (axes[1], log.inputs, log.input_names)):  # fmt: skip
        for k, (column, name) in enumerate(zip(columns.T, names, strict=True)):
            unit = log.units.get(name, "")
            label = literal(f"{name} [{unit}]" if unit else name)
            ax.plot(log.time, column, color=SERIES[k % len(SERIES)], lw=1, label=label)
        ax.legend(fontsize=8, ncols=4, loc="lower left", bbox_to_anchor=(0, 1))
    axes[0].set_ylabel("expected")
    axes[1].set(ylabel="input", xlabel="time [s]")
    return figure


@styled
def std_figure(found: Design) -> Figure:
    """Returns a figure of the std of each free value after the experiment, over that before it."""
    names, n = found.hypotheses[0].names, len(found.before)
    figure = Figure((7.5, 1.2 + 0.35 * n), layout="constrained")
    ax, at = figure.subplots(), np.arange(n)
    for k, (label, std) in enumerate((("designed", found.best.std), ("random", found.random.std))):
        ax.barh(at + 0.2 - 0.4 * k, 100 * std / found.before, 0.38, label=label,
                color=SERIES[k])  # fmt: skip
    ax.axvline(100, color=GREY, lw=0.8)
    ax.set_yticks(at, [literal(name) for name in names])
    ax.set(xlabel="expected std, in per cent of that before")
    ax.legend(fontsize=8)
    return figure
