"""inca crosscheck: two models of one robot that share no code must agree, at steps of its own."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, draw_report, output_field, table
from inca_mj.commands.common import Values, do_not_draw, values_field

if TYPE_CHECKING:
    from pathlib import Path

    from inca_mj.verification import CrossCheck


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
    robot: Annotated[Values, tyro.conf.OmitArgPrefixes] = values_field
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Check, say, keep; 0 when they agree, 1 when not."""
        do_not_draw()
        from inca_mj.verification import crosscheck

        result = crosscheck(
            self.robot.parameters(),
            self.robot.place(),
            duration=self.duration,
            states=self.states,
            progress=self.output.tell,
        )
        conclude(self, result.to_json(), summary(result), partial(keep, result))
        return 0 if result.passed else 1


def summary(result: CrossCheck) -> str:
    """Returns the cross-check as a text table and its verdict."""
    head = ("case", "step [ms]", "angle [rad]", "position [m]", "tension [N]")
    rows = [
        (
            str(row["case"]),
            f"{1e3 * row['step']:g}",
            *(_error(row[f"max_{what}_error"]) for what in ("angle", "position", "tension")),
        )
        for row in result.rows
    ]
    return table(head, rows) + "\n" + "\n".join(result.sentences)


def keep(result: CrossCheck, out: Path) -> None:
    """Write the figure and the one-file report into a folder."""
    from inca_mj.report.sections import crosscheck_section

    title, sections = "The twin against the reference", [crosscheck_section(result)]
    draw_report(out, title, result.sentences, sections, good=result.passed)


def _error(value: float | None) -> str:
    return "diverged" if value is None else f"{value:.2e}"
