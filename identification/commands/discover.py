"""identification discover ROBOT LOG: what the model of any robot lacks."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from identification.commands.common import conclude
from identification.commands.robots import OnRobot

if TYPE_CHECKING:
    from identification.robot.repetition import Repetition


@dataclass(frozen=True)
class Discover(OnRobot):
    """Find what the model lacks and prove it on unseen data, or say that it is unknown.

    Examples:
        identification discover models/emps.toml log.csv --out out/emps
        identification discover robot.toml a.csv b.csv --confirm c.csv --out out/mine
    """

    options: Annotated[Path | None, tyro.conf.arg(metavar="PATH")] = None
    """TOML file of options: min_proof_t = 3.0, without = ["add_pair"], ... (docs/discovery.md)."""

    def run(self) -> int:
        """Discover, confirm, say, keep."""
        from identification.discovery.options import read_options

        options = None if self.options is None else read_options(self.options)
        robot = self.read()  # before the imports that are slow: a wrong file is refused at once
        from identification.report.discovery_json import discovery_to_json
        from identification.report.discovery_report import write_discovery_report
        from identification.report.discovery_text import discovery_text
        from identification.robot.confirmation import confirm
        from identification.robot.discovery import discover
        from identification.robot.reading import doubtful
        from identification.robot.repetition import find_repetitions
        from identification.robot.write import write_robot

        found = discover(robot, progress=self.output.tell, options=options)
        # Over a horizon the report has the errors of every record already.
        pairs = confirm(robot, found) if found.horizon is None else ()
        repeated = find_repetitions(robot)
        told = [*doubtful(robot), *map(str, (*pairs, *repeated))]
        record = {
            **_with_repetitions(discovery_to_json(found), repeated),
            "confirm": [vars(c) for c in pairs], "remarks": list(robot.remarks),
        }  # fmt: skip

        def keep(out: Path) -> None:
            has = {
                n for each in found.named for n in (*each.candidate.sizes, *each.candidate.fixed)
            }
            final = found.final.values
            values = {n: v for n, v in final.items() if n in {*found.nominal.values, *has}}
            own, place = found.final.own_values, self.output.out or out
            write_robot(robot, values, out / "robot.toml", place, own_values=own)

        draw = self._timed(partial(write_discovery_report, found, sentences=told))
        conclude(self, record, "\n".join([discovery_text(found), *told]), keep, draw)
        return 0

    def _timed(self, draw: Callable[..., object]) -> Callable[[Path], None]:
        """Returns what draws figures and report into a folder, and says how long it took."""
        from identification.progress import duration

        def timed(out: Path) -> None:
            self.output.tell("drawing the report")
            begun = time.monotonic()
            draw(folder=out)
            drawn = duration(time.monotonic() - begun)
            self.output.tell(f"report and figures took {drawn}, beside the search")

        return timed


def _with_repetitions(record: dict[str, Any], repeated: Sequence[Repetition]) -> dict[str, Any]:
    """Returns the record of a discovery with the findings about repetitions of the fitted data."""
    return {
        **record,
        "located": [*record.get("located", []), *map(str, repeated)],
        "findings": [*record.get("findings", []), *(r.finding for r in repeated)],
    }
