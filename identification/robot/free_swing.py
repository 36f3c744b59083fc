"""Free parameters that a log does not tell, and inertias that may become those of no body.

    M(q) q̈ + h(q, q̇) = B u,   u = 0        what acts through B u alone, such as a gear, is not felt

In a free swing or a drop test no input moves. Nothing sets how large forces are, too: where masses,
inertias, frictions and stiffnesses grow together, the motion stays as it is. Which parameters are
not felt is computed from sensitivities. Those that an input would show are held at their values,
and the rest is fitted.

    I_k <= I_i + I_j        of every distribution of mass; flat bodies have I_k = I_i + I_j

An inertia that is free alone has bounds for this, or the other two go along with it where nothing
feels them (`identification.robot.file.parameters`). Bounds cannot say it of several, whose limits
move with each other; spreads of the mass can (`identification.model.tied`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.logs.log import Log
from identification.logs.names import listed
from identification.model.coordinates import coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import sensitivity, without_effect
from identification.robot.file.file import RobotFile
from identification.robot.robot import Robot, robot_of

ROUNDING = 1e-9  # relative: a flat body lies on the limit
FEW = 100  # samples under inputs that show what inputs would tell; one step of them would do


def without_untold(robot: Robot) -> Robot:
    """Returns the robot without those free parameters that its free swing does not tell.

    A robot with an input that moves in one of the logs that are fitted is returned as it is. So is
    one with a parameter that no input would show either: it is refused where it is fitted.
    """
    logs = (robot.log, *robot.others)
    if any(log.inputs.any() for log in logs):
        return robot
    idle = set.intersection(*(_idle(robot, log) for log in logs))
    untold = idle - _idle(robot, _driven(robot.log)) if idle else set()
    file = robot.file
    untold &= set(file.by_itself)
    if not untold:
        return robot
    names = [n for n in file.free if n in untold]
    which = f"no input moves in {listed(repr(log.name) for log in logs)}, and a free swing"
    if len(names) == len(file.free):
        raise InputError(
            f"{which} does not tell {listed(names)}; free what it tells, such as the damping of a"
            f" joint, in {file.path}, or take a log with inputs that are not all zero"
        )
    model = replace(
        file,
        free=tuple(n for n in file.free if n not in untold),
        own=tuple(n for n in file.own if n not in untold),
        records={n: record for n, record in file.records.items() if n not in untold},
    )
    fitted = robot_of(model, robot.log, robot.others, robot.records, robot.own_effects)
    it, keeps = ("it", "keeps its value") if len(names) == 1 else ("they", "keep their values")
    remark = f"{which[0].upper()}{which[1:]} does not tell {listed(names)}: {it} {keeps}."
    return replace(fitted, remarks=(*fitted.remarks, remark))


def inertias_sentence(file: RobotFile) -> str:
    """Says of bodies that several of their inertias are free; empty where there is none."""
    several = {body: names for body, names in _by_body(file).items() if len(names) > 1}
    if not several:
        return ""
    free = listed(name for names in several.values() for name in names)
    spreads = listed(f"{body}.spread[0] to [2]" for body in several)
    return (
        f"{file.path} frees {free}: together they may become inertias that no body has; free"
        f" {spreads} instead, which cannot."
    )


def carried_sentence(robot: Robot) -> str:
    """Returns a sentence on inertias that go along with a free one; empty where there are none."""
    lines = []
    for p in robot.plant.parameters:
        body, inertia, _ = p.where.partition(".inertia[")
        if inertia and p.ties and p.name in robot.file.free:
            others = listed(path for path, _ in p.ties)
            lines.append(
                f"Of {body} the motion feels the inertia {p.name} alone; {others}, which nothing"
                " feels, go along with it in proportion, so that it stays a body."
            )
    return " ".join(lines)


def impossible_sentence(robot: Robot, values: Mapping[str, float]) -> str:
    """Says of bodies that no body has their fitted inertias; empty where there is none."""
    known = robot.plant.parameters.values()
    model = robot.plant.with_values({n: v for n, v in values.items() if n in known}).model
    bad = []
    for body in _by_body(robot.file):
        inertia = np.sort(model.body(body.removeprefix("body/")).inertia)
        if inertia[2] > (inertia[0] + inertia[1]) * (1 + ROUNDING):
            bad.append(body)
    if not bad:
        return ""
    return (
        f"No body has the fitted inertias of {listed(bad)}: one is larger than the other two"
        f" together. Free {listed(f'{body}.spread[0] to [2]' for body in bad)} instead."
    )


def _by_body(file: RobotFile) -> dict[str, list[str]]:
    """Returns the free parameters that are principal inertias, by body."""
    found: dict[str, list[str]] = {}
    for name in file.free:
        path = str(file.records.get(name, {}).get("path", name))
        body, inertia, _ = path.partition(".inertia[")
        if inertia and not set("*?[") & set(body):
            found.setdefault(body, []).append(name)
    return found


def _idle(robot: Robot, log: Log) -> set[str]:
    """Returns free parameters that no output of a log feels; none where it cannot be simulated."""
    names, plant = robot.file.free, robot.plant_of(log)
    values = plant.parameters.values()
    first = np.array([values[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    try:
        J = sensitivity(Predictor(plant, log, names), space, space.encode(first))
    except (DivergenceError, InputError):  # whoever fits it says why
        return set()
    found: Sequence[bool] = without_effect(J, log.outputs).tolist()
    return {name for name, idle in zip(names, found, strict=True) if idle}


def _driven(log: Log) -> Log:
    """Returns the first samples of a log, with inputs of one throughout."""
    rows = slice(0, FEW)
    inputs = np.ones_like(log.inputs[rows])
    return replace(log, time=log.time[rows], inputs=inputs, outputs=log.outputs[rows],
                   extras={}, splits={})  # fmt: skip
