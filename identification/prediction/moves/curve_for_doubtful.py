"""Curves of the data take the place of effects that are all in doubt.

A cause that is in no catalogue may be put together from laws: a place where something catches, from
a friction that differs by direction and a cogging. Or a law was found beside a curve, and explains
only what the cause does between the curve's nodes. Where no law is sure, all that are in doubt are
taken out, and curves are asked at their joints. What these draw is an unlisted effect, which says
more than that nothing is known.

The doubtful effects stay, and nothing is named, where no curve is proven, or where unseen records
prove that these effects together predict better than the curves, by enough to matter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.effects.effect import Candidate
from identification.prediction.judging.trial import Contender, compared, find_doubt
from identification.prediction.moves.add_curve import add_curve
from identification.prediction.moves.drop_doubtful import fitted_without, sure_and_doubtful
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.neighbours import share_a_joint
from identification.runtime.progress import Progress


def curve_for_doubtful(state: WindowSearch, progress: Progress) -> WindowSearch:
    """Returns the state with curves in the place of its effects; the state itself with a sure law.

    A curve that is sure stays, and is no law.
    """
    sure, doubtful = sure_and_doubtful(state)
    if not doubtful or not all(a.candidate.effect.is_curve for a in sure):
        return state
    drawn = fitted_without(state, sure, {a.candidate.key for a in doubtful})
    if drawn is None:
        return state
    # No more curves than there were effects: no law is asked again, which would be found beside a
    # curve, and would be what its cause does between the nodes.
    grows = drawn.room > 0
    while grows and len(drawn.accepted) < len(state.accepted):
        at_joints = tuple(s for s in drawn.scores if _is_beside(s.candidate, doubtful))
        # What was refitted before asked another question, and these curves do not pay for it.
        more = add_curve(replace(drawn, scores=at_joints, rejected=()), progress)
        grows = len(more.accepted) > len(drawn.accepted) and more.room > 0
        drawn = more
    if not drawn.accepted or is_better(state, drawn):
        return replace(state, seconds=drawn.seconds)
    for a in doubtful:
        progress(f"{a.candidate.effect.name}, {a.candidate.where}: is in doubt, curves do as much")
    return replace(drawn, rejected=(*doubtful, *state.rejected))


def is_better(state: WindowSearch, drawn: WindowSearch) -> bool:
    """Returns whether effects in doubt predict better than curves, by a part of the gap they close.

    What follows a curve between its nodes takes little away, however surely.

    Args:
        state: with the effects.
        drawn: with the curves in their place.
    """
    options = state.task.options
    if find_doubt(compared(drawn.model.unseen, state.model.unseen, options), 1, options):
        return False
    nominal = state.worse_fit or state.nominal.unseen
    without, curves, laws = (
        float(np.mean(np.concatenate(u.select.at_horizon)))
        for u in (nominal, drawn.model.unseen, state.model.unseen)
    )
    return curves - laws > options.min_gap_share * (without - laws)


def _is_beside(candidate: Candidate, doubtful: Sequence[Contender]) -> bool:
    return any(share_a_joint(candidate, a.candidate) for a in doubtful)
