"""Sentences, tables and sections of a report on the robot's linear model and on its grid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification.linear.gridded import GriddedSystem
from identification.linear.modes import Mode, modes
from identification.quantities import plain, plain_fields
from identification.report.linear import linear_sections, slowest_and_fastest, system_to_json
from identification.report.page.page import Section, Table
from identification.report.page.style import GREY, INK, MEASURED, SIMULATED, styled
from identification.shares import HELD, percent
from inca_mj.kinematics.rotations import rotation
from inca_mj.linear.accuracy import InterpolationError, RunError
from inca_mj.linear.linearization import LinearModel
from inca_mj.linear.thesis_states import EULER, PLATFORM, POSITION
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.spread import displaced
from inca_mj.twin.logs import POSE, UNITS

SHOWN = 6  # modes: a rigid platform has as many
REACH = 0.03  # largest motion of a connector in the picture [m]
STUB = 0.1  # of each cable that is drawn [m]


def handle_share(mode: Mode) -> float:
    """Returns the share of the platform's pose and rates in a mode, between 0 and 1."""
    return float(mode.participation[PLATFORM].sum())


def handle_modes(model: LinearModel) -> list[Mode]:
    """Returns the swinging modes in which the platform has the largest share, the slowest first."""
    swinging = [m for m in modes(model.system) if m.swings]
    chosen = sorted(swinging, key=handle_share, reverse=True)[:SHOWN]
    return sorted(chosen, key=lambda m: m.frequency)


def handle_motion(mode: Mode, arm: float) -> str:
    """Returns the motions of at least half the largest; `arm` [m] turns an angle into a way."""
    size = np.abs(np.concatenate([mode.shape[POSITION], arm * mode.shape[EULER]]))
    order = np.argsort(-size)
    return ", ".join(POSE[i] for i in order if size[i] >= size.max() / 2)


@styled
def shape_figure(model: LinearModel) -> Figure:
    """Returns a figure of the platform at both ends of its swing in each mode, with cable parts."""
    placed = displaced(model.robot.geometry, model.robot.parameters.values())
    found = handle_modes(model)
    figure = Figure((9.5, 6.4), layout="constrained")
    rows = -(-max(1, len(found)) // 3)
    for k, mode in enumerate(found, 1):
        axis: Any = figure.add_subplot(rows, 3, k, projection="3d")
        _draw_mode(axis, model, mode, placed)
    return figure


def _draw_mode(axis: Any, model: LinearModel, mode: Mode, placed: Geometry) -> None:
    """Draws one mode: the platform at rest in grey, and both ends of its swing in colour."""
    p, e = model.system.x[POSITION], model.system.x[EULER]
    # The phase at which the platform is farthest out.
    shape = np.concatenate([mode.shape[POSITION], mode.shape[EULER]])
    lead = shape[np.abs(shape).argmax()]
    shape = np.real(shape * np.abs(lead) / lead)

    def connectors(size: float) -> np.ndarray:
        return p + size * shape[:3] + placed.B @ rotation(*(e + size * shape[3:])).T

    still = connectors(0.0)
    small = 1e-3 / np.abs(shape).max()
    size = REACH * small / np.linalg.norm(connectors(small) - still, axis=1).max()
    for end, colour, width in ((-size, SIMULATED, 1.4), (size, MEASURED, 1.4), (0.0, GREY, 2.4)):
        centre = p + end * shape[:3]
        for point, far in zip(connectors(end), placed.A, strict=True):  # an arm, and its cable
            axis.plot(*np.stack([centre, point], axis=1), color=colour, lw=width)
            way = (far - point) / np.linalg.norm(far - point)
            axis.plot(*np.stack([point, point + STUB * way], axis=1), color=colour, lw=0.5)
    moved = connectors(size) - still
    for point, way in zip(still, moved, strict=True):
        axis.quiver(*point, *way, color=INK, lw=0.8, arrow_length_ratio=0.3)
    arm = float(np.linalg.norm(placed.B, axis=1).max())
    axis.set_title(
        f"{mode.frequency:.1f} Hz, damping {mode.damping:.2f}: {handle_motion(mode, arm)}",
        color=INK, fontsize=9,
    )  # fmt: skip
    box = 0.12
    for name, centre in zip("xyz", p, strict=True):
        getattr(axis, f"set_{name}lim")(centre - box, centre + box)
        getattr(axis, f"set_{name}ticks")([centre - 0.1, centre, centre + 0.1])
        getattr(axis, f"set_{name}label")(f"{name} [m]", fontsize=7, labelpad=-8)
    axis.tick_params(labelsize=6, pad=-3)
    axis.set_box_aspect((1, 1, 1))


ERRORS = ("matrix", "response", "eigenvalue")
HANDLE_HEAD = ("frequency [Hz]", "damping", "the platform moves along", "share of the platform")


def model_to_json(model: LinearModel, rate: float) -> dict[str, Any]:
    """Returns a linear model of the robot as plain values; its discrete form has the rate [Hz]."""
    return {
        **plain_fields(model, "time", "tension", "friction_slope"),
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
    """Returns what matters about a linear model, in sentences; `label` is its operating point."""
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
    """Returns the sections on linear models; the discrete form of the first has the rate [Hz]."""
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
    """Returns a gridded model by its axes, its errors off the grid and its runs as plain values."""
    return {
        **plain_fields(grid, "axes", "method"),
        "errors": {key: max(getattr(e, key) for e in errors) for key in ERRORS},
        "runs": plain(runs),
    }


def grid_sentences(
    errors: Sequence[InterpolationError], runs: Sequence[RunError]
) -> list[str]:  # fmt: skip
    """Returns how good a gridded model is, in sentences."""
    worst = {key: max(getattr(e, key) for e in errors) for key in ERRORS}
    lines = [
        f"At {len(errors)} random points off the grid the interpolated model differs from the"
        f" twin's own linearisation by at most {worst['response']:.2g} of the transfer function,"
        f" {worst['matrix']:.2g} of A and {worst['eigenvalue']:.2g} of an eigenvalue."
    ]
    for run in runs:
        left = "the model leaves the grid" if run.scheduled != run.scheduled else (
            f"the scheduled model misses {percent(run.scheduled, HELD)} of the angles' motion"
        )  # fmt: skip
        lines.append(
            f"Under a PRBS of ±{run.amplitude:g} A about a held point {left}, the linearisation at"
            f" the start {percent(run.fixed, HELD)}."
        )
    return lines


def _range(values: np.ndarray) -> str:
    low, high = np.round([values.min(), values.max()], 2) + 0.0  # no sign of a zero
    return f"{low:.2f} to {high:.2f}"
