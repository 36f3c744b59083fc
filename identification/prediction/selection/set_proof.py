"""The proof of a set of effects: each member beside the others, and all of them together.

Each must be proven on unseen records as an effect that was found alone is, with chance that pays
for all refits, and by both roles of the records where it misses chance alone; the weakest that is
not proven is left out. The set as a whole must hold with the roles of the records exchanged.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from identification.discovery.attempts import attempt
from identification.discovery.passes import uses
from identification.prediction.fits.crossing import at_all_lengths, at_their_best
from identification.prediction.fits.model import WindowModel
from identification.prediction.judging.extension import refitted, with_fitting_steps
from identification.prediction.judging.judging import judged
from identification.prediction.judging.trial import Contender, compared, find_doubt
from identification.prediction.selection.exchange import (
    exchanged,
    is_contradicted,
    with_both_roles,
)
from identification.prediction.selection.set_choice import find_members
from identification.prediction.selection.set_members import Key
from identification.prediction.selection.smooth_rivals import without_imitated
from identification.prediction.task import WindowSearch
from identification.runtime.progress import Progress


def proven_members(
    state: WindowSearch, model: WindowModel, refits: int, progress: Progress
) -> tuple[Contender, ...]:
    """Returns the members that are proven, each beside the others; none where fewer than two are.

    Args:
        state: the model without them.
        model: with all of them, which may have predicted the horizon alone.
        refits: how many effects were refitted, which chance has to pay for.
        progress: is told what is left out.
    """
    task, options = state.task, state.task.options
    shorter = partial(with_fitting_steps, model, task.horizon, task.confirm)
    model = attempt(None, shorter) or model
    while True:
        new = [c.key for c in find_members(model, state.model)]
        if len(new) < 2:  # one alone was refused where it competed with curves
            return ()
        parent, (whole,) = at_all_lengths(
            state.model, [model], task.horizon, task.confirm, uses(options, "states_of_others")
        )
        each = [] if whole is None else [_beside(state, whole, key, refits) for key in new]
        if whole is None or None in each:
            return ()
        known = [c for c in each if c is not None]
        lost = [c for c in known if not c.is_proven]
        if not lost:
            break
        weakest = min(lost, key=lambda c: c.criterion).candidate
        progress(f"{weakest.effect.name}, {weakest.where}: not proven beside the others")
        rest = [c for c in model.candidates if c.key != weakest.key]
        less = refitted(model, rest, task.nominal_model, task.confirm)
        if less is None:
            return ()
        model = less
    seen = compared(parent.unseen, whole.unseen, options)
    is_proven = find_doubt(seen, max(1, refits), options) is None
    return tuple(known) if is_proven and not _is_contradicted(state, parent, whole) else ()


def _beside(state: WindowSearch, model: WindowModel, key: Key, refits: int) -> Contender | None:
    """Returns what an effect does beside the others; None where these cannot be refitted alone."""
    task = state.task
    rest = [c for c in model.candidates if c.key != key]
    mine = [c for c in model.candidates if c.key == key]
    without = refitted(model, rest, task.nominal_model, task.confirm)
    if without is None:
        return None
    best = replace(model, candidates=(*rest, *mine))
    if uses(task.options, "states_of_others"):
        without, (best,) = at_their_best(without, [best], task.horizon, task.confirm)
    found = judged(without, best, max(1, refits), task.options)
    found = _by_both_roles(state, without, found)
    return without_imitated(without, found, task.options)


def _by_both_roles(state: WindowSearch, without: WindowModel, found: Contender) -> Contender:
    """Returns a member, judged by both roles of the records where it misses chance alone.

    Args:
        state: whose records change places.
        without: the model with the other members.
        found: the member beside them.
    """
    task = state.task
    if found.doubt != "chance" or not uses(task.options, "proof_by_both_roles"):
        return found
    other = exchanged(without, task.records, task.horizon)
    if other is None:
        return found
    return with_both_roles([found], other, task.records, task.horizon, task.options)[0]


def _is_contradicted(state: WindowSearch, parent: WindowModel, whole: WindowModel) -> bool:
    """Returns whether all of them predict worse with the roles of the records exchanged."""
    task = state.task
    if not uses(task.options, "exchange_roles"):
        return False
    without, with_it = (exchanged(m, task.records, task.horizon) for m in (parent, whole))
    if without is None or with_it is None:
        return False
    return is_contradicted(without, with_it, whole, task.options)
