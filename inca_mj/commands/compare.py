"""inca compare LOG: measured against simulated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, note, output_field, table
from inca_mj.commands.common import Robot, do_not_draw, robot_field

if TYPE_CHECKING:
    from inca_mj.workflows.comparison import Comparison


@dataclass(frozen=True)
class Compare:
    """Lay a measured log over the twin's prediction from the same currents.

    Examples:
        inca compare examples/log.csv --out out/compare
        inca compare examples/log.csv --param K_t=0.085 --json
    """

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """Log to explain: CSV (with a TOML beside it) or MATLAB .mat with u, y, Ts."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Compare, say and keep the result; 0 unless the input is bad."""
        do_not_draw()
        from inca_mj.twin.logs import read_inca_log
        from inca_mj.workflows.comparison import compare

        result = compare(
            read_inca_log(self.log),
            self.robot.parameters(),
            self.robot.place(),
            timestep=self.robot.step,
        )
        conclude(self, result.to_json(), summary(result), partial(keep, result))
        if self.output.out is not None:
            note(f"figure, report, model and result.json are in {self.output.out}")
        return 0


def summary(result: Comparison) -> str:
    """The comparison as a text table; an output that never moves has no fit."""
    from identification.estimation.metrics import mean_fit

    rows = [
        (name, "-" if fit != fit else f"{fit:.2f}", f"{1e3 * error:.2f}")
        for name, fit, error in zip(
            result.log.output_names, result.fit_percent, result.rms, strict=True
        )
    ]
    head = f"{result.log.name}: {len(result.log)} samples, {result.log.duration:g} s simulated"
    return (
        head + "\n" + table(("output", "fit [%]", "rms [mrad]"), rows)
        + f"\nmean fit {mean_fit(result.fit_percent)}, mean rms {1e3 * result.rms.mean():.2f} mrad"
    )  # fmt: skip


def keep(result: Comparison, out: Path) -> None:
    """Write the figure, the one-file report, the model and the run into a folder."""
    from identification.report.page import save_figures, write_report
    from inca_mj.report.sections import compare_section, compare_verdict, model_section
    from inca_mj.twin.run import save_run

    sections = [compare_section(result), model_section(result.run.twin)]
    save_figures(sections, out)
    result.run.twin.save(out / "model.xml")
    save_run(result.run, out / "run.npz")
    write_report(
        out / "report.html",
        f"{result.log.name}: measured against simulated",
        compare_verdict(result),
        sections,
    )
