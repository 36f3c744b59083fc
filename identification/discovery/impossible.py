"""Sizes that physics forbids: an effect that has one is told as what was tried, and is no name.

Searches over windows and along a free run hold to it, and so do torques (`identification.torques`).

    mass        Δm <= -m/2            a body would lose half of what the model's file says, or more
    gain        |α| T > 1/2           an input's gain would leave [1/2, 3/2] within a record
    command     τ < -T_s              outputs would move before their servo is told to

m: mass of the body in the file; T: longest record, T_s: its sampling time. Each of these sizes fits
the data better than no effect, so that something is missing that acts like it: as long as it is
likelier than what is possible, the latter is no name either.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import inf
from typing import Literal, get_args

import mujoco

from identification.discovery.fitted import Fitted
from identification.effects.effect import Candidate
from identification.effects.plant.jointed import JointPlant
from identification.logs.log import Log
from identification.model.predictor import Plant
from identification.model.tied import servo_kind

Impossible = Literal["mass", "gain", "command"]
IMPOSSIBLE: tuple[Impossible, ...] = get_args(Impossible)
MOST_LOST = 0.5  # of a mass: drawings leave out screws and cables, and no half of a body
MOST_DRIFT = 0.5  # of a gain: warm magnets and amplifiers lose a tenth or two


def find_impossible(candidate: Candidate, fit: Fitted, logs: Sequence[Log]) -> Impossible | None:
    """Returns what physics forbids of an effect as it was fitted; None where it may be.

    Args:
        candidate: the effect.
        fit: with it.
        logs: that were fitted.
    """
    name, plant = candidate.effect.name, fit.plant
    masses = {b.label: b.mass for b in plant.bodies} if isinstance(plant, JointPlant) else {}
    sizes = [(v, masses.get(n.partition("@")[2], inf)) for n, v in _values(candidate, fit)]
    return forbids(name, sizes, logs, partial(_are_servos, candidate, plant))


def forbids(
    name: str, sizes: Sequence[tuple[float, float]], logs: Sequence[Log],
    are_servos: Callable[[], bool],
) -> Impossible | None:  # fmt: skip
    """Returns what physics forbids of an effect with some sizes; None where it may be.

    Args:
        name: of the effect.
        sizes: each with the mass of its body in the model's file [kg], inf where it is of no body.
        logs: that were fitted.
        are_servos: returns whether all inputs on which it acts are what servos are told.
    """
    values = [v for v, _ in sizes]
    if name == "mass_mismatch" and any(v <= -MOST_LOST * m for v, m in sizes):
        return "mass"
    longest = max(log.duration for log in logs)
    if name == "gain_drift" and any(abs(v) * longest > MOST_DRIFT for v in values):
        return "gain"
    is_early = name == "time_shift" and any(v < -logs[0].sampling_time for v in values)
    return "command" if is_early and are_servos() else None


def _values(candidate: Candidate, fit: Fitted) -> Iterator[tuple[str, float]]:
    """Yields the effect's sizes by the names of the plant's parameters; all records' own ones."""
    sizes = {*candidate.sizes}
    for name, value in fit.told_values.items():
        if (size := name.partition(" [")[0]) in sizes:
            yield size, value


def _are_servos(candidate: Candidate, plant: Plant) -> bool:
    """Returns whether all inputs on which an effect acts are what servos are told."""
    at = [suffix for suffix in candidate.effect.places.values() if suffix]
    own = candidate.effect.places[candidate.where]
    rows = (plant.model.actuator(suffix[1:]).id for suffix in ([own] if own else at))
    return all(is_servo(plant.model, int(row)) for row in rows)


def is_servo(model: mujoco.MjModel, row: int) -> bool:
    """Returns whether the input of an actuator is a position or a rate that a servo is told."""
    return servo_kind(model, row) is not None and float(model.actuator_gainprm[row, 0]) != 0
