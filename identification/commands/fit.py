"""python -m identification fit ROBOT LOG: estimate the parameters of any robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from identification.commands.common import (
    note,
    refuse_folder,
    say,
    say_json,
    table,
    write_result,
)
from identification.commands.robots import OnRobot

if TYPE_CHECKING:
    from identification.estimation.window_estimate import WindowEstimate
    from identification.robot.robot import Robot

FEWEST = 10  # values for each parameter
FARTHEST = 100.0  # factor from where a fit began that is hardly an estimate


@dataclass(frozen=True)
class Fit(OnRobot):
    """Estimate free parameters on the first half of a log, confirm them on the rest."""

    def run(self) -> int:
        """Fit, confirm, say, keep."""
        from identification.files import whole_folder
        from identification.robot.checks import refuse_horizon, refuse_start
        from identification.robot.confirmation import confirmed
        from identification.robot.write import write_robot

        refuse_folder(self.output.out)
        robot, records = self.read()
        _refuse_short(robot)
        refuse_horizon(robot.file, robot.log)
        if robot.file.horizon is None:
            refuse_start(robot.file, robot.plant.model, robot.log)
        record, values = self._windows(robot) if robot.file.horizon else self._free_run(robot)
        found = [confirmed(robot, log, {}, values) for log in records]
        record["confirm"] = [vars(c) for c in found]
        record["verdict"] = [*_far(record["parameters"]), *record["verdict"], *map(str, found)]
        if self.output.json:
            say_json(record)
        else:
            say(_text(record))
        if self.output.out is not None:
            with whole_folder(self.output.out) as out:
                write_robot(robot, values, out / "robot.toml", self.output.out)
                write_result(out / "result.json", self, record)
        return 0

    def _free_run(self, robot: Robot) -> tuple[dict[str, Any], dict[str, float]]:
        """By the error of a free run, the start among the free parameters or held."""
        from identification.estimation.estimation import estimate
        from identification.estimation.fit import assess
        from identification.report.fit_json import fit_to_json

        part = robot.log.part("estimation")
        found = estimate(robot.plant, part, robot.file.free, progress=note)
        return {**fit_to_json(assess(found, robot.log)), "horizon": None}, found.values

    def _windows(self, robot: Robot) -> tuple[dict[str, Any], dict[str, float]]:
        """By the errors over a horizon; every window has a start of its own."""
        from identification.estimation.window_estimate import estimate_windows
        from identification.robot.confirmation import unseen

        names = tuple(n for n in robot.file.free if n not in robot.starts)
        part, horizon = robot.log.part("estimation"), float(robot.file.horizon or 0)
        found = estimate_windows(robot.plant, part, names, horizon, progress=note)
        return _as_record(robot, found, unseen(robot, {}, found.values)), found.values


def _refuse_short(robot: Robot) -> None:
    """Refuse a log that has hardly more samples than there are parameters."""
    from identification.errors import InputError

    part, free = robot.log.part("estimation"), len(robot.file.free)
    if part.outputs.size < FEWEST * free:
        raise InputError(
            f"the log has {part.outputs.size} values to fit {free} parameters to; it needs"
            f" {FEWEST} for each: record longer, or free fewer parameters"
        )


def _far(parameters: dict[str, Any]) -> list[str]:
    """A sentence on values that no robot has."""
    far = [
        n for n, p in parameters.items()
        if p["initial"] and not 1 / FARTHEST < abs(p["value"] / p["initial"]) < FARTHEST
        and p["initial"] * p["value"] > 0
    ]  # fmt: skip
    if not far:
        return []
    return [
        f"{', '.join(far)}: more than {FARTHEST:g} times from where the fit began; the log's units"
        " and signs must be those of the model (rad or m, s, and what its actuators take)."
    ]


def _as_record(robot: Robot, found: WindowEstimate, held_out: Any) -> dict[str, Any]:
    """Windows as plain values, with the keys of a fit."""
    import numpy as np

    from identification.logs.noise import noise_floor
    from identification.report.fit_verdict import window_sentences

    floor = float(np.sqrt(np.mean(noise_floor(robot.log.outputs) ** 2)))
    rows = zip(found.values.items(), found.std, found.start, found.at_bound, strict=True)
    return {
        "parameters": {
            name: {"value": value, "std": float(std) if np.isfinite(std) else None,
                   "unit": robot.plant.parameters[name].unit, "initial": float(first),
                   "at_bound": bool(bound)}
            for (name, value), std, first, bound in rows
        },
        "rms": found.rms, "validation_rms": held_out.after, "noise_floor": floor,
        "seconds": found.seconds, "horizon": found.length,
        "verdict": [*window_sentences(found, floor), str(held_out)],
    }  # fmt: skip


def _text(record: dict[str, Any]) -> str:
    cells = [
        (name, f"{p['value']:.6g}", "unknown" if p["std"] is None else f"{p['std']:.2g}", p["unit"],
         f"{p['initial']:.6g}", "at bound" if p["at_bound"] else "")
        for name, p in record["parameters"].items()
    ]  # fmt: skip
    head = ("parameter", "value", "std", "unit", "start", "")
    return table(head, cells) + "\n" + "\n".join(record["verdict"])
