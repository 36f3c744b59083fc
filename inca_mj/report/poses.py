"""The results of the kinematics as JSON, text and sections, at one pose and along a log."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from identification.quantities import plain, plain_fields
from identification.report.page.page import Section, Table
from identification.report.page.style import GREY, INK, SERIES, styled
from identification.shares import percent
from identification.storage.files import write_text
from inca_mj.kinematics.cables import Cables
from inca_mj.kinematics.jacobians import condition, jacobian, rank
from inca_mj.robot.geometry import Geometry
from inca_mj.twin.logs import POSE
from inca_mj.workflows.poses import LogPoses

INSIDE = 1.96  # std on each side that hold 95 % of a Gaussian


def cables_json(pose: np.ndarray, cables: Cables) -> dict[str, Any]:
    """Returns a pose (6,) [m, rad] and its cables as plain values."""
    return {
        "pose": plain(pose),
        **plain_fields(cables, "lengths", "directions", "wraps", cable_angles="angles"),
        "jacobian": plain(jacobian(cables)),
        "rank": rank(cables),
        "condition": plain(condition(cables)),
    }


def cables_verdict(cables: Cables, geometry: Geometry) -> list[str]:
    """Returns what the Jacobian says of a pose, in sentences."""
    lines = []
    if rank(cables) < 6:
        lines.append(
            f"The lengths do not tell this pose: the Jacobian has rank {rank(cables)} of 6, so that"
            " the platform can move without a change of any length."
        )
    else:
        lines.append(
            "The lengths tell this pose: the Jacobian has rank 6 and the condition number"
            f" {condition(cables):.3g} (angles counted at the distance of the connectors)."
        )
    if geometry.assumed:
        lines.append(f"The geometry is assumed ({geometry.source}).")
    return lines


def cables_rows(cables: Cables) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Returns a table of the cables: heading and a row for each."""
    head = ("cable", "length [m]", "direction", "φ [deg]", "θ [deg]")
    rows = [
        (
            str(k + 1),
            f"{cables.lengths[k]:.5f}",
            " ".join(f"{x:+z.4f}" for x in cables.directions[k]),
            *(f"{x:z.2f}" for x in np.degrees(cables.angles[k])),
        )
        for k in range(len(cables.lengths))
    ]
    return head, rows


def cables_section(pose: np.ndarray, cables: Cables, geometry: Geometry) -> Section:
    """Returns the section on the cables of a pose: picture and table."""
    head, rows = cables_rows(cables)
    place = ", ".join(f"{name} {x:zg}" for name, x in zip(POSE, pose, strict=True))
    return Section(
        "The cables of the pose",
        f"Pose: {place} [m, rad]. φ and θ are the Euler angles of the cable (thesis 2.9, 2.10).",
        figures=(("Cables in space", cables_figure(pose, cables, geometry)),),
        table=Table(head, tuple(rows)),
    )


def poses_json(found: LogPoses) -> dict[str, Any]:
    """Returns poses along a log as plain values."""
    return {
        "samples": len(found.log),
        "encoder_std": plain(found.encoder),
        **plain_fields(found, "length_error", "tension_error", "force_error"),
        "slack_samples": int((~found.taut.all(axis=1)).sum()),
        "mean_std": plain(found.std.mean(axis=0)),
        "mean_noise_std": plain(found.noise_std.mean(axis=0)),
        "measured": plain(_measured(found)),
        "time": plain(found.log.time),
        **plain_fields(found, "pose", "std", "tension"),
    }


def poses_verdict(found: LogPoses) -> list[str]:
    """Returns what the poses are worth, in sentences."""
    length, angle = 1e6 * found.std[:, :3].mean(), 1e3 * found.std[:, 3:].mean()
    lines = [
        f"The mean std is {length:.0f} µm of the position and {angle:.2f} mrad of the angles.",
        f"The motors' balances leave {found.tension_error:.2g} N of each tension open, and the"
        f" neglected acceleration of the platform is worth {found.force_error:.2g} N.",
    ]
    encoder = float(found.encoder_length.mean())
    if found.length_error > 0:
        lines.append(
            f"The lengths disagree by {1e3 * found.length_error:.2g} mm, far more than the"
            f" encoders' {1e3 * encoder:.2g} mm: geometry, start pose or parameters are not those"
            " of this robot; inca calibrate finds them, and inca discover"
            " what a model of them lacks."
        )
    slack = int((~found.taut.all(axis=1)).sum())
    if slack:
        lines.append(
            f"In {slack} samples a cable is slack; its motor says nothing of the pose there."
        )
    against = _measured(found)
    if against is not None:
        inside = percent(float(np.mean(against["inside_95"])))
        rms = np.array(against["rms"])
        lines.append(
            f"Against the pose in the log the rms error is {1e6 * rms[:3].max():.0f} µm and"
            f" {1e3 * rms[3:].max():.2f} mrad at the worst axis; {inside} of the errors lie"
            " within the 95 % intervals."
        )
    if np.allclose(found.std, found.noise_std):
        lines.append("The parameters are taken as exact; --std says how well they are known.")
    return lines


def poses_section(found: LogPoses) -> Section:
    """Returns the section on poses along a log: figure and table."""
    against = _measured(found)
    columns: tuple[str, ...] = ("coordinate", "unit", "mean std", "of it noise")
    if against is not None:
        columns += ("rms error", "within 95 % interval [%]")
    rows: list[tuple[object, ...]] = []
    for k, name in enumerate(POSE):
        std, noise = found.std[:, k].mean(), found.noise_std[:, k].mean()
        row: tuple[object, ...] = (name, "m" if k < 3 else "rad", float(std), float(noise))
        if against is not None:
            row += (against["rms"][k], 100 * against["inside_95"][k])
        rows.append(row)
    return Section(
        "The pose along the log",
        f"{len(found.log)} samples, each by weighted least squares of cable lengths, balances of"
        " the motors and balance of the platform (docs/kinematics.md). poses.csv has all samples.",
        figures=(("Pose and its std", poses_figure(found)),),
        table=Table(columns, tuple(rows)),
    )


@styled
def cables_figure(pose: np.ndarray, cables: Cables, geometry: Geometry) -> Figure:
    """Returns a figure of the frame, the cables and the platform in space."""
    A, B = geometry.A, pose[:3] + cables.arms
    figure = Figure((6.0, 5.2), layout="constrained")
    ax: Any = figure.add_subplot(projection="3d")
    for k, (a, b) in enumerate(zip(A, B, strict=True)):
        d = cables.lengths[k]
        ax.plot(*zip(a, b, strict=True), color=SERIES[k], label=f"cable {k + 1}: {d:.4f} m")
        ax.plot(*zip(pose[:3], b, strict=True), color=INK, lw=2)
    ax.scatter(*A.T, color=GREY, s=12)
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    ax.set_box_aspect(np.maximum(np.ptp(np.vstack([A, B]), axis=0), 0.5))
    figure.legend(loc="outside lower center", ncols=4)
    return figure


@styled
def poses_figure(found: LogPoses) -> Figure:
    """Returns a figure of the pose over time with its std, or its error if the log has a pose."""
    figure = Figure((9.5, 5.6), layout="constrained")
    axes = figure.subplots(2, 2, sharex=True)
    for row, (about, unit, small) in enumerate((("position", "m", "µm"),
                                                 ("angle", "rad", "mrad"))):  # fmt: skip
        scale = 1e6 if row == 0 else 1e3
        left, right = axes[row]
        for k in range(3):
            at, color = 3 * row + k, SERIES[k]
            left.plot(found.log.time, found.pose[:, at], color=color, label=POSE[at])
            std = scale * found.std[:, at]
            if found.measured is None:
                right.plot(found.log.time, std, color=color, lw=0.8)
                continue
            error = scale * (found.pose - found.measured)[:, at]
            right.fill_between(found.log.time, -2 * std, 2 * std, color=color, alpha=0.15, lw=0)
            right.plot(found.log.time, error, color=color, lw=0.7)
        left.set_ylabel(f"{about} [{unit}]")
        left.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
        what = "std of the" if found.measured is None else "error and ± 2 std of the"
        right.set_ylabel(f"{what} {about} [{small}]")
    for ax in axes[1]:
        ax.set_xlabel("time [s]")
    return figure


def write_poses(found: LogPoses, path: Path) -> Path:
    """Write poses, their std and the tensions as CSV; returns the path."""
    drives = range(1, found.tension.shape[1] + 1)
    names = [
        "time", *POSE, *(f"std_{name}" for name in POSE),
        *(f"tension_{k}" for k in drives), *(f"std_tension_{k}" for k in drives),
    ]  # fmt: skip
    table = np.column_stack(
        [found.log.time, found.pose, found.std, found.tension, found.tension_std]
    )
    lines = [",".join(names), *(",".join(f"{x:z.10g}" for x in row) for row in table)]
    return write_text(path, "\n".join(lines) + "\n")


def _measured(found: LogPoses) -> dict[str, Any] | None:
    """Returns the errors against the pose in the log, where it has one."""
    if found.measured is None:
        return None
    error = found.pose - found.measured
    inside = np.abs(error) <= INSIDE * found.std
    return {
        "rms": np.sqrt(np.mean(error**2, axis=0)).tolist(),
        "inside_95": inside.mean(axis=0).tolist(),
    }
