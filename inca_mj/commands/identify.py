"""inca identify LOG: estimate the twin's parameters from a log."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import tyro

from inca_mj.commands.common import (
    Output,
    Robot,
    do_not_draw,
    folder,
    note,
    output_field,
    robot_field,
    say,
    say_json,
    table,
    write_result,
)

if TYPE_CHECKING:
    from identification.fit import Fit
    from inca_mj.identify import Identification


@dataclass(frozen=True)
class Identify:
    """Estimate parameters and start pose on the first half of a log, confirm on the second."""

    log: Annotated[Path, tyro.conf.Positional]
    """Log to learn from; its TOML may name the splits estimation and validation."""
    free: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME")] = ()
    """Parameters to estimate in one step; the thesis' two-step procedure when none is named."""
    criterion: Literal["trace", "det"] = "trace"
    """Least squares, or maximum likelihood with the noise covariance estimated."""
    method: Literal["trf", "lm", "dogbox"] = "trf"
    """Search method of scipy.optimize.least_squares."""
    loss: Literal["linear", "soft_l1", "huber", "cauchy", "arctan"] = "linear"
    """Robust loss against outliers."""
    horizons: tuple[float, ...] = (0.05, 0.2, 0.5, 1.0)
    """Growing fractions of the data; 1.0 alone is a single free-run fit, as in the thesis."""
    robot: Annotated[Robot, tyro.conf.OmitArgPrefixes] = robot_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Identify, say, keep."""
        do_not_draw()
        from identification.estimation import Options
        from identification.fit_json import fit_to_json
        from inca_mj.identify import identify
        from inca_mj.logs import read_inca_log

        result = identify(
            read_inca_log(self.log),
            self.robot.parameters(),
            self.robot.place(),
            self.free,
            Options(self.method, self.criterion, self.loss, self.horizons),
            note,
            self.robot.step,
        )
        best = fit_to_json(result.fit)
        best["steps"] = [fit_to_json(fit) for fit in result.fits]
        if self.output.out is not None:
            out = folder(self.output.out)
            keep(result, out, self.robot)
            write_result(out / "result.json", self, best)
        if self.output.json:
            say_json(best)
        else:
            for k, fit in enumerate(result.fits, 1):
                say(f"step {k} of {len(result.fits)}\n{summary(fit)}\n")
            if len(result.fits) > 1:
                say(f"step {result.best + 1} predicts unseen data best.")
        return 0


def summary(fit: Fit) -> str:
    """A fit as a text table and its verdict."""
    from identification.verdict import verdict

    known = fit.estimate.predictor.plant.parameters
    rows = [
        (name, f"{value:.6g}", "unknown" if std == float("inf") else f"{std:.2g}",
         known[name].unit, f"{first:.6g}", "at bound" if bound else "")
        for (name, value), std, first, bound in zip(
            fit.estimate.values.items(), fit.std, fit.estimate.start, fit.at_bound, strict=True
        )
    ]  # fmt: skip
    return (
        table(("parameter", "value", "std", "unit", "start", ""), rows)
        + f"\nfit {fit.fit_percent.mean():.3f} %, {fit.estimate.seconds:.1f} s\n"
        + "\n".join(verdict(fit))
    )


def keep(result: Identification, out: Path, robot: Robot) -> None:
    """Write figures, the one-file report and the identified model into a folder."""
    from identification.verdict import verdict
    from inca_mj.comparison import compare
    from inca_mj.report import write_report
    from inca_mj.sections import compare_section, model_section, save_figures
    from inca_mj.sections_fit import fit_section

    plant = result.fit.estimate.predictor.plant
    final = plant.parameters.with_values(result.fit.estimate.values)
    shown = compare(result.log, final, robot.place(), timestep=robot.step)
    sections = [
        *(fit_section(fit, f"Step {k}") for k, fit in enumerate(result.fits, 1)),
        compare_section(shown),
        model_section(shown.run.twin),
    ]
    save_figures(sections, out)
    shown.run.twin.save(out / "model.xml")
    write_report(
        out / "report.html", f"{result.log.name}: identified", verdict(result.fit), sections
    )
