"""What `inca statics` tells: sentences, the sections and figures of its report, and JSON."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification.quantities import plain, plain_fields, quantity
from identification.report.page import Section, Table
from identification.report.style import GREY, INK, MEASURED, SERIES, SIMULATED, styled
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.elastic import Robot
from inca_mj.statics.cable_mass import NOISE, RHO
from inca_mj.statics.catenary import sag_length
from inca_mj.statics.interference import Interference
from inca_mj.statics.stiffness import Axes, Modes
from inca_mj.statics.workspace import NAMES, Kind, margin
from inca_mj.workflows.statics import StaticAnalysis

MASS_COLUMNS = (
    "ρ [g/m]", "tension [N]", "length [µm]", "angle [mrad]", "force [mN]",
    "force, half weight [mN]", "stiffness lost [%]", "platform moves [mm]", "straight is enough",
)  # fmt: skip
CABLE_MODES = ("massless", "added", "coupled", "share", "cables", "in_plane")


def statics_verdict(found: StaticAnalysis) -> list[str]:
    """Returns what was found, in sentences."""
    held, rest, push = found.held, found.rest, found.push
    x, y, z = rest.pose[:3]
    lines = [
        f"The cables have rank {found.closure.rank} and closure: the best internal tension has a"
        f" smallest tension of {found.closure.margin:.2f} of the largest.",
        f"Tensions from {held.within.min():.2f} to {held.within.max():.2f} N hold the platform,"
        f" with currents from {held.current.min():z.2f} to {held.current.max():z.2f} A.",
        f"With the power off it rests at ({x:z.3f}, {y:z.3f}, {z:z.3f}) m,"
        f" {'stable' if rest.stable else 'NOT stable'}; Coulomb friction may hold it up to"
        f" {1e3 * rest.friction_band[:3].max():.0f} mm away from there.",
        f"With locked drums the softest direction is {push.words[0]}, {push.values[0] / 1e3:.1f}"
        f" N/mm, and the stiffest {push.words[-1]}, {push.values[-1] / 1e3:.1f} N/mm; the softest"
        f" turn is {found.twist.words[0]}, {found.twist.values[0]:.1f} N m/rad.",
        f"The slowest mode with locked drums has {found.modes.frequency[0]:.1f} Hz: the platform"
        f" {found.modes.words[0]}.",
    ]
    if found.workspace is not None:
        w = found.workspace
        lines.append(
            f"The {NAMES[w.kind]} workspace at this orientation has"
            f" {quantity(w.volume, w.std, 'm³')} (standard error of stratified sampling)."
        )
    lines += _near_words("At the pose", found.nearness)
    if found.nearness_along is not None:
        n = len(found.nearness_along.platform)
        lines += _near_words(f"Over {n} poses", found.nearness_along)
    return [*lines, *mass_verdict(found)]


def mass_verdict(found: StaticAnalysis) -> list[str]:
    """Returns for which cables the massless straight line is good enough, in sentences."""
    lines = []
    for rho in found.rho:
        rows = [e for e in found.line_errors if e.rho == rho]
        enough = [e.tension for e in rows if e.line_is_enough]
        where = f"from {min(enough):g} N on" if enough else "at none of the tensions"
        lines.append(
            f"Cables of {1e3 * rho:g} g/m are straight to the noise of a log {where}; their weight"
            f" moves a free platform by {1e3 * rows[0].moved:.1f} mm."
        )
    return lines


def _near_words(begin: str, found: Interference) -> list[str]:
    (i, j), _ = found.nearest_pair()
    cable, _ = found.nearest_to_platform()
    gap = found.platform.min()
    touch = f"clears it by {1e3 * gap:.0f} mm" if gap > 0 else "TOUCHES it"
    return [
        f"{begin} the nearest cables are {i} and {j}, {1e3 * found.between.min():.0f} mm apart;"
        f" cable {cable} is nearest to the platform and {touch}."
    ]


def statics_sections(found: StaticAnalysis) -> list[Section]:
    """Returns the sections, with their figures."""
    held = found.held
    stiffness = tuple(
        (f"{what}{words}", float(value), unit)
        for what, values, each, unit in (
            ("stiffness ", found.push.values, found.push.words, "N/m"),
            ("stiffness ", found.twist.values, found.twist.words, "N m/rad"),
            ("drums locked: ", found.modes.frequency, found.modes.words, "Hz"),
            ("drums free: ", found.modes_free.frequency, found.modes_free.words, "Hz"),
        )
        for value, words in zip(values, each, strict=True)
    )
    errors = tuple(
        (1e3 * e.rho, e.tension, 1e6 * e.length, 1e3 * e.angle, 1e3 * e.force, 1e3 * e.force_half,
         1e2 * e.stiffness_lost, 1e3 * e.moved, "yes" if e.line_is_enough else "no")
        for e in found.line_errors
    )  # fmt: skip
    sections = [
        Section(
            "Tensions at the pose",
            "Limits follow from the smallest and the largest current and the drum springs.",
            figures=(("Tensions of the cables", tension_figure(found)),),
            table=Table(
                ("cable", "low [N]", "high [N]", "minimum norm [N]", "nearest to 4 N [N]",
                 "within limits [N]", "current [A]"),
                tuple(
                    (k + 1, *(float(x[k]) for x in (held.low, held.high, held.minimum_norm,
                                                    held.nearest, held.within, held.current)))
                    for k in range(8)
                ),
            ),
        ),
        Section(
            "Stiffness and modes",
            "Stiffness against a force while the platform may turn, against a torque while it may"
            " move; drums locked. Modes have no damping here.",
            figures=(("Frequencies of platform and cables", frequency_figure(found)),),
            table=Table(("what", "value", "unit"), stiffness),
        ),
    ]  # fmt: skip
    if found.workspace is not None:
        kinds: tuple[Kind, ...] = tuple(dict.fromkeys(("closure", found.workspace.kind)))
        sections.append(
            Section(
                "Workspace",
                "Slices through the pose. Volume"
                f" {quantity(found.workspace.volume, found.workspace.std, 'm³')}.",
                figures=(("Slices of the workspace", slices_figure(found.robot, found, kinds)),),
            )
        )
    sections.append(
        Section(
            "Mass of the cables",
            "What a massless straight cable gets wrong at this pose, the worst of the eight.",
            figures=(("Error of the length of a straight line", cable_mass_figure(found)),),
            table=Table(MASS_COLUMNS, errors),
        )
    )
    return sections


def statics_json(found: StaticAnalysis) -> dict[str, Any]:
    """Returns the record; `docs/json.md` explains its keys."""
    along, inside = found.nearness_along, None
    if (w := found.workspace) is not None:
        inside = plain_fields(w, "kind", "orientation", "volume", "std")
        inside |= {"points": int(w.margin.size), "inside": int(w.inside.sum())}
    return {
        **plain_fields(found, "pose", "load"),
        "closure": plain_fields(found.closure, "rank", "condition", "closed", "margin"),
        "tension": plain_fields(
            found.held, "low", "high", "nearest", "minimum_norm", "current", within_limits="within"
        ),
        "rest": plain_fields(found.rest, "pose", "tension", "angle", "stable", "friction_band"),
        "stiffness": {
            **plain_fields(found, drums_locked="locked", drums_free="free"),
            "against_forces": _axes(found.push),
            "against_torques": _axes(found.twist),
        },
        "modes": {"drums_locked": _modes(found.modes), "drums_free": _modes(found.modes_free)},
        "workspace": inside,
        "interference": {
            "at_pose": _nearness(found.nearness),
            "along": None if along is None else _nearness(along),
        },
        "cable_mass": [
            plain_fields(
                e, "rho", "tension", "sag", "stiffness_lost", "moved", "moved_angle",
                "line_is_enough", "massless_is_enough", length_error="length", angle_error="angle",
                force_error="force", force_error_half_weight="force_half",
            )
            for e in found.line_errors
        ],
        "cable_modes": [
            {"rho": rho, **plain_fields(c, *CABLE_MODES)}
            for rho, c in zip(found.rho, found.cable_modes, strict=True)
        ],
    }  # fmt: skip


def _axes(axes: Axes) -> list[dict[str, Any]]:
    rows = zip(axes.values, axes.vectors, axes.words, strict=True)
    return [plain({"value": v, "vector": x, "words": words}) for v, x, words in rows]


def _modes(modes: Modes) -> list[dict[str, Any]]:
    rows = zip(modes.frequency, modes.words, strict=True)
    return [plain({"frequency": f, "words": words}) for f, words in rows]


def _nearness(found: Interference) -> dict[str, Any]:
    pair, at = found.nearest_pair()
    cable, near = found.nearest_to_platform()
    return {
        "poses": len(found.platform),
        "cables": {"pair": list(pair), "distance": float(found.between.min()), "pose": at},
        "platform": {"cable": cable, "clearance": float(found.platform.min()), "pose": near},
        "angle": float(found.angle.min()) if found.angle.size else None,
    }


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
