"""Errors of several models on the same windows of the same records, and the mean squares' change.

e_w = y_w - ŷ_w,   each model from the first state of each window that explains it best

Of a long record only parts are predicted, spread over it and the same for every model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from identification import (
    InputError,
    JointPlant,
    Log,
    Plant,
    estimate_windows,
    read_robot,
    window_error,
)
from robots.measured_robot import Apart, Errors, MeasuredRobot
from robots.written import write_model

MOST = 60  # windows of a record that are predicted: an arm of six joints takes a second for each
PARTS = 6  # of a record that has more


def errors_of(
    plant: Plant,
    values: Mapping[str, float],
    own: Mapping[str, Mapping[str, float]] | None = None,
) -> Errors:
    """The window errors of a plant with some values.

    Args:
        plant: the model.
        values: by name, the same for all records.
        own: by record and by name, what a record has for itself.
    """
    each = own or {}
    if isinstance(plant, JointPlant):  # an effect among the values may need states of joints
        plant = plant.with_states_of(n for n, v in values.items() if v != 0)
    return lambda log, horizon: window_error(
        plant, log, horizon, {**values, **each.get(log.name, {})}
    )


def compare(models: Mapping[str, Errors], logs: Sequence[Log], horizon: float) -> dict[str, Any]:
    """Rms errors of models by record and over all, as a JSON object.

    Args:
        models: window errors by name; the first is what the others are compared with.
        logs: records that no fit has seen.
        horizon: length of the windows [s].

    Returns:
        `windows`: their number; `rms`: by model, over all windows; `change`: relative change of the
        mean square, by model; `better`: number of records on which each model is better than the
        first; `records`: rms by record and model; `outputs`: rms by model, of each output.
    """
    squares = {name: [_square(errors, log, horizon) for log in logs]
               for name, errors in models.items()}  # fmt: skip
    first, *others = squares
    by_record = {name: [float(np.mean(s)) for s in each] for name, each in squares.items()}
    every = {name: np.concatenate([s.reshape(-1, s.shape[-1]) for s in each])
             for name, each in squares.items()}  # fmt: skip
    whole = {name: float(s.mean()) for name, s in every.items()}
    return {
        "horizon": horizon,
        "windows": int(sum(len(s) for s in squares[first])),
        "rms": {name: s**0.5 for name, s in whole.items()},
        "outputs": {name: np.sqrt(s.mean(0)).tolist() for name, s in every.items()},
        "change": {name: whole[name] / whole[first] - 1 for name in others},
        "better": {
            name: sum(b < a for a, b in zip(by_record[first], by_record[name], strict=True))
            for name in others
        },
        "records": {
            log.name: {name: by_record[name][k] ** 0.5 for name in squares}
            for k, log in enumerate(logs)
        },
    }


def free_run(errors: Errors, log: Log, skipped: int = 0) -> float:
    """Rms error of a run over the whole record from its best first state, all outputs together.

    Args:
        errors: of the model.
        log: the record.
        skipped: samples at its beginning that are not counted.
    """
    error = errors(log, log.duration + log.sampling_time)
    return float(np.sqrt(np.mean(error[0, skipped:] ** 2)))


def _square(errors: Errors, log: Log, horizon: float) -> np.ndarray:
    """Squared errors of a record, shape (W, L, ny)."""
    found = np.concatenate([errors(part, horizon) for part in spread(log, horizon)])
    if not np.all(np.isfinite(found)):
        raise InputError(f"a model has no finite error on {log.name!r}")
    return found**2


def spread(log: Log, horizon: float) -> list[Log]:
    """The record, or parts of it with `MOST` windows together, spread evenly over it."""
    samples = round(horizon / log.sampling_time)
    count, each = len(log) // samples, MOST // PARTS
    if count <= MOST:
        return [log]
    half = 0.5 * log.sampling_time
    return [
        log.between(log.time[k * samples] - half, log.time[(k + each) * samples] - half)
        for k in np.linspace(0, count - each - 1, PARTS).astype(int)
    ]


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
