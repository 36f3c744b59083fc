"""inca thesis: the tables and figures of the thesis by their numbers, beside ours."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, table
from inca_mj.commands.common import do_not_draw

if TYPE_CHECKING:
    from inca_mj.thesis.results import ThesisResults


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
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = field(
        default_factory=lambda: Output(out=Path("out/thesis"))
    )

    def run(self) -> int:
        """Compute, write, say."""
        do_not_draw()
        from identification.estimation.estimation import Options
        from inca_mj.thesis.report import thesis_json
        from inca_mj.thesis.results import repeat_thesis

        options = Options(horizons=(1.0,)) if self.single else None
        found = repeat_thesis(seed=self.seed, options=options, progress=self.output.tell)
        conclude(self, thesis_json(found), self._text(found), draw=partial(draw, found))
        return 0

    def _text(self, found: ThesisResults) -> str:
        from inca_mj.thesis.report import thesis_verdict

        rows = [
            (f"trial {r.trial.number}", f"3.{r.trial.number + 2}", f"3.{r.trial.number + 3}",
             f"{r.trial.thesis_fit:.2f}", f"{r.output_fit_percent.mean():.4f}")
            for r in found.trials
        ]  # fmt: skip
        said = table(("", "Table", "Figure", "thesis: fit [%]", "ours [%]"), rows)
        said += "\n" + "\n".join(thesis_verdict(found)[2:])
        if self.output.out is not None:
            said += f"\nThe report is {self.output.out / 'report.html'}"
        return said


def draw(found: ThesisResults, out: Path) -> None:
    """Write the report and its figures as PNG."""
    from identification.report.page import save_figures, write_report
    from inca_mj.thesis.report import thesis_sections, thesis_verdict

    sections = thesis_sections(found)
    save_figures(sections, out)
    write_report(
        out / "report.html",
        "Modelling and identification of the INCA robot: the thesis, number by number",
        thesis_verdict(found),
        sections,
    )
