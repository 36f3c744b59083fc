"""Why does a simulation of a log fail? What a user wrote is asked before the model's step.

A factor in the TOML of a log that is wrong by some powers of ten, or a start far from the log's
first sample, drives a model so hard that no step is short enough. Either is named where the same
model with the same step simulates the log well without it. Nothing is asked of a simulation that
does not fail, so that no right log is blamed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from identification.logs.log import Log
from identification.robot.robot import Robot
from identification.robot.start_words import given_apart

LARGE = 10.0  # a factor from here on is asked; a smaller one makes no step too long by itself


def blamed(robot: Robot, is_good: Callable[[Robot], bool]) -> str | None:
    """Returns what makes the simulation of a log fail, and the cure; None where neither does."""
    for other, said in (*_without_factors(robot), *_without_start(robot)):
        if is_good(other):
            return said
    return None


def _without_factors(robot: Robot) -> Iterator[tuple[Robot, str]]:
    """Yields the robot whose log lacks one large factor, or all of them, and the advice."""
    log, column = robot.log, robot.file.columns
    given = {n: f for n, f in log.factors.items() if abs(f) >= LARGE and n in log.columns}
    for names in [*([n] for n in given), *([[*given]] if len(given) > 1 else [])]:
        told = " and ".join(f"{given[n]:g} of {column.get(n, n)}" for n in names)
        largest = max(float(np.abs(log.columns[n]).max()) for n in names)
        yield (
            _started(replace(robot, log=_divided(log, {n: given[n] for n in names}))),
            f"log {log.name!r}: its TOML gives the factor {told} under [factors], which makes"
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
