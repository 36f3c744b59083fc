"""Sizes that physics forbids: an effect that has one is told as what was tried, and is no name.

    mass        Δm <= -m/2            a body would lose half of what the model's file says, or more
    gain        |α| T > 1/2           an input's gain would leave [1/2, 3/2] within a record
    command     τ < -T_s              outputs would move before their servo is told to
    known       |q - q̄| > 3 σ         a value of the model would leave what is known of it

m: mass of the body in the file; T: longest record, T_s: its sampling time; q̄, σ: what the user said
to be known of a value that lies within 3 σ without the effect. A std that nobody said, the default
of a robot's file, forbids nothing. Each of these sizes fits the data better than no effect, so that
something is missing that acts like it: as long as it is likelier than what is possible, the latter
is no name either.
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

Impossible = Literal["mass", "gain", "command", "known"]
IMPOSSIBLE: tuple[Impossible, ...] = get_args(Impossible)
MOST_LOST = 0.5  # of a mass: drawings leave out screws and cables, and no half of a body
MOST_DRIFT = 0.5  # of a gain: warm magnets and amplifiers lose a tenth or two
FAR = 3.0  # std of what was known: 0.3 % of a normal distribution


def find_impossible(
    candidate: Candidate, fit: Fitted, before: Fitted, logs: Sequence[Log],
    guessed: Sequence[str] = (),
) -> Impossible | None:  # fmt: skip
    """Returns what physics forbids of an effect as it was fitted; None where it may be.

    Args:
        candidate: the effect.
        fit: with it.
        before: without it.
        logs: that were fitted.
        guessed: names of values of which nobody said what is known.
    """
    name, sizes = candidate.effect.name, [*_values(candidate, fit)]
    if name == "mass_mismatch" and any(v <= -MOST_LOST * m for v, m in _masses(sizes, fit.plant)):
        return "mass"
    longest = max(log.duration for log in logs)
    if name == "gain_drift" and any(abs(v) * longest > MOST_DRIFT for _, v in sizes):
        return "gain"
    is_early = name == "time_shift" and any(v < -logs[0].sampling_time for _, v in sizes)
    if is_early and _are_servos(candidate, fit.plant):
        return "command"
    near = (n for n, d in before.distances.items() if d <= FAR and n not in guessed)
    return "known" if any(fit.distances.get(n, 0.0) > FAR for n in near) else None


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
