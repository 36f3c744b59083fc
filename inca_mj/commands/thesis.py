"""inca thesis|trials: the tables and figures of the thesis by their numbers, beside ours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from identification.commands.common import Output, conclude, draw_report, table
from inca_mj.commands.common import do_not_draw

if TYPE_CHECKING:
    from inca_mj.thesis.results import ThesisResults
    from inca_mj.thesis.trials import TrialResult

TITLE = "Modelling and identification of the INCA robot: the thesis, number by number"


@dataclass(frozen=True)
class Thesis:
    """Write one report with Tables 2.1 to 3.8 and Figures 2.16 to 3.13 of the thesis beside ours.

    Examples:
        inca thesis
        inca thesis --single --out out/thesis-single --json
    """

    seed: int = 0
    """Seed of the simulated robot that stands in for the real one, and of trial 4's noise."""
    single: bool = False
    """One free-run fit over all data, as the thesis did, instead of a growing horizon."""
    output: Output = Output(out=Path("out/thesis"))

    def run(self) -> int:
        """Compute, write, say."""
        do_not_draw()
        from identification.estimation.estimation import Options
        from inca_mj.thesis.report import thesis_json, thesis_sections, thesis_verdict
        from inca_mj.thesis.results import repeat_thesis

        options = Options(horizons=(1.0,)) if self.single else None
        found = repeat_thesis(seed=self.seed, options=options, progress=self.output.tell)
        verdict = thesis_verdict(found)
        conclude(
            self, thesis_json(found), self._text(found, verdict),
            draw=lambda out: draw_report(out, TITLE, verdict, thesis_sections(found)),
        )  # fmt: skip
        return 0

    def _text(self, found: ThesisResults, verdict: Sequence[str]) -> str:
        rows = [
            (f"trial {r.trial.number}", f"3.{r.trial.number + 2}", f"3.{r.trial.number + 3}",
             f"{r.trial.thesis_fit:.2f}", f"{r.output_fit_percent.mean():.4f}")
            for r in found.trials
        ]  # fmt: skip
        said = table(("", "Table", "Figure", "thesis: fit [%]", "ours [%]"), rows)
        said += "\n" + "\n".join(verdict[2:])
        if self.output.out is not None:
            said += f"\nThe report is {self.output.out / 'report.html'}"
        return said


@dataclass(frozen=True)
class Trials:
    """Run the thesis' four identification trials from its own starts.

    Examples:
        inca trials --trial 1 2
        inca trials --trial 4 --monte-carlo 20 --out out/trials
    """

    trial: tuple[int, ...] = (1, 2, 3, 4)
    """Which trials."""
    seed: int = 0
    """Seed of the noise of trial 4."""
    monte_carlo: int = 0
    """Repeat trial 4 with so many seeds: bias, std and coverage of the 95 %% intervals."""
    single: bool = False
    """One free-run fit over all data, as the thesis did, instead of a growing horizon."""
    output: Output = Output()

    def run(self) -> int:
        """Run, say, keep."""
        do_not_draw()
        from identification.errors import refuse_negative
        from identification.estimation.estimation import Options
        from inca_mj.thesis.trials import monte_carlo, trials

        refuse_negative("--monte-carlo", self.monte_carlo)  # before trials that take minutes
        options = Options(horizons=(1.0,)) if self.single else None
        results = trials(self.trial, seed=self.seed, options=options, progress=self.output.tell)
        record: dict[str, object] = {"trials": [r.to_json() for r in results]}
        if self.monte_carlo:
            record["monte_carlo"] = monte_carlo(self.monte_carlo, progress=self.output.tell)
        text = "\n\n".join(summary(r) for r in results)
        if self.monte_carlo:
            text += f"\n{record['monte_carlo']}"
        conclude(self, record, text)
        return 0


def summary(result: TrialResult) -> str:
    """Returns a trial as the thesis' table with a column of ours."""
    from identification.report.fit.verdict import fit_verdict

    shown = result.to_json()
    rows = [
        (
            name,
            f"{p['true']:.6g}",
            f"{p['initial']:.6g}",
            f"{p['thesis']:.6g}",
            f"{p['estimated']:.8g}",
            "-" if p["fit_percent"] is None else f"{p['fit_percent']:.5f}",
        )
        for name, p in shown["parameters"].items()
    ]
    return (
        f"trial {result.trial.number}: output fit {result.output_fit_percent.mean():.5f} %"
        f" (thesis {result.trial.thesis_fit} %), loss {result.loss:.3g},"
        f" {result.fit.estimate.seconds:.1f} s\n"
        + table(("parameter", "true", "start", "thesis", "ours", "fit [%]"), rows)
        + "\n"
        + "\n".join(fit_verdict(result.fit))
    )
