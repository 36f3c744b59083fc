"""How far the inputs of each record are shifted in time against its outputs.

    u(t - τ_r) in record r, all other parameters those of the model

A controller of one record may have logged its torques late, and that of another not: such a shift
is no physics of the robot, and what all records together say of it is little. Each record is asked
by itself, whether it was fitted or not. A shift is told where it is beyond its std by blocks of
windows, the number of records paid for, and where it takes away enough to matter.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.stats import t as student

from identification.discovery.findings.evidence import ShiftedRecord
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.model.coordinates import coordinates
from identification.prediction.fit import BLOCKS, WindowFit, solve
from identification.prediction.model import WindowModel
from identification.prediction.problem import Problem, no_moves, problem
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, window_scores
from identification.prediction.state import RecordsTask
from identification.prediction.unknowns import Prior

SHIFT = "time_shift"  # the effect


def shifted_records(task: RecordsTask, model: WindowModel) -> list[ShiftedRecord]:
    """The records whose inputs are shifted, those that differ most first.

    Nothing is asked where the model knows shifts already, or where no candidate is one.

    Args:
        task: the records, and the candidates.
        model: fitted.
    """
    options = task.options
    shifts = [e for e in task.effects if e.name == SHIFT]
    if not shifts or any(c.effect.name == SHIFT for c in model.candidates):
        return []
    where = next(iter(shifts[0].places))  # all inputs: a record has one clock
    candidates = [Candidate(shifts[0], where, {}, probe) for probe in shifts[0].probes]
    out = []
    for record in task.records:
        try:
            at = _alone(model, record, task.horizon)
            best = max(window_scores(at, candidates), key=lambda s: s.fall, default=None)
            if best is not None:
                out.append(_fitted(at, record, best))
        except InputError:  # the record is too short, or cannot be simulated: it tells nothing
            continue
    told = (
        s for s in out
        if s.chance * len(task.records) < options.significance and s.fall > options.min_fall
    )  # fmt: skip
    return sorted(told, key=lambda s: -s.fall)


def _alone(model: WindowModel, record: Record, horizon: float) -> WindowFit:
    """The windows of one record at the model's values, their states settled; nothing is free."""
    values = {**model.values, **model.own_values.get(record.log.name, {})}
    task = problem(model.plant, [record], Prior(), Prior(), horizon, values, model.scale)
    moves, _ = task.settled(np.zeros(0), no_moves(task), is_thorough=True)
    return solve(task, np.zeros(0), moves)


def _fitted(at: WindowFit, record: Record, score: WindowScore) -> ShiftedRecord:
    """The shift that is best for the record."""
    (name,) = score.candidate.sizes
    plant = at.problem.parts[0].predictor.plant
    space = coordinates(plant.parameters, [name], score.size, linear=[name])
    prior = Prior(space, space.encode(score.size), np.zeros(1))
    task = _with(at.problem, prior)
    found = solve(task, prior.mean, at.moves)
    shift, std = float(found.values[name]), float(found.std[0])
    blocks = min(BLOCKS, len(found.tangents[0].r))
    return ShiftedRecord(
        record=record.log.name + (" (fit)" if record.role == "fit" else ""), shift=shift, std=std,
        fall=float(1 - found.cost / at.cost),
        chance=float(2 * student.sf(abs(shift) / std, blocks - 1)) if std > 0 else 1.0,
    )  # fmt: skip


def _with(problem_: Problem, prior: Prior) -> Problem:
    (part,) = problem_.parts
    predictor = replace(part.predictor, names=prior.names)
    unknowns = replace(problem_.unknowns, shared=prior)
    return Problem((replace(part, space=prior.space, predictor=predictor),), unknowns)
