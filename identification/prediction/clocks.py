"""The shift in time of each record's inputs against its outputs.

    u(t - τ_r) in record r, all other parameters those of the model
    |τ_a - τ_b| < t 2 σ        halves a, b of it: each has twice the variance σ² of the whole record

A controller of one record may have logged its torques late, and that of another not: such a shift
is no physics of the robot, and what all records together say of it is little. Each record is asked
by itself, whether it was fitted or not, by blocks of its windows. A shift counts where both halves
of the record tell the same; it is a finding where it is beyond chance among all records, and takes
away enough to matter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.chances import student_above
from identification.discovery.attempts import attempt
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.estimation.priors import Priors
from identification.model.coordinates import coordinates
from identification.pool import run_parts
from identification.prediction.model import WindowModel
from identification.prediction.scores import WindowScore, window_scores
from identification.prediction.std import degrees_of_freedom, told_std
from identification.prediction.task import RecordsTask
from identification.windows.fit import WindowFit, solve
from identification.windows.problem import MOST_STEPS, Problem, no_moves, problem
from identification.windows.records import Record

SHIFT = "time_shift"  # the effect
# Of the sampling time: a smaller shift that may be chance stands in the JSON alone.
MIN_SHOWN_SHIFT = 0.1
ALONE_STEPS = MOST_STEPS // 4  # of the windows of one record: one number needs no more


def record_shifts(task: RecordsTask, model: WindowModel) -> tuple[ShiftedRecord, ...]:
    """Returns the shifts of records whose halves tell the same, beyond two std.

    Nothing is asked where the model knows shifts already, or where no candidate is one.

    Args:
        task: the records, and the candidates.
        model: fitted.
    """
    shifts = [e for e in task.effects if e.name == SHIFT]
    if not shifts or any(c.effect.name == SHIFT for c in model.candidates):
        return ()
    where = next(iter(shifts[0].places))  # all inputs: a record has one clock
    candidates = [Candidate(shifts[0], where, {}, probe) for probe in shifts[0].probes]

    def shift(record: Record) -> ShiftedRecord | None:
        # A record that is too short, or cannot be simulated, tells nothing.
        return attempt(None, partial(_record_shift, task, model, record, candidates))

    return tuple(s for s in run_parts(shift, task.records) if s is not None)


def _record_shift(
    task: RecordsTask, model: WindowModel, record: Record, candidates: Sequence[Candidate]
) -> ShiftedRecord | None:
    """Returns the shift of one record; None where it has none that both halves tell."""
    at = _alone(model, record, task.horizon)
    best = max(window_scores(at, candidates), key=lambda s: s.fall, default=None)
    if best is None:
        return None
    largest = best.candidate.effect.sizes[0].largest
    return _told(at, record, best, largest, task.options)


def told_shifts(
    shifts: Sequence[ShiftedRecord], records: int, options: DiscoveryOptions
) -> list[ShiftedRecord]:
    """Returns shifts that are beyond chance among all records and matter, the largest fall first.

    Args:
        shifts: of `record_shifts`.
        records: how many records there are.
        options: what is beyond chance, and what matters.
    """
    told = (
        s for s in shifts if s.chance * records < options.significance and s.fall > options.min_fall
    )
    return sorted(told, key=lambda s: -s.fall)


def shown_shifts(
    shifts: Sequence[ShiftedRecord], records: Sequence[Record], options: DiscoveryOptions
) -> list[ShiftedRecord]:
    """Returns the shifts to report: beyond chance among all records, or no small part of a step.

    Args:
        shifts: of `record_shifts`.
        records: all of them.
        options: what is beyond chance.
    """
    least = {_called(r): MIN_SHOWN_SHIFT * r.log.sampling_time for r in records}
    return [
        s for s in shifts
        if s.chance * len(records) < options.significance or abs(s.shift) >= least[s.record]
    ]  # fmt: skip


def _called(record: Record) -> str:
    """Returns the name of a record as it is reported with its shift."""
    return record.log.name + (" (fit)" if record.role == "fit" else "")


def _alone(model: WindowModel, record: Record, horizon: float) -> WindowFit:
    """Returns the fit of one record at the model's values: its states settled, nothing free."""
    values = {**model.values, **model.own_values.get(record.log.name, {})}
    task = problem(
        model.plant, [record], Priors(), Priors(), horizon, values, model.scale, ALONE_STEPS
    )
    moves, r = task.settled(np.zeros(0), no_moves(task), is_thorough=True)
    return solve(task, np.zeros(0), moves, known=r)


def _told(
    at: WindowFit, record: Record, score: WindowScore, largest: float, options: DiscoveryOptions
) -> ShiftedRecord | None:
    """Returns the best shift of a record; None where it is not significant or its halves differ."""
    windows, least = np.arange(len(at.moves[0])), options.min_proof_t
    whole = _fitted(at, windows, score)
    std = float(told_std(whole)[0])
    if not (np.isfinite(std) and least * std < abs(_shift(whole)) < largest):
        return None
    a, b = (_shift(_fitted(at, half, score)) for half in np.array_split(windows, 2))
    if a * b <= 0 or abs(a - b) > least * 2 * std:
        return None
    t, freedom = abs(_shift(whole)) / std, degrees_of_freedom(whole)[0]
    return ShiftedRecord(
        record=_called(record),
        shift=_shift(whole), std=std, fall=float(1 - whole.cost / at.cost),
        chance=2 * student_above(t, freedom),
    )  # fmt: skip


def _shift(found: WindowFit) -> float:
    (value,) = found.values.values()
    return value


def _fitted(at: WindowFit, rows: np.ndarray, score: WindowScore) -> WindowFit:
    """Returns the fit of the shift to some windows of the record."""
    task = _with(at, rows, score)
    return solve(task, task.prior.mean, [at.moves[0][rows]])


def _with(at: WindowFit, rows: np.ndarray, score: WindowScore) -> Problem:
    """Returns the problem of some windows with the shift free, begun at the score's size."""
    (part,), (name,) = at.problem.parts, score.candidate.sizes
    space = coordinates(part.predictor.plant.parameters, [name], score.size, linear=[name])
    prior = Priors(space, space.encode(score.size), np.zeros(1))
    predictor = replace(part.predictor, names=prior.names)
    here = replace(part.rows(rows), space=space, predictor=predictor)
    return Problem((here,), replace(at.problem.unknowns, shared=prior))
