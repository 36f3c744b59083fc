"""A pair of effects, where the first cannot be proven as long as the second is missing.

An effect may be likely, and predict the next sample of unseen data better, and yet bring the free
run no nearer while another effect is missing. A second effect is then searched beside it. Each of
the two must be proven beside the other, and both together against the model with neither.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    score_candidates,
    try_fit,
)
from identification.discovery.proof import prove
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.discovery.selection.forward_selection import select_effect
from identification.discovery.task import DiscoveryTask
from identification.estimation.options import Progress


def find_pair(
    task: DiscoveryTask,
    model: FittedModel,
    first: FittedModel,
    sensitivities: Sequence[Sensitivity],
    progress: Progress,
) -> tuple[AcceptedEffect, ...]:
    """The effect that is not proven alone and the one beside which it is; empty without such.

    Args:
        task: the nominal model, the log and the options.
        model: the model with neither effect.
        first: the model with the first effect.
        sensitivities: of all candidates.
        progress: is told a line per refit.
    """
    options = task.options
    scores = score_candidates(first, sensitivities, options)
    selection = select_effect(task, first, scores, progress)
    if not selection.accepted:
        return ()
    (second,) = selection.accepted
    pair = second.model
    rest = (*model.candidates, second.candidate)
    alone = try_fit(task, rest, pair.refit.point.values, pair)
    if alone is None:
        return ()
    proof = prove(alone.validation, pair.validation, options)
    together = prove(model.validation, pair.validation, options)
    if not (is_confirmed(proof, options) and is_confirmed(together, options)):
        return ()
    return AcceptedEffect(first, proof, first.negative_bic - model.negative_bic, ()), second
