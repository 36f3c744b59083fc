"""Each of several effects is the best of what may stand in its place, beside the others.

An effect is accepted beside those that were found before it, and what is found later changes what
its place needs: a Stribeck peak that was found beside cogging is Coulomb friction once a friction
that grows with the square of speed is there too. So where a name is in doubt, or much is left, each
effect is taken out, all laws are scored and the best refitted in its place. The new effects are
taken where unseen records prove all of them, each beside the others and all together, and where
they leave little: a law that is near what is missing is then no better than the one before it.
"""

from __future__ import annotations

from dataclasses import replace

from identification.discovery.moves import Watch
from identification.prediction.moves.add_set import with_members
from identification.prediction.moves.drop_doubtful import sure_and_doubtful
from identification.prediction.selection.set_members import each_at_its_best
from identification.prediction.selection.set_proof import proven_members
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.doubts import laws_of
from identification.prediction.verdict.remaining import is_much_left
from identification.runtime.progress import Progress


def exchange_effects(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with better effects in the places of its own, or as it is where none are.

    Args:
        state: with all effects that were found.
        progress: is told what is refitted in their places.
    """
    laws = [a for a in laws_of(state) if not a.candidate.effect.is_curve]
    if len(laws) < 2 or len(laws) < len(state.accepted):
        return state
    if not is_much_left(state.model, state.task.options) and not sure_and_doubtful(state)[1]:
        return state
    watch = Watch(state.seconds)
    before = replace(
        state, model=state.nominal, accepted=(), scores=state.nominal_scores, rejected=()
    )
    model, places = each_at_its_best(before, state.model, progress)
    is_new = {c.key for c in model.candidates} != {c.key for c in state.model.candidates}
    refits = sum(len(p.tried) for p in places.values())
    found = proven_members(before, model, refits, progress) if is_new else ()
    watch.stop("refits")
    if len(found) < len(laws) or is_much_left(found[0].model, state.task.options):
        return replace(state, seconds=watch.seconds)
    return with_members(replace(before, seconds=watch.seconds), found, places)
