"""Read a user's robot from its files, and check it against its logs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

from identification.effects.axes import axes
from identification.effects.effect import Effect
from identification.errors import InputError, refuse_kind
from identification.logs.log import Log
from identification.logs.plausible import still_sentence
from identification.logs.repeats import repeats_told
from identification.logs.wrapped import doubted_jumps
from identification.quantities import quantity
from identification.refusals.crossed import late_sentence
from identification.refusals.far_angles import far_angles
from identification.refusals.limits import refuse_limits
from identification.refusals.same_units import wanted_units
from identification.refusals.touching import (
    find_touches,
    is_contradicted,
    refuse_touching,
    told_first,
    touch_sentence,
)
from identification.refusals.trust import trusted
from identification.refusals.wiring import refuse_different_units, refuse_miswired
from identification.robot.blame import refuse_absurd_start
from identification.robot.file.checks import with_judged_gaps
from identification.robot.file.file import RobotFile, read_robot_file, with_spread
from identification.robot.file.start import (
    apart_sentence,
    made_up_sentence,
    start_sentence,
    unused_sentence,
)
from identification.robot.file.unread_inputs import inputs_told
from identification.robot.free_swing import carried_sentence, inertias_sentence, without_untold
from identification.robot.robot import Robot, read_robot_log, robot_of
from identification.robot.step_error import refuse_coarse_steps
from identification.shares import percent

LEAST = 0.01  # of an input's rms: less is cut off by the noise of a measured input at its limit


def read_robot(
    path: str | Path,
    log: str | Path | Log | Sequence[str | Path | Log],
    confirm: Sequence[str | Path | Log] = (),
    trust: Sequence[str] = (),
    spread: str = "usual",
    own_effects: Sequence[Effect] = (),
) -> Robot:
    """Read a robot and the logs that it is to explain; refuse files that do not belong together.

    Args:
        path: path of its TOML, which names the model (`docs/robot/keys.md` lists every key).
        log: what was measured: a CSV (with a TOML beside it), a MATLAB file with u, y and Ts, or a
            `Log` whose columns bear the names of the model's actuators and sensors. Several of
            them are fitted together.
        confirm: records of the same robot to which nothing will be fitted.
        trust: judgements that are not to refuse a log, beside those of the file's key `trust`:
            words of `identification.refusals.trust.TRUST`.
        spread: of values that are alike: "usual" for that of the file's [spread] tables, "none" for
            no deviations from their common values, or the path of a TOML with such tables.
        own_effects: candidates of your own, which a search tries beside those of the catalogue.

    Raises:
        InputError: a file cannot be what it should be, a name is unknown, a sensor froze, no
            sensor measures a free or ball joint, bodies touch all along logs which contradict this,
            the model's steps are too coarse for the log's noise, or another unit, sign or order of
            a log's columns would explain it far better.
        DivergenceError: the model cannot be simulated.
    """
    refuse_kind(path, (str, Path), "read_robot takes the path of a robot's TOML")
    for records, of in ((log, "log"), (confirm, "confirm")):
        _refuse_records(records, of)
    file = read_robot_file(path)
    file = replace(file, trust=(*file.trust, *trusted(trust, "given as trust")))
    file = with_spread(file, spread)
    given = [log] if isinstance(log, str | Path | Log) else [*log]
    records = tuple(_log(file, record) for record in confirm)
    first, *others = (_log(file, each) for each in given)
    read_from = tuple(None if isinstance(each, Log) else Path(each) for each in (*given, *confirm))
    robot = without_untold(robot_of(file, first, others, records, own_effects))
    every = (robot.log, *robot.others, *records)
    touches = find_touches(robot, every)
    refuse_touching(robot, every, touches)  # no step is short enough for a body inside another
    contradicted = is_contradicted(robot, every, touches)
    text = touch_sentence(robot, every, touches, contradicted)
    wraps = (doubted_jumps(measured.remarks) for measured in every)
    with told_first(text if contradicted else "", *wraps):
        for measured in every:  # nor for degrees that are taken for radians, in one of two columns
            refuse_different_units(robot, measured)
        model, far = robot.plant.model, [log for log in every if far_angles(robot.plant.model, log)]
        for measured in far:  # nor in both
            refuse_miswired(robot, measured)
            refuse_limits(robot.file, model, False, measured, whatever=True)
        refuse_coarse_steps(robot)
        refuse_absurd_start(robot)
        for record in records:
            axes(model, record, file.trust)  # a sensor that froze is refused
        for measured in every:
            if not any(measured is log for log in far):
                refuse_miswired(robot, measured)
    robot = replace(robot, touches=text, read_from=read_from)
    return replace(robot, remarks=_remarks(robot, every))


def clipped_sentence(model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on the input of which most is cut off; None where none is."""
    worst, share, wanted = "", LEAST, wanted_units(model, log)
    for name, u in zip(log.input_names, log.inputs.T, strict=True):
        actuator = model.actuator(name)
        if not actuator.ctrllimited[0]:
            continue
        low, high = map(float, actuator.ctrlrange)
        off = u - np.clip(u, low, high)
        if np.linalg.norm(off) > share * np.linalg.norm(u):
            share = float(np.linalg.norm(off) / np.linalg.norm(u))
            unit = log.units.get(name, "")
            farthest = float(u[np.argmax(np.abs(off))])
            part = percent(float(np.mean(off != 0)))
            cure = "widen ctrlrange in the model if they reached the robot as they were logged"
            angle = np.deg2rad(u)
            if wanted.get(name) == "rad" and (np.clip(angle, low, high) == angle).all():
                cure += ", or give their unit under [units] of the log's TOML if they are degrees"
            worst = (
                f"Of the samples of {name!r} in log {log.name!r}, {part} lie beyond the"
                f" actuator's ctrlrange {low:g} to {high:g}, such as"
                f" {quantity(farthest, unit=unit)}, and MuJoCo clips them; {cure}."
            )  # fmt: skip
    return worst or None


def _refuse_records(records: object, of: str) -> None:
    """Refuse what is neither a path nor a log, nor several of them."""
    what = f"{of} of read_robot takes paths of files or Logs (read_log)"
    one = isinstance(records, (str, Path, Log))
    if of == "confirm" and one:
        raise InputError(f"{what} in a list; write confirm=[...] around it")
    if of == "log" and isinstance(records, Sequence) and not len(records):
        raise InputError(f"{what}, and none is given; give at least one")
    refuse_kind(records, (str, Path, Log, Sequence), what)
    for each in [] if one else records:  # type: ignore[attr-defined]
        refuse_kind(each, (str, Path, Log), what)


def doubtful(robot: Robot) -> list[str]:
    """Returns sentences of the remarks on which a result depends, to stand beside it.

    They say that a free run of the robot's log begins elsewhere than the log does, in short, that
    outputs stand still or repeat samples, that nothing reads columns which look like inputs, that
    the model clips inputs, and that its geoms touch.
    """
    text = None
    if robot.file.horizon is None:
        text = made_up_sentence(robot.file, robot.plant.model, robot.log)
    fitted = (robot.log, *robot.others)
    still = (still_sentence(log) for log in fitted)
    clipped = (clipped_sentence(robot.plant.model, log) for log in fitted)
    told = (
        told for log in fitted for of in (inputs_told, repeats_told) for told in of(log.remarks)
    )
    return [*filter(None, (text, *still, *told, *clipped, robot.touches))]


def _remarks(robot: Robot, logs: Sequence[Log]) -> tuple[str, ...]:
    """Returns what was taken for granted, a sentence each."""
    file, model = robot.file, robot.plant.model
    if file.horizon is None:
        starts = [of(file, model, log) for log in logs for of in (start_sentence, apart_sentence)]
    else:  # each window begins where it was measured
        starts = [unused_sentence(file, model, robot.log)]
    inertias = (inertias_sentence(file), carried_sentence(robot))
    still = (still_sentence(log) for log in logs)
    resampled = (remark for log in logs for remark in log.remarks)
    clipped = (clipped_sentence(model, log) for log in logs)
    late = (late_sentence(file, model, log) for log in logs)
    of_logs = (*still, *resampled, *clipped, *late, *starts, robot.touches)
    return tuple(filter(None, (*robot.remarks, *inertias, *of_logs)))


def _log(file: RobotFile, log: str | Path | Log) -> Log:
    return with_judged_gaps(file, log if isinstance(log, Log) else read_robot_log(file, log))
