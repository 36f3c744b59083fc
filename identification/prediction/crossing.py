"""Models compared at their best: windows of each begin where those of the others begin too.

    V_w <- min(V_w, V_w from x'_w)      x'_w: where the window begins with a model that has less

Where a joint sticks in a window, its criterion has several minima, and the one that a search found
by luck would decide which law is the better one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.prediction.fit import WindowFit
from identification.prediction.model import WindowModel, predict_fitted
from identification.prediction.records import Record
from identification.prediction.unseen import best_begun
from identification.windows.settling import Settled, begun_at, best_settled, settle


def crossed(fit: WindowFit, others: Sequence[WindowFit]) -> WindowFit:
    """A fit whose windows begin where they are best, of what its own search and others found.

    Args:
        fit: whose parameters stay as they are.
        others: fits of the same windows with other effects.
    """
    own = [np.sum(t.r**2, axis=1) for t in fit.tangents]
    squares = [np.array([np.sum(o.tangents[k].r ** 2, axis=1) for o in others])
               for k in range(len(own))]  # fmt: skip
    less = [s.min(axis=0) < mine for s, mine in zip(squares, own, strict=True)]
    if not any(at.any() for at in less):
        return fit
    begun = []
    for k, d in enumerate(fit.moves):
        each = np.array([begun_at(d, o.moves[k]) for o in others])
        best = each[squares[k].argmin(axis=0), np.arange(len(d))]
        begun.append(np.where(less[k][:, None], best, d))
    try:
        found = settle(fit.problem.held(fit.q), begun, fit.tangents)
        old = (Settled(d, t.r) for d, t in zip(fit.moves, fit.tangents, strict=True))
        best_of = [best_settled(pair) for pair in zip(old, found, strict=True)]
        moves, r = tuple(s.d for s in best_of), [s.r for s in best_of]
        tangents = fit.problem.tangents(fit.q, moves, r)
    except InputError:  # from there it diverges: what its own search found stands
        return fit
    return replace(
        fit, moves=moves, tangents=tangents, cost=fit.problem.cost_of(fit.q, r)
    )  # fmt: skip


def at_their_best(
    parent: WindowModel, children: Sequence[WindowModel], horizon: float, confirm: Sequence[Record]
) -> tuple[WindowModel, tuple[WindowModel, ...]]:
    """A model and models with one effect more, whose windows begin at the best that any one found.

    Args:
        parent: the model without the effects.
        children: models with one of them each.
        horizon: [s].
        confirm: records that no fit may see.
    """
    if not children:
        return parent, ()
    parent = _crossed(parent, children, horizon, confirm)
    best = []
    for c in children:
        others = [parent, *(o for o in children if o is not c)]
        best.append(_crossed(c, others, horizon, confirm))
    return parent, tuple(best)


def _crossed(
    model: WindowModel, others: Sequence[WindowModel], horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """A model whose windows begin where they are best, of what its searches and others found."""
    fit = crossed(model.fit, [o.fit for o in others])
    names = fit.problem.unknowns.local.names
    fixed = {n: v for n, v in model.values.items() if n not in names}
    near = [model.unseen, best_begun(model.unseen, [o.unseen for o in others])]
    seen = predict_fitted(model.plant, confirm, horizon, model.scale, fit, fixed, near)
    return replace(model, fit=fit, unseen=seen)
