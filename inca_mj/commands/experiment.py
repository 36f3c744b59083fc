"""inca sensitivity|excite: what an experiment says of parameters, and the input that says most."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import radians
from pathlib import Path
from typing import Annotated

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, table
from inca_mj.commands.common import Robot, do_not_draw

Names = Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")]
UNKNOWN = ("lambda", "b", "J", "b_v", "b_c", "beta")


@dataclass(frozen=True, kw_only=True)
class Sensitivity:
    """Say which parameters the angles can tell, how well, and which only together.

    Examples:
        inca sensitivity --out out/sensitivity
        inca sensitivity examples/log.csv --free b_v b_c K_t J
    """

    log: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")] = None
    """Log whose currents are taken; the thesis' PRBS when none is given."""
    free: Names = UNKNOWN
    """Parameters to look at; the start pose is taken as unknown too."""
    noise: Annotated[float | None, tyro.conf.arg(metavar="RAD")] = None
    """Std of the noise on each motor angle [rad]; seen in the log, or 6.7e-4 without one."""
    duration: float = 5.0
    """Length of the PRBS [s]; a log has its own."""
    robot: Robot = Robot()
    output: Output = Output()

    def run(self) -> int:
        """Analyse, say, keep."""
        do_not_draw()
        from inca_mj.report.information import (
            information_json,
            information_section,
            information_verdict,
        )
        from inca_mj.workflows.sensitivity import planned_experiment, robot_information

        log = None if self.log is None else inca.read_inca_log(self.log)
        trial = planned_experiment(
            log, self.robot.parameters(), self.robot.place(), noise=self.noise,
            duration=self.duration, timestep=self.robot.step,
        )  # fmt: skip
        found = robot_information(trial, self.free)
        what = f"{self.duration:g} s of the thesis' PRBS"
        if log is not None:
            what = f"The currents of {log.name}, {log.duration:g} s"
        about = f"{what}, noise {trial.sigma:.3g} rad."
        record = {"noise": trial.sigma, **information_json(found)}
        std = dict(zip(found.names, zip(found.std, found.conditional, strict=True), strict=False))
        rows = [(name, *(f"{x:.3g}" for x in std[name])) for name in found.ranking]
        said = table(("parameter", "std", "others known"), rows)
        verdict, title = information_verdict(found), "What an experiment can say"
        conclude(
            self, record, "\n".join([said, about, *verdict]),
            draw=lambda out: draw_report(
                out, title, verdict, [information_section(found, about)]
            ),
        )  # fmt: skip
        return 0


@dataclass(frozen=True, kw_only=True)
class Excite:
    """Design currents that show the worst determined parameter best, inside the limits.

    Examples:
        inca excite --duration 5 --budget 60 --out out/excite
        inca excite --free b_v b_c K_t --current 0 1.5
    """

    duration: float = 5.0
    """Length of the experiment [s]."""
    noise: float = 6.7e-4
    """Std of the noise on each motor angle [rad]."""
    free: Names = UNKNOWN
    """Parameters to determine; the start pose is taken as unknown too."""
    budget: int = 60
    """Inputs to evaluate, about a second each."""
    seed: int = 0
    """Seed of the search."""
    current: tuple[float, float] = (0.0, 2.0)
    """Smallest and largest current [A]."""
    margin: float = 0.2
    """Every cable keeps more tension than this [N]."""
    reach: float = 0.35
    """The platform stays so near its start along x, y, z [m]."""
    turn: float = 60.0
    """And turns no further from its start [deg]."""
    robot: Robot = Robot()
    output: Output = Output()

    def run(self) -> int:
        """Design, say, keep."""
        do_not_draw()
        from inca_mj.report.information import design_json, design_verdict
        from inca_mj.workflows.recipes import SAMPLING

        (low, high), turn = self.current, radians(self.turn)
        limits = inca.Limits(low=low, high=high, margin=self.margin, reach=self.reach, turn=turn)
        result = inca.excite(
            self.robot.twin(SAMPLING), self.duration, noise=self.noise, free=self.free,
            limits=limits, budget=self.budget, seed=self.seed, progress=self.output.tell,
        )  # fmt: skip
        lines = [summary(result), *design_verdict(result)]
        if self.output.out is not None:
            lines.append(f"inca simulate --input {self.output.out / 'excite.csv'} replays it")
        keep_it, draw_it = partial(keep, result), partial(draw, result)
        conclude(self, design_json(result), "\n".join(lines), keep_it, draw_it)
        return 0


def summary(result: inca.Design) -> str:
    """Returns the std of every parameter under the PRBS and the design."""
    found = result.best.found
    columns = zip(found.names, result.prbs.found.std, found.std, result.gain, strict=False)
    rows = [(name, f"{a:.3g}", f"{b:.3g}", f"{gain:.2f}") for name, a, b, gain in columns]
    return table(("parameter", "std, PRBS", "std, designed", "gain"), rows)


def keep(result: inca.Design, out: Path) -> None:
    """Write the input as a log that the twin replays."""
    from identification import write_log

    notes = f"designed by inca excite: {result.best.name}, simulated"
    write_log(inca.run_to_log(result.best.run, "excite", notes), out / "excite.csv")


def draw(result: inca.Design, out: Path) -> None:
    """Write figures and the report into a folder."""
    from inca_mj.report.information import design_section, design_verdict
    from inca_mj.report.sections import run_section

    sections = [design_section(result), run_section(result.best.run)]
    draw_report(out, "An input to identify with", design_verdict(result), sections)
