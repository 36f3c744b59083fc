"""The models that a discovery could not tell apart, read from what it has saved.

Where an effect is `one_of` a set, its rivals were refitted in its place, and result.json has their
sizes and shapes. Each is a model of the robot: the named effect is absent, and the rival is there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from identification.discovery.nominal_model import SHAPE_STD, NominalModel, nonzero
from identification.effects.effect import Effect
from identification.errors import InputError, unknown_name
from identification.robot.file.parameters import KNOWN
from identification.robot.robot import Robot
from identification.storage.results import read_result

LEAST_SHARE = 0.02  # of a rival: less likely ones are not worth an experiment


@dataclass(frozen=True)
class Model:
    """A model that may be right."""

    name: str  # of its effect and where it acts, in words
    share: float  # probability that it is right, as the search has said
    nominal: NominalModel  # with the effect among its free values


def read_rivals(robot: Robot, result: str | Path) -> tuple[Model, ...]:
    """Returns the models among which a discovery could not decide, the named one first.

    There are none where every name is sure, or nothing is named.

    Raises:
        InputError: the result was saved by an older version, or names an unknown effect.
    """
    record = read_result(result)
    if "effects" not in record:
        return ()
    of_set = [e for e in record["effects"] if e.get("one_of") and e["name"] != "unlisted"]
    out: list[Model] = []
    for named in of_set:
        effect = _effect(robot, named["name"])
        own = {effect.parameter(n, named["where"]) for n in effect.names}
        mine = [p for p in robot.plant.parameters.values() if p in own]
        if not out:
            # its shapes are free, as they were in the search
            model = robot.nominal_model
            shapes = [effect.parameter(s.name, named["where"]) for s in effect.shapes if s.free]
            free = _freed(model, [n for n in shapes if n not in model.names], {})
            out.append(Model(_words(named), float(named["confidence"]), free))
        for rival in named["rivals"]:
            if rival["name"] == "unlisted" or rival["confidence"] < LEAST_SHARE:
                continue
            if "values" not in rival:
                raise InputError(
                    f"{result} does not have the values of {rival['name']}, because it was saved by"
                    " an older version; run identification discover again"
                )
            other = _effect(robot, rival["name"])
            if rival["where"] in other.places:  # else it is a difference between records
                model = _instead(robot, mine, other, rival["where"], rival["values"])
                out.append(Model(_words(rival), float(rival["confidence"]), model))
    return tuple(out) if len(out) > 1 else ()


def _words(effect: Mapping[str, Any]) -> str:
    return f"{effect['name']} ({effect['where']})"


def _effect(robot: Robot, name: str) -> Effect:
    known = {e.name: e for e in robot.plant.effects}
    if name not in known:
        raise unknown_name("effect", name, known)
    return known[name]


def _instead(
    robot: Robot, mine: Sequence[str], effect: Effect, where: str, values: Mapping[str, float]
) -> NominalModel:
    """Returns the model in which an effect is there instead of the named one."""
    model, at = robot.nominal_model, robot.plant.parameters
    sizes = {n for e in robot.plant.effects for s in e.sizes for n in mine
             if n.startswith(f"{e.name}.{s.name}")}  # fmt: skip
    free = [effect.parameter(s.name, where) for s in effect.sizes if s.present is None]
    free += [effect.parameter(s.name, where) for s in effect.shapes if s.free]
    given = {n: nonzero(at[n], float(v)) if n in free else float(v) for n, v in values.items()}
    kept = [k for k, n in enumerate(model.names) if n not in mine]
    names = tuple(model.names[k] for k in kept)
    plant = robot.plant.with_values({**dict.fromkeys(sizes, 0.0), **given})
    less = replace(
        model, plant=plant, names=names, std=np.asarray(model.std)[kept],
        mean={n: v for n, v in model.mean.items() if n in names},
        own=tuple(n for n in model.own if n in names),
    )  # fmt: skip
    largest = {effect.parameter(s.name, where): s.largest for s in effect.sizes}
    return _freed(less, [n for n in free if n in given], largest)


def _freed(model: NominalModel, free: Sequence[str], largest: Mapping[str, float]) -> NominalModel:
    """Returns a model with more free values, of which no more is known than what is plausible."""
    at, std = model.plant.parameters, []
    for name in free:
        p = at[name]
        is_relative = p.lower >= 0 and p.value > 0
        width = KNOWN * largest[name] if name in largest else SHAPE_STD * (abs(p.value) or p.scale)
        std.append(max(KNOWN, width / p.value) if is_relative else width / p.scale)
    names = (*model.names, *free)
    return replace(model, names=names, std=np.concatenate([np.asarray(model.std), std]))
