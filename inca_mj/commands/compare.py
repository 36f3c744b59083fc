"""inca compare LOG, inca crosscheck: the twin beside a measured log, and beside the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

import inca_mj as inca
from identification.commands.common import Output, conclude, draw_report, flat, note, table
from inca_mj.commands.common import SavedRobot, Trust, Values, do_not_draw

if TYPE_CHECKING:
    from identification import Log
    from inca_mj.verification.check import CrossCheck


@dataclass(frozen=True)
class Compare:
    """Lay a measured log over the twin's prediction from the same currents.

    A log in other units, or whose encoders or currents are exchanged or turned, or with a dead
    encoder, is refused; --trust shows it all the same.

    Examples:
        inca compare examples/log.csv --out out/compare
        inca compare examples/log.csv --model out/discover --json
    """

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Log to explain: CSV (with a TOML beside it) or MATLAB .mat with u, y, Ts."""
    trust: Trust = ()
    """Checks of the log that you overrule: sensors, units, wiring."""
    robot: SavedRobot = SavedRobot()
    output: Output = Output()

    def run(self) -> int:
        """Compare, say and keep the result; 0 unless the input is bad."""
        do_not_draw()
        result = compare_with(
            self.robot, inca.read_inca_log(self.log, flat(self.trust)), flat(self.trust)
        )

        def keep(out: Path) -> None:
            result.run.twin.save(out / "model.xml")
            inca.save_run(result.run, out / "run.npz")

        def draw(out: Path) -> None:
            from inca_mj.report.sections import compare_section, compare_verdict
            from inca_mj.twin.section import model_section

            sections = [compare_section(result), model_section(result.run.twin)]
            title = f"{result.log.name}: measured against simulated"
            draw_report(out, title, compare_verdict(result), sections, data=[result.log.name])

        if conclude(self, result.to_json(), summary(result), keep, draw):
            note(f"figure, report, model and result.json are in {self.output.out}")
        return 0


def compare_with(robot: SavedRobot, log: Log, trust: Sequence[str]) -> inca.Comparison:
    """Compares a log with the robot that the options describe, or with the saved one."""
    saved = robot.saved()
    if saved is not None:
        return inca.compare_twin(log, saved, timestep=robot.step, trust=trust)
    place, step = robot.place(), robot.step
    return inca.compare(log, robot.parameters(), place, timestep=step, trust=trust)


def summary(result: inca.Comparison) -> str:
    """Returns the comparison as a text table; an output that never moves has no fit."""
    from identification.estimation.metrics import mean_fit

    rows = [
        (name, "-" if fit != fit else f"{fit:z.2f}", f"{1e3 * error:.2f}")
        for name, fit, error in zip(
            result.log.output_names, result.fit_percent, result.rms, strict=True
        )
    ]
    head = f"{result.log.name}: {len(result.log)} samples, {result.log.duration:g} s simulated"
    return (
        head + "\n" + table(("output", "fit [%]", "rms [mrad]"), rows)
        + f"\nmean fit {mean_fit(result.fit_percent)}, mean rms {1e3 * result.rms.mean():.2f} mrad"
    )  # fmt: skip


@dataclass(frozen=True)
class Crosscheck:
    """Compare the MuJoCo twin with the reference ODE; exit 1 when they disagree.

    Examples:
        inca crosscheck
        inca crosscheck --set simulation --duration 5 --states 1000
    """

    duration: float = 10.0
    """Length of each run [s]."""
    states: int = 10_000
    """Random states at which accelerations are compared."""
    robot: Values = Values()
    output: Output = Output()

    def run(self) -> int:
        """Check, say, keep; 0 when they agree, 1 when not."""
        do_not_draw()
        from inca_mj.verification.check import crosscheck

        result = crosscheck(
            self.robot.parameters(),
            self.robot.place(),
            duration=self.duration,
            states=self.states,
            progress=self.output.tell,
        )

        def keep(out: Path) -> None:
            from inca_mj.report.sections import crosscheck_section

            title, sections = "The twin against the reference", [crosscheck_section(result)]
            draw_report(out, title, result.sentences, sections, good=result.passed)

        conclude(self, result.to_json(), crosscheck_table(result), keep)
        return 0 if result.passed else 1


def crosscheck_table(result: CrossCheck) -> str:
    """Returns the cross-check as a text table and its verdict."""
    head = ("case", "step [ms]", "angle [rad]", "position [m]", "tension [N]")
    rows = []
    for row in result.rows:
        errors = [row[f"max_{what}_error"] for what in ("angle", "position", "tension")]
        said = ("diverged" if error is None else f"{error:.2e}" for error in errors)
        rows.append((str(row["case"]), f"{1e3 * row['step']:g}", *said))
    return table(head, rows) + "\n" + "\n".join(result.sentences)
