"""inca linearize: A, B, C, D at a pose or along a log, modes, and a model over the workspace."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, table
from identification.commands.linearize import save_systems
from identification.errors import InputError, unknown_name
from identification.storage.files import check_file
from inca_mj.commands.common import Robot, do_not_draw

if TYPE_CHECKING:
    import numpy as np

    from identification.linear.gridded import GriddedSystem

MOST = 200  # points of one axis of a grid


@dataclass(frozen=True, kw_only=True)
class Linearize:
    """Linearise the robot: the thesis' 36 states, the minimal ones, its modes, and an LPV model.

    Examples:
        inca linearize --pose 0.2 0 1.3 0 0 0 --out out/linear
        inca linearize --grid x=-0.4:0.4:5 y=-0.4:0.4:5 z=1:1.8:5 --out out/lpv
    """

    pose: Annotated[tuple[float, ...], tyro.conf.arg(metavar="X Y Z ROLL PITCH YAW")] = ()
    """Where currents hold the robot [m, rad]; its start when not given."""
    log: Annotated[Path | None, tyro.conf.arg(metavar="LOG")] = None
    """Log under whose currents the twin runs, to be linearised at --time."""
    time: Annotated[tuple[float, ...], tyro.conf.arg(metavar="SECONDS")] = ()
    """Times of the log."""
    rate: Annotated[float | None, tyro.conf.arg(metavar="HZ")] = None
    """Samples a second of the discrete model [Hz]; that of the log, or 100."""
    grid: Annotated[tuple[str, ...] | None, tyro.conf.arg(metavar="NAME=LOW:HIGH:POINTS")] = None
    """Axes of an LPV model, of x y z [m] roll pitch yaw [rad]."""
    interpolation: Literal["linear", "cubic"] = "cubic"
    """Between the points of the grid."""
    robot: Robot = Robot()
    output: Output = Output()

    def run(self) -> int:
        """Linearise, say, keep."""
        self._refuse_unclear()
        do_not_draw()
        from inca_mj.report.linear import (
            HANDLE_HEAD,
            grid_sentences,
            grid_to_json,
            handle_rows,
            model_sections,
            model_sentences,
            model_to_json,
        )

        models, labels, rate = self._models()
        record: dict[str, Any] = {"models": [model_to_json(m, rate) for m in models]}
        lines = []
        for model, label in zip(models, labels, strict=True):
            lines += [*model_sentences(model, label), table(HANDLE_HEAD, handle_rows(model))]
        grid = None
        if self.grid:
            grid, errors, runs = self._grid(models[0], rate)
            record["grid"] = grid_to_json(grid, errors, runs)
            lines += grid_sentences(errors, runs)
        verdict = [line for line in lines if "\n" not in line]
        conclude(
            self, record, "\n".join(lines), partial(keep, models, rate, grid),
            lambda out: draw_report(
                out, "The robot linearised", verdict, model_sections(models, labels, rate)
            ),
        )  # fmt: skip
        return 0

    def _refuse_unclear(self) -> None:
        """Refuse options that make no sense, before anything heavy is imported."""
        from identification.linear.system import sampling_time_of
        from inca_mj.robot.parameters import pose_values

        if self.grid == ():
            raise InputError(
                "--grid has no axis; give one or more as NAME=LOW:HIGH:POINTS, such as --grid"
                " x=-0.4:0.4:5 z=1:1.8:5, of x y z [m] roll pitch yaw [rad]"
            )
        if self.log is not None and (self.pose or self.grid):
            other = "--pose" if self.pose else "--grid"
            raise InputError(f"--log and {other} are two ways to an operating point; give one")
        if (self.log is None) != (not self.time):
            raise InputError("--log and --time belong together; give both, or a --pose")
        if self.rate is not None:
            sampling_time_of(self.rate)
        self.robot.check()
        if self.pose:
            self.robot.parameters().with_values(pose_values(self.pose))
        grid_axes(self.grid or ())
        if self.log is not None:
            check_file(self.log)

    def _models(self) -> tuple[tuple[inca.LinearModel, ...], list[str], float]:
        """Returns the models, the names of their operating points, and the rate [Hz]."""
        from inca_mj.workflows.comparison import linearize_log

        parameters, place = self.robot.parameters(), self.robot.place()
        if self.log is None:
            model = inca.linearize(inca.build_twin(parameters, place), self.pose or None)
            label = f"held at pose {', '.join(f'{v:g}' for v in self.pose)}"
            return (model,), [label if self.pose else "at rest at its start"], self.rate or 100.0
        log = inca.read_inca_log(self.log)
        models = linearize_log(log, self.time, parameters, place, self.robot.step)
        labels = [f"at {m.time:g} s of {log.name}" for m in models]
        return models, labels, self.rate or 1 / log.sampling_time

    def _grid(self, model: inca.LinearModel, rate: float) -> tuple[GriddedSystem, Any, Any]:
        """Returns the gridded model, its errors off the grid, and a run beside the twin."""
        from inca_mj.linear.accuracy import interpolation_errors, random_points, run_error
        from inca_mj.twin.logs import POSE

        axes = grid_axes(self.grid or ())
        grid = inca.linearize_grid(model.robot, axes, self.interpolation)
        point = random_points(grid, 1, seed=1)[0]
        if self.pose:
            point = {n: v for n, v in zip(POSE, self.pose, strict=True) if n in axes}
        grid.place(point)
        errors = interpolation_errors(model.robot, grid)
        return grid, errors, (run_error(model.robot, grid, point, rate=rate),)


def keep(
    models: Sequence[inca.LinearModel], rate: float, grid: GriddedSystem | None, out: Path
) -> None:
    """Write the systems for Python and MATLAB into a folder."""
    from identification.linear.export import FORMATS

    save_systems([m.system for m in models], rate, out)
    if grid is not None:
        for end in FORMATS:
            grid.save(out / f"grid{end}")


def grid_axes(words: Sequence[str]) -> dict[str, np.ndarray]:
    """Returns the axes [m, rad] of a grid from words NAME=LOW:HIGH:POINTS, or refuses a word."""
    import numpy as np

    from inca_mj.robot.parameters import POSE

    axes: dict[str, np.ndarray] = {}
    for word in words:
        name, _, rest = word.partition("=")
        try:
            first, last, count = rest.split(":")
            low, high, points = float(first), float(last), int(count)
        except ValueError:
            raise InputError(
                f"{word!r} is not NAME=LOW:HIGH:POINTS; write e.g. --grid x=-0.4:0.4:5"
            ) from None
        if name not in POSE:
            raise unknown_name("scheduling variable", name, POSE)
        if name in axes:
            raise InputError(f"--grid gives {name} twice; give it once")
        if not 2 <= points <= MOST:
            raise InputError(f"--grid gives {points} points of {name}; give 2 to {MOST}")
        axes[name] = np.linspace(low, high, points)
    return axes
