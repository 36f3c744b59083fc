"""Sizes that physics forbids: an effect that has one is told as what was tried, and is no name.

    mass        Δm <= -m/2            a body would lose half of what the model's file says, or more
    gain        |α| T > 1/2           an input's gain would leave [1/2, 3/2] within a record
    command     τ < -T_s              outputs would move before their servo is told to

m: mass of the body in the file; T: longest record, T_s: its sampling time. Each of these sizes fits
the data better than no effect, so that something is missing that acts like it: as long as it is
likelier than what is possible, the latter is no name either.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, get_args

import mujoco

from identification.discovery.fitted import Fitted
from identification.effects.effect import Candidate
from identification.effects.jointed import JointPlant
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
    name, sizes = candidate.effect.name, [*_values(candidate, fit)]
    if name == "mass_mismatch" and any(v <= -MOST_LOST * m for v, m in _masses(sizes, fit.plant)):
        return "mass"
    longest = max(log.duration for log in logs)
    if name == "gain_drift" and any(abs(v) * longest > MOST_DRIFT for _, v in sizes):
        return "gain"
    is_early = name == "time_shift" and any(v < -logs[0].sampling_time for _, v in sizes)
    return "command" if is_early and _are_servos(candidate, fit.plant) else None


def _values(candidate: Candidate, fit: Fitted) -> Iterator[tuple[str, float]]:
    """Yields the effect's sizes by the names of the plant's parameters; all records' own ones."""
    sizes = {*candidate.sizes}
    for name, value in fit.told_values.items():
        if (size := name.partition(" [")[0]) in sizes:
            yield size, value


def _masses(sizes: Sequence[tuple[str, float]], plant: Plant) -> Iterator[tuple[float, float]]:
    """Yields each size at a body with the mass that the model's file gives this body [kg]."""
    each = {b.label: b.mass for b in plant.bodies} if isinstance(plant, JointPlant) else {}
    for name, value in sizes:
        if (mass := each.get(name.partition("@")[2])) is not None:
            yield value, mass


def _are_servos(candidate: Candidate, plant: Plant) -> bool:
    """Returns whether all inputs on which an effect acts are what servos are told."""
    at = [suffix for suffix in candidate.effect.places.values() if suffix]
    own = candidate.effect.places[candidate.where]
    rows = (plant.model.actuator(suffix[1:]).id for suffix in ([own] if own else at))
    return all(_is_servo(plant.model, int(row)) for row in rows)


def _is_servo(model: mujoco.MjModel, row: int) -> bool:
    return servo_kind(model, row) is not None and float(model.actuator_gainprm[row, 0]) != 0
