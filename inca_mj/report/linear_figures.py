"""Figures of the robot's linear models: shapes of the platform's modes, errors between a grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.linear.modes import Mode, modes
from identification.report.style import GREY, INK, MEASURED, SERIES, SIMULATED, STYLE
from inca_mj.kinematics.rotations import rotation
from inca_mj.linear.linearization import LinearModel
from inca_mj.linear.thesis_states import EULER, PLATFORM, POSITION
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.spread import displaced

SHOWN = 6  # modes: a rigid platform has as many
REACH = 0.03  # largest motion of a connector in the picture [m]
STUB = 0.1  # of each cable that is drawn [m]
POSE_WORDS = ("x", "y", "z", "roll", "pitch", "yaw")


def handle_share(mode: Mode) -> float:
    """Returns the share of the platform's pose and rates in a mode, between 0 and 1."""
    return float(mode.participation[PLATFORM].sum())


def handle_modes(model: LinearModel) -> list[Mode]:
    """Returns the swinging modes in which the platform has the largest share, the slowest first.

    Args:
        model: of the robot.
    """
    swinging = [m for m in modes(model.system) if m.swings]
    chosen = sorted(swinging, key=handle_share, reverse=True)[:SHOWN]
    return sorted(chosen, key=lambda m: m.frequency)


def handle_motion(mode: Mode, arm: float) -> str:
    """Returns which motions of the platform a mode has: those of at least half the largest.

    Args:
        mode: the mode.
        arm: that turns an angle into a way [m].
    """
    size = np.abs(np.concatenate([mode.shape[POSITION], arm * mode.shape[EULER]]))
    order = np.argsort(-size)
    return ", ".join(POSE_WORDS[i] for i in order if size[i] >= size.max() / 2)


def shape_figure(model: LinearModel) -> Figure:
    """Returns a figure of the platform at both ends of its swing in each mode, with cable parts.

    Args:
        model: of the robot.
    """
    placed = displaced(model.robot.geometry, model.robot.parameters.values())
    found = handle_modes(model)
    with matplotlib.rc_context(STYLE):
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
        at = connectors(end)
        _draw_handle(axis, at, p + end * shape[:3], placed.A, colour, width)
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


def _draw_handle(
    axis: Any, at: np.ndarray, centre: np.ndarray, exits: np.ndarray, colour: str, width: float
) -> None:
    """Draws the arms of the platform, and the first part of each cable."""
    for point, far in zip(at, exits, strict=True):
        axis.plot(*np.stack([centre, point], axis=1), color=colour, lw=width)
        way = (far - point) / np.linalg.norm(far - point)
        axis.plot(*np.stack([point, point + STUB * way], axis=1), color=colour, lw=0.5)


def spacing_figure(errors: Mapping[str, Sequence[tuple[float, float]]]) -> Figure:
    """Returns the largest error of the transfer function between grid points, over their spacing.

    Args:
        errors: by what is interpolated and how, pairs of spacing [m] and error.
    """
    with matplotlib.rc_context(STYLE):
        figure = Figure((6.5, 3.6), layout="constrained")
        axis = figure.subplots()
        for k, (label, pairs) in enumerate(errors.items()):
            x, y = zip(*pairs, strict=True)
            axis.loglog(x, y, "o-", color=SERIES[k], label=label)
        axis.set(xlabel="spacing of the grid [m]", ylabel="largest relative error of G(f)")
        axis.legend(fontsize=8)
    return figure
