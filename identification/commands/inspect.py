"""identification inspect LOG: what is in a file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from identification.commands.common import OneLog, Output, conclude, output_field, table

if TYPE_CHECKING:
    from identification.inspection.inspected import Inspection


@dataclass(frozen=True)
class Inspect:
    """Say what is in a log: columns, units, rates, gaps, ranges, and which answers which.

    Examples:
        identification inspect run.mcap --out out/run
        identification inspect run.csv
    """

    log: OneLog
    output: Annotated[Output, tyro.conf.OmitArgPrefixes] = output_field

    def run(self) -> int:
        """Inspect, say, draw."""
        from identification.inspection.inspected import inspect_log
        from identification.inspection.words import HEAD, inspection_to_json, rows, sentences

        found = inspect_log(self.log)
        lines = [table(HEAD, rows(found)), *sentences(found)]
        lines.append(f"Next, with your model: identification new MODEL.xml {self.log}")
        conclude(self, inspection_to_json(found), "\n".join(lines), draw=partial(_draw, found))
        return 0


def _draw(found: Inspection, out: Path) -> None:
    from identification.inspection.picture import log_figure
    from identification.report.style import save_png

    save_png(log_figure(found), out / "log.png")
