"""A robot of which nothing is missing: its best model, with its own residual in another order.

    y* = ŷ_w + e_v,    w each window of a record, v drawn with replacement from its windows

The windows have twice the horizon, the longest over which a discovery judges, and each begins at
the state that explains it best; so all windows of a discovery lie within one. The errors keep their
colour and their size, and lose what ties them to the motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from identification import JointPlant, Log, Parameter, Plant, window_error
from identification.discovery.result import Discovery
from identification.windows.windows import windows
from robots.measured_robot import Free, MeasuredRobot
from robots.measurement import discovered

LENGTH = 2.0  # of the windows, in units of the horizon
SEEDS = 1000  # of a null: one for each record


def null_log(plant: Plant, log: Log, horizon: float, values: Mapping[str, float], seed: int) -> Log:
    """A log that the model with these values explains but for errors as large as its own.

    Args:
        plant: the model.
        log: what was measured.
        horizon: over which a discovery predicts [s].
        values: parameters that are not the plant's own.
        seed: of what is drawn.
    """
    cut = windows(log, LENGTH * horizon)
    errors = window_error(plant, log, LENGTH * horizon, values)
    drawn = np.random.default_rng(seed).integers(len(errors), size=len(errors))
    outputs = (cut.outputs - errors + errors[drawn]).reshape(-1, errors.shape[-1])
    rows = slice(0, len(outputs))
    return replace(log, time=log.time[rows], inputs=log.inputs[rows], outputs=outputs, splits={})


def best_model(robot: MeasuredRobot, own: JointPlant, found: Discovery) -> MeasuredRobot:
    """The robot whose model has the named effects: their sizes are free, their shapes fixed."""
    values = found.final.values
    shapes = {f"{e.name}.{s.name}" for e in own.effects for s in e.shapes}
    more = [n for n in values if n not in {p.name for p in robot.free}]
    sizes = [_free(own.parameters[n], values[n]) for n in more if n not in shapes]
    fixed = {**robot.fixed, **{n: values[n] for n in more if n in shapes}}
    begun = robot.started(values)
    return replace(begun, free=(*begun.free, *sizes), fixed=fixed)


def _free(p: Parameter, value: float) -> Free:
    """The size of a named effect, within the bounds that it had: those of a null may be others."""
    known = 0.5 if p.lower >= 0 < value else abs(value) or 1.0
    return Free(name=p.name, value=value, known=known, bounds=(p.lower, p.upper))


def null_of(
    robot: MeasuredRobot, plant: Plant, values: Mapping[str, float], k: int
) -> MeasuredRobot:
    """The k-th null of a robot, whose records a model with these values made."""
    seed = iter(range(SEEDS * k, SEEDS * (k + 1)))
    fit, confirm = (
        tuple(null_log(plant, log, robot.horizon, values, next(seed)) for log in logs)
        for logs in (robot.fit, robot.confirm)
    )
    return replace(robot, fit=fit, confirm=confirm)


def null_study(
    robot: MeasuredRobot, count: int, say: Callable[[str], None]
) -> Iterator[dict[str, Any]]:
    """How many nulls of a robot get a name; the record so far after each of them.

    Args:
        robot: the robot, which is discovered first.
        count: number of nulls.
        say: is told a line per step.

    Raises:
        InputError: a null is refused.
        DivergenceError: the nominal model cannot be simulated.
    """
    compiled, found, _ = discovered(robot, say)
    plant, values = found.final.plant, found.final.values
    if isinstance(plant, JointPlant):
        plant = replace(plant, steps=1)  # the steps of the model itself
    best, rows = best_model(robot, compiled.plant, found), []
    for k in range(count):
        null = null_of(best, plant, values, k)
        _, answer, seconds = discovered(null, say)
        named = [n.candidate.effect.name for n in answer.named]
        rows.append({"verdict": answer.verdict, "named": named, "seconds": seconds})
        say(f"null {k + 1} of {count}: {rows[-1]}")
        yield {
            "robot": robot.name, "records": [len(robot.fit), len(robot.confirm)],
            "count": len(rows), "nulls": list(rows),
            "with_a_name": sum(bool(row["named"]) for row in rows),
        }  # fmt: skip
