"""Two effects at once, where the first alone cannot be proven for want of the second.

An effect may be likely and foretell the next sample of unseen data, and yet bring a free run no
nearer while another is missing. Then a second is sought beside it; each must be proven beside the
other, and both against the model with neither.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from identification.discovery.columns import Column
from identification.discovery.extend import Base
from identification.discovery.forward import add
from identification.discovery.proof import prove
from identification.discovery.steps import Accepted, Step, fitted_if_any, holds, scores_of
from identification.logs.log import Log


def both(
    base: Base,
    whole: Log,
    step: Step,
    first: Step,
    columns: Sequence[Column],
    say: Callable[[str], None],
) -> tuple[Accepted, ...]:
    """An effect that is not proven alone, and the one beside which it is; none where there is none.

    Args:
        base: the nominal model.
        whole: the log.
        step: the model with neither.
        first: the model with the first.
        columns: sensitivities of all candidates.
        say: is told a line per refit.
    """
    second, *_ = add(base, whole, first, scores_of(first, columns), say)
    if second is None:
        return ()
    pair = second.step
    other = pair.candidates[-1]
    rest = (*step.candidates, other)
    alone = fitted_if_any(base, whole, rest, pair.refit.at.values, pair)
    if alone is None:
        return ()
    proof = prove(alone.unseen, pair.unseen)
    if not (holds(proof) and holds(prove(step.unseen, pair.unseen))):
        return ()
    return Accepted(first, proof, first.criterion - step.criterion, ()), second
