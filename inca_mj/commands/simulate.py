"""inca simulate: run the twin and write its log."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, table
from identification.commands.places import refuse_place
from identification.errors import InputError
from inca_mj.commands.common import SavedRobot, do_not_draw, keep_run

if TYPE_CHECKING:
    import numpy as np


USUAL_PLACE = Path("out/simulate")

OneOf = Annotated[Literal["trial", "simulation"] | None, tyro.conf.arg(metavar="trial|simulation")]


@dataclass(frozen=True)
class FigureRobot(SavedRobot):
    """A robot whose parameter set may be that of a figure."""

    set: OneOf = None  # type: ignore[assignment]
    """Parameter set: the thesis' Table 3.2 (trial, when not given) or Table 2.1 (simulation)."""


@dataclass(frozen=True)
class Simulate:
    """Run the twin and write log.csv (states and tensions) and run.npz into out/simulate.

    With --out they are written there, with figures and a report.

    Examples:
        inca simulate --input prbs --duration 5 --out out/prbs
        inca simulate --figure 2.16 --out out/figure
    """

    input: Annotated[str | None, tyro.conf.arg(metavar="step|prbs|multisine|zero|FILE")] = None
    """Currents: 2 A in motor 1 (step, when not given), PRBS, multisine, none, or those of a log."""
    duration: Annotated[float | None, tyro.conf.arg(metavar="SECONDS")] = None
    """Length of the run [s]; 10 s when not given; a FILE has its own."""
    rate: float = 100.0
    """Samples a second of the input and of what is written [Hz]; a FILE has its own."""
    seed: int = 0
    """Seed of the PRBS' and the multisine's phases."""
    figure: Annotated[str | None, tyro.conf.arg(metavar="2.16|3.2|3.3")] = None
    """A figure of the thesis: with the input, parameter set and duration that it needs."""
    force: Annotated[tuple[float, float, float] | None, tyro.conf.arg(metavar="FX FY FZ")] = None
    """Constant external force G on the platform, in the fixed frame [N]."""
    force_at: Annotated[tuple[float, float, float], tyro.conf.arg(metavar="X Y Z")] = (0, 0, 0)
    """The point b_G where the force acts, in the platform's frame [m]."""
    robot: FigureRobot = FigureRobot()
    output: Output = Output()

    def run(self) -> int:
        """Simulate, write, say."""
        do_not_draw()
        now = self._resolved()
        refuse_place(now)
        currents, sampling_time, hold = now._currents()
        if now.force is None and any(now.force_at):
            raise InputError("--force-at says where a force acts; give the force with --force")
        robot = now.robot.twin(sampling_time)
        if now.force is not None:
            robot = inca.with_force(robot, now.force, now.force_at)
        result = inca.simulate(robot, currents, sampling_time, hold_kind=hold)
        summary = {
            "samples": len(result.time),
            "seconds_simulated": float(result.time[-1]),
            "tension_min": float(result.tension.min()),
            "tension_max": float(result.tension.max()),
            "position_end": result.position[-1].tolist(),
        }
        # Figures take longer than a short run, so that they are drawn where they are asked for.
        is_drawn = self.output.out is not None or self.figure is not None
        more = (
            "figures and report.html follow" if is_drawn else "--out DIR adds figures and a report"
        )
        saved = f"log.csv, run.npz and model.xml are in {now.output.out}; {more}"
        notes = f"input {now.input}, seed {now.seed}"
        if now.figure is not None:
            notes = f"Figure {now.figure} of the thesis: {notes}, parameter set {now.robot.set}"
        if now.force is not None:
            notes += f", force {now.force} N at {now.force_at} m"
        drawn = partial(draw, result, notes) if is_drawn else None
        keep = partial(keep_run, result, f"simulated by inca simulate: {notes}")
        conclude(now, summary, _text(result), keep, drawn, saved)
        return 0

    def _resolved(self) -> Simulate:
        """Returns the command with the settings of its figure, or with the usual ones."""
        output = replace(self.output, out=self.output.out or USUAL_PLACE)
        if self.figure is None:
            robot = replace(self.robot, set=self.robot.set or "trial")
            seconds = 10.0 if self.duration is None else self.duration
            return replace(
                self, input=self.input or "step", duration=seconds, robot=robot, output=output
            )
        from inca_mj.thesis.results import figure_settings  # slow to import

        needs = figure_settings(self.figure)
        for name, given, right in (
            ("--input", self.input, needs.input),
            ("--set", self.robot.set, needs.set),
            ("--duration", self.duration, needs.duration),
        ):
            if given not in (None, right):
                raise InputError(
                    f"Figure {self.figure} is made with {name} {right}, not {given}; leave out"
                    f" {name}, or leave out --figure"
                )
        if self.robot.model is not None:
            raise InputError("--figure is of the thesis' robot; leave out --model, or --figure")
        robot = replace(self.robot, set=needs.set)
        return replace(self, input=needs.input, duration=needs.duration, robot=robot, output=output)

    def _currents(self) -> tuple[np.ndarray, float, str]:
        from inca_mj.robot.inputs import INPUTS, make_input, sampling_time_of

        given, seconds = str(self.input), float(self.duration or 0.0)
        if given in INPUTS:
            sampling_time = sampling_time_of(self.rate)
            currents = make_input(given, seconds, sampling_time, seed=self.seed)
            return currents, sampling_time, "zoh"
        if not Path(given).suffix:
            raise InputError(f"unknown input {given!r}; known: {', '.join(INPUTS)}, or a log file")
        log = inca.read_inca_log(given)
        return log.inputs, log.sampling_time, log.hold


def _text(result: inca.Run) -> str:
    from inca_mj.workflows.limits import remarks

    T = result.tension
    columns = zip(result.motor_angle[-1], T.min(axis=0), T.max(axis=0), strict=True)
    rows = [
        (str(k), f"{angle:z.3f}", f"{low:z.2f}", f"{high:z.2f}")
        for k, (angle, low, high) in enumerate(columns, 1)
    ]
    place = ", ".join(f"{x:z.4f}" for x in result.position[-1])
    return (
        table(("drive", "angle at end [rad]", "least tension [N]", "largest [N]"), rows)
        + f"\nplatform after {result.time[-1]:g} s at ({place}) m"
        + "".join(f"\n{line}" for line in remarks(result))
    )


def draw(result: inca.Run, notes: str, out: Path) -> None:
    """Write figures and the report into a folder."""
    from inca_mj.report.sections import run_section
    from inca_mj.twin.section import model_section

    sections = [run_section(result), model_section(result.twin)]
    verdict = [f"{result.time[-1]:g} s simulated, {notes}."]
    draw_report(out, "A run of the twin", verdict, sections)
