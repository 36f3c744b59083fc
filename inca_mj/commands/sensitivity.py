"""inca sensitivity [LOG]: what a log can say about parameters, before a fit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, output_field, table
from inca_mj.commands.common import Robot, do_not_draw, robot_field

if TYPE_CHECKING:
    from identification.estimation.information import Information


@dataclass(frozen=True, kw_only=True)
class Sensitivity:
    """Which parameters the angles can tell, how well, and which only together.

    Examples:
        inca sensitivity --out out/sensitivity
        inca sensitivity examples/log.csv --free b_v b_c K_t J
    """

    log: Annotated[Path | None, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")] = None
    """Log whose currents are taken; the thesis' PRBS when none is given."""
    free: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")] = (
        "lambda", "b", "J", "b_v", "b_c", "beta",
    )  # fmt: skip
    """Parameters to look at; the start pose is taken as unknown too."""
    noise: Annotated[float | None, tyro.conf.arg(metavar="RAD")] = None
    """Std of the noise on each motor angle [rad]; seen in the log, or 6.7e-4 without one."""
    duration: float = 5.0
    """Length of the PRBS [s]; a log has its own."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Analyse, say, keep."""
        do_not_draw()
        from inca_mj.report.information import information_json, information_verdict
        from inca_mj.twin.logs import read_inca_log
        from inca_mj.workflows.sensitivity import planned_experiment, robot_information

        log = None if self.log is None else read_inca_log(self.log)
        trial = planned_experiment(
            log,
            self.robot.parameters(),
            self.robot.place(),
            noise=self.noise,
            duration=self.duration,
            timestep=self.robot.step,
        )
        found = robot_information(trial, self.free)
        what = f"{self.duration:g} s of the thesis' PRBS"
        if log is not None:
            what = f"The currents of {log.name}, {log.duration:g} s"
        about = f"{what}, noise {trial.sigma:.3g} rad."
        record = {"noise": trial.sigma, **information_json(found)}
        text = "\n".join([summary(found), about, *information_verdict(found)])
        conclude(self, record, text, draw=partial(draw, found, about))
        return 0


def summary(found: Information) -> str:
    """Returns the ranking with the least std of every parameter."""
    std = dict(zip(found.names, zip(found.std, found.conditional, strict=True), strict=False))
    return table(
        ("parameter", "std", "others known"),
        [(name, f"{std[name][0]:.3g}", f"{std[name][1]:.3g}") for name in found.ranking],
    )


def draw(found: Information, about: str, out: Path) -> None:
    """Write the figure and the one-file report into a folder."""
    from identification.report.page import save_figures, write_report
    from inca_mj.report.information import information_section, information_verdict

    sections = [information_section(found, about)]
    save_figures(sections, out)
    write_report(
        out / "report.html", "What an experiment can say", information_verdict(found), sections
    )
