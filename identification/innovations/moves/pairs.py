"""A pair of effects, where the first cannot be proven as long as the second is missing.

An effect may be likely, and predict the next sample of unseen data better, and yet bring the free
run no nearer while another effect is missing. A second effect is then searched beside it. Each of
the two must be proven beside the other, and both together against the model with neither.

Or the first was only in the place of the second, which did not show before: a linear score says
little where the fit without an effect has moved the parameters far. The second is then accepted
alone, if it is likelier than the first and proven against the model with neither.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.innovations.fitted_model import (
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    score_candidates,
    try_fit,
)
from identification.innovations.moves.forward_selection import select_effect
from identification.innovations.proof import prove
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.innovations.task import DiscoveryTask
from identification.runtime.progress import Progress


def find_pair(
    task: DiscoveryTask,
    model: FittedModel,
    first: FittedModel,
    sensitivities: Sequence[Sensitivity],
    progress: Progress,
) -> tuple[AcceptedEffect, ...]:
    """Returns two effects of which the first is proven only beside the second, or the second alone.

    Args:
        task: the nominal model, the log and the options.
        model: the model with neither effect.
        first: the model with the first effect.
        sensitivities: of all candidates.
        progress: is told a line per refit.

    Returns:
        The accepted effects, of which the last has the model with all of them; empty without any.
    """
    options = task.options
    scores = score_candidates(first, sensitivities, options)
    selection = select_effect(task, first, scores, progress)
    if not selection.accepted:
        return ()
    (second,) = selection.accepted
    pair = second.model
    rest = (*model.candidates, second.candidate)
    alone = try_fit(task, rest, pair.refit.point.values, pair, tried=second.candidate)
    if alone is None:
        return ()
    proof = prove(alone.validation, pair.validation, options)
    together = prove(model.validation, pair.validation, options)
    tried = len(second.alternatives) + 2  # with the first
    if all(is_confirmed(p, options, tried) for p in (proof, together)):
        return AcceptedEffect(first, proof, first.negative_bic - model.negative_bic, ()), second
    instead, gain = prove(model.validation, alone.validation, options), _gain(model, alone)
    if gain > _gain(model, first) and is_confirmed(instead, options, tried):
        return (AcceptedEffect(alone, instead, gain, (first,)),)
    return ()


def _gain(model: FittedModel, new: FittedModel) -> float:
    return new.negative_bic - model.negative_bic
