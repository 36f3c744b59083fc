"""A robot on a path: where it went, and how far from the path it was."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from identification.report.page import Section, Table
from identification.report.style import GREY, SERIES, STYLE
from inca_mj.control.paths import PLANES, Circle
from inca_mj.workflows.tracking import Tracking

MAGNIFIED = 20.0  # errors in the drawing of the path


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


def tracking_figure(results: Mapping[str, Tracking]) -> Figure:
    """Returns the path with errors drawn larger, and the distance over time, of several runs.

    Args:
        results: runs by what to call them, all on one path.
    """
    first = next(iter(results.values()))
    circle = isinstance(first.path, Circle)
    i, j = PLANES[first.path.plane] if isinstance(first.path, Circle) else (0, 1)
    with matplotlib.rc_context(STYLE):
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
        over_time.set(
            xlabel="time [s]", ylabel="distance from the asked point [mm]", ylim=(0, None)
        )
        over_time.axvline(first.counted, color=GREY, lw=0.8, ls=":")
        handles, labels = over_time.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure
