"""Rivals of an accepted effect: what was refitted in its place, and may be meant."""

from __future__ import annotations

from collections.abc import Sequence

from identification.prediction.model import WindowModel
from identification.prediction.proof import Doubt
from identification.prediction.scores import WindowScore
from identification.prediction.selection import Contender

# Of what an effect explained: one that still explains as much beside another is missing too.
OWN_SHARE = 0.5
# By what was measured, or by what is believed of its size.
CONTRADICTED: tuple[Doubt, ...] = ("lengths", "record", "bound", "exchange")


def find_rivals(
    others: Sequence[Contender], before: WindowModel, scores: Sequence[WindowScore],
    after: WindowModel, then: Sequence[WindowScore],
) -> tuple[Contender, ...]:  # fmt: skip
    """Returns other contenders that explain less than half as much once the best one is there.

    What still explains as much is no rival of the best one: it is missing too. A rival need not be
    proven to make a name doubtful; but what some windows or a record contradict is none, nor what
    ends on the bound of its size, nor what predicts unseen records no better than the model without
    it.

    Args:
        others: refitted in the place of the best one.
        before: the model without it.
        scores: of all candidates on that model.
        after: the model with it.
        then: scores on this one.
    """
    was, still = (
        {s.candidate.key: s.fall * model.fit.cost for s in reversed(each)}
        for each, model in ((scores, before), (then, after))
    )
    return tuple(
        o for o in others
        if o.doubt not in CONTRADICTED and o.prediction.t > 0
        and still.get(o.candidate.key, 0.0) < OWN_SHARE * was.get(o.candidate.key, 0.0)
    )  # fmt: skip
