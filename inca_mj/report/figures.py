"""Figures of runs, paths, cross-checks, calibrations and the information of an experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from identification.report.page.style import GREY, INK, MEASURED, SERIES, SIMULATED, literal, styled
from identification.report.words.values import describe_parameter
from inca_mj.control.paths import PLANES, Circle
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import AXES

if TYPE_CHECKING:
    from inca_mj.twin.run import Run
    from inca_mj.workflows.calibration import Calibration
    from inca_mj.workflows.tracking import Tracking

MARKERS = "osD^vPX*"
STRIP = 0.72  # height of a current's strip, of the distance between strips
MAGNIFIED = 20.0  # errors in the drawing of the path
VIEWS = ((0, 1), (0, 2), (1, 2))  # axes of the three views
LARGE = 0.12  # length of the longest arrow, as a share of the frame


def simulation_figures(run: Run) -> dict[str, Figure]:
    """Returns the currents, and the four figures of the thesis' Figure 2.16, by name.

    The caption of part (d) in the thesis repeats "angles of the motors", but its text speaks of
    roll, pitch and yaw; these are shown here.
    """
    drives = range(1, run.motor_angle.shape[1] + 1)
    series: dict[str, tuple[str, np.ndarray, list[str]]] = {
        "motor_angles": ("motor angle φ [rad]", run.motor_angle, [f"motor {k}" for k in drives]),
        "cable_tensions": ("cable tension T [N]", run.tension, [f"cable {k}" for k in drives]),
        "platform_position": ("platform position [m]", run.position, ["x", "y", "z"]),
        "platform_angles": ("platform angle [rad]", run.angles, ["roll", "pitch", "yaw"]),
    }
    drawn = {name: over_time(run.time, *what) for name, what in series.items()}
    return {"motor_currents": currents_figure(run.time, run.currents), **drawn}


@styled
def currents_figure(
    time: np.ndarray, currents: np.ndarray, size: tuple[float, float] = (6.4, 3.4)
) -> Figure:
    """Returns a figure of each motor's current (N, 8) [A] in a strip, all strips of one scale."""
    low, high = float(currents.min()), float(currents.max())
    strips = np.arange(currents.shape[1])
    height = STRIP * (currents - low) / (high - low if high > low else 1.0)
    figure = Figure(size, layout="constrained")
    ax = figure.subplots()
    for k in strips:
        ax.plot(time, height[:, k] - k, color=SERIES[k], drawstyle="steps-post")
    ax.set_yticks(-strips + STRIP / 2, [f"motor {k + 1}" for k in strips])
    ax.set(xlabel="time [s]", xlim=(time[0], time[-1]))
    ax.set_ylabel(f"currents, each strip from {low:g} to {high:g} [A]")
    ax.grid(visible=False, axis="y")
    return figure


@styled
def over_time(
    time: np.ndarray, label: str, values: np.ndarray, names: list[str],
    size: tuple[float, float] = (6.4, 3.4),
) -> Figure:  # fmt: skip
    """Returns a figure of curves (N, n) over time (N,) [s]."""
    figure = Figure(size, layout="constrained")
    ax = figure.subplots()
    for k, name in enumerate(names):
        ax.plot(time, values[:, k], color=SERIES[k], ls="-" if k < 4 else "--", label=name)
    ax.set(xlabel="time [s]", ylabel=label, xlim=(time[0], time[-1]))
    figure.legend(loc="outside upper center", ncols=min(4, len(names)))
    return figure


@styled
def tracking_figure(results: Mapping[str, Tracking]) -> Figure:
    """Returns the path with errors drawn larger, and the distance over time, of several runs."""
    first = next(iter(results.values()))
    circle = isinstance(first.path, Circle)
    i, j = PLANES[first.path.plane] if isinstance(first.path, Circle) else (0, 1)
    figure = Figure((9.5, 4.2), layout="constrained")
    plan, over_time = figure.subplots(1, 2, width_ratios=(1, 1.4))
    plan.plot(first.asked[:, i], first.asked[:, j], color=GREY, lw=1, label="asked")
    for k, (name, result) in enumerate(results.items()):
        late = result.run.time >= (result.counted if circle else 0.0)
        shown = result.asked + MAGNIFIED * result.error
        plan.plot(shown[late, i], shown[late, j], color=SERIES[k], label=name)
        distance = 1e3 * np.linalg.norm(result.error, axis=1)
        label = f"{name}: {1e3 * result.rms:.3g} mm rms"
        over_time.plot(result.run.time, distance, color=SERIES[k], label=label)
    plan.set(xlabel=f"{'xyz'[i]} [m]", ylabel=f"{'xyz'[j]} [m]", aspect="equal")
    plan.set_title(f"the path, errors drawn {MAGNIFIED:g} times as large", loc="left")
    over_time.set(xlabel="time [s]", ylabel="distance from the asked point [mm]", ylim=(0, None))
    over_time.axvline(first.counted, color=GREY, lw=0.8, ls=":")
    handles, labels = over_time.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


@styled
def crosscheck_figure(rows: Sequence[Mapping[str, Any]], order: float | None) -> Figure:
    """Returns a figure of the largest difference of the two models over the step, with slope 4.

    The rows are those of `CrossCheck`; the observed order is None when it could not be observed.
    """
    cases = list(dict.fromkeys(str(row["case"]) for row in rows))
    figure = Figure((9.5, 3.6), layout="constrained")
    for ax, (kind, unit) in zip(
        figure.subplots(1, 3), (("angle", "rad"), ("position", "m"), ("tension", "N")), strict=True
    ):
        error = f"max_{kind}_error"
        for number, case in enumerate(cases):
            # An error of zero cannot stand on a logarithmic axis, so a gap is left.
            points = sorted((r["step"], r[error] or np.nan) for r in rows
                            if str(r["case"]) == case)  # fmt: skip
            ax.plot(*zip(*points, strict=True), color=SERIES[number % len(SERIES)],
                    marker=MARKERS[number % len(MARKERS)], ms=4.5, label=case)  # fmt: skip
        steps = sorted({row["step"] for row in rows})
        largest = max((row[error] or 0.0 for row in rows if row["step"] == steps[-1]), default=0.0)
        if largest > 0:  # a guide just below the largest errors
            guide = 0.4 * largest * (np.array(steps) / steps[-1]) ** 4
            ax.plot(steps, guide, color=GREY, ls="--", lw=1, label="slope 4")
        ax.set(xscale="log", xlabel="step [ms]")
        if any(row[error] for row in rows):
            ax.set_yscale("log")
        ax.set_xticks(steps, [f"{1e3 * step:g}" for step in steps])
        ax.minorticks_off()
        ax.set_title(f"largest {kind} error [{unit}]", loc="left", color=INK)
    observed = "" if order is None else f": observed order {order:.2f}"
    figure.suptitle(f"twin against reference{observed}", color=INK, fontsize=10.5)
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(5, len(labels)))
    return figure


@styled
def std_figure(names: Sequence[str], stds: Mapping[str, np.ndarray]) -> Figure:
    """Returns bars of the std of each parameter, one colour per experiment, on a logarithmic axis.

    An infinite std has no bar.
    """
    place = np.arange(len(names))
    width = 0.8 / max(1, len(stds))
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


@styled
def points_figure(found: Calibration, point: str = "exit") -> Figure:
    """Returns three views of the exits or connectors, with enlarged arrows from nominal places."""
    new = found.robot.geometry.A if point == "exit" else found.robot.geometry.B
    move = _grid(found.values, point)
    old, std = new - move, _grid(found.std, point)
    size = float(np.ptp(old, axis=0).max())
    times = LARGE * size / max(float(np.abs(move).max()), 1e-9)
    figure = Figure((9.5, 3.6), layout="constrained")
    for ax, (i, j) in zip(figure.subplots(1, 3), VIEWS, strict=True):
        ax.plot(old[:, i], old[:, j], "o", color=GREY, ms=4)
        tips = old + times * move
        for k in range(DRIVES):
            arrow = {"arrowstyle": "->", "color": SIMULATED}
            ax.annotate("", tips[k, [i, j]], old[k, [i, j]], arrowprops=arrow)
            ax.errorbar(
                tips[k, i], tips[k, j], times * std[k, j], times * std[k, i],
                color=MEASURED, lw=0.8,
            )  # fmt: skip
            ax.annotate(str(k + 1), old[k, [i, j]], xytext=(4, 4), color=INK, fontsize=7,
                        textcoords="offset points")  # fmt: skip
        ax.set(xlabel=f"{AXES[i]} [m]", ylabel=f"{AXES[j]} [m]", aspect="equal")
        ax.margins(0.2)
    figure.suptitle(
        f"{point} points: arrows show {times:.3g} times the displacement, bars its std",
        color=INK, fontsize=10,
    )  # fmt: skip
    return figure


@styled
def drives_figure(found: Calibration) -> Figure:
    """Returns a figure of each drive's deviation from the common value, with its std."""
    names, k = [*found.spread.drives], np.arange(1, DRIVES + 1)
    parameters = found.robot.parameters
    columns = min(5, len(names))
    rows = -(-len(names) // columns)
    figure = Figure((9.5, 2.0 * rows), layout="constrained")
    panels = np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).ravel()
    for ax, name in zip(panels, names, strict=False):
        values = 100 * np.array([found.values[f"{name}@{i}"] for i in k])
        std = 100 * np.array([found.std[f"{name}@{i}"] for i in k])
        ax.errorbar(k, values, std, fmt="o", color=SERIES[0], ms=4, lw=1)
        ax.axhline(0, color=GREY, lw=0.8)
        what = literal(describe_parameter(parameters[name]))
        ax.set_title(f"{what} [%]", loc="left", color=INK, fontsize=8)
        ax.set_xticks(k)
    for ax in panels[len(names) :]:
        ax.set_axis_off()
    figure.supxlabel("drive", fontsize=9)
    return figure


def _grid(values: dict[str, float], point: str) -> np.ndarray:
    """Returns numbers of points by drive and axis, shape (8, 3)."""
    every = range(1, DRIVES + 1)
    return np.array([[values[f"{point}_{axis}@{k}"] for axis in AXES] for k in every])
