"""identification fit ROBOT LOG: estimate the parameters of any robot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from identification.commands.common import conclude, note, table
from identification.commands.robots import OnRobot
from identification.commands.stopping import STOPPED

WORSE = (
    "the fitted values predict unseen records worse than those of the robot's file, and are not to"
    " be used (exit code 1)"
)


@dataclass(frozen=True)
class Fit(OnRobot):
    """Estimate free parameters from one log or several, confirm them on what was not fitted.

    Examples:
        identification fit models/emps.toml log.csv --out out/fit
        identification fit robot.toml a.csv b.csv --confirm c.csv --trust units
    """

    def run(self) -> int:
        """Fit, confirm, say, keep; 1 where unseen records are predicted worse, 130 when stopped."""
        robot = self.read()  # before the imports that are slow: a wrong file is refused at once
        from identification.robot.confirmation import confirm
        from identification.robot.fit_json import robot_fit_to_json
        from identification.robot.fitting import fit
        from identification.robot.write import write_robot

        found = fit(robot, self.output.tell)
        record = robot_fit_to_json(found, confirm(robot, found))

        def keep(out: Path) -> None:
            place = self.output.out or out
            remark = record["verdict"][0] if found.is_worse or found.stopped else ""
            write_robot(robot, found.shared, out / "robot.toml", place, remark, found.own_values)

        conclude(self, record, _text(record), keep)
        if found.is_worse:
            note(f"identification: {WORSE}")
        return STOPPED if found.stopped else int(found.is_worse)


def _text(record: dict[str, Any]) -> str:
    from identification.quantities import matched, plain_unit

    cells = [
        (name, *matched(p["value"], float("inf") if p["std"] is None else p["std"]),
         plain_unit(p["unit"]), f"{p['initial']:z.6g}", "at bound" if p["at_bound"] else "")
        for name, p in record["parameters"].items()
    ]  # fmt: skip
    head = ("parameter", "value", "std", "unit", "start", "")
    first = int(record["worse"] is not None)  # a warning stands above the values it warns of
    said = record["verdict"]
    return "\n".join([*said[:first], table(head, cells), *said[first:]])
