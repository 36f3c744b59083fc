"""Principal inertias of one body that are free together, and may become those of no body.

    I_k <= I_i + I_j        of every distribution of mass; flat bodies have I_k = I_i + I_j

An inertia that is free alone has bounds for this, or the other two go along with it where nothing
feels them (`identification.robot.parameters`). Bounds cannot say it of several, whose limits move
with each other; spreads of the mass can (`identification.model.spread`).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.logs.names import listed
from identification.robot.file import RobotFile
from identification.robot.robot import Robot

ROUNDING = 1e-9  # relative: a flat body lies on the limit


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
    said = []
    for p in robot.plant.parameters:
        body, inertia, _ = p.where.partition(".inertia[")
        if inertia and p.ties and p.name in robot.file.free:
            others = listed(path for path, _ in p.ties)
            said.append(
                f"Of {body} the motion feels the inertia {p.name} alone; {others}, which nothing"
                " feels, go along with it in proportion, so that it stays a body."
            )
    return " ".join(said)


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
