"""Sections of reports: a comparison, a run, a robot on a path, and a cross-check."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from identification.estimation.metrics import mean_fit
from identification.report.page.figures import compare_figure
from identification.report.page.page import Section, Table
from identification.shares import percent
from inca_mj.report.figures import crosscheck_figure, simulation_figures, tracking_figure

if TYPE_CHECKING:
    from inca_mj.twin.run import Run
    from inca_mj.verification.check import CrossCheck
    from inca_mj.workflows.comparison import Comparison
    from inca_mj.workflows.tracking import Tracking


def compare_verdict(result: Comparison) -> list[str]:
    """Returns what the comparison means, in sentences."""
    fit, error = result.fit_percent, 1e3 * float(result.rms.mean())
    cable = error * result.run.twin.parameters["R"].value
    lines = [f"The mean fit is {mean_fit(fit)}."]
    if not np.isnan(fit).all():
        worst = int(np.nanargmin(fit))
        lines = [
            f"The twin explains {percent(np.nanmean(fit) / 100, 3)} of the motor angles' motion"
            f" (mean fit); drive {worst + 1} is worst with {percent(fit[worst] / 100, 3)}."
        ]
    if still := [str(i + 1) for i in np.flatnonzero(np.isnan(fit))]:
        lines.append(f"No fit is said of drives that never move: {', '.join(still)}.")
    return [*lines, f"The difference is {error:.1f} mrad rms, {cable:.2f} mm of cable."]


def compare_section(result: Comparison) -> Section:
    """Returns the section on measured and simulated angles, as MATLAB's `compare` shows them."""
    log = result.log
    figure = compare_figure(
        log.time, log.outputs, result.run.motor_angle, result.fit_percent, log.output_names, "rad"
    )
    rows = zip(log.output_names, result.fit_percent, 1e3 * result.rms, strict=True)
    return Section(
        "Measured against simulated",
        f"{len(log)} samples of {log.sampling_time:g} s, simulated from the currents alone.\n\n"
        "Fit is 100 (1 − ‖ŷ − y‖/‖y − ȳ‖): 100 % is perfect, 0 % is as good as the mean."
        + (f"\n\nThe log says: {log.notes}" if log.notes else ""),
        figures=(("Measured and simulated motor angles", figure),),
        table=Table(
            ("output", "fit [%]", "rms [mrad]"),
            tuple(
                (name, "–" if np.isnan(fit) else float(fit), float(error))
                for name, fit, error in rows
            ),
        ),
    )


def run_section(run: Run) -> Section:
    """Returns the section on the currents, and the four pictures of the thesis' Figure 2.16."""
    return Section(
        "What the robot does",
        f"{len(run.time)} samples; the least tension is {run.tension.min():.2f} N, the largest"
        f" {run.tension.max():.2f} N.",
        figures=tuple(simulation_figures(run).items()),
    )


def tracking_section(result: Tracking) -> Section:
    """Returns what a report says of a robot that followed a path."""
    rows = (
        ("from the asked point, root mean square", 1e3 * result.rms),
        ("from the asked point, largest", 1e3 * result.largest),
        (
            "from the asked point, root mean square by the controller's estimate",
            1e3 * result.seen_rms,
        ),
        ("off the path (cross-track), root mean square", 1e3 * result.cross_track_rms),
    )
    return Section(
        "Asked and done",
        f"Distance of the platform from where it should be, from {result.counted:g} s on, when the"
        " path is at its full rate. The controller sees the motor angles and has a model.",
        figures=(("Path and error", tracking_figure({"this run": result})),),
        table=Table(("distance", "[mm]"), rows),
    )


def crosscheck_section(result: CrossCheck) -> Section:
    """Returns the section on two models of one robot that share no code."""
    keys = ("max_angle_error", "max_position_error", "max_tension_error")
    return Section(
        "Two independent models of one robot",
        "The thesis' 36-state ODE (body axes, Euler angles), integrated adaptively, against the"
        " MuJoCo twin at several steps. They share parameters and geometry and no line of physics.",
        figures=(("Error against step", crosscheck_figure(result.rows, result.order)),),
        table=Table(
            ("case", "step [ms]", "angle [rad]", "position [m]", "tension [N]"),
            tuple(
                (row["case"], 1e3 * row["step"], *(row[key] for key in keys)) for row in result.rows
            ),
        ),
    )
