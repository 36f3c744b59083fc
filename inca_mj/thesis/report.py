"""The report of `inca thesis`: every table and figure of chapters 2.4 and 3 by its number, once."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification import Log
from identification.estimation.fit import Fit
from identification.estimation.metrics import loss
from identification.report.page.figures import compare_figure
from identification.report.page.page import Section, Table
from inca_mj.report.figures import currents_figure, over_time, simulation_figures
from inca_mj.report.identification import identification_json
from inca_mj.robot.parameters import parameter_set
from inca_mj.thesis.prints import FITS, LOST, TABLES
from inca_mj.thesis.results import ThesisResults
from inca_mj.thesis.tables import (
    fits_table,
    model_table,
    parameter_table,
    step_table,
    trial_table,
)
from inca_mj.thesis.trials import TrialResult

PARTS = {
    "motor_angles": "a: angles of the motors",
    "cable_tensions": "b: tensions of the cables",
    "platform_position": "c: position of the moving platform",
    "platform_angles": "d: roll, pitch and yaw of the platform",
    "motor_currents": "input: the currents, which the thesis does not draw",
}
_FITTING = "The thesis' fitting of a parameter is 100 (1 − |estimate − true|/true)."
_WIDE = (9.0, 3.6)  # of a figure that has a row of its own [inch]
_NOT_HIS = (
    "The thesis' column is of the real robot, whose log was never published. The other columns are"
    " of a simulated robot, whose values are known."
)


def thesis_verdict(found: ThesisResults) -> list[str]:
    """Returns what the report means, in sentences."""
    rows = [
        f"{r.trial.number}: {r.trial.thesis_fit} % and {r.output_fit_percent.mean():.4f} %"
        for r in found.trials
    ]
    return [
        "Tables 2.1 and 3.1 to 3.8 and Figures 2.16 and 3.2 to 3.13 of the thesis, each by its"
        " number, with its printed numbers beside those computed here.",
        f"Mean output fit of the trials, thesis and here: {'; '.join(rows)}.",
        *LOST,
    ]


def thesis_sections(found: ThesisResults) -> list[Section]:
    """Returns the sections, in the order of the thesis."""
    twin = found.figure_2_16.twin
    return [
        Section(
            _table("2.1"),
            "The parameter set “simulation”. The moment of inertia is that of the rotor and the"
            " cable and leaves out the pulleys, says the thesis' footnote.",
            table=parameter_table("2.1", "simulation"),
        ),
        _figure_2_16(found),
        Section(
            _table("3.1"),
            "Here every parameter can be free, alike on all drives or for each drive.",
            table=model_table(twin),
        ),
        Section(
            _table("3.2"),
            "The parameter set “trial”, with which the data of the trials are simulated.",
            table=parameter_table("3.2", "trial"),
        ),
        *_data(found.data, "3.2", "3.3", "Simulated", "5 s of a 4 bit PRBS, 0.25 s a bit, between"
               " 0.5 and 1 A. The thesis logged the currents of its real motors under this"
               " reference; here the currents are the reference itself."),
        *(section for r in found.trials for section in _trial(r)),
        *_data(found.stand_in, "3.8", "3.9", "The simulated robot's", "The thesis shows 10 s of its"
               " real robot here, at 100 Hz. That log was never published; a simulated robot with"
               " Table 3.2 and noise of its encoders stands in for it."),
        *_steps(found),
    ]  # fmt: skip


def thesis_json(found: ThesisResults) -> dict[str, Any]:
    """Returns the printed numbers and ours as plain values."""
    return {
        "tables": {t.number: {"title": t.title, "columns": list(t.columns),
                              "rows": [list(row) for row in t.rows]} for t in TABLES.values()},
        "fits": {f.number: {"title": f.title, "fit_percent": list(f.fits), "mean": f.mean,
                            "loss": f.loss, "matlab_loss": f.matlab_loss} for f in FITS.values()},
        "trials": [result.to_json() for result in found.trials],
        "procedure": identification_json(found.procedure),
        "verdict": thesis_verdict(found),
    }  # fmt: skip


def _figure_2_16(found: ThesisResults) -> Section:
    run = found.figure_2_16
    drawn = simulation_figures(run)
    x, y, z = run.position[-1]
    return Section(
        "Figure 2.16: Outputs of simulation",
        "2 A in motor 1 and no current in the others, with Table 2.1. The caption of part d repeats"
        " \"angles of the motors\"; the text means roll, pitch and yaw.\n\nThe platform ends at"
        f" ({x:z.3f}, {y:z.3f}, {z:z.3f}) m, and the tensions lie between {run.tension.min():.2f}"
        f" and {run.tension.max():.2f} N. The thesis prints no number of this figure, and how long"
        " it is, is not known.",
        figures=tuple((f"2.16 {what}", drawn[name]) for name, what in PARTS.items()),
    )  # fmt: skip


def _data(log: Log, currents: str, angles: str, whose: str, text: str) -> list[Section]:
    drives = [f"motor {k}" for k in range(1, 9)]
    return [
        Section(
            f"Figure {currents}: {whose} input signals: currents of motors",
            text,
            figures=(
                (f"{currents}: currents of the motors",
                 currents_figure(log.time, log.inputs, _WIDE)),
            ),
        ),
        Section(
            f"Figure {angles}: {whose} output signals: angles of motors",
            "A positive angle winds the cable in.",
            figures=(
                (f"{angles}: angles of the motors",
                 over_time(log.time, "motor angle φ [rad]", log.outputs, drives, _WIDE)),
            ),
        ),
    ]  # fmt: skip


def _trial(result: TrialResult) -> list[Section]:
    n, fit = result.trial.number, result.fit
    table, figure = f"3.{n + 2}", f"3.{n + 3}"
    log = fit.estimate.predictor.log
    noisy = " The fits are to the data without their noise." if result.trial.noisy else ""
    return [
        Section(
            _table(table),
            _FITTING + _products(fit),
            table=trial_table(table, result),
        ),
        _fits(
            figure, result.output_fit_percent, result.loss,
            f"Part b, as in the thesis, is the angle of motor 2.{noisy}",
            (f"{figure} b: data and estimated model of trial {n}",
             _motor_2(log, log.outputs - fit.residual, result.output_fit_percent)),
        ),
    ]  # fmt: skip


def _steps(found: ThesisResults) -> list[Section]:
    out: list[Section] = []
    true = parameter_set("trial").values()
    for k, fit in enumerate(found.procedure.fits):
        table, estimation, validation = (("3.7", "3.10", "3.11"), ("3.8", "3.12", "3.13"))[k]
        whole, log = found.validation(fit), fit.estimate.predictor.log
        out += [
            Section(_table(table), f"{_NOT_HIS}\n\n{_FREE[k]}{_products(fit)}",
                    table=step_table(table, fit, true)),
            _fits(
                estimation, fit.fit_percent, fit.loss, "The first half, from 0 to 5 s.",
                (f"{estimation} b: estimation of step {k + 1}",
                 _motor_2(log, log.outputs - fit.residual, fit.fit_percent)),
            ),
            _fits(
                validation, whole.fit_percent, loss(whole.log.outputs - whole.run.motor_angle),
                "The whole log, from 0 to 10 s, as in the thesis; its second half is unseen.",
                (f"{validation} b: validation of step {k + 1}",
                 _motor_2(whole.log, whole.run.motor_angle, whole.fit_percent)),
            ),
        ]  # fmt: skip
    return out


_FREE = (
    "Step 1 frees all parameters and the start position and begins at the table's initial values.",
    "Step 2 frees R, λ, J, b_v, b_c, β, K_t and m and holds the rest. The text of the section says"
    " that what a data sheet or a measurement gives is fixed; the table frees R, λ, K_t and m all"
    " the same, and the table is followed here.",
)


def _products(fit: Fit) -> str:
    """Returns a sentence for each product of parameters whose factors the log does not tell."""
    return "".join(
        f" Only {c} can be known from the log, and not its factors." for c, _, _ in fit.combinations
    )


def _motor_2(log: Log, model: np.ndarray, fit: np.ndarray) -> Figure:
    """Returns the angle of motor 2, which the thesis draws: data, model and their difference."""
    return compare_figure(
        log.time, log.outputs[:, 1:2], model[:, 1:2], fit[1:2], ("angle of motor 2",), "rad",
        labels=("data", "estimated model"),
    )  # fmt: skip


def _fits(
    number: str, fit: np.ndarray, value: float, text: str, figure: tuple[str, Any]
) -> Section:
    table: Table = fits_table(number, fit, value)
    return Section(f"Figure {number}: {FITS[number].title}", text, figures=(figure,), table=table)


def _table(number: str) -> str:
    return f"Table {number}: {TABLES[number].title}"
