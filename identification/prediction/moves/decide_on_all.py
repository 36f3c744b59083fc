"""An effect that all unseen windows prove, where those that decide are too few for it.

A part of the unseen windows is kept from the search (`identification.logs.parts`), so that what is
told is of data that decided nothing. What acts seldom, such as a spring that hardens far out or a
stop, may act in that part more than in the other. So where nothing is proven and all unseen windows
err far more than noise makes, all of them decide, and none is kept. Two looks pay for both: each
chance counts double.
"""

from __future__ import annotations

from dataclasses import replace

from identification.prediction.moves.add_effect import add_effect
from identification.prediction.remaining import is_much_left
from identification.prediction.task import WindowSearch
from identification.progress import Progress
from identification.windows.unseen import Unseen

LOOKS = 2  # at unseen data, each of which may prove an effect by luck


def decide_on_all(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with an effect that all unseen windows prove; itself where none is."""
    task = state.task
    if state.accepted or not any(state.model.unseen.parts):
        return state
    model = replace(state.model, unseen=_whole(state.model.unseen))
    if not is_much_left(model, task.options):
        return state
    progress("all unseen windows decide, because those that decided prove nothing")
    stricter = replace(task.options, significance=task.options.significance / LOOKS)
    begun = replace(
        state,
        task=replace(
            task, options=stricter, records=tuple(replace(r, parts=None) for r in task.records)
        ),
        model=model, nominal=model, begun=_whole(state.begun),
        worse_fit=None if state.worse_fit is None else _whole(state.worse_fit),
    )  # fmt: skip
    found = add_effect(begun, progress)
    if not found.accepted:
        return replace(state, seconds=found.seconds)
    return replace(found, task=replace(found.task, options=task.options))


def _whole(unseen: Unseen) -> Unseen:
    """Returns errors of which all windows decide and are told of."""
    return replace(unseen, parts=(None,) * len(unseen.parts))
