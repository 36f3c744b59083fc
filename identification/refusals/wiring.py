"""Is a log wired as its robot's model is? What is judged, and what is never held against a log.

A model that lacks a payload, has gravity where there is none, or a friction three times too small,
explains a right log badly too, and may explain a wrong reading better by chance: one that makes the
motion larger makes every error of the model smaller beside it. So a log is refused only where the
balance of forces says the same (`identification.refusals.balance`): no payload, gravity, friction
or mass lets the log be explained as it is read nearly as well as otherwise. Where that balance
cannot be had, the other reading must explain nearly all. A log may have two mistakes: a turned sign
together with a wrong unit, with exchanged columns, or with another turned sign. They are looked for
where no reading with one of them is far better, and only where the balance does not explain the log
as it is read. There are many pairs, so that a few windows of each are simulated first, and none of
a log with very many columns. A motion that is too
large for the forces of the drives is refused without any simulation.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import chain

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.refusals.by_forces import Balance, balanced_otherwise, rescaled
from identification.refusals.columns import (
    Doubt,
    Readings,
    factor_readings,
    input_readings,
    input_unit_readings,
    output_readings,
    turned_exchanges,
    turned_units,
    two_turns,
    unit_readings,
)
from identification.refusals.crossed import crossed_readings, is_no_late_stamp, late_pairs
from identification.refusals.far_angles import are_whole, far_angles, far_readings, far_sentence
from identification.refusals.judge import Judge, beginning, lengths_of
from identification.refusals.readings import NEARER, SAME, UNEXPLAINED, Reading, misread
from identification.refusals.same_units import different_units, drive_units, wanted_units
from identification.refusals.trust import Robot
from identification.refusals.turned_inputs import all_inputs_turned
from identification.refusals.turned_servos import turned_servos

# Inputs and outputs of a log in which two mistakes are looked for: exchanges with another sign grow
# as the third power of the columns, and for 50 joints would be simulated for half a day.
MOST_COLUMNS = 32
ENOUGH = 0.15  # ε of a usual unit, behind which no unusual one is asked


def refuse_different_units(robot: Robot, log: Log) -> None:
    """Refuse a log in which columns of one joint have another unit than they say."""
    file, log = robot.file, beginning(log)
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    cure = different_units(robot.plant_of(log).model, log, column)
    if cure and "units" not in file.trust:
        raise InputError(f'log {log.name!r}: {cure}, or write trust = ["units"] into {file.path}')


def refuse_miswired(robot: Robot, log: Log) -> None:
    """Refuse a log that other units, signs or places of its columns would explain far better."""
    file, plant = robot.file, robot.plant_of(log)
    wanted = wanted_units(plant.model, log)
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    units, wiring = ("units" not in file.trust), ("wiring" not in file.trust)
    is_small = len(column) <= MOST_COLUMNS
    log = beginning(log)
    every = Doubt.of(log, column)
    together = partial(all_inputs_turned, model=plant.model, file=file)
    in_units = partial(unit_readings, wanted=wanted)
    balance, lengths = Balance(plant.model, log), lengths_of(robot, log)
    is_far = bool(far_angles(plant.model, log))
    is_explained = is_nearer = False
    late = late_pairs(plant.model, log) if wiring and is_small else []
    for judge in (Judge(plant, length, log) for length in lengths):
        if (as_read := judge.as_read) is None:
            continue
        crossed = misread(
            log, as_read, crossed_readings(every, late), judge.if_far_better,
            partial(is_no_late_stamp, judge, late),
        )  # fmt: skip
        if crossed is not None:
            raise _refusal(robot, log, *crossed)
        diverges = not np.isfinite(as_read).all()
        if diverges and not wanted:
            continue  # forces that are no guess tell more, below
        bad = as_read > UNEXPLAINED
        if not bad.any():
            is_explained = True
            continue
        doubt, found = replace(every, bad=bad), None
        if units and is_far:
            # A servo's forces are a guess, and what diverges cannot be fitted in any case.
            for likely in far_readings(doubt, plant.model, wanted):
                found = found or misread(
                    log, as_read, likely, judge.if_far_better,
                    (lambda reading, rest: True) if diverges else balance.confirms, ENOUGH,
                )  # fmt: skip
        kinds: list[Readings] = [factor_readings, in_units] * units
        kinds += [partial(_of_outputs, judge), input_readings] * wiring
        kinds += [together] * (wiring and len(log.input_names) > 1)
        readings = chain(*(kind(doubt) for kind in kinds))
        if found is None:
            found = misread(log, as_read, readings, judge.if_far_better, balance.confirms)
        if found is None and wiring and is_small and balance.contradicts:
            two = [turned_units(doubt, wanted)] * units
            if judge.length == lengths[0]:  # an exchange is seen in all windows, and these are many
                two += [two_turns(doubt), turned_exchanges(doubt)]
            near = judge.promising(chain(*two))
            found = misread(log, as_read, near, judge.if_far_better, balance.confirms)
        if wiring and not diverges:
            turns = (judge.of(reading.log) for reading in together(doubt))
            is_nearer |= any(
                e is not None and (e[bad] < NEARER * as_read[bad]).all() for e in turns
            )
        if found is not None:
            raise _refusal(robot, log, *found)
    if units and are_whole(plant.model, log):
        raise InputError(
            f"{far_sentence(plant.model, log, column)} (they are whole numbers, which angles in"
            f' radians never are), or write trust = ["units"] into {file.path}'
        )
    if wiring and not is_explained and (is_nearer or balance.excludes):
        for reading in together(every):
            if words := balance.decides(reading):
                raise _refusal(robot, log, reading, words)
    _refuse_turned_servos(robot, every)
    # The gain of a drive that wants a position is a guess, and its force with it.
    if units and not (is_explained or wanted):
        found = rescaled(plant.model, every, wiring and is_small, is_small)
        if found is not None:
            raise _refusal(robot, log, *found)
    if not is_explained:
        refuse_unbalanced(robot, log)


def refuse_unbalanced(robot: Robot, log: Log) -> None:
    """Refuse a log whose drives' forces only another unit, sign or order of columns explains.

    Nothing is simulated: a simulation of an arm in a closed loop says little of its log, because
    what the model lacks grows over a window. Where a drive wants a position, its gain is a guess:
    its sign is told, and the unit that all angles and setpoints share where angles go far, because
    weight and the forces between joints have another course in each, whatever the gain.
    """
    file, model = robot.file, robot.plant_of(log).model
    column = {n: file.columns.get(n, n) for n in (*log.output_names, *log.input_names)}
    log = beginning(log)
    doubt, readings = Doubt.of(log, column), []
    if wanted := wanted_units(model, log):
        if "units" not in file.trust and far_angles(model, log):
            of_all = unit_readings(doubt, wanted, alone=False, together=True)
            if found := balanced_otherwise(model, doubt, of_all):
                raise _refusal(robot, log, *found)
        _refuse_turned_servos(robot, doubt)
        return
    if len(column) > MOST_COLUMNS or not log.inputs.any():
        return
    if "units" not in file.trust:
        readings += [input_unit_readings(doubt, drive_units(model, log)), unit_readings(doubt)]
    if "wiring" not in file.trust:
        readings += [input_readings(doubt), output_readings(doubt)]
    if found := balanced_otherwise(model, doubt, chain(*readings)):
        raise _refusal(robot, log, *found)


def _refuse_turned_servos(robot: Robot, doubt: Doubt) -> None:
    """Refuse a log in which the setpoint and the encoder of a servo are both turned."""
    if "wiring" in robot.file.trust or len(doubt.column) > MOST_COLUMNS:
        return
    if words := turned_servos(robot.plant_of(doubt.log).model, doubt):
        raise _refusal(robot, doubt.log, Reading(doubt.log, doubt.wrong, "", ""), words)


def _of_outputs(judge: Judge, doubt: Doubt) -> Iterator[Reading]:
    """Yields other signs and places of outputs, and says where inputs may be turned as well.

    All outputs turned look as all inputs turned where nothing, such as gravity, has a direction of
    its own. Whether it has is seen by trying both.
    """
    is_mirrored, log = False, doubt.log
    if doubt.bad.all() and log.inputs.any():
        one = judge.of(replace(log, outputs=-log.outputs))
        other = judge.of(replace(log, inputs=-log.inputs))
        is_mirrored = one is not None and other is not None and np.allclose(one, other, rtol=SAME)
    yield from output_readings(doubt, is_mirrored)


def _refusal(robot: Robot, log: Log, reading: Reading, text: str) -> InputError:
    file = robot.file
    words = ", ".join(f'"{kind}"' for kind in reading.kinds)
    return InputError(
        f"log {log.name!r}: the model of {file.model} {text}, or give values nearer to the"
        f" robot's, or write trust = [{words}] into {file.path}"
    )
