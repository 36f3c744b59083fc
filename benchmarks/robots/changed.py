"""Records of a robot that was changed: what the model of the unchanged one makes of them.

A model of the changed robot predicts them with the values of the others. Where there is none, the
parameters that the change should move are fitted to these records, all others held.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from identification import JointPlant, estimate_windows, read_robot
from robots.measured_robot import Apart, MeasuredRobot
from robots.unseen import compare, errors_of
from robots.written import write_model


def on_changed(
    robot: MeasuredRobot, apart: Apart, plant: JointPlant, values: dict[str, dict[str, float]]
) -> dict[str, Any]:
    """Errors on the records of the changed robot, as a JSON object.

    Args:
        robot: the robot before it was changed.
        apart: the changed one.
        plant: of the unchanged robot.
        values: of its parameters, by what to call the model; the last is the best.

    Returns:
        `what`; `unseen` as of `robots.unseen.compare`; `refitted`: by record, values and their std
        of the parameters that were fitted to it, beside those before, and the rms error then.

    Raises:
        InputError: windows do not fit a record.
        DivergenceError: the model cannot be simulated.
    """
    if apart.model is not None:
        with TemporaryDirectory() as folder:
            path = write_model(replace(robot, model=apart.model), Path(folder))
            plant = read_robot(path, list(apart.logs)).plant
    models = {name: errors_of(plant, own) for name, own in values.items()}
    record: dict[str, Any] = {
        "what": apart.what, "unseen": compare(models, apart.logs, robot.horizon), "refitted": {}
    }  # fmt: skip
    best = [*values.values()][-1]
    for log in apart.logs if apart.refit else ():
        found = estimate_windows(plant.with_values(best), log, apart.refit, robot.horizon,
                                 tolerance=1e-4)  # fmt: skip
        std = dict(zip(found.values, found.std.tolist(), strict=True))
        record["refitted"][log.name] = {
            "values": {n: {"before": best[n], "value": v, "std": std[n]}
                       for n, v in found.values.items()},
            "rms": float(found.rms),
        }  # fmt: skip
    return record
