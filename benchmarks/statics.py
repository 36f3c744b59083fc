"""How long each call of the statics takes; prints one JSON object, in milliseconds.

    python benchmarks/statics.py                    # timings
    python benchmarks/statics.py --figures docs     # the figures of docs/statics.md, cable_mass.md

The least processor time of several calls counts, so that other programs on the machine do not.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from identification.report.page.style import save_png
from inca_mj.kinematics.cables import inverse
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import parameter_set
from inca_mj.statics.cable_mass import line_errors
from inca_mj.statics.catenary import hang
from inca_mj.statics.closure import closure
from inca_mj.statics.equilibrium import equilibrium
from inca_mj.statics.interference import interference
from inca_mj.statics.robot import static_robot
from inca_mj.statics.stiffness import stiffness
from inca_mj.statics.tensions import distribute, nearest
from inca_mj.statics.vibration import coupled_modes
from inca_mj.statics.workspace import NAMES, workspace

TRIAL = parameter_set("trial")
ROBOT = static_robot(TRIAL, INCA)
AT = inverse(ROBOT.start, INCA)
CONNECTOR = ROBOT.start[:3] + AT.arms[0]
LOAD = np.array([0.5, 0.0, -1.0, 0.0, 0.0, 0.0])


def least(function: Callable[[], object], rounds: int) -> float:
    """Least processor time of a call [ms]; short calls are timed ten at once."""
    best, together = float("inf"), 10 if rounds > 10 else 1
    for _ in range(max(1, rounds // together)):
        begin = time.process_time()
        for _ in range(together):
            function()
        best = min(best, (time.process_time() - begin) / together)
    return 1e3 * best


def timings() -> dict[str, float]:
    """Each call, with the least of its times [ms]."""
    w, K = ROBOT.weight, ROBOT.lambda_ / ROBOT.no_load
    many = np.tile(ROBOT.start, (1000, 1))
    calls: dict[str, tuple[Callable[[], object], int]] = {
        "tensions, closed form": (lambda: nearest(AT.W, w), 300),
        "tensions, limits not active": (lambda: distribute(AT.W, w, 1.0, 20.0), 300),
        "tensions, limits active": (lambda: distribute(AT.W, w, 3.9, 20.0), 300),
        "rank and closure": (lambda: closure(AT.W), 30),
        "stiffness matrix": (lambda: stiffness(AT, ROBOT.tension, K), 100),
        "equilibrium under a load": (lambda: equilibrium(ROBOT, load=LOAD), 20),
        "interference, 1000 poses": (lambda: interference(many, INCA), 5),
        "catenary of one cable": (
            lambda: hang(INCA.A[0], CONNECTOR, ROBOT.no_load[0], 1e-3, 25000.0), 30),
        "handle and swinging cables": (
            lambda: coupled_modes(ROBOT, ROBOT.start, AT, ROBOT.tension, 1e-3), 5),
        **{f"workspace {kind}, 24 cells": (lambda kind=kind: workspace(kind, ROBOT), 3)
           for kind in NAMES},
    }  # fmt: skip
    return {name: round(least(*call), 3) for name, call in calls.items()}


def figures(folder: Path) -> None:
    """Write the figures of the documents."""
    from inca_mj.rendering.graphics import choose_backend

    choose_backend()
    from inca_mj.rendering.workspace_picture import workspace_picture
    from inca_mj.report.statics import cable_mass_figure, frequency_figure, slices_figure
    from inca_mj.workflows.statics import analyse_statics

    found = analyse_statics()
    save_png(slices_figure(ROBOT, found, tuple(NAMES)), folder / "workspace_slices.png")
    save_png(cable_mass_figure(found), folder / "cable_length.png")
    save_png(frequency_figure(found), folder / "cable_frequencies.png")
    space = workspace("feasible", ROBOT, cells=32)
    workspace_picture(space, folder / "workspace.png", TRIAL, INCA, tension=ROBOT.tension)


def table(folder: Path) -> None:
    """Write the table of docs/cable_mass.md as JSON lines, over masses, tensions and poses."""
    poses = np.array([ROBOT.start, [0.4, 0.4, 1.0, 0, 0, 0], [0.0, 0.0, 2.0, 0, 0, 0]])
    rows = [
        {"rho": e.rho, "tension": e.tension, "pose": e.pose.tolist(), "length": e.length,
         "angle": e.angle, "force": e.force, "force_half": e.force_half,
         "sag": e.sag,
         "stiffness_lost": e.stiffness_lost, "moved": e.moved,
         "moved_angle": e.moved_angle}
        for e in line_errors(ROBOT, poses)
    ]  # fmt: skip
    text = "\n".join(json.dumps(row) for row in rows)
    (folder / "cable_mass.jsonl").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--figures", type=Path, help="folder for the figures of the documents")
    parser.add_argument("--table", type=Path, help="folder for the table of the mass of cables")
    chosen = parser.parse_args()
    if chosen.figures is not None:
        figures(chosen.figures)
    if chosen.table is not None:
        table(chosen.table)
    if chosen.figures is None and chosen.table is None:
        print(json.dumps(timings(), indent=1))
