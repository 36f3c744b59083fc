"""The figures of `inca statics`: tensions, slices of workspaces, masses of cables, frequencies."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from identification.report.page.style import GREY, INK, MEASURED, SERIES, SIMULATED, styled
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.elastic import Robot
from inca_mj.statics.cable_mass import NOISE, RHO
from inca_mj.statics.catenary import sag_length
from inca_mj.statics.workspace import NAMES, Kind, margin
from inca_mj.workflows.statics import StaticAnalysis

FINE = 61  # points along an edge of a slice
_PLANES = (
    (0, 1, 2, "seen from above"),
    (0, 2, 1, "seen from the front"),
    (1, 2, 0, "from the side"),
)


@styled
def tension_figure(found: StaticAnalysis) -> Figure:
    """Returns a figure of the tensions of the eight cables at the pose, with their limits."""
    held, cable = found.held, np.arange(1, 9)
    figure = Figure((6.4, 3.4), layout="constrained")
    ax = figure.subplots()
    ax.bar(cable, held.high - held.low, bottom=held.low, width=0.6, color="#DDE6EE",
           label="possible with the currents")  # fmt: skip
    for x, values, marker, colour, label in (
        (-0.15, held.minimum_norm, "v", GREY, "minimum norm, no limits"),
        (0.15, held.nearest, "o", MEASURED, "nearest to 4 N, no limits"),
        (0.0, held.within, "_", SIMULATED, "nearest to 4 N within the limits"),
    ):
        ax.plot(cable + x, values, marker, color=colour, ms=14 if marker == "_" else 5, mew=2,
                ls="", label=label)  # fmt: skip
    ax.axhline(0, color=INK, lw=0.8)
    ax.set(xlabel="cable", ylabel="tension [N]", xticks=cable)
    figure.legend(loc="outside upper center", ncols=2)
    return figure


@styled
def slices_figure(
    robot: Robot, found: StaticAnalysis, kinds: tuple[Kind, ...], points: int = FINE
) -> Figure:
    """Returns a figure of three slices of workspaces through the pose, so many points an edge."""
    low, high = robot.geometry.A.min(axis=0), robot.geometry.A.max(axis=0)
    figure = Figure((9.5, 3.6), layout="constrained")
    for ax, (i, j, fixed, title) in zip(figure.subplots(1, 3), _PLANES, strict=True):
        u, v = np.linspace(low[i], high[i], points), np.linspace(low[j], high[j], points)
        poses = np.tile(found.pose, (points * points, 1))
        poses[:, i], poses[:, j] = (x.ravel() for x in np.meshgrid(u, v))
        for n, kind in enumerate(kinds):
            m = margin(kind, robot, poses, found.limits).reshape(points, points)
            edge = float(np.quantile(np.abs(m[np.isfinite(m)]), 0.5)) or 1.0
            m = np.clip(m, -edge, edge)
            colour = SERIES[n]
            ax.contourf(u, v, m, levels=[0, np.inf], colors=[colour], alpha=0.18)
            ax.contour(u, v, m, levels=[0], colors=[colour], linewidths=1.3)
            ax.plot([], [], color=colour, label=NAMES[kind] if fixed == 2 else None)
        ax.plot(found.pose[i], found.pose[j], "+", color=INK, ms=9)
        ax.plot(robot.geometry.A[:, i], robot.geometry.A[:, j], "s", color=GREY, ms=4)
        ax.set(xlabel=f"{'xyz'[i]} [m]", ylabel=f"{'xyz'[j]} [m]", aspect="equal")
        ax.set_title(f"{title}, {'xyz'[fixed]} = {found.pose[fixed]:.2f} m", loc="left", color=INK)
    figure.legend(loc="outside upper center", ncols=3)
    return figure


@styled
def cable_mass_figure(found: StaticAnalysis) -> Figure:
    """Returns a figure of the massless line's length error over the tension, for some masses."""
    robot = found.robot
    at = inverse(found.pose, robot.geometry)
    span = np.hypot(at.directions[:, 0], at.directions[:, 1]) * at.lengths
    T = np.geomspace(0.5, 20, 60)
    noise = NOISE * float(robot.R.mean())
    figure = Figure((6.4, 3.6), layout="constrained")
    ax = figure.subplots()
    for n, rho in enumerate(found.rho or RHO):
        longest = int(np.argmax(span**2 * at.lengths))
        line = [
            1e6 * sag_length(float(at.lengths[longest]), float(span[longest]), t, rho) for t in T
        ]
        ax.plot(T, line, color=SERIES[n], label=f"ρ = {1e3 * rho:g} g/m, Irvine's parabola")
        exact = [(e.tension, 1e6 * e.length) for e in found.line_errors if e.rho == rho]
        ax.plot(*zip(*exact, strict=True), "o", ms=5, color=SERIES[n])
    ax.axhline(1e6 * noise, color=INK, ls="--", lw=1)
    ax.text(20, 1.1e6 * noise, "noise of a log", ha="right", color=INK)
    ax.plot([], [], "o", color=GREY, label="elastic catenary, worst cable")
    ax.set(xscale="log", yscale="log", xlabel="tension [N]", ylabel="error of the length [µm]")
    ax.set_xticks([0.5, 1, 2, 4, 8, 16], ["0.5", "1", "2", "4", "8", "16"])
    ax.minorticks_off()
    figure.legend(loc="outside upper center", ncols=2)
    return figure


@styled
def frequency_figure(found: StaticAnalysis) -> Figure:
    """Returns a figure of the frequencies of the platform and of its cables."""
    rows: list[tuple[str, np.ndarray, str]] = [
        ("platform and drums", found.modes_free.frequency, INK),
        ("platform, drums locked", found.modes.frequency, MEASURED),
    ]
    for rho, c in zip(found.rho, found.cable_modes, strict=True):
        name = f"{1e3 * rho:g} g/m"
        rows += [(f"platform, swinging cables of {name}", c.coupled, "#009E73"),
                 (f"cables of {name}, ends at rest", c.cables, SIMULATED)]  # fmt: skip
    figure = Figure((6.4, 0.9 + 0.32 * len(rows)), layout="constrained")
    ax = figure.subplots()
    for y, (_, values, colour) in enumerate(rows):
        ax.plot(values, np.full(len(values), y), "|", color=colour, ms=13, mew=1.6)
    ax.set(xscale="log", xlabel="frequency [Hz]", ylim=(len(rows) - 0.5, -0.5))
    ax.set_yticks(range(len(rows)), [name for name, _, _ in rows])
    return figure
