"""The shift in time of each record's inputs against its outputs.

    u(t - τ_r) in record r, all other parameters those of the model
    |τ_a - τ_b| < max(t 2 σ, |τ|/10)      halves a, b of it, each of twice the variance σ²

A controller of one record may have logged its torques late, and that of another not: such a shift
is no physics of the robot, and what all records together say of it is little. Each record is asked
by itself, whether it was fitted or not, by blocks of its windows. A shift counts where both halves
of the record tell the same; it is a finding where it is beyond chance among all records, and takes
away enough to matter.

    E_0 = ‖r_0 - S c_0‖² - F,   E_τ = ‖r_τ - S c_τ‖² - F      without the shift, and with it

A force that is missing looks a little like any other cause, and no scatter of blocks shows that: a
bump of a rail made shifts of some ten std in records whose stamps were exact. So beside the shift
stands the smooth force S c that the joints could have
(`identification.discovery.forces.smooth_force`). Where much more than the noise F is left with the
shift, it counts only if it takes away most of what this force leaves, E_τ < E_0/2, and is then told
with the value that it has beside the force.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from identification.chances import student_above
from identification.discovery.attempts import attempt
from identification.discovery.candidates import list_common
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.forces.smooth_force import MUCH_LEFT, find_smooth_force, takes_most
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.estimation.priors import Priors
from identification.logs.noise import noise_floor
from identification.model.coordinates import coordinates
from identification.prediction.fits.model import WindowModel
from identification.prediction.fits.std import degrees_of_freedom, told_std
from identification.prediction.scoring.columns import columns
from identification.prediction.scoring.scores import WindowScore, each_condensed, window_scores
from identification.prediction.task import RecordsTask
from identification.runtime.pool import run_parts
from identification.windows.fit import WindowFit, solve
from identification.windows.problem import MOST_STEPS, Problem, no_moves, problem
from identification.windows.records import Record

SHIFT = "time_shift"  # the effect
# Of the sampling time: a smaller shift that may be chance stands in the JSON alone.
MIN_SHOWN_SHIFT = 0.1
SMOOTH = ("_speed", "_load", "_position")  # ends of names of curves; over time they follow all
ALIKE = 0.1  # of a shift: halves that differ by less tell the same
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
    curves = list_common([e for e in task.effects if e.is_curve and e.name.endswith(SMOOTH)])
    return _told(at, record, best, curves, task.options)


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
    at: WindowFit, record: Record, score: WindowScore, curves: Sequence[Candidate],
    options: DiscoveryOptions,
) -> ShiftedRecord | None:  # fmt: skip
    """Returns the best shift of a record.

    It is None where it is not significant, its halves differ, or it leaves most of what is far
    above the noise.
    """
    windows, least = np.arange(len(at.moves[0])), options.min_proof_t
    largest = score.candidate.effect.sizes[0].largest
    whole = _fitted(at, windows, score)
    std = float(told_std(whole)[0])
    if not (np.isfinite(std) and least * std < abs(_shift(whole)) < largest):
        return None
    a, b = (_shift(_fitted(at, half, score)) for half in np.array_split(windows, 2))
    if a * b <= 0 or abs(a - b) > max(least * 2 * std, ALIKE * abs(_shift(whole))):
        return None
    shift, noise = _shift(whole), _noise(whole)
    if whole.cost > MUCH_LEFT**2 * noise:
        before, after = (_beside_forces(fit, curves) for fit in (at, whole))
        if not takes_most(before.left, after.left, noise):
            return None
        shift, std = shift + after.shift, max(std, after.std)
        if not least * std < abs(shift) < largest:
            return None
    return ShiftedRecord(
        record=_called(record), shift=shift, std=std, fall=float(1 - whole.cost / at.cost),
        chance=2 * student_above(abs(shift) / std, degrees_of_freedom(whole)[0]),
    )  # fmt: skip


@dataclass(frozen=True)
class _Beside:
    """A fit of one record beside the smooth force of its joints."""

    left: float  # sum of squares that the force leaves, in blocks that it was not fitted to
    shift: float = 0.0  # by which the shift of the fit is another one beside it [s]
    std: float = 0.0  # of the shift [s]


def _beside_forces(fit: WindowFit, curves: Sequence[Candidate]) -> _Beside:
    """Returns a fit of one record, with a shift or without, beside smooth forces."""
    (t,) = fit.tangents
    s, r = (x.reshape(t.r.size, -1) for x in t.projected)
    left = float(np.sum(r**2))
    S = np.hstack([columns(fit, [c])[0] for c in curves] or [np.zeros((t.r.size, 0))])
    if not S.any():
        return _Beside(left)
    told = next(each_condensed(fit, [S]))
    force = find_smooth_force(told.G, told.a, [len(c.sizes) for c in curves])
    left -= force.gain
    if not s.shape[1]:
        return _Beside(left)
    blocks = np.array_split(np.arange(len(t.r)), len(told.G) - 1)  # the last one are priors
    rows = t.r.shape[1] * np.cumsum([0, *map(len, blocks)])
    each = np.array([
        s[a:b].T @ np.hstack([S[a:b], r[a:b], s[a:b]]) for a, b in pairwise(rows.tolist())
    ])[:, 0]  # fmt: skip
    folds = np.array_split(np.arange(len(told.G)), len(force.left_out))
    rest = [np.delete(each, f[f < len(each)], axis=0) for f in folds]
    sums = [x.sum(axis=0) for x in (each, *rest)]
    q = [
        (x[-2] - x[:-2] @ c) / x[-1] for x, c in zip(sums, (force.c, *force.left_out), strict=True)
    ]
    slope, out = float(fit.problem.prior.space.slope(fit.q)[0]), np.array(q[1:])
    return _Beside(left, slope * q[0], slope * float(np.sqrt((len(out) - 1) * out.var())))


def _noise(fit: WindowFit) -> float:
    """Returns the sum of squares that the noise of the sensors makes in windows of one record."""
    (part,), (t,) = fit.problem.parts, fit.tangents
    square = (noise_floor(part.predictor.log.outputs) * np.diag(part.whitener)) ** 2
    return float(np.mean(square)) * (part.cut.outputs.size - t.freedom)


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
