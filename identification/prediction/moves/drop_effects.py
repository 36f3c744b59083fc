"""Effects that later ones have made needless.

An effect is needless where unseen records are predicted as well without it, by chance or but for
too little to matter. The last one was just proven.
"""

from __future__ import annotations

from collections.abc import Sequence

from identification.discovery.moves import drop_needless
from identification.discovery.passes import uses
from identification.effects.effect import Candidate
from identification.prediction.fits.crossing import at_their_best
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import refitted
from identification.prediction.judging.trial import Contender, Doubt, compared, find_doubt
from identification.prediction.task import Change, RecordsTask, WindowSearch
from identification.runtime.progress import Progress

NEEDLESS: tuple[Doubt, ...] = ("chance", "little")  # others make up for it


def drop_effects(state: WindowSearch, progress: Progress) -> Change:
    """Returns the state's model without needless effects, and those that stay."""

    def without(model: WindowModel, old: Contender) -> WindowModel | None:
        rest = [c for c in model.candidates if c.key != old.candidate.key]
        return as_good_without(model, rest, state.task)

    kept, model = drop_needless(state.model, state.accepted, without, progress)
    return model, kept, ()


def as_good_without(
    model: WindowModel, candidates: Sequence[Candidate], task: RecordsTask
) -> WindowModel | None:
    """Returns the refit of fewer effects or places; None where it predicts unseen records worse.

    Args:
        model: with all of them.
        candidates: those that it keeps.
        task: what is asked.

    Returns:
        None also where it cannot be simulated.
    """
    without = refitted(model, candidates, task.nominal_model, task.confirm)
    if without is None:
        return None
    best = model
    if uses(task.options, "states_of_others"):
        without, (best,) = at_their_best(without, [model], task.horizon, task.confirm)
    doubt = find_doubt(compared(without.unseen, best.unseen, task.options), 1, task.options)
    return without if doubt in NEEDLESS else None
