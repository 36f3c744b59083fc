"""Figures of a pose and its cables, and of poses along a log."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.style import GREY, INK, SERIES, STYLE
from inca_mj.kinematics.inverse_geometry import Cables
from inca_mj.robot.geometry import Geometry
from inca_mj.workflows.poses import LogPoses

_NAMES = ("x", "y", "z", "roll", "pitch", "yaw")


def cables_figure(pose: np.ndarray, cables: Cables, geometry: Geometry) -> Figure:
    """Returns a figure of the frame, the cables and the platform in space.

    Args:
        pose: x, y, z [m], roll, pitch, yaw [rad], shape (6,).
        cables: of that pose.
        geometry: exit points and connectors.
    """
    A, B = geometry.A, pose[:3] + cables.arms
    with matplotlib.rc_context(STYLE):
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


def poses_figure(found: LogPoses) -> Figure:
    """Returns a figure of the pose over time with its std, or its error if the log has a pose."""
    with matplotlib.rc_context(STYLE):
        figure = Figure((9.5, 5.6), layout="constrained")
        axes = figure.subplots(2, 2, sharex=True)
        for row, (about, unit, small) in enumerate((("position", "m", "µm"),
                                                     ("angle", "rad", "mrad"))):  # fmt: skip
            scale = 1e6 if row == 0 else 1e3
            left, right = axes[row]
            for k in range(3):
                at, color = 3 * row + k, SERIES[k]
                left.plot(found.log.time, found.pose[:, at], color=color, label=_NAMES[at])
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
