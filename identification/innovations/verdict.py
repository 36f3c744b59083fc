"""The verdict on a finished search: are the accepted effects named, and what is left unexplained?

Only kinds and numbers of findings decide; words are made in `identification.report`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import listed_once
from identification.discovery.effect_results import NamedEffect, RejectedEffect, Unlogged
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.free_run import FreeRun
from identification.discovery.impossible import Impossible, find_impossible
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.discovery.result import Discovery, Verdict, closed_share
from identification.estimation.metrics import by_unit
from identification.innovations.confidence import name_effects
from identification.innovations.findings import (
    find_doubtful_effect,
    find_oversized_effect,
    find_robot_change,
    find_structure,
    find_untried_effect,
)
from identification.innovations.fit import list_at_bound
from identification.innovations.fitted_model import FittedModel, is_proven, score_candidates
from identification.innovations.input_error import find_input_error, find_input_hold
from identification.innovations.proof import prove
from identification.innovations.recovery import recover_force
from identification.innovations.scoring.detection import list_detectable
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.sensitivities import compute_sensitivities
from identification.innovations.scoring.significance import correct_p_value, list_hidden
from identification.innovations.state import InnovationSearch
from identification.innovations.unexpected import find_unexpected_error
from identification.kalman.refit import Refit

# With these findings a model is not believed, and nothing is named that leaves anything.
DISBELIEVED = (FindingKind.PARAMETERS_AT_LIMIT, FindingKind.OVERSIZED_EFFECT)

# Of the inputs' own motion. Where they would have to err by more, they are not what moved the
# robot, and nothing is named that leaves anything.
MAX_BELIEVED_INPUT_ERROR = 1.0


def find_remaining(state: InnovationSearch) -> tuple[Finding, ...]:
    """Returns what the model of a finished search leaves unexplained; empty if it explains all."""
    options, model = state.task.options, state.model
    named = [a.candidate.effect.name for a in state.accepted]
    samples = len(model.refit.point.log)
    findings = (
        *find_structure(model, options),
        *(
            find_robot_change(model.validation, options)
            or find_unexpected_error(model.validation, options)
        ),
        *find_input_error(model.validation, options, "report"),
        *(() if named else find_doubtful_effect(state.rejected, samples, options)),
        *_find_oversized(state, named),
        *(find_untried_effect(state.scores, state.rejected, options) if state.cut_short else ()),
    )
    if not findings:
        return ()
    return (*find_input_hold(state.nominal.refit), *findings)


def _find_oversized(state: InnovationSearch, named: Sequence[str]) -> tuple[Finding, ...]:
    """Finds a candidate beyond belief that explains more than named effects with fitted shapes.

    What jumps is scored at a few times only, so that its first score may be a small one.
    """
    options, nominal = state.task.options, state.nominal
    found = find_oversized_effect(state.nominal_scores, named, options)
    if not found:
        return found
    fitted = [state.model.with_fitted_shape(a.candidate) for a in state.accepted]
    own = compute_sensitivities(nominal.refit.point, fitted)
    scores = (*state.nominal_scores, *score_candidates(nominal, own, options))
    return find_oversized_effect(scores, named, options)


def compute_explained_share(
    nominal: FittedModel, model: FittedModel, findings: Sequence[Finding], options: DiscoveryOptions
) -> float:
    """Returns the share of the gap on unseen samples that the effects of a model close.

    The gap ends at what sensors and input errors make of a free run, where the input errors can be
    believed to be noise: where they are random, and no larger than noise is. Else it ends at what
    sensors make.

    Args:
        nominal: the fitted model without effects.
        model: the fitted model with them.
        findings: what the model leaves unexplained.
        options: how large an error of the inputs is noise.
    """
    proof = prove(nominal.validation, model.validation, options).told
    is_random = not _has(findings, FindingKind.STRUCTURED_INPUT_ERROR)
    is_noise = is_random and model.refit.relative_input_error <= options.allowed_input_error
    return proof.share if is_noise else proof.above


def decide(
    named: Sequence[NamedEffect],
    findings: Sequence[Finding],
    explained: float,
    model: FittedModel,
    options: DiscoveryOptions,
) -> Verdict:
    """Returns the verdict.

    Args:
        named: the accepted effects.
        findings: what the model with them leaves unexplained.
        explained: share of the gap that they close.
        model: the fitted model with them.
        options: when effects are named although something is left.
    """
    is_believed = model.refit.relative_input_error < MAX_BELIEVED_INPUT_ERROR and not _has(
        findings, *DISBELIEVED
    )
    explains_most = explained > options.min_explained_share and is_believed
    others = [f for f in findings if f.kind is not FindingKind.UNTRIED_EFFECT]
    if named and (not others or explains_most):
        return "named"
    return "unknown effect" if named or findings else "nothing missing"


def conclude(state: InnovationSearch) -> Discovery:
    """Returns the outcome of a finished search.

    Args:
        state: the finished state.
    """
    task, nominal, model, scores = state.task, state.nominal, state.model, state.scores
    options, log = task.options, task.log
    findings = find_remaining(state)
    explained = compute_explained_share(nominal, model, findings, options)
    tried = len(state.rejected)
    beside = [
        r for r in state.rejected if r.bic_gain > 0 and is_proven(r.proof, options, tried)
    ]  # fmt: skip
    limit = options.left_confidence if findings or beside else options.max_confidence
    share = explained if findings else 1.0
    every = name_effects(task, state.accepted, model, state.sensitivities, share, limit)
    forbidden = _forbidden(state, every)
    named = tuple(
        n for n in every if n.odds >= options.min_confidence and not forbidden[n.name, n.where]
    )
    verdict = decide(named, findings, explained, model, options)
    if every and not named:
        verdict = "unknown effect"
    if verdict == "unknown effect":
        named, model, scores = (), nominal, state.nominal_scores
    unnamed = [n for n in every if n not in named]
    refused = (
        RejectedEffect(
            n.candidate, n.parameters, n.bic_gain, n.proof, n.outside,
            doubt=forbidden[n.name, n.where],
        )
        for n in unnamed
    )  # fmt: skip
    rejected = listed_once((*refused, *state.rejected))
    proven = (r for r in rejected if r.bic_gain > 0 and is_proven(r.proof, options))
    is_random = not _has(findings, FindingKind.STRUCTURED_INPUT_ERROR)
    disturbed = by_unit(model.validation.disturbances("report"), log)
    run = FreeRun(
        log, nominal.refit, model.refit, nominal.validation.e, model.validation.e, task.parts
    )
    found = Discovery(
        records=run.records, options=options, verdict=verdict, named=named, rejected=rejected,
        nearest=next(proven, None), unexplained=bool(findings or unnamed or (named and beside)),
        share=None, unit=log.output_unit, noise_rms=model.refit.level.sigma,
        noise_by_unit=by_unit(model.validation.noise, log),
        noise_by_output=dict(zip(log.output_names, model.validation.noise.tolist(), strict=True)),
        disturbance_rms=model.validation.disturbance("report") if is_random else 0.0,
        disturbance_by_unit={u: s if is_random else 0.0 for u, s in disturbed.items()},
        input_error=model.refit.relative_input_error, unlogged=_unlogged(model.refit),
        before=nominal.validation.gap, after=model.validation.gap, errors=run.errors,
        nominal=nominal.refit, final=model.refit,
        at_bound=tuple(list_at_bound(model.refit, nominal.refit.point.space.names)),
        scores=state.nominal_scores, remaining=scores, scored_by="gain",
        next_best=_next(scores) if named and not rejected else None,
        detectable=list_detectable(scores, _deciding_share(state.model), options),
        hidden=list_hidden(scores, model.refit.level, options), findings=findings,
        seconds=state.seconds, failed=state.failed, moves=state.made,
        cut_short=state.cut_short, run=run,
        recover=partial(recover_force, model.refit), took=state.took,
    )  # fmt: skip
    return replace(found, share=closed_share(found))


def _forbidden(
    state: InnovationSearch, every: Sequence[NamedEffect]
) -> dict[tuple[str, str], Impossible | None]:
    """Returns what physics forbids of each effect, by its name and its place."""
    task, fit = state.task, state.model.refit
    if not uses(task.options, "impossible_sizes"):
        return {(n.name, n.where): None for n in every}
    logs = [fit.point.log]
    return {(n.name, n.where): find_impossible(n.candidate, fit, logs) for n in every}


def _deciding_share(model: FittedModel) -> float:
    """Returns the number of unseen samples on which a proof decides over that of fitted ones."""
    deciding, seen = model.validation.parts.select, model.validation.seen
    return float(np.sum(deciding) / np.sum(seen))


def _unlogged(fit: Refit) -> Unlogged:
    """Returns the error of the inputs, or of forces on the joints, that a fitted noise has."""
    log = fit.point.log
    unit = log.units.get(log.input_names[0], "") if log.input_names else ""
    return Unlogged(fit.level.input_std, unit, fit.level.noise.time, bool(log.inputs.any()))


def _next(scores: Sequence[Score]) -> tuple[Score, float] | None:
    """Returns the best of some candidates, and the chance that one of them does so by luck."""
    if not scores:
        return None
    best = max(scores, key=lambda s: s.gain)
    return best, correct_p_value(best, len(scores))


def _has(findings: Sequence[Finding], *kinds: FindingKind) -> bool:
    return any(f.kind in kinds for f in findings)
