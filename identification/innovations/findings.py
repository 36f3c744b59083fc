"""What a final model of a free run leaves: structure, doubtful effects, a changed robot.

    δ = argmin ‖E - F δ‖² + Σ ((q_j + δ_j - q̄_j)/s_j)²        over all samples, F = ∂E/∂q

Are the unseen samples predicted as well as the fitted ones? A fit that knows its parameters only
roughly predicts unseen samples only roughly. The part of the innovations that a small change δ of
the parameters can explain is therefore removed; what is left is no uncertainty of the parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from identification.chances import mean_above_other, student_above
from identification.discovery.attempts import attempt
from identification.discovery.effect_results import RejectedEffect
from identification.discovery.findings.evidence import (
    CorrelatedInnovations,
    DoubtfulEffect,
    LargeInputError,
    OversizedEffect,
    ParametersAtLimit,
    RobotChange,
    SpectralLine,
    UntriedEffect,
)
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.estimation.residuals import innovation_tests
from identification.innovations.fitted_model import (
    FittedModel,
    is_far_likelier,
    is_relevant,
    list_parameters_at_limit,
)
from identification.innovations.proof import Validation
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.significance import find_oversized, select_significant
from identification.kalman.point import evaluate_sensitivities
from identification.runtime.pool import one_blas_thread


def find_structure(model: FittedModel, options: DiscoveryOptions) -> tuple[Finding, ...]:
    """Returns what a model does not explain on the fitted samples; empty when it explains all.

    Args:
        model: the fitted model.
        options: what counts as beyond chance, and as an error of the inputs that is no noise.
    """
    log = model.refit.point.log
    white = innovation_tests(model.innovations, log.sampling_time)
    out = []
    if white.p_line < options.structure_level:
        line = SpectralLine(log.output_names[white.channel], white.frequency, white.p_line)
        out.append(Finding(FindingKind.SPECTRAL_LINE, line))
    if white.is_correlated(options.structure_level, options.min_structure_share):
        correlated = CorrelatedInnovations(white.predictable, white.p_correlation)
        out.append(Finding(FindingKind.CORRELATED_INNOVATIONS, correlated))
    if names := list_parameters_at_limit(model):
        out.append(Finding(FindingKind.PARAMETERS_AT_LIMIT, ParametersAtLimit(names)))
    if model.refit.relative_input_error > options.allowed_input_error:
        out.append(Finding(FindingKind.LARGE_INPUT_ERROR, _input_error(model)))
    return tuple(out)


def _input_error(model: FittedModel) -> LargeInputError:
    log, level = model.refit.point.log, model.refit.level
    return LargeInputError(
        unit=log.units.get(log.input_names[0], ""),
        rms=level.input_std,
        share=model.refit.relative_input_error,
        correlation_time=level.noise.time,
    )


def find_doubtful_effect(
    rejected: Sequence[RejectedEffect], samples: int, options: DiscoveryOptions
) -> tuple[Finding, ...]:
    """Returns the best effect that fitted samples want and that would matter, but is not proven.

    Of an effect that makes the unseen samples less likely there is no doubt: it is not there. Only
    where the fitted samples want it far more than BIC asks does a doubt remain.

    Args:
        rejected: effects that were refitted and not accepted, the best first.
        samples: that were fitted.
        options: which effects would matter.
    """
    wanted = [
        r for r in rejected
        if is_relevant(told := r.proof.told, options)
        and (r.bic_gain > 0 < told.gain or is_far_likelier(r.candidate, r.bic_gain, samples))
    ]  # fmt: skip
    return tuple(Finding(FindingKind.DOUBTFUL_EFFECT, DoubtfulEffect(r)) for r in wanted[:1])


def find_untried_effect(
    scores: Sequence[Score], rejected: Sequence[RejectedEffect], options: DiscoveryOptions
) -> tuple[Finding, ...]:
    """Returns the best candidate beyond chance that was not refitted; nothing without one.

    Where the time limit ended the search, what is left is then no noise, although nothing was
    refused or proven.

    Args:
        scores: of all candidates on the final model.
        rejected: effects that were refitted beside it, and not accepted.
        options: what is beyond chance.
    """
    tried = {r.candidate.key for r in rejected}
    left = [s for s in select_significant(scores, options) if s.candidate.key not in tried]
    return tuple(Finding(FindingKind.UNTRIED_EFFECT, UntriedEffect(s)) for s in left[:1])


def find_oversized_effect(
    scores: Sequence[Score], named: Sequence[str], options: DiscoveryOptions
) -> tuple[Finding, ...]:
    """Returns the candidate that explains more than all named effects, at a size beyond belief.

    Args:
        scores: of all candidates on the nominal fit.
        named: names of the named effects.
        options: which sizes are believed.
    """
    score = find_oversized(scores, named, options)
    if score is None:
        return ()
    limits = {
        s.name: options.size_factor * s.largest
        for s, value in zip(score.candidate.effect.sizes, score.size, strict=True)
        if abs(value) > options.size_factor * s.largest
    }
    return (Finding(FindingKind.OVERSIZED_EFFECT, OversizedEffect(score, limits)),)


def find_robot_change(validation: Validation, options: DiscoveryOptions) -> tuple[Finding, ...]:
    """Returns a change of the robot if unseen innovations are larger beyond chance; else nothing.

    Only samples count on which the search has not decided.

    Args:
        validation: the prediction of the whole log by a fitted model.
        options: what is beyond chance, and large enough to matter.
    """
    told, E = validation.parts.report, validation.innovations
    fitted, blocks = _power(E[validation.seen]), options.proof_blocks
    if not has_changed(fitted, _power(E[told]), options):
        return ()
    # A small change of a parameter may make the simulation diverge.
    explained = attempt(None, partial(_explain, validation))
    power = _power(E if explained is None else E - explained)
    if not has_changed(fitted, power[told], options):
        return ()
    rest = ~validation.seen  # all of them, or the time would be known to a few blocks only
    onset = find_onset(fitted, power[rest], blocks)
    time = validation.log.time[rest][onset]
    later = told & (validation.log.time >= time)
    ratio = power[later if later.any() else told].mean() / fitted.mean()
    evidence = RobotChange(float(np.sqrt(ratio)), float(time))
    return (Finding(FindingKind.ROBOT_CHANGE, evidence),)


def find_onset(fitted: np.ndarray, unseen: np.ndarray, blocks: int) -> int:
    """Returns the index of the unseen sample from which on the power differs most from before.

    Args:
        fitted: power of each fitted sample, shape (n,).
        unseen: power of each unseen sample, shape (m,).
        blocks: number of blocks, to whose starts the index is rounded.
    """
    ends = np.array_split(np.arange(len(unseen)), blocks)
    a, b = np.log(_means(fitted, blocks)), np.log(_means(unseen, blocks))

    def difference(k: int) -> float:
        before, after = np.concatenate([a, b[:k]]), b[k:]
        n, m = len(before), len(after)
        return float((after.mean() - before.mean()) * np.sqrt(n * m / (n + m)))

    return int(ends[max(range(blocks), key=difference)][0])


def _means(power: np.ndarray, blocks: int) -> np.ndarray:
    return np.array([part.mean() for part in np.array_split(power, blocks)])


def _power(E: np.ndarray) -> np.ndarray:
    return np.asarray(np.mean(E**2, axis=1))


def has_changed(fitted: np.ndarray, unseen: np.ndarray, options: DiscoveryOptions) -> bool:
    """Returns whether unseen innovations are larger, beyond chance and by enough to matter.

    They may be larger from any time on: a robot that changes a second before its log ends errs as
    before in most blocks. Each block in which that may begin is asked, and paid for.

    Args:
        fitted: power of each fitted sample, shape (n,).
        unseen: power of each unseen sample, shape (m,).
        options: what is beyond chance, and large enough to matter.
    """
    a, b = (_means(power, options.proof_blocks) for power in (fitted, unseen))
    # The logarithm keeps a few blocks with large errors from looking like scatter only.
    if _matters(a, b, options) and mean_above_other(np.log(b), np.log(a)) < options.structure_level:
        return True
    return any(
        _matters(before := np.concatenate([a, b[:k]]), b[k:], options)
        and len(b) * _chance_of_last(np.log(before), np.log(b[k:])) < options.structure_level
        for k in range(1, len(b))
    )


def _matters(before: np.ndarray, after: np.ndarray, options: DiscoveryOptions) -> bool:
    return bool(after.mean() > (1 + options.min_structure_share) * before.mean())


def _chance_of_last(before: np.ndarray, after: np.ndarray) -> float:
    """Returns the chance that the mean of a few last numbers is as far above that of the others.

    Their scatter is that of the others, because that of two or three numbers may be small by luck.
    """
    std = before.std(ddof=1) * np.sqrt(1 / len(before) + 1 / len(after))
    return float(student_above((after.mean() - before.mean()) / std, len(before) - 1))


def _explain(validation: Validation) -> np.ndarray:
    """Returns the part of innovations that a small parameter change explains, shape (N, ny)."""
    fit = validation.refit
    with one_blas_thread():
        J = evaluate_sensitivities(fit.point, validation.log)
        F = validation.filter(J).reshape(validation.e.size, -1) / fit.level.sigma
        rows = np.vstack([F, fit.priors.rows])
        target = np.concatenate([validation.innovations.ravel(), fit.priors.against(fit.point.q)])
        scale = np.linalg.norm(rows, axis=0) + 1e-300
        move = np.linalg.lstsq(rows / scale, target, rcond=1e-12)[0] / scale
    return np.asarray((F @ move).reshape(validation.e.shape))
