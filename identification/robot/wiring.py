"""Is a log wired as its robot's model is: every column in its unit, with its sign, in its place?

    ε = Σ ‖y - ŷ‖² / Σ ‖y - y(0)‖²      over windows, each from the state that it measured first

A model whose parameters are yet to be found may be far off, so a log is refused only where the
model would explain it as another one, and far better: in other units, against a sign, with two
columns exchanged. What only a better model explains is left to the search.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.window_error import first_error
from identification.estimation.windows import windows
from identification.logs.log import Log
from identification.logs.names import listed
from identification.logs.sampling import MIN_ROWS
from identification.logs.units import UNITS
from identification.robot.robot import Robot

LENGTHS = (0.1, 1.0)  # of windows, shares of a log, where the robot has no horizon of its own
UNEXPLAINED = 0.05  # least ε of an output that is not what it says
NEARER = 0.2  # of ε, that another reading must leave
EXPLAINED = 0.5  # ε of all that it changes, at most


@dataclass(frozen=True)
class Reading:
    """Another way to read a log.

    Attributes:
        log: so read.
        columns: outputs that change, with it or with what an input does to them.
        said: what it would be, in words.
        cure: what to do, were it so.
    """

    log: Log
    columns: list[int]
    said: str
    cure: str


def refuse_miswired(robot: Robot, log: Log) -> None:
    """Refuse a log that other units, signs or places of its columns would explain far better.

    Args:
        robot: with the values that its file gives.
        log: of the robot.

    Raises:
        InputError: there is such a reading.
    """
    horizon = robot.file.horizon
    lengths = [share * log.duration for share in LENGTHS] if horizon is None else [horizon]
    for length in lengths:
        own = _unexplained(robot, log, length)
        if own is None or not (own > UNEXPLAINED).any():
            continue
        best, least = None, NEARER
        for reading in _readings(robot, log, own > UNEXPLAINED):
            left = _unexplained(robot, reading.log, length)
            if left is None or not (left[reading.columns] < EXPLAINED).all():
                continue
            ratio = float(np.max(left[reading.columns] / own[reading.columns]))
            if ratio < least:
                best, least = (reading, left), ratio
        if best is not None:
            raise InputError(_sentence(robot, log, *best, own))


def _sentence(robot: Robot, log: Log, reading: Reading, left: np.ndarray, own: np.ndarray) -> str:
    before, after = (100 * max(0.0, 1 - float(e[reading.columns].max())) for e in (own, left))
    return (
        f"log {log.name!r}: the model of {robot.file.model} explains {before:.0f} % of"
        f" {listed(log.output_names[k] for k in reading.columns)}, and {after:.0f} %"
        f" {reading.said}; {reading.cure}, or give values nearer to the robot's in"
        f" {robot.file.path}"
    )


def _readings(robot: Robot, log: Log, bad: np.ndarray) -> Iterator[Reading]:
    """Other readings of the outputs that are not explained, and of the inputs."""
    y, u = log.outputs, log.inputs
    column = {n: robot.file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    out, into = ([column[n] for n in names] for names in (log.output_names, log.input_names))
    wrong = np.flatnonzero(bad).tolist()
    units = [log.units.get(n, "") for n in log.output_names]
    for words in _units(units):
        changed = [k for k, word in enumerate(words) if word]
        if all(bad[changed]):
            scale = [UNITS[word][1] if word else 1.0 for word in words]
            told = ", ".join(f'{out[k]} = "{words[k]}"' for k in changed)
            said = f"were it in {' and '.join(dict.fromkeys(words[k] for k in changed))}"
            yield Reading(replace(log, outputs=y * scale), changed, said,
                          f"write {told} under [units] of the log's TOML")  # fmt: skip
    for turned in [*([k] for k in wrong), *([wrong] if len(wrong) > 1 else [])]:
        mirror = f", or of {listed(into)}" if len(turned) == y.shape[1] else ""  # looks the same
        yield Reading(replace(log, outputs=_turned(y, turned)), turned, "with the other sign",
                      f"turn the sign of {listed(out[k] for k in turned)}{mirror}")  # fmt: skip
    for k in range(u.shape[1]):
        yield Reading(replace(log, inputs=_turned(u, [k])), wrong,
                      "with the other sign of an input",
                      f"turn the sign of {into[k]}")  # fmt: skip
    for i, j in combinations(range(y.shape[1]), 2):
        if bad[i] and bad[j] and units[i] == units[j]:
            yield Reading(replace(log, outputs=_exchanged(y, i, j)), [i, j], "were they exchanged",
                          f"exchange {out[i]} and {out[j]} under [columns]")  # fmt: skip
    for i, j in combinations(range(u.shape[1]), 2):
        yield Reading(replace(log, inputs=_exchanged(u, i, j)), wrong, "were inputs exchanged",
                      f"exchange {into[i]} and {into[j]} under [columns]")  # fmt: skip


def _units(units: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Other units of the columns, "" for as it is: of all that share one, and of one alone."""
    kinds = [*dict.fromkeys(units)]
    words = {si: ["", *(w for w, (of, _) in UNITS.items() if of == si != w)] for si in kinds}
    for chosen in product(*(words[si] for si in kinds)):
        if any(chosen):
            yield tuple(chosen[kinds.index(si)] for si in units)
    for k, si in enumerate(units):
        if units.count(si) > 1:
            yield from (tuple(w * (i == k) for i in range(len(units))) for w in words[si][1:])


def _turned(signals: np.ndarray, columns: Sequence[int]) -> np.ndarray:
    return signals * np.where(np.isin(np.arange(signals.shape[1]), columns), -1.0, 1.0)


def _exchanged(signals: np.ndarray, i: int, j: int) -> np.ndarray:
    return signals[:, [{i: j, j: i}.get(k, k) for k in range(signals.shape[1])]]


def _unexplained(robot: Robot, log: Log, length: float) -> np.ndarray | None:
    """ε of each output, shape (ny,); None where nothing can be simulated so."""
    if not MIN_ROWS * log.sampling_time <= length <= log.duration:
        return None  # too short to tell, and whoever fits it will say so
    try:
        error = first_error(robot.plant, log, length)
    except DivergenceError:
        return None
    y = windows(log, length).outputs
    moved = np.sum((y - y[:, :1]) ** 2, axis=(0, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio: np.ndarray = np.sum(error**2, axis=(0, 1)) / moved
    return np.where(moved > 0, ratio, 0.0)
