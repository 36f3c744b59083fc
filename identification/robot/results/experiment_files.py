"""The files of the next experiment: its CSV, result.json and the report."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification.experiment.design import Design
from identification.logs.formats.csv_files import write_log
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from identification.model.predictor import output_columns
from identification.report.experiment_words import (
    FILE,
    experiment_to_json,
    experiment_verdict,
    limit_unit,
    value_rows,
)
from identification.report.page.page import Section, Table, write_report
from identification.report.page.page_files import PageFiles
from identification.report.page.style import GREY, SERIES, literal, styled
from identification.robot.results.results import NextExperiment

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


PLAYED = "Designed, not measured: inputs to play."
FOLLOWED = "Designed, not measured: positions to follow, and the inputs that the model expects."


@dataclass(frozen=True)
class ExperimentFiles(PageFiles):
    """The files of the next experiment."""

    of: NextExperiment  # the result

    @cached_property
    def record(self) -> dict[str, Any]:
        """The experiment as plain values."""
        return experiment_to_json(self.of.found, self.of.robot.plant.parameters)

    @cached_property
    def sections(self) -> list[Section]:
        """The sections of the report, whose figures are drawn once."""
        return experiment_sections(self.of.found, self.of.robot.plant.parameters)

    def keep(self, folder: Path, place: Path) -> dict[str, Any]:
        """Write the CSV."""
        write_log(played_log(self.of), folder / FILE, digits=9)
        return {}

    def write_page(self, path: Path) -> Path:
        """Write the report; returns its path."""
        robot = self.of.robot
        names = [log.name for log in (robot.log, *robot.others, *robot.records)]
        verdict = experiment_verdict(self.of.found, robot.plant.parameters)
        return write_report(path, "The next experiment", verdict, self.sections, data=names)


def played_log(of: NextExperiment) -> Log:
    """Returns what the CSV holds, in the columns of the robot's log.

    These are time and inputs and, where a motion is to be followed, the positions of its joints.
    Outputs that the model expects are left out: nobody shall take them for measured ones.
    """
    played, robot, stage = of.found.best.played, of.robot, of.found.stage
    log, columns = played.log, robot.file.columns
    data = {name: log.inputs[:, k] for k, name in enumerate(log.input_names)}
    followed = []
    if played.aim is not None:
        joints = [d.qpos for d in stage.drives if d is not None]
        for name, (field, i) in zip(log.output_names,
                                    output_columns(stage.model, log.output_names),
                                    strict=True):  # fmt: skip
            if field == "qpos" and i in joints:
                data[name] = played.aim[0][:, joints.index(i)]
                followed.append(name)
    factors, zeros = robot.log.factors, robot.log.zeros
    data = {n: (x + zeros.get(n, 0.0)) / factors.get(columns.get(n, n), factors.get(n, 1.0))
            for n, x in data.items()}  # fmt: skip
    outputs = [data[n] for n in followed]
    return replace(
        log,
        inputs=np.column_stack([data[n] for n in log.input_names]),
        outputs=np.column_stack(outputs) if outputs else np.zeros((len(log), 0)),
        input_names=tuple(columns.get(n, n) for n in log.input_names),
        output_names=tuple(columns.get(n, n) for n in followed),
        units={columns.get(n, n): u for n, u in log.units.items() if n in data},
        notes=FOLLOWED if followed else PLAYED,
        values={},
    )
