"""Is a log wired as its robot's model is? What is judged, and what is never held against a log.

ε of `identification.logs.readings` is summed over windows that each begin in the state that the log
measured first. A model that lacks a payload, has gravity where there is none, or a friction three
times too small, explains a right log badly too, and may explain a wrong reading better by chance:
one that makes the motion larger makes every error of the model smaller beside it. So a log is
refused only where the balance of forces says the same (`identification.robot.balance`): no payload,
gravity, friction or mass lets the log be explained as it is read nearly as well as otherwise. Where
that balance cannot be had, the other reading must explain nearly all. Two mistakes in one log, a
sign and a unit, an exchange or another sign, are looked for where no reading with one of them is
far better, and only where the balance does not explain the log as it is read. These are many, so
that a few windows of each are simulated first, and none of a log with very many columns. Of a long
log only its beginning is judged. A motion that is too large for the forces of the drives is refused
without any simulation (`identification.robot.scale`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import chain

import mujoco
import numpy as np

from identification.effects.joint_plant import JointPlant
from identification.errors import DivergenceError, InputError
from identification.logs.double_readings import turned_exchanges, turned_units, two_turns
from identification.logs.factor_readings import factor_readings
from identification.logs.log import Log
from identification.logs.readings import (
    EXPLAINED,
    NEARER,
    SAME,
    UNEXPLAINED,
    Reading,
    input_readings,
    is_far_better,
    misread,
    output_readings,
    unexplained_share,
    unit_readings,
)
from identification.logs.sampling import MIN_ROWS
from identification.robot.balance import unbalanced_share
from identification.robot.robot import Robot
from identification.robot.same_units import different_units
from identification.robot.scale import NEEDED, rescaled, wanted_units
from identification.robot.turned_inputs import (
    all_inputs_turned,
    decided_by_forces,
    plant_of_reading,
    with_turned_ranges,
)
from identification.windows.window_error import first_error
from identification.windows.windows import spread, windows

MOST_WINDOWS = 60  # of a log that are simulated; a wrong reading is wrong everywhere
FEW_WINDOWS = 15  # that are simulated first of a reading with two mistakes
MARGIN = 2.0  # times as much as of all windows, that these few may leave
# Of the windows, that are simulated of each reading one after the other: squares only add up, so
# that a reading that leaves too much of a part leaves too much of all.
PARTS = (1 / 8, 1 / 2, 1.0)
# Inputs and outputs of a log in which two mistakes are looked for: exchanges with another sign grow
# as the third power of the columns, and for 50 joints would be simulated for half a day.
MOST_COLUMNS = 32
# Samples of a log that are judged, from its beginning: a wrong reading is wrong everywhere, and
# each one is simulated. More are where something moves less in them than in the rest.
MOST_SAMPLES, MOVES = 20_000, 0.5  # MOVES: of the std of a column in the whole log
LENGTHS = (0.1, 1.0)  # of windows, shares of a log, where the robot has no horizon of its own


def refuse_miswired(robot: Robot, log: Log) -> None:
    """Refuse a log that other units, signs or places of its columns would explain far better.

    Args:
        robot: with the values that its file gives, and what it trusts.
        log: of the robot.

    Raises:
        InputError: there is such a reading.
    """
    file, plant = robot.file, robot.plant_of(log)
    wanted = wanted_units(plant.model, log)
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    together = partial(all_inputs_turned, model=plant.model, file=file)
    is_judged = "wiring" not in file.trust
    log = _telling(log)
    lengths = lengths_of(robot, log)
    balance = _Balance(plant.model, log)
    if "units" not in file.trust and (cure := different_units(plant.model, log, column)):
        raise InputError(f'log {log.name!r}: {cure}, or write trust = ["units"] into {file.path}')
    is_small = len(column) <= MOST_COLUMNS
    is_explained = is_nearer = False
    for length in lengths:
        own = unexplained(plant, length, log)
        if own is None:
            continue
        if not (own > UNEXPLAINED).any():
            is_explained = True
            continue
        bad = own > UNEXPLAINED
        explain = partial(_of_reading, plant, length, log)
        kinds: dict[str, tuple[Callable[..., Iterable[Reading]], ...]] = {
            "units": (factor_readings, partial(unit_readings, wanted=wanted)),
            "wiring": (partial(_of_outputs, explain), input_readings,
                       *([together] if len(log.input_names) > 1 else [])),
        }  # fmt: skip
        read = (r for word, kind in kinds.items() if word not in file.trust for r in kind)
        readings = chain(*(r(log, bad, column) for r in read))
        left = partial(_if_far_better, plant, length, log, own)
        found = misread(log, own, readings, left, balance.confirms)
        if found is None and is_judged and is_small and balance.contradicts:
            units = () if "units" in file.trust else turned_units(log, bad, column, wanted)
            # Over the shorter windows only: an exchange is seen in both, and these are many.
            pairs = (two_turns, turned_exchanges) if length == lengths[0] else ()
            both = chain(units, *(pair(log, bad, column) for pair in pairs))
            near = _promising(plant, length, log, both)
            found = misread(log, own, near, left, balance.confirms)
        if is_judged:
            turns = (explain(reading.log) for reading in together(log, bad, column))
            is_nearer |= any(e is not None and (e[bad] < NEARER * own[bad]).all() for e in turns)
        if found is not None:
            raise _refusal(robot, log, *found)
    if is_judged and not is_explained and (is_nearer or balance.excludes):
        for reading in together(log, np.ones(log.outputs.shape[1], bool), column):
            if said := decided_by_forces(reading, plant.model, balance.own, log):
                raise _refusal(robot, log, reading, said)
    # The gain of a drive that wants a position is a guess, and its force with it.
    if not (is_explained or wanted or "units" in file.trust):
        found = rescaled(plant.model, log, column, is_judged and is_small, is_small)
        if found is not None:
            raise _refusal(robot, log, *found)


def _telling(log: Log) -> Log:
    """Returns the beginning of a long log, in which every column moves as it does in all of it."""
    signals, n = np.hstack([log.inputs, log.outputs]), MOST_SAMPLES
    enough = MOVES * signals.std(axis=0)
    while n < len(log) and (signals[:n].std(axis=0) < enough).any():
        n *= 2
    if n >= len(log) or log.gaps:  # with gaps it has a horizon, and few windows are simulated
        return log
    return log.between(float(log.time[0]), float(log.time[n]))


def _of_outputs(
    explain: Callable[[Log], np.ndarray | None],
    log: Log,
    bad: np.ndarray,
    column: Mapping[str, str],
) -> Iterator[Reading]:
    """Yields other signs and places of outputs, and says where inputs may be turned as well.

    All outputs turned look as all inputs turned where nothing, such as gravity, has a direction of
    its own. Whether it has is seen by trying both.
    """
    is_mirrored = False
    if bad.all() and log.inputs.any():
        of_outputs = replace(log, outputs=-log.outputs)
        of_inputs = replace(log, inputs=-log.inputs)
        one, other = explain(of_outputs), explain(of_inputs)
        is_mirrored = one is not None and other is not None and np.allclose(one, other, rtol=SAME)
    yield from output_readings(log, bad, column, is_mirrored)


def _refusal(robot: Robot, log: Log, reading: Reading, said: str) -> InputError:
    file = robot.file
    words = ", ".join(f'"{kind}"' for kind in reading.kinds)
    return InputError(
        f"log {log.name!r}: the model of {file.model} {said}, or give values nearer to the"
        f" robot's, or write trust = [{words}] into {file.path}"
    )


@dataclass(frozen=True)
class _Balance:
    """The balance of forces of a log as it is read, which other readings are compared with."""

    model: mujoco.MjModel
    log: Log

    @cached_property
    def own(self) -> np.ndarray | None:
        """η of each output, shape (ny,)."""
        return unbalanced_share(self.model, self.log)

    @property
    def contradicts(self) -> bool:
        """Whether forces do not explain the log as it is read, or say nothing of it."""
        return self.own is None or bool((self.own > UNEXPLAINED).any())

    @property
    def excludes(self) -> bool:
        """Whether forces cannot be those of the log as it is read, whatever the model lacks."""
        return self.own is not None and bool((self.own > NEEDED).any())

    def confirms(self, reading: Reading, left: np.ndarray) -> bool:
        """Returns whether forces speak for a reading that leaves ε (ny,)."""
        k = list(reading.columns)
        if self.own is None:
            return bool((left[k] < UNEXPLAINED).all())
        other = unbalanced_share(with_turned_ranges(self.model, self.log, reading.log), reading.log)
        # Together, because a joint without a drive looks the same from both sides.
        return other is not None and bool(other[k].sum() < NEARER * self.own[k].sum())


def _promising(
    plant: JointPlant, length: float, log: Log, readings: Iterable[Reading]
) -> Iterator[Reading]:
    """Yields the readings that a few windows do not speak against."""
    if log.duration < 2 * FEW_WINDOWS * length:
        yield from readings
        return
    own = unexplained(plant, length, log, FEW_WINDOWS)
    for reading in readings:
        left = _of_reading(plant, length, log, reading.log, FEW_WINDOWS)
        k = list(reading.columns)
        if own is None or left is None:
            continue
        if (left[k] < np.minimum(EXPLAINED, NEARER * MARGIN * own[k])).all():
            yield reading


def lengths_of(robot: Robot, log: Log) -> list[float]:
    """Returns the lengths of windows of a log over which a robot's model is judged [s]."""
    horizon = robot.file.horizon
    return [share * log.duration for share in LENGTHS] if horizon is None else [horizon]


def _if_far_better(
    plant: JointPlant, length: float, log: Log, own: np.ndarray, reading: Reading
) -> np.ndarray | None:
    """Returns ε of a reading; None as soon as a part of the windows is not far better."""
    of_reading = plant_of_reading(plant, log, reading.log)
    left = None
    for part in PARTS:
        left = unexplained(of_reading, length, reading.log, part=part)
        if left is None or not is_far_better(reading, left, own):
            return None
    return left


def _of_reading(
    plant: JointPlant, length: float, log: Log, other: Log, most: int = MOST_WINDOWS
) -> np.ndarray | None:
    """Returns ε of another reading of a log; see `unexplained`."""
    return unexplained(plant_of_reading(plant, log, other), length, other, most)


def unexplained(
    plant: JointPlant, length: float, log: Log, most: int = MOST_WINDOWS, part: float = 1.0
) -> np.ndarray | None:
    """Returns the share of each output that a model leaves unexplained, ε of shape (ny,).

    Args:
        plant: the model, as it begins in the log.
        length: of the windows [s].
        log: what was measured.
        most: windows, spread over the log.
        part: of these, that is simulated; what the rest leaves unexplained is not counted.

    Returns:
        None where nothing can be simulated so.
    """
    if not MIN_ROWS * log.sampling_time <= length <= log.duration:
        return None  # too short to tell, and whoever fits it will say so
    try:
        error = first_error(plant, log, length, most, part)
    except DivergenceError:
        return None
    return unexplained_share(spread(windows(log, length), most).outputs, error)
