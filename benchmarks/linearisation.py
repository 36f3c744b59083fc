"""How well the LPV model of the robot interpolates, how it predicts the twin, and what it takes.

    python benchmarks/linearisation.py          about five minutes; --quick for one

Writes benchmarks/results/linearisation.json, docs/linearisation_modes.png and
docs/linearisation_grid.png; docs/linearisation.md tells the numbers.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

import numpy as np
from matplotlib.figure import Figure

from identification.linear.gridded import gridded
from identification.linear.modes import minimal, modes
from identification.linear.operating_points import State, at_rest
from identification.report.page.style import SERIES, save_png, styled
from inca_mj.linear.accuracy import (
    BAND,
    InterpolationError,
    interpolation_errors,
    random_points,
    run_error,
)
from inca_mj.linear.linearization import linearize, linearize_grid
from inca_mj.report.linear import shape_figure
from inca_mj.twin.logs import POSE
from inca_mj.twin.twin import Twin, build_twin

ROOT = Path(__file__).parents[1]
SPAN = {"x": (-0.4, 0.4), "y": (-0.4, 0.4), "z": (1.0, 1.8)}  # cables pull everywhere [m]
POINTS, REPEATS = 30, 15


def axes(n: int) -> dict[str, np.ndarray]:
    return {name: np.linspace(*span, n) for name, span in SPAN.items()}


def worst(errors: tuple[InterpolationError, ...]) -> dict[str, float]:
    return {k: max(getattr(e, k) for e in errors) for k in ("matrix", "response", "eigenvalue")}


def no_load_error(robot: Twin, n: int, method: str) -> float:
    """The error of G where no-load lengths, and not tensions, are among the states."""
    every = [[p[k] for k in SPAN] for p in grid_points(n)]
    systems = [linearize(robot, [*p, 0, 0, 0]).system for p in every]
    grid = gridded(axes(n), systems, method)
    found = []
    for point in random_points(grid, POINTS, seed=0):
        own = linearize(robot, [point.get(name, 0.0) for name in POSE]).system.response(BAND)
        miss = np.linalg.norm(grid.at(point).response(BAND) - own, axis=(1, 2))
        found.append(float((miss / np.linalg.norm(own, axis=(1, 2))).max()))
    return max(found)


def grid_points(n: int) -> list[dict[str, float]]:
    mesh = np.meshgrid(*axes(n).values(), indexing="ij")
    return [dict(zip(SPAN, p, strict=True)) for p in np.stack(mesh, -1).reshape(-1, len(SPAN))]


def milliseconds(call: Callable[[], object]) -> dict[str, float]:
    """Median wall time and mean processor time of a call."""
    call()
    walls, begun = [], process_time()
    for _ in range(REPEATS):
        start = perf_counter()
        call()
        walls.append(1e3 * (perf_counter() - start))
    return {"wall": median(walls), "processor": 1e3 * (process_time() - begun) / REPEATS}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser grids")
    quick = parser.parse_args().quick
    robot = build_twin(visual=False)
    record: dict[str, object] = {"span": SPAN, "points": POINTS}
    grids, table, lines = {}, [], {}
    for method in ("linear", "cubic"):
        for n in (5, 9) if quick else (5, 7, 9, 13):
            grid = grids[method, n] = linearize_grid(robot, axes(n), method)
            row = {"method": method, "n": n, "spacing": 0.8 / (n - 1)}
            row |= worst(interpolation_errors(robot, grid, POINTS))
            table.append(row)
            lines.setdefault(f"tensions, {method}", []).append((row["spacing"], row["response"]))
            print(row)
    for n in (5, 9):
        error = no_load_error(robot, n, "linear")
        table.append({"method": "linear, no-load lengths", "n": n, "spacing": 0.8 / (n - 1),
                      "response": error})  # fmt: skip
        lines.setdefault("no-load lengths, linear", []).append((0.8 / (n - 1), error))
        print(table[-1])
    record["interpolation"] = table

    runs = []
    point = {"x": 0.1, "y": 0.05, "z": 1.35}
    smooth = robot.with_values({"b_c": 0.0})
    of = {"b_c = 0.005": (robot, grids["cubic", 5]),
          "b_c = 0": (smooth, linearize_grid(smooth, axes(5)))}  # fmt: skip
    for label, (one, grid) in of.items():
        for amplitude in (0.01, 0.02, 0.05, 0.1):
            found = run_error(one, grid, point, amplitude=amplitude)
            runs.append({"friction": label, **vars(found)})
            print(runs[-1])
    record["runs"] = runs

    model, grid = linearize(robot), grids["cubic", 5]
    s, start = model.system, State(*(getattr(robot.state(), f) for f in ("qpos", "qvel", "act")))
    record["milliseconds"] = {
        "linearize": milliseconds(lambda: linearize(robot)),
        "discrete": milliseconds(lambda: s.discrete(100)),
        "minimal": milliseconds(lambda: minimal(s)),
        "modes": milliseconds(lambda: modes(s)),
        "at_rest": milliseconds(lambda: at_rest(robot.model, start)),
        "grid of 125": milliseconds(partial(linearize_grid, robot, axes(5))),
        "at(point)": milliseconds(lambda: grid.at(point)),
    }
    print(record["milliseconds"])
    out = ROOT / "benchmarks" / "results" / "linearisation.json"
    out.write_text(json.dumps(record, indent=1) + "\n")
    save_png(shape_figure(model), ROOT / "docs" / "linearisation_modes.png", dpi=110)
    save_png(spacing_figure(lines), ROOT / "docs" / "linearisation_grid.png", dpi=110)


@styled
def spacing_figure(errors: Mapping[str, Sequence[tuple[float, float]]]) -> Figure:
    """Returns a figure of errors of G(f) between grid points over their spacing [m], by method."""
    figure = Figure((6.5, 3.6), layout="constrained")
    axis = figure.subplots()
    for k, (label, pairs) in enumerate(errors.items()):
        x, y = zip(*pairs, strict=True)
        axis.loglog(x, y, "o-", color=SERIES[k], label=label)
    axis.set(xlabel="spacing of the grid [m]", ylabel="largest relative error of G(f)")
    axis.legend(fontsize=8)
    return figure


if __name__ == "__main__":
    main()
