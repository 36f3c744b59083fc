"""Sentences, tables and sections of a report on the robot's linear model and on its grid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from identification.linear.gridded import GriddedSystem
from identification.linear.modes import modes
from identification.report.linear_json import system_to_json
from identification.report.linear_sections import (
    linear_sections,
    slowest_and_fastest,
)
from identification.report.page import Section, Table
from inca_mj.linear.accuracy import InterpolationError, RunError
from inca_mj.linear.linearization import LinearModel
from inca_mj.report.linear_figures import (
    handle_modes,
    handle_motion,
    handle_share,
    shape_figure,
)
from inca_mj.twin.logs import UNITS

HANDLE_HEAD = ("frequency [Hz]", "damping", "the platform moves along", "share of the platform")


def model_to_json(model: LinearModel, rate: float) -> dict[str, Any]:
    """Returns a linear model of the robot as plain values.

    Args:
        model: of the robot.
        rate: of the samples of its discrete form [Hz].

    Raises:
        InputError: the rate is not above zero.
    """
    return {
        "time": model.time,
        "tension": model.tension.tolist(),
        "friction_slope": model.friction_slope.tolist(),
        **system_to_json(model.system, rate),
    }


def handle_rows(model: LinearModel) -> list[tuple[str, str, str, str]]:
    """Returns the platform's modes: frequency, damping, motion, and the platform's share."""
    arm = float(np.linalg.norm(model.robot.geometry.B, axis=1).max())
    return [
        (f"{m.frequency:.1f}", f"{m.damping:.3f}", handle_motion(m, arm), f"{handle_share(m):.2f}")
        for m in handle_modes(model)
    ]


def model_sentences(model: LinearModel, label: str) -> list[str]:
    """Returns what matters about a linear model, in sentences.

    Args:
        model: of the robot.
        label: what its operating point is called.
    """
    low, high = model.friction_slope.min(), model.friction_slope.max()
    slope = f"{low:.3g}" if high - low < 1e-3 * high else f"{low:.3g} to {high:.3g}"
    return [
        f"The robot {label}: currents {_range(model.system.u)} A, tensions"
        f" {_range(model.tension)} N.",
        slowest_and_fastest(modes(model.system)),
        f"The slope of the motors' friction there is {slope} N m s/rad; it is b_v + b_c β where a"
        " motor is at rest, and falls once it turns faster than 1/β.",
    ]


def model_sections(models: Sequence[LinearModel], labels: Sequence[str], rate: float) -> list:
    """Returns the sections on linear models of the robot.

    Args:
        models: at some operating points.
        labels: what these are called.
        rate: of the samples of the discrete form of the first one [Hz].
    """
    shapes = Section(
        f"The modes of the platform, {labels[0]}",
        "Grey: at rest. Blue and red: both ends of the swing, enlarged so that a connector moves by"
        " 3 cm; thin lines are the cables' first 10 cm.",
        table=Table(HANDLE_HEAD, tuple(handle_rows(models[0]))),
        figures=(("Shapes of the platform's modes", shape_figure(models[0])),),
    )
    systems = [m.system for m in models]
    names = (*systems[0].inputs, *systems[0].outputs)
    units = {name: UNITS[name.rstrip("_12345678")] for name in names}
    return [shapes, *linear_sections(systems, labels, rate, units)]


def grid_to_json(
    grid: GriddedSystem, errors: Sequence[InterpolationError], runs: Sequence[RunError]
) -> dict[str, Any]:
    """Returns a gridded model by its axes and its errors as plain values.

    Args:
        grid: the gridded model.
        errors: at points off the grid.
        runs: beside the twin.
    """
    return {
        "axes": {name: points.tolist() for name, points in grid.axes.items()},
        "method": grid.method,
        "errors": {
            key: max(getattr(e, key) for e in errors)
            for key in ("matrix", "response", "eigenvalue")
        },
        "runs": [
            {**vars(run), "scheduled": run.scheduled if np.isfinite(run.scheduled) else None}
            for run in runs
        ],
    }


def grid_sentences(
    errors: Sequence[InterpolationError], runs: Sequence[RunError]
) -> list[str]:  # fmt: skip
    """Returns how good a gridded model is, in sentences.

    Args:
        errors: at points off the grid.
        runs: beside the twin.
    """
    worst = {k: max(getattr(e, k) for e in errors) for k in ("matrix", "response", "eigenvalue")}
    said = [
        f"At {len(errors)} random points off the grid the interpolated model differs from the"
        f" twin's own linearisation by at most {worst['response']:.2g} of the transfer function,"
        f" {worst['matrix']:.2g} of A and {worst['eigenvalue']:.2g} of an eigenvalue."
    ]
    for run in runs:
        left = "the model leaves the grid" if run.scheduled != run.scheduled else (
            f"the scheduled model misses {100 * run.scheduled:.2g} % of the angles' motion"
        )  # fmt: skip
        said.append(
            f"Under a PRBS of ±{run.amplitude:g} A about a held point {left}, the linearisation at"
            f" the start {100 * run.fixed:.2g} %."
        )
    return said


def _range(values: np.ndarray) -> str:
    low, high = np.round([values.min(), values.max()], 2) + 0.0  # no sign of a zero
    return f"{low:.2f} to {high:.2f}"
