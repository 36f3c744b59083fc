"""What a final model leaves over a horizon, and which error of the inputs would explain it.

    Σ_w ‖r⊥_w‖² = σ² n + α² Σ_w ‖S⊥_w‖²           α: rms error of the inputs, a share of their rms

S = -∂r/∂u, u the inputs in units of their rms, each error constant over a window; r⊥, S⊥: residual
and sensitivity without what the state of a window makes up for; n: readings less the states that
they tell, σ: the sensors' noise. No log has exact inputs: a drive's current or a commanded torque
is good to some per cent. What so small an error of the inputs makes is no reason to seek an effect.
The set point of a servo is a number that a computer has sent: it does not err, and u is without it.
The residual is that of fitted or of unseen windows, whichever is larger for its number: a force
that came or changed after the fitted record leaves nothing there.

All of it is of the windows on which the search has not decided (`identification.logs.parts`).
Where the error at the horizon is that of the sensors, nothing is left that an effect or a shift of
a record could explain. Among many that are tried one gains by luck, so that such a doubt counts
only where more than `min_gap_share` is left above the sensors' noise; that of an effect only where
inputs would also have to err by more than `max_input_error`. One output may err while the
others do not, and the mean over all outputs then hides it. So an output also counts by itself,
where its error is more than `MAX_OUTPUT_RATIO` times its noise.

The noise is itself estimated, by the differences of a few hundred samples to a tenth or two of its
mean square. A right model would err by more than such an estimate in every fourth short log. So
what is left also counts only beyond what 95 % of these estimates would miss.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.chances import mean_above_other
from identification.discovery.attempts import attempt
from identification.discovery.effect_results import RejectedEffect
from identification.discovery.findings.evidence import UntriedEffect
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.findings.records_evidence import (
    DifferentRecord,
    RemainingError,
    ShiftedRecord,
    UnprovenEffect,
    WorseFit,
)
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.named import phrase_there
from identification.estimation.metrics import relative
from identification.model.predictor import Plant
from identification.model.tied import is_set_point
from identification.prediction.fits.model import WindowModel
from identification.prediction.fits.record_errors import errors_by_unit
from identification.prediction.scoring.contenders import beyond_chance
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.clocks import told_shifts
from identification.windows.comparison import rise
from identification.windows.fit import WindowFit
from identification.windows.shooting import Shooting, Tangent
from identification.windows.unseen import Unseen

INPUT_STEP = 1e-3  # of an input's rms, by which it is moved
# Of an output's error to its noise, which its own differences tell to a tenth or two.
MAX_OUTPUT_RATIO = 1.5
SURE = 1.645  # std, above which 5 % of normal numbers lie
# Of a record's rms error to that of the others: beyond it, and beyond chance, it is reported.
DIFFERENT_RECORD_RATIO = 2.0
MIN_COMPARED_RECORDS = 3  # of two, only that they differ is known, and not which one is wrong


def find_remaining(
    state: WindowSearch, rejected: Sequence[RejectedEffect], shifts: Sequence[ShiftedRecord],
    needed: float,
) -> tuple[Finding, ...]:  # fmt: skip
    """Returns what the final model leaves: errors above the sensors' noise, and doubtful effects.

    Args:
        state: the finished state.
        rejected: effects that were refitted and not proven.
        shifts: of records, of `identification.prediction.verdict.clocks`.
        needed: error of the inputs that would make what is left, a share of their rms.
    """
    out: list[Finding] = []
    if state.worse_fit is not None:
        worse = WorseFit(rise(state.begun.report, state.worse_fit.report))
        out.append(Finding(FindingKind.WORSE_FIT, worse))
    left = _error_left(state)
    places: set[tuple[str, str]] = set()  # each is told once, as it did best
    for r in rejected if left and needed > state.task.options.max_input_error else ():
        if r.doubt == "steps":  # they are told, and are nothing that is missing
            continue
        seen, has_fallen = r.proof, r.proof.told.fall > state.task.options.min_fall
        if seen.is_everywhere and has_fallen and seen.t > state.task.options.min_proof_t:
            unproven = _unproven(r, state.model.plant)
            if (unproven.name, unproven.where) not in places:
                out.append(Finding(FindingKind.UNPROVEN_EFFECT, unproven))
            places.add((unproven.name, unproven.where))
    if state.accepted and left:
        out.append(Finding(FindingKind.REMAINING_ERROR, left))
    out += [Finding(FindingKind.DIFFERENT_RECORD, e) for e in different_records(state, needed)]
    out += _untried(state)
    told = told_shifts(shifts, len(state.task.records), state.task.options) if left else ()
    out += [Finding(FindingKind.SHIFTED_RECORD, e) for e in told]
    return tuple(out)


def _untried(state: WindowSearch) -> list[Finding]:
    """Returns the best candidate beyond chance that the time limit left unfitted."""
    if not state.cut_short:
        return []
    tried = {r.candidate.key for r in state.rejected} | {f.key for f in state.failed}
    beyond = beyond_chance(state.scores, state.task.options)
    left = [s for s in beyond if s.candidate.key not in tried]
    return [Finding(FindingKind.UNTRIED_EFFECT, UntriedEffect(s)) for s in left[:1]]


def is_much_left(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a model errs by so much that more than one effect may be missing.

    That is far above the sensors' noise at an output, on windows on which the search decides, and
    more than inputs make that are off by what is usual. Of a right model that errs by little there
    is nothing to find, and what is asked then takes as long as all that was before it.

    Args:
        model: fitted.
        options: the usual error of inputs.
    """
    unseen = model.unseen.select
    if not output_ratios(unseen).max() > MAX_OUTPUT_RATIO:
        return False
    asked = partial(
        needed_input_error, model.fit, options, model.scale, unseen.noise, unseen.of_outputs
    )
    needed = attempt(None, asked)
    return needed is None or needed > options.max_input_error


def _error_left(state: WindowSearch) -> RemainingError | None:
    """Returns the error above the sensors' noise; None where the noise alone explains it."""
    options, share = state.task.options, left_by_steps(state.model)
    unseen = state.model.unseen.report
    ratio, ratios = share * noise_ratio(state, unseen), share * output_ratios(unseen)
    names = state.task.records[0].log.output_names
    worst, of = int(np.argmax(ratios)), tuple(r.log.name for r in state.task.confirm)
    if len(names) > 1 and ratios[worst] > max(MAX_OUTPUT_RATIO, ratio):
        return RemainingError(float(ratios[worst]), names[worst], of)
    most = 1 + options.min_gap_share + missed_noise(unseen, options) / 2  # of a root of squares
    return RemainingError(ratio, records=of) if ratio > most else None


def is_off(model: WindowModel, options: DiscoveryOptions) -> bool:
    """Returns whether a model errs on unseen records by more than sensors' noise and steps make."""
    unseen, share = model.unseen.report, left_by_steps(model)
    square = float(np.mean(np.concatenate(unseen.at_horizon))) * share**2
    is_one_off = share * output_ratios(unseen).max() > MAX_OUTPUT_RATIO
    most = 1 + options.min_gap_share + missed_noise(unseen, options)
    return is_one_off or square > unseen.floor * most


def missed_noise(unseen: Unseen, options: DiscoveryOptions) -> float:
    """Returns by how much the noise may be estimated too small, a share of its mean square."""
    return SURE * unseen.floor_std if uses(options, "scatter_of_noise") else 0.0


def left_by_steps(model: WindowModel) -> float:
    """Returns the share of a model's rms error that finer steps would leave: 1 where all of it."""
    return model.finer.left


def output_ratios(unseen: Unseen) -> np.ndarray:
    """Returns each output's rms error over that of its noise, (ny,); zero where that is unknown."""
    squares, noise = np.concatenate(unseen.of_outputs).mean(axis=0), unseen.noise
    return np.sqrt(np.divide(squares, noise, out=np.zeros_like(squares), where=noise > 0))


def noise_ratio(state: WindowSearch, unseen: Unseen) -> float:
    """Returns the model's rms error on some unseen windows over that of the sensors' noise."""
    scale, log = state.model.scale, state.task.records[0].log
    errors = errors_by_unit(np.concatenate(unseen.of_outputs), scale, log)
    return relative(errors, errors_by_unit(unseen.noise, scale, log))


def different_records(state: WindowSearch, needed: float) -> list[DifferentRecord]:
    """Returns records that the final model predicts much worse than the others, by Welch's t-test.

    The sample are logarithms of the windows' mean squares, and the records are paid for. Of two
    records the worse one is told only where inputs that are off by what is usual would not make it.

    Args:
        state: the finished state.
        needed: error of the inputs that would make what is left, a share of their rms.
    """
    unseen, options = state.model.unseen.report, state.task.options
    errors = {
        r.log.name: np.log(squares + unseen.floor)
        for r, squares in zip(state.task.confirm, unseen.at_horizon, strict=True)
    }
    fitted = [r for r in state.task.records if r.role == "fit"]
    scale = state.model.scale
    for r, e in zip(fitted, state.model.fit.errors, strict=True):
        errors[f"{r.log.name} (fit)"] = np.log(
            np.mean((e / scale) ** 2, axis=(1, 2)) + unseen.floor
        )
    out: list[DifferentRecord] = []
    if len(errors) < MIN_COMPARED_RECORDS and not needed > options.max_input_error:
        return out
    for name, mine in errors.items():
        rest = np.concatenate([e for n, e in errors.items() if n != name])
        ratio = float(np.exp((mine.mean() - rest.mean()) / 2))
        chance = mean_above_other(mine, rest)
        if ratio > DIFFERENT_RECORD_RATIO and chance * len(errors) < options.significance:
            out.append(DifferentRecord(name, ratio, chance, tuple(n for n in errors if n != name)))
    return out


def _unproven(r: RejectedEffect, plant: Plant) -> UnprovenEffect:
    c = r.candidate
    doubt = r.doubt or "chance"
    return UnprovenEffect(
        c.effect.name,
        phrase_there(c, plant),
        c.where,
        r.proof.told.fall,
        r.proof.told.t,
        doubt,
        r.luck,
    )


def needed_input_error(
    fit: WindowFit, options: DiscoveryOptions, scale: np.ndarray, noise: np.ndarray,
    unseen: Sequence[np.ndarray] = (),
) -> float:  # fmt: skip
    """Returns the inputs' rms error over a window that the residual needs, as a share of their rms.

    It is infinite where no input moves that may err. Unseen windows are taken to feel an error of
    the inputs as the fitted ones do.

    Args:
        fit: the model, on the windows of the records that were fitted.
        options: whether set points of servos are exact.
        scale: s of each output, shape (ny,), in its unit; the fit may weigh its errors otherwise.
        noise: σ², mean square of each sensor's noise in units of s², shape (ny,).
        unseen: mean squares of each output over windows that were not fitted, shape (W, ny), one
            array a record, in these units.
    """
    weight = (scale * np.diag(fit.problem.parts[0].whitener)) ** 2
    floor = float(np.mean(noise * weight))
    inputs = np.concatenate([p.predictor.log.inputs for p in fit.problem.parts])
    size = np.sqrt(np.mean(inputs**2, axis=0))
    moving = np.flatnonzero(size > 0)
    if uses(options, "exact_set_points"):
        model = fit.problem.plant.model
        moving = np.array([i for i in moving if not is_set_point(model, int(i))], int)
    if not len(moving):  # in a free swing, no error of the inputs is a share of their size
        return np.inf
    left, felt, count = 0.0, 0.0, 0.0
    for k, (part, d, t) in enumerate(zip(fit.problem.parts, fit.moves, fit.tangents, strict=True)):
        q = fit.q[fit.problem.unknowns.columns(k)]
        readings = part.cut.outputs.size - t.freedom
        left += float(np.sum(t.projected[1] ** 2)) - floor * readings
        count += readings
        felt += float(np.sum(_sensitivity(part, q, d, t, size, moving) ** 2))
    if unseen:
        left = max(left, count * float(np.mean(np.concatenate(unseen) * weight) - floor))
    return float(np.sqrt(max(0.0, left) / felt)) if felt > 0 else np.inf


def _sensitivity(
    part: Shooting, q: np.ndarray, d: np.ndarray, t: Tangent, size: np.ndarray, moving: np.ndarray
) -> np.ndarray:
    """Returns S⊥ of the inputs that move, each in units of its rms, shape (W, m, k)."""
    out = []
    at = part.joined(part.outputs(q[None], [d], is_rough=True)[0], d)
    for j in moving:
        step = np.zeros(len(size))
        step[j] = INPUT_STEP * size[j]
        log = replace(part.predictor.log, inputs=part.predictor.log.inputs + step)
        moved = replace(
            part, predictor=replace(part.predictor, log=log),
            cut=replace(part.cut, inputs=part.cut.inputs + step),
        )  # fmt: skip
        r = part.joined(moved.outputs(q[None], [d], is_rough=True)[0], d)
        out.append((at - r) / INPUT_STEP)
    S = np.stack(out, axis=-1)
    U = t.U * (t.s > 0)[:, None]
    return np.asarray(S - U @ (np.swapaxes(U, 1, 2) @ S))
