"""How far the inputs of each record are shifted in time against its outputs.

    u(t - τ_r) in record r, all other parameters those of the model

A controller of one record may have logged its torques late, and that of another not: such a shift
is no physics of the robot, and what all records together say of it is little. Each record is asked
by itself, whether it was fitted or not: the shift that is best for one half of its windows must
predict the other half better, beyond chance among all records and by enough to matter.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.stats import ttest_1samp

from identification.discovery.findings.evidence import ShiftedRecord
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.model.coordinates import coordinates
from identification.prediction.fit import WindowFit, solve
from identification.prediction.model import WindowModel
from identification.prediction.problem import Problem, no_moves, problem
from identification.prediction.records import Record
from identification.prediction.scores import WindowScore, window_scores
from identification.prediction.state import RecordsTask
from identification.prediction.told_std import told_std
from identification.prediction.unknowns import Prior
from identification.prediction.unseen import window_gains

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
                out.append(_told(at, record, best, model.unseen.floor))
        except InputError:  # the record is too short, or cannot be simulated: it tells nothing
            continue
    told = (
        s for s in out
        if s.chance * len(task.records) < options.significance and s.fall > options.min_fall
        and abs(s.shift) > options.min_proof_t * s.std and abs(s.shift) < shifts[0].sizes[0].largest
    )  # fmt: skip
    return sorted(told, key=lambda s: -s.fall)


def _alone(model: WindowModel, record: Record, horizon: float) -> WindowFit:
    """The windows of one record at the model's values, their states settled; nothing is free."""
    values = {**model.values, **model.own_values.get(record.log.name, {})}
    task = problem(model.plant, [record], Prior(), Prior(), horizon, values, model.scale)
    moves, _ = task.settled(np.zeros(0), no_moves(task), is_thorough=True)
    return solve(task, np.zeros(0), moves)


def _told(at: WindowFit, record: Record, score: WindowScore, floor: float) -> ShiftedRecord:
    """The best shift of the record, and what that of each of its halves makes of the other one."""
    whole = _fitted(at, np.arange(len(at.moves[0])), score)
    before, after = _squares(at), np.zeros(len(at.moves[0]))
    halves = np.array_split(np.arange(len(after)), 2)
    for mine, other in (halves, halves[::-1]):
        q = _fitted(at, mine, score).q
        there = _with(at, other, score)
        moves, _ = there.settled(q, [at.moves[0][other]], is_thorough=True)
        (r,) = there.held(q).residuals(moves)
        after[other] = np.mean(r**2, axis=1)
    gains = window_gains(before, after, floor)
    std = float(told_std(whole)[0])
    return ShiftedRecord(
        record=record.log.name + (" (fit)" if record.role == "fit" else ""),
        shift=float(whole.values[score.candidate.sizes[0]]),
        std=std if np.isfinite(std) else np.inf,
        fall=float(1 - after.mean() / before.mean()),
        chance=float(ttest_1samp(gains, 0.0, alternative="greater").pvalue),
    )  # fmt: skip


def _squares(at: WindowFit) -> np.ndarray:
    """Mean squares of the windows of the one record, shape (W,)."""
    return np.asarray(np.mean(at.tangents[0].r ** 2, axis=1))


def _fitted(at: WindowFit, rows: np.ndarray, score: WindowScore) -> WindowFit:
    """The shift that is best for some windows of the record."""
    task = _with(at, rows, score)
    return solve(task, task.prior.mean, [at.moves[0][rows]])


def _with(at: WindowFit, rows: np.ndarray, score: WindowScore) -> Problem:
    """Some windows of the record, the shift free; its search begins at the score's."""
    (part,), (name,) = at.problem.parts, score.candidate.sizes
    space = coordinates(part.predictor.plant.parameters, [name], score.size, linear=[name])
    prior = Prior(space, space.encode(score.size), np.zeros(1))
    predictor = replace(part.predictor, names=prior.names)
    here = replace(part.rows(rows), space=space, predictor=predictor)
    return Problem((here,), replace(at.problem.unknowns, shared=prior))
