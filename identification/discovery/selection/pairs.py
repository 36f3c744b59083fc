"""Two effects at once, where the first alone cannot be proven for want of the second.

An effect may be likely and foretell the next sample of unseen data, and yet bring a free run no
nearer while another is missing. Then a second is sought beside it; each must be proven beside the
other, and both against the model with neither.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification.discovery.fitted_model import (
    AcceptedEffect,
    FittedModel,
    is_confirmed,
    score_candidates,
    try_fit,
)
from identification.discovery.nominal_model import NominalModel
from identification.discovery.proof import prove
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.discovery.selection.forward_selection import select_effect
from identification.logs.log import Log


def find_pair(
    base: NominalModel,
    whole: Log,
    step: FittedModel,
    first: FittedModel,
    columns: Sequence[Sensitivity],
    say: Callable[[str], None],
) -> tuple[AcceptedEffect, ...]:
    """An effect that is not proven alone, and the one beside which it is; none where there is none.

    Args:
        base: the nominal model.
        whole: the log.
        step: the model with neither.
        first: the model with the first.
        columns: sensitivities of all candidates.
        say: is told a line per refit.
    """
    second, *_ = select_effect(base, whole, first, score_candidates(first, columns), say)
    if second is None:
        return ()
    pair = second.step
    other = pair.candidates[-1]
    rest = (*step.candidates, other)
    alone = try_fit(base, whole, rest, pair.refit.point.values, pair)
    if alone is None:
        return ()
    proof = prove(alone.validation, pair.validation)
    if not (is_confirmed(proof) and is_confirmed(prove(step.validation, pair.validation))):
        return ()
    return AcceptedEffect(first, proof, first.criterion - step.criterion, ()), second
