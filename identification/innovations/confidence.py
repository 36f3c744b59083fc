"""The confidence in a name, against its rivals and against what it leaves unexplained.

    P_j ∝ exp(-ΔBIC_j/(2 T))        over the models that were refitted in its place, and over the
                                    nominal model with other parameters (`retune`), and over
                                    curves that no law gives (`free_curves`)

T, the temperature, is above 1 because the likelihood believes its noise model. The confidence has
an upper limit because no effect is certain that was confirmed under one kind of input only. Both
are judgement; a sweep over hidden worlds says how well the confidence is calibrated. Where
something is left beside the names, the limit is lower: of the names with which something was left
in hidden worlds, it is the share that were right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.effect_results import NamedEffect, Outside, Rival
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import CURVE, Candidate
from identification.effects.laws.curves import NODES
from identification.innovations.fitted_model import AcceptedEffect, FittedModel, collect_parameters
from identification.innovations.free_curves import Curve, find_curves
from identification.innovations.replacement import replace_effect, retune
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.task import DiscoveryTask
from identification.kalman.noise_model import build_whitener
from identification.runtime.pool import one_blas_thread


def name_effects(
    task: DiscoveryTask,
    accepted: Sequence[AcceptedEffect],
    final: FittedModel,
    sensitivities: Sequence[Sensitivity],
    explained: float,
    limit: float,
) -> tuple[NamedEffect, ...]:
    """Returns the accepted effects with their final values, their rivals and their confidence.

    Args:
        task: the nominal model and the options.
        accepted: effects in the order in which they were added.
        final: the model with all of them.
        sensitivities: of all candidates.
        explained: share of the gap that they close together, 0 to 1.
        limit: the upper limit of the confidence.
    """
    names = {_key(a.candidate) for a in accepted}
    curves: tuple[Curve, ...] = ()
    if accepted:
        curves = attempt("curves", partial(find_curves, final.refit, task.options)) or ()
    return tuple(
        _name(task, a, names, final, sensitivities, curves, explained, limit) for a in accepted
    )


def _name(
    task: DiscoveryTask,
    effect: AcceptedEffect,
    names: set[tuple[str, str]],
    final: FittedModel,
    sensitivities: Sequence[Sensitivity],
    curves: Sequence[Curve],
    explained: float,
    limit: float,
) -> NamedEffect:
    options, mine = task.options, effect.candidate
    # An effect that is named itself is no rival of another named effect.
    others = [m for m in effect.alternatives if _key(m.candidates[-1]) not in names]
    loss, retuned = retune(final.refit, task.nominal_model, mine)
    spared = len(mine.free) * float(np.log(len(final.refit.point.log)))
    bic = [m.negative_bic for m in (effect.model, *others)]
    drawn = [_worth_of_curve(final, mine, c, options) for c in curves]
    worth = np.array([*bic, bic[0] + max(drawn, default=-np.inf), bic[0] + spared - loss])
    weights = np.exp((worth - worth.max()) / (2 * options.temperature))
    probability = weights / weights.sum()
    rivals = [m.candidates[-1] for m in others]
    cosines = _compare(task, final, mine, rivals, sensitivities)
    own = min(limit, probability[0])
    of_rivals = probability[1:-2]
    return NamedEffect(
        candidate=final.with_fitted_shape(mine),
        parameters=collect_parameters(task, final, mine),
        confidence=float(own * min(1.0, max(0.0, explained))),
        rivals=tuple(
            _rival(task, m, float(p), cosine)
            for m, p, cosine in zip(others, of_rivals, cosines, strict=True)
        ),
        compared=len(others),
        one_of=bool(others and of_rivals.max() > options.set_confidence),
        bic_gain=effect.gain,
        proof=effect.proof,
        retuned=replace(retuned, confidence=float(probability[-1])),
        outside=_outside(curves[int(np.argmax(drawn))], probability[-2]) if curves else None,
    )


def _rival(task: DiscoveryTask, model: FittedModel, probability: float, alike: float) -> Rival:
    """Returns another effect with the values of its own fit."""
    c = model.candidates[-1]
    values, parameters = model.refit.point.values, collect_parameters(task, model, c)
    return Rival(c, probability, alike, values, parameters)


def _worth_of_curve(
    final: FittedModel, mine: Candidate, curve: Curve, options: DiscoveryOptions
) -> float:
    """Returns how much larger the negative BIC is with a curve instead of an effect.

    A law that takes nearly all of what the curve takes may have something small beside it: the
    curve is then at most half as likely.
    """
    drawn = replace_effect(final.refit, mine, curve.sensitivity.S, curve.level)
    more = NODES - len(mine.free)
    worth = -drawn.loss - more * float(np.log(len(final.refit.point.log)))
    is_equal = drawn.share > options.equal_share
    return min(worth, -2 * options.temperature * np.log(2)) if is_equal else worth


def _outside(curve: Curve, probability: float) -> Outside:
    """Returns the record of a curve that may explain the same data."""
    drawn = curve.sensitivity.candidate
    along = drawn.effect.name.removeprefix(f"{CURVE}_")
    return Outside(along, drawn.where, float(probability))


def _key(candidate: Candidate) -> tuple[str, str]:
    return candidate.effect.name, candidate.where


def _compare(
    task: DiscoveryTask,
    final: FittedModel,
    mine: Candidate,
    rivals: Sequence[Candidate],
    sensitivities: Sequence[Sensitivity],
) -> list[float]:
    """Returns cosines of the whitened sensitivity of an effect with those of its rivals."""
    known: dict[tuple[str, str], list[Sensitivity]] = {}
    for s in sensitivities:
        known.setdefault(_key(s.candidate), []).append(s)
    wanted = [_find_nearest(c, known[_key(c)]) for c in (mine, *rivals)]
    point, level = final.refit.point, final.refit.level
    keep = [i for i, n in enumerate(point.space.names) if n in task.nominal_model.names]
    with one_blas_thread():
        filter_ = build_whitener(point.linear, level.noise, point.log.sampling_time)
        stacked = np.concatenate([point.J[..., keep], *wanted], axis=2)
        W = filter_(stacked).reshape(point.e.size, -1)
    F, S = W[:, : len(keep)], W[:, len(keep) :]
    ridge = np.diag((final.refit.priors.weight[keep] * level.sigma) ** 2)
    S = S - F @ np.linalg.solve(F.T @ F + ridge, F.T @ S)
    ends = np.cumsum([w.shape[2] for w in wanted])
    spans = [np.linalg.qr(S[:, e - w.shape[2] : e])[0] for e, w in zip(ends, wanted, strict=True)]
    return [float(np.linalg.norm(spans[0].T @ span, 2)) for span in spans[1:]]


def _find_nearest(candidate: Candidate, known: Sequence[Sensitivity]) -> np.ndarray:
    """Returns the sensitivity whose shapes are the nearest to a candidate's, shape (N, ny, m)."""

    def distance(s: Sensitivity) -> float:
        return sum(abs(s.candidate.shape[n] - v) for n, v in candidate.shape.items())

    return min(known, key=distance).S
