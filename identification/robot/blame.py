"""Why does a simulation of a log fail? What a user wrote is asked before the model's step.

A factor in the TOML of a log that is wrong by some powers of ten, or a start far from the log's
first sample, drives a model so hard that no step is short enough. Either is named where the same
model with the same step simulates the log well without it. Nothing is asked of a simulation that
does not fail, so that no right log is blamed. A search over a horizon diverges at values that
nobody has written, so that there all factors are named, as what may be wrong.

A start is refused by itself where it is so far from the log that it is a slip of the pen:

    |given - begin| > 1000 max(|y|_max, 1)        in the unit of the state

A robot whose sensors count from elsewhere than its model may be some metres or turns apart from
where its log begins, but not a kilometre, and not a thousand times as far as it was ever measured.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.log import Log
from identification.model.plant import start_place
from identification.model.predictor import output_columns
from identification.refusals.far_angles import far_sentence
from identification.robot.file.start import given_apart, measured_begin
from identification.robot.robot import Robot

FAR = 1e3  # of the largest number of the log, or of one unit
LARGE = 10.0  # a factor from here on is asked; a smaller one makes no step too long by itself


def blamed(robot: Robot, is_good: Callable[[Robot], bool]) -> str | None:
    """Returns what makes the simulation of a log fail, and the cure; None where neither does."""
    for other, said in (*_without_factors(robot), *_without_start(robot)):
        if is_good(other):
            return said
    return None


@contextmanager
def told_of_factors(robot: Robot) -> Iterator[None]:
    """Adds to a divergence of the block the factors of the robot's logs, or where the step is."""
    try:
        yield
    except DivergenceError as error:
        raise DivergenceError(f"{error}. {_next_step(robot)}") from error


def refuse_absurd_start(robot: Robot) -> None:
    """Refuse a start of a free run that is beyond all that the log measured."""
    file, model, log = robot.file, robot.plant.model, robot.log
    if file.horizon is not None or not file.start:
        return
    begins, sensors = measured_begin(model, log), output_columns(model, log.output_names)
    for path, said in given_apart(file, model, log).items():
        place = start_place(path, model)
        begin = begins[place]  # type: ignore[index]
        is_measured = place in sensors
        largest = _largest(log, begin.output, is_measured)
        if abs(file.start[path] - begin.value) > FAR * max(largest, 1.0):
            raise InputError(
                f"start in {file.path}: it gives {said}, more than {FAR:g} times as much as log"
                f" {log.name!r} ever shows; correct {path}, or delete it to begin where the log"
                " does"
            )


def _next_step(robot: Robot) -> str:
    file = robot.file
    where = (
        f"The step is timestep in <option> of {file.model}, and the nominal values are those of"
        f" {file.path}"
    )
    logs = (robot.log, *robot.others, *robot.records)
    given = [said for log in logs for said in _factors(log, robot)]
    far = [far_sentence(robot.plant.model, log, file.columns) for log in logs]
    said = [*filter(None, (*far[:1], _turned(robot)))]
    where = " ".join([*(f"{one[:1].upper()}{one[1:]}." for one in said), where])
    if not given:
        return where
    it = "it is" if len(given) == 1 else "they are"
    return f"First see whether {it} right: {'; '.join(given)}. {where}"


def _turned(robot: Robot) -> str:
    """Returns in words that all drives are turned, "" where torques do not tell it."""
    if "wiring" in robot.file.trust:
        return ""
    from identification.robot.turned_drives import turned_drives  # slow to import

    try:
        return turned_drives(robot)
    except (InputError, np.linalg.LinAlgError):  # what diverged is told in any case
        return ""


def _factors(log: Log, robot: Robot) -> list[str]:
    """Returns the factors of a log that change the size of its numbers, and what they make."""
    column = robot.file.columns
    return [
        f"the factor {f:g} of {column.get(n, n)} under [factors] for log {log.name!r}, which makes"
        f" numbers up to {float(np.abs(log.columns[n]).max()):.3g}"
        for n, f in log.factors.items()
        if abs(f) != 1 and n in log.columns
    ]


def _largest(log: Log, output: str, is_measured: bool) -> float:
    """Returns the largest number of an output, or of its rate where that is not measured."""
    y = log.outputs[:, log.output_names.index(output)]
    return float(np.abs(y if is_measured else np.diff(y) / log.sampling_time).max())


def _without_factors(robot: Robot) -> Iterator[tuple[Robot, str]]:
    """Yields the robot whose log lacks one large factor, or all of them, and the advice."""
    log, column = robot.log, robot.file.columns
    given = {n: f for n, f in log.factors.items() if abs(f) >= LARGE and n in log.columns}
    for names in [*([n] for n in given), *([[*given]] if len(given) > 1 else [])]:
        text = " and ".join(f"{given[n]:g} of {column.get(n, n)}" for n in names)
        largest = max(float(np.abs(log.columns[n]).max()) for n in names)
        yield (
            _started(replace(robot, log=_divided(log, {n: given[n] for n in names}))),
            f"log {log.name!r}: its TOML gives the factor {text} under [factors], which makes"
            f" numbers up to {largest:.3g}; with these the model cannot be simulated well, and with"
            " the numbers of the log itself it can: correct the factor",
        )


def _divided(log: Log, factors: dict[str, float]) -> Log:
    """Returns a log without some of its factors."""

    def of(names: tuple[str, ...]) -> list[float]:
        return [factors.get(n, 1.0) for n in names]

    return replace(log, inputs=log.inputs / of(log.input_names),
                   outputs=log.outputs / of(log.output_names))  # fmt: skip


def _without_start(robot: Robot) -> Iterator[tuple[Robot, str]]:
    """Yields the robot begun as the log does, in one entry of its start or in all, and advice."""
    file = robot.file
    apart = given_apart(file, robot.plant.model, robot.log)
    for paths in [*([p] for p in apart), *([[*apart]] if len(apart) > 1 else [])]:
        kept = {p: v for p, v in file.start.items() if p not in paths}
        yield (
            _started(replace(robot, file=replace(file, start=kept))),
            f"log {robot.log.name!r}: [start] of {file.path} gives"
            f" {' and '.join(apart[p] for p in paths)}; from there the model cannot be simulated"
            " well, and from where the log begins it can: correct the start, or leave it out",
        )


def _started(robot: Robot) -> Robot:
    """Returns a robot whose plant begins as its file and its log say now."""
    return replace(robot, plant=robot.plant_of(robot.log))
