"""What a model leaves unexplained of a log over windows, as it is read and as it may be read.

ε of `identification.refusals.readings` is summed over windows that each begin in the state that the
log measured first. Of a long log only its beginning is judged.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from identification.effects.plant.joint_plant import JointPlant
from identification.errors import DivergenceError
from identification.logs.log import Log
from identification.logs.sampling import MIN_ROWS
from identification.refusals.readings import (
    EXPLAINED,
    NEARER,
    Reading,
    is_far_better,
    unexplained_share,
)
from identification.refusals.trust import Robot
from identification.refusals.turned_inputs import plant_of_reading
from identification.windows.window_error import first_error
from identification.windows.windows import spread, windows

MOST_WINDOWS = 60  # of a log that are simulated; a wrong reading is wrong everywhere
FEW_WINDOWS = 15  # that are simulated first of a reading with two mistakes
MARGIN = 2.0  # times as much as of all windows, that these few may leave
# Of the windows, that are simulated of each reading one after the other: squares only add up, so
# that a reading that leaves too much of a part leaves too much of all.
PARTS = (1 / 8, 1 / 2, 1.0)
# Samples of a log that are judged, from its beginning: a wrong reading is wrong everywhere, and
# each one is simulated. More are where something moves less in them than in the rest.
MOST_SAMPLES, MOVES = 20_000, 0.5  # MOVES: of the std of a column in the whole log
LENGTHS = (0.1, 1.0)  # of windows, shares of a log, where the robot has no horizon of its own


@dataclass(frozen=True)
class Judge:
    """A model over windows of one length of a log."""

    plant: JointPlant  # the model, as it begins in the log
    length: float  # of the windows [s]
    log: Log  # as it is read

    @cached_property
    def as_read(self) -> np.ndarray | None:
        """ε of the log as it is read, shape (ny,); infinite where its simulation diverges."""
        return _as_read(self.plant, self.length, self.log)

    def of(self, other: Log, most: int = MOST_WINDOWS, part: float = 1.0) -> np.ndarray | None:
        """Returns ε of the log as it may be read; see `unexplained`."""
        plant = plant_of_reading(self.plant, self.log, other)
        return unexplained(plant, self.length, other, most, part)

    def if_far_better(self, reading: Reading) -> np.ndarray | None:
        """Returns ε of a reading; None as soon as a part of the windows is not far better."""
        rest = None
        for part in PARTS:
            rest = self.of(reading.log, part=part)
            if (
                rest is None
                or self.as_read is None
                or not is_far_better(reading, rest, self.as_read)
            ):
                return None
        return rest

    def promising(self, readings: Iterable[Reading]) -> Iterator[Reading]:
        """Yields the readings that a few windows do not speak against."""
        if self.log.duration < 2 * FEW_WINDOWS * self.length:
            yield from readings
            return
        as_read = _as_read(self.plant, self.length, self.log, FEW_WINDOWS)
        for reading in readings:
            rest, k = self.of(reading.log, FEW_WINDOWS), list(reading.columns)
            if as_read is None or rest is None:
                continue
            if (rest[k] < np.minimum(EXPLAINED, NEARER * MARGIN * as_read[k])).all():
                yield reading


def unexplained(
    plant: JointPlant, length: float, log: Log, most: int = MOST_WINDOWS, part: float = 1.0
) -> np.ndarray | None:
    """Returns ε (ny,) of a model over windows of a length [s]; None where none can be simulated.

    At most so many windows are spread over the log. Of these a part is simulated; what the rest
    leaves unexplained is not counted.
    """
    if not _fits(length, log):
        return None
    try:
        error = first_error(plant, log, length, most, part)
    except DivergenceError:
        return None
    return unexplained_share(spread(windows(log, length), most).outputs, error)


def _as_read(
    plant: JointPlant, length: float, log: Log, most: int = MOST_WINDOWS
) -> np.ndarray | None:
    """Returns ε (ny,) of a log as it is read; nothing is explained where the simulation diverges.

    Angles in degrees that are read as radians often make it diverge.
    """
    found = unexplained(plant, length, log, most)
    if found is None and _fits(length, log):
        return np.full(len(log.output_names), np.inf)
    return found


def _fits(length: float, log: Log) -> bool:
    """Returns whether windows tell something of a log; whoever fits a wrong one will say so."""
    return MIN_ROWS * log.sampling_time <= length <= log.duration


def lengths_of(robot: Robot, log: Log) -> list[float]:
    """Returns the lengths of windows of a log over which a robot's model is judged [s]."""
    horizon = robot.file.horizon
    return [share * log.duration for share in LENGTHS] if horizon is None else [horizon]


def beginning(log: Log) -> Log:
    """Returns the beginning of a long log, in which every column moves as it does in all of it."""
    signals, n = np.hstack([log.inputs, log.outputs]), MOST_SAMPLES
    enough = MOVES * signals.std(axis=0)
    while n < len(log) and (signals[:n].std(axis=0) < enough).any():
        n *= 2
    if n >= len(log) or log.gaps:  # with gaps it has a horizon, and few windows are simulated
        return log
    return log.between(float(log.time[0]), float(log.time[n]))
