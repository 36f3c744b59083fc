"""Forward selection: the best candidates are refitted, and the most likely one is to be proven.

The refitted models are ordered by BIC. The first one is accepted that unseen samples confirm beyond
chance and by enough to matter; a second name is often only the wrong shape of the first. An effect
need not matter to the free run where the model leaves no structure unexplained: such an effect is
small, but it is all that is missing. Beside effects that are named already the fitted samples must
then want it far more than BIC asks. Where no score is beyond chance but the noise model has an
error of the inputs, in which an effect may hide, the best candidates are refitted all the same, and
their gain must then be beyond chance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.chances import chi2_level
from identification.discovery.candidates import list_between
from identification.discovery.effect_results import RejectedEffect
from identification.discovery.options import DiscoveryOptions
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.innovations.findings import find_structure
from identification.innovations.fitted_model import (
    AcceptedEffect,
    FittedModel,
    collect_parameters,
    is_confirmed,
    is_far_likelier,
    is_proven,
    is_relevant,
    score_candidates,
    try_fit,
)
from identification.innovations.input_error import find_input_error
from identification.innovations.moves.kinds import improve_rivals
from identification.innovations.moves.shapes import begin_anew, improve_shape
from identification.innovations.proof import prove
from identification.innovations.scoring.outliers import list_at_outliers
from identification.innovations.scoring.scores import Score
from identification.innovations.scoring.sensitivities import compute_sensitivities
from identification.innovations.scoring.significance import (
    is_plausible,
    select_significant,
)
from identification.innovations.task import DiscoveryTask
from identification.runtime.progress import Progress, counted


@dataclass(frozen=True)
class Selection:
    """The outcome of one round of forward selection."""

    accepted: tuple[AcceptedEffect, ...] = ()  # the effect to add; none when no effect is worth it
    # what was refitted instead, the best first; empty when an effect is accepted
    rejected: tuple[RejectedEffect, ...] = ()
    # of those the most likely model that unseen samples speak for in one way only: they are
    # predicted better one step ahead, or the free run comes much nearer and the fitted samples want
    # the effect far more than BIC asks. None when there is none.
    unproven: FittedModel | None = None


def select_effect(
    task: DiscoveryTask, model: FittedModel, scores: Sequence[Score], progress: Progress
) -> Selection:
    """Select the best effect to add to a model.

    Args:
        task: the nominal model, the log and the options.
        model: the model so far.
        scores: of the candidates on it, the best first.
        progress: is told a line per refit.
    """
    options = task.options
    refitted = _refit_candidates(task, model, scores, progress)
    if refitted:
        best, *others = refitted
        if uses(options, "other_shapes"):
            best = improve_shape(task, model, best, scores)
        refitted = [best, *others]
        if uses(options, "kinds_of_rivals"):
            refitted = improve_rivals(task, best, others)
        if not model.candidates and uses(options, "begin_anew"):
            refitted = begin_anew(task, refitted, scores)
    rejected: list[RejectedEffect] = []
    unproven: FittedModel | None = None
    tried = len(refitted)
    is_clean = not find_structure(model, options)
    for k, new in enumerate(refitted):
        proof = prove(model.validation, new.validation, options)
        gain, mine = new.negative_bic - model.negative_bic, new.candidates[-1]
        is_wanted = is_far_likelier(mine, gain, len(model.refit.point.log))
        is_sure = gain > 0 and is_proven(proof, options, tried)
        is_small = is_clean and is_sure and (is_wanted or not model.candidates)
        if (gain > 0 and is_confirmed(proof, options, tried)) or (
            is_small and not find_input_error(new.validation, options)
        ):
            instead = tuple(refitted[:k] + refitted[k + 1 :])
            return Selection(accepted=(AcceptedEffect(new, proof, gain, instead),))
        is_half_proven = is_sure or (is_wanted and is_relevant(proof, options))
        if is_half_proven and unproven is None:
            unproven = new
        parameters = collect_parameters(task, new, mine)
        rejected.append(RejectedEffect(mine, parameters, gain, proof))
    return Selection(rejected=tuple(rejected), unproven=unproven)


def _refit_candidates(
    task: DiscoveryTask, model: FittedModel, scores: Sequence[Score], progress: Progress
) -> list[FittedModel]:
    """Returns the model with each of the best candidates in turn, the most likely one first."""
    scores = (*scores, *_sharpen(model, scores, task.options))
    chosen = _select_contenders(select_significant(scores, task.options), task.options)
    is_hidden = not chosen and bool(model.refit.level.noise.ratio)
    is_hidden = is_hidden and uses(task.options, "hidden_effects")
    if is_hidden:
        chosen = _select_likeliest(scores, task.options)
    refitted = []
    for s in counted(chosen, "refits", len(chosen)):
        name = f"{s.candidate.effect.name}, {s.candidate.where}"
        sizes = dict(zip(s.candidate.sizes, s.size, strict=True))
        more = (*model.candidates, s.candidate)
        start = {**model.refit.point.values, **sizes}
        asked = _ask(s.candidate, model, len(scores) if is_hidden else 0, task.options)
        least = model.refit.log_posterior + asked / 2
        new = try_fit(task, more, start, model, least=least, tried=s.candidate)
        if new is None:
            continue
        progress(f"{name}: gain {new.negative_bic - model.negative_bic:.0f}")
        if not is_hidden or new.refit.log_posterior > least:
            refitted.append(new)
    return sorted(refitted, key=lambda new: new.negative_bic, reverse=True)


def _sharpen(
    model: FittedModel, scores: Sequence[Score], options: DiscoveryOptions
) -> tuple[Score, ...]:
    """Returns scores of the likely candidates at more values of their shapes, as a refit asks.

    What jumps explains less at a wrong time, and must not stand back behind another candidate at a
    better time. A sensor that jumps is scored where the outputs jump.
    """
    near = _select_contenders(select_significant(scores, options), options)
    finer: list[Candidate] = []
    if uses(options, "finer_shapes"):
        finer += [c for s in near for c in list_between(s.candidate)]
    if uses(options, "jumps_at_outliers"):
        every, log = [s.candidate for s in scores], model.refit.point.log
        finer += list_at_outliers(every, model.innovations, log, options)
    if not finer:
        return ()
    return score_candidates(model, compute_sensitivities(model.refit.point, finer), options)


def _select_likeliest(scores: Sequence[Score], options: DiscoveryOptions) -> list[Score]:
    """Returns the best scores of a few effects, which may be luck.

    Without the effect the fit may have moved the parameters so far that the score, which is linear,
    says little, and the noise model may have taken the rest for an error of the inputs.
    """
    best: dict[str, Score] = {}
    for s in scores:
        if s.gain > 0 and is_plausible(s.candidate, s.size, options):
            best.setdefault(s.candidate.effect.name, s)
    return [*best.values()][: options.max_refits]


def _ask(candidate: Candidate, model: FittedModel, count: int, options: DiscoveryOptions) -> float:
    """Returns what a refit must gain, in twice the log posterior, to matter.

    It is what the best of `count` candidates gains by luck, or where this is zero what BIC asks.
    """
    known = {*model.refit.point.space.names}
    more = sum(name not in known for name in candidate.estimated)
    if count:
        return chi2_level(options.significance / count, more) if more else np.inf
    return more * float(np.log(len(model.refit.point.log)))


def _select_contenders(significant: Sequence[Score], options: DiscoveryOptions) -> list[Score]:
    """Returns the few best of the significant scores.

    One effect is refitted at two places only where both have nearly the same gain.
    """
    best: dict[str, float] = {}
    out = []
    for s in significant:
        here = options.other_place_share * best.get(s.candidate.effect.name, 0.0)
        if s.gain > max(options.refit_share * significant[0].gain, here):
            out.append(s)
            best.setdefault(s.candidate.effect.name, s.gain)
    return out[: options.max_refits]
