"""identification inspect LOG: what is in a file, and the robot's file to begin with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import Output, conclude, note, output_field, table

if TYPE_CHECKING:
    from identification.inspection.inspected import Inspection


@dataclass(frozen=True)
class Inspect:
    """Say what is in a log: columns, units, rates, gaps, ranges, and which answers which.

    Examples:
        identification inspect run.mcap --out out/run
        identification inspect run.csv --model arm.xml
    """

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """A log of any kind: .csv, .npz, .parquet, an episode of LeRobot, .mcap, .db3, .bag."""
    model: Annotated[Path | None, tyro.conf.arg(metavar="MODEL")] = None
    """MJCF or URDF; the robot's file to begin with is written for it."""
    robot: Annotated[Path, tyro.conf.arg(metavar="FILE")] = Path("robot.toml")
    """Where that file goes; one that exists is never replaced."""
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Inspect, say, write, draw."""
        from identification.inspection.inspected import inspect_log
        from identification.inspection.words import HEAD, inspection_to_json, rows, sentences

        found = inspect_log(self.log)
        record = inspection_to_json(found)
        lines = [table(HEAD, rows(found)), *sentences(found)]
        if self.model is not None:
            from identification.inspection.beginning import write_beginning

            path, needs = write_beginning(found, self.model, self.robot)
            for sentence in needs:
                note(sentence)
            record |= {"robot": str(path), "needs": needs}
            lines.append(f"Written: {path}; then run identification fit {path} {self.log}")
        conclude(self, record, "\n".join(lines), draw=partial(_draw, found))
        return 0


def _draw(found: Inspection, out: Path) -> None:
    from identification.inspection.picture import log_figure
    from identification.report.style import save_png

    save_png(log_figure(found), out / "log.png")
