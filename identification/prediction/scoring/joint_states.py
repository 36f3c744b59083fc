"""Windows of a plant that gets states of joints, because an effect needs them.

The states that a plant has already stay as they are. Those that it gets begin at the loads of gears
and frictions (`identification.effects.plant.joint_states`), and windows do not move them yet. With
sizes of zero the outputs are the same, to the bit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from identification.effects.effect import Candidate
from identification.effects.plant.jointed import JointPlant
from identification.model.predictor import Plant
from identification.prediction.fits.model import WindowModel
from identification.windows.problem import Problem
from identification.windows.shooting import Shooting
from identification.windows.windows import extended


def plant_for(plant: Plant, candidate: Candidate) -> Plant:
    """Returns the plant with the states that an effect needs; itself where it has them."""
    if not candidate.effect.state or not isinstance(plant, JointPlant):
        return plant
    return plant.with_states_of(candidate.sizes)


def part_for(
    part: Shooting, candidate: Candidate, values: Mapping[str, float], plant: Plant | None = None
) -> Shooting:
    """Returns the windows of a record in a plant with the states that an effect needs.

    Args:
        part: the windows.
        candidate: the effect.
        values: of the parameters that differ from the plant's own.
        plant: with these states, and perhaps with others; the one with these when None.
    """
    plant = plant or plant_for(part.predictor.plant, candidate)
    if plant is part.predictor.plant:
        return part
    probes = zip(candidate.sizes, candidate.effect.sizes, strict=True)
    present = {name: size.probe for name, size in probes}
    there = {**part.predictor.fixed, **values, **candidate.fixed, **present}
    at_probe = replace(part.predictor, plant=plant, names=(), fixed=there)
    first = extended(at_probe, np.zeros(0), part.cut, part.first)
    return replace(part, predictor=replace(part.predictor, plant=plant), first=first)


def widened(moves: np.ndarray, part: Shooting) -> np.ndarray:
    """Returns moves of windows' states (W, nx), with zeros for states that the plant got since."""
    model = part.predictor.plant.model
    more = 2 * model.nv + model.na - moves.shape[1]
    return np.hstack([moves, np.zeros((len(moves), more))])


def rows_for(
    part: Shooting, d: np.ndarray, group: Sequence[Candidate], values: Mapping[str, float]
) -> tuple[Shooting, list[np.ndarray]]:
    """Returns windows in a plant for a group of candidates, and moves of their states by size.

    The sensitivity to where the states of joints begin is zero as long as sizes are, so that a
    score need not project it out; they begin at the loads that go with each candidate's shapes.

    Args:
        part: the windows.
        d: moves of their states, shape (W, nx).
        group: candidates that need states of one kind, or none.
        values: of the parameters that differ from the plant's own.

    Returns:
        The windows, and the moves: those without any candidate first.
    """
    own = part.predictor.plant
    plant = own
    for c in group:
        plant = plant_for(plant, c)
    sizes = [len(c.sizes) for c in group]
    if plant is own:
        return part, [d] * (1 + sum(sizes))
    have = own.model.na
    each = [part_for(part, c, values, plant) for c in group]
    states = each[0].first.states
    act = np.array(states.act)
    act[:, have:] = 0.0
    there = replace(each[0], first=replace(each[0].first, states=replace(states, act=act)))
    moves = [widened(d, there)]
    for one, count in zip(each, sizes, strict=True):
        begun = widened(d, there)
        begun[:, d.shape[1] :] = one.first.states.act[:, have:]
        moves += [begun] * count
    return there, moves


def model_for(model: WindowModel, candidate: Candidate) -> WindowModel:
    """Returns a fitted model in a plant with the states that an effect needs."""
    if plant_for(model.plant, candidate) is model.plant:
        return model
    fit = model.fit
    parts = tuple(part_for(p, candidate, fit.of_record(k)) for k, p in enumerate(fit.problem.parts))
    moves = tuple(widened(d, p) for d, p in zip(fit.moves, parts, strict=True))
    task = Problem(parts, fit.problem.unknowns)
    # tangents are those of the plant before: a refit makes its own
    return replace(model, fit=replace(fit, problem=task, moves=moves))
