"""Is a log wired as its robot's model is: each output in the unit, sign and column it is read as?

    ε = Σ ‖y - ŷ‖² / Σ ‖y - y(0)‖²      over windows, each from the state that it measured first

A model whose parameters are yet to be found may be far off, so a log is refused only where it
would be explained far better as another one: read in another unit, against its sign, with two
columns exchanged. What only a better model explains is left to the search.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from identification.coordinates import Coordinates
from identification.errors import DivergenceError, InputError
from identification.log import Log
from identification.predictor import Predictor
from identification.robot import Robot
from identification.sampling import MIN_ROWS
from identification.shooting import Shooting
from identification.units import UNITS
from identification.windows import first_states, windows

WINDOWS = 10  # of a log, where no horizon asks for longer ones
UNEXPLAINED = 0.2  # least ε of a log that is not what it says
NEARER = 0.2  # of ε, that another reading must leave


@dataclass(frozen=True)
class Reading:
    """Another way to read a log.

    Attributes:
        columns: outputs that change.
        outputs: all of them, so read, shape (N, ny).
        said: what they would be, in words.
        cure: what to do, were it so.
    """

    columns: tuple[int, ...]
    outputs: np.ndarray
    said: str
    cure: str


def refuse_miswired(robot: Robot, log: Log) -> None:
    """Refuse a log that another unit, sign or order of its columns would explain far better.

    Args:
        robot: with the values that its file gives.
        log: of the robot.

    Raises:
        InputError: there is such a reading.
    """
    own = _unexplained(robot, log)
    if own is None or not (own > UNEXPLAINED).any():
        return
    best, least = None, NEARER
    for reading in _readings(robot, log):
        columns = list(reading.columns)
        if not (own[columns] > UNEXPLAINED).all():
            continue
        left = _unexplained(robot, replace(log, outputs=reading.outputs))
        if left is not None and (ratio := float(np.max(left[columns] / own[columns]))) < least:
            best, least = (reading, own[columns], left[columns]), ratio
    if best is None:
        return
    reading, *errors = best
    before, after = (100 * max(0.0, 1 - float(e.max())) for e in errors)
    raise InputError(
        f"log {log.name!r}: the model of {robot.file.model} explains {before:.0f} % of"
        f" {' and '.join(log.output_names[k] for k in reading.columns)}, and {after:.0f} %"
        f" {reading.said}; {reading.cure}, or give values nearer to the robot's in"
        f" {robot.file.path}"
    )


def _readings(robot: Robot, log: Log) -> Iterator[Reading]:
    """Other units of the outputs that share one, other signs, exchanged columns."""
    y, n = log.outputs, log.outputs.shape[1]
    column = [robot.file.columns.get(name, name) for name in log.output_names]
    units = [log.units.get(name, "") for name in log.output_names]
    for unit in dict.fromkeys(units):
        same = tuple(k for k in range(n) if units[k] == unit)
        for word, (si, factor) in UNITS.items():
            if si != unit or factor == 1:
                continue
            told = ", ".join(f'{column[k]} = "{word}"' for k in same)
            cure = f"write {told} under [units] of the log's TOML"
            scale = [factor if k in same else 1.0 for k in range(n)]
            yield Reading(same, y * scale, f"were it in {word}", cure)
    for k in range(n):
        sign = np.where(np.arange(n) == k, -1.0, 1.0)
        cure = f"turn the sign of column {column[k]}"
        yield Reading((k,), y * sign, "with the other sign", cure)
    for i, j in combinations(range(n), 2):
        if units[i] == units[j]:
            order = [{i: j, j: i}.get(k, k) for k in range(n)]
            cure = f"exchange {column[i]} and {column[j]} under [columns]"
            yield Reading((i, j), y[:, order], "were they exchanged", cure)


def _unexplained(robot: Robot, log: Log) -> np.ndarray | None:
    """ε of each output, shape (ny,); None where the model cannot be simulated so."""
    none, length = np.zeros(0), max(robot.file.horizon or 0.0, log.duration / WINDOWS)
    if not MIN_ROWS * log.sampling_time <= length <= log.duration:
        return None  # too short to tell, and whoever fits it will say so
    cut = windows(log, length)
    predictor = Predictor(robot.plant, log, ())
    space = Coordinates((), none.astype(bool), none, none, none)
    d = np.zeros((len(cut.starts), 2 * robot.plant.model.nv + robot.plant.model.na))
    try:
        shooting = Shooting(predictor, space, cut, first_states(predictor, none, cut),
                            np.eye(log.outputs.shape[1]))  # fmt: skip
        error = shooting.error(shooting.residual(none, d))
    except DivergenceError:
        return None
    moved = np.sum((cut.outputs - cut.outputs[:, :1]) ** 2, axis=(0, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio: np.ndarray = np.sum(error**2, axis=(0, 1)) / moved
    return np.where(moved > 0, ratio, 0.0)
