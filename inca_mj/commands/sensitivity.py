"""inca sensitivity [LOG]: what a log can say about parameters, before a fit."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, output_field, say, say_json, table, write_result
from inca_mj.commands.common import Robot, do_not_draw, robot_field

if TYPE_CHECKING:
    import numpy as np

    from identification.estimation.information import Information


@dataclass(frozen=True)
class Sensitivity:
    """Which parameters the angles can tell, how well, and which only together."""

    log: Annotated[Path | None, tyro.conf.Positional] = None
    """Log whose currents are taken; the thesis' PRBS when none is given."""
    free: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")] = (
        "lambda", "b", "J", "b_v", "b_c", "beta",
    )  # fmt: skip
    """Parameters to look at; the start pose is taken as unknown too."""
    noise: float | None = None
    """Std of the noise on each motor angle [rad]; seen in the log, or 6.7e-4 without one."""
    duration: float = 5.0
    """Length of the PRBS [s]; a log has its own."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Analyse, say, keep."""
        do_not_draw()
        from identification.estimation.experiment import Experiment, information
        from identification.files import whole_folder
        from inca_mj.report.sections_information import information_json, information_verdict
        from inca_mj.twin.logs import ANGLES
        from inca_mj.twin.twin import build_twin
        from inca_mj.workflows.comparison import timestep_for
        from inca_mj.workflows.identification import POSE

        currents, sampling, hold, sigma, about = self._experiment()
        robot = build_twin(
            self.robot.parameters(),
            self.robot.place(),
            timestep=timestep_for(sampling, self.robot.step),
        )
        trial = Experiment(robot, currents, sampling, ANGLES, sigma, hold)
        found = information(trial, self.free, [n for n in POSE if n not in self.free])
        record = {"noise": sigma, **information_json(found)}
        if self.output.out is not None:
            with whole_folder(self.output.out) as out:
                keep(found, about, out)
                write_result(out / "result.json", self, record)
        if self.output.json:
            say_json(record)
        else:
            say(summary(found) + "\n" + "\n".join([about, *information_verdict(found)]))
        return 0

    def _experiment(self) -> tuple[np.ndarray, float, str, float, str]:
        """Currents, sampling time [s], hold, noise [rad], and what they are in words."""
        import numpy as np

        from identification.logs.noise import noise_floor
        from inca_mj.robot.inputs import make_input
        from inca_mj.twin.logs import read_inca_log

        if self.log is None:
            sigma = 6.7e-4 if self.noise is None else self.noise
            about = f"{self.duration:g} s of the thesis' PRBS, noise {sigma:.3g} rad."
            return make_input("prbs", self.duration), 0.01, "zoh", sigma, about
        log = read_inca_log(self.log)
        floor = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2)))
        sigma = floor if self.noise is None else self.noise
        about = f"The currents of {log.name}, {log.duration:g} s, noise {sigma:.3g} rad."
        return log.inputs, log.sampling_time, log.hold, sigma, about


def summary(found: Information) -> str:
    """The ranking with the least std of every parameter."""
    std = dict(zip(found.names, zip(found.std, found.conditional, strict=True), strict=False))
    return table(
        ("parameter", "std", "others known"),
        [(name, f"{std[name][0]:.3g}", f"{std[name][1]:.3g}") for name in found.ranking],
    )


def keep(found: Information, about: str, out: Path) -> None:
    """Write the figure and the one-file report into a folder."""
    from identification.report.page import save_figures, write_report
    from inca_mj.report.sections_information import information_section, information_verdict

    sections = [information_section(found, about)]
    save_figures(sections, out)
    write_report(
        out / "report.html", "What an experiment can say", information_verdict(found), sections
    )
