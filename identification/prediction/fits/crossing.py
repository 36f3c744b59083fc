"""Models compared at their best: windows of each begin where those of the others begin too.

    V_w <- min(V_w, V_w from x'_w)      x'_w: where the window begins with a model that has less

Where a joint sticks in a window, its criterion has several minima, and the one that a search found
by luck would decide which law is the better one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt, attempt_each, refuse_infinite
from identification.prediction.fits.model import WindowModel, predict_fitted
from identification.runtime.pool import run_parts
from identification.windows.fit import WindowFit
from identification.windows.records import Record
from identification.windows.settling import Starts, best_starts, sought_from_others
from identification.windows.unseen import LENGTHS, Unseen


def crossed(fit: WindowFit, others: Sequence[WindowFit]) -> WindowFit:
    """Returns a fit whose windows begin at the best states that its own search or others found.

    Args:
        fit: whose parameters stay as they are.
        others: fits of the same windows with other effects.
    """
    mine, *theirs = (
        [Starts(d, s) for d, s in zip(f.moves, _squares(f, fit), strict=True)]
        for f in (fit, *others)
    )
    starts = [best_starts(one, rest) for one, *rest in zip(mine, *theirs, strict=True)]
    if not any(is_better.any() for _, is_better in starts):
        return fit
    known = [t.r for t in fit.tangents]
    found = sought_from_others(fit.problem.held(fit.q), fit.moves, starts, known)
    moves, r = tuple(s.d for s in found), [s.r for s in found]
    is_moved = [np.any(new != old, axis=1) for new, old in zip(moves, fit.moves, strict=True)]
    tangents = fit.problem.tangents_after(fit.tangents, fit.q, moves, r, is_moved)
    return replace(
        fit, moves=moves, tangents=tangents, cost=fit.problem.cost_of(fit.q, r)
    )  # fmt: skip


def _squares(fit: WindowFit, like: WindowFit) -> list[np.ndarray]:
    """Returns the sum of squares of each window, shape (W,), as another fit weighs its outputs."""
    out = []
    for own, part, t in zip(like.problem.parts, fit.problem.parts, fit.tangents, strict=True):
        _, L, ny = part.cut.outputs.shape
        factors = np.diag(own.whitener) / np.diag(part.whitener)
        rows = t.r * np.concatenate([np.tile(factors, L), np.ones(t.r.shape[1] - L * ny)])
        out.append(np.sum(rows**2, axis=1))
    return out


def at_their_best(
    parent: WindowModel, children: Sequence[WindowModel], horizon: float, confirm: Sequence[Record]
) -> tuple[WindowModel, tuple[WindowModel, ...]]:
    """Returns a parent and its children, whose windows begin at the best states that any found.

    Args:
        parent: the model without the effects.
        children: models with one of them each.
        horizon: [s].
        confirm: records that no fit may see.
    """
    if not children:
        return parent, ()
    parent = _crossed(parent, children, horizon, confirm)

    def best(c: WindowModel) -> WindowModel:
        others = [parent, *(o for o in children if o is not c)]
        return _crossed(c, others, horizon, confirm)

    return parent, tuple(run_parts(best, children))


def at_all_lengths(
    parent: WindowModel, children: Sequence[WindowModel], horizon: float,
    confirm: Sequence[Record], crosses: bool = True,
) -> tuple[WindowModel, tuple[WindowModel | None, ...]]:  # fmt: skip
    """Returns a parent and its children, which predict windows of every length at their best.

    Args:
        parent: the model without the effects.
        children: models with one of them each, of which some have predicted the horizon alone.
        horizon: [s].
        confirm: records that no fit may see.
        crosses: whether windows of each may begin where those of the others do.

    Returns:
        The model, and the others in their order; None for one that cannot be simulated over the
        other lengths, which is told.
    """
    tasks = [(c.candidates[-1], partial(_completed, c, parent, horizon, confirm)) for c in children]
    found = [*attempt_each(tasks)]
    whole = [c for c in found if c is not None]
    if not whole or not crosses:
        return parent, tuple(found)
    lengths = [n for n in parent.unseen.lengths if n != 1.0]

    def best(model: WindowModel, others: Sequence[WindowModel]) -> WindowModel:
        moved = partial(_begun_best, model, others, horizon, confirm, lengths)
        return attempt(None, moved) or model

    parent = best(parent, whole)

    def child(c: WindowModel | None) -> WindowModel | None:
        return None if c is None else best(c, [parent, *(o for o in whole if o is not c)])

    return parent, tuple(run_parts(child, found))


def _completed(
    model: WindowModel, parent: WindowModel, horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """Returns the model with predictions of windows of every length that its parent predicts."""
    rest = [n for n in parent.unseen.lengths if n not in model.unseen.lengths]
    if not rest:
        return model
    more = _predicted(model, horizon, confirm, parent.unseen, lengths=rest)
    refuse_infinite(*(s for of_length in more.squares for s in of_length))
    return replace(model, unseen=model.unseen.plus(more))


def _crossed(
    model: WindowModel, others: Sequence[WindowModel], horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """Returns a model whose windows begin at the best states that its searches or others found.

    Where one of these cannot be simulated, or beside it, what its own search found stands.
    """
    return attempt(None, partial(_moved, model, others, horizon, confirm)) or model


def _moved(
    model: WindowModel, others: Sequence[WindowModel], horizon: float, confirm: Sequence[Record]
) -> WindowModel:
    """Returns the model whose windows begin at these states; raises if it cannot be simulated."""
    model = replace(model, fit=crossed(model.fit, [o.fit for o in others]))
    return _begun_best(model, others, horizon, confirm, model.unseen.lengths)


def _begun_best(
    model: WindowModel, others: Sequence[WindowModel], horizon: float, confirm: Sequence[Record],
    lengths: Sequence[float],
) -> WindowModel:  # fmt: skip
    """Returns the model with unseen windows of some lengths begun at any model's best states."""
    theirs = [o.unseen for o in others]
    seen = _predicted(model, horizon, confirm, model.unseen, theirs, lengths)
    refuse_infinite(model.fit.cost, *(s for of_length in seen.squares for s in of_length))
    return replace(model, unseen=seen)


def _predicted(
    model: WindowModel, horizon: float, confirm: Sequence[Record], near: Unseen,
    others: Sequence[Unseen] = (), lengths: Sequence[float] = LENGTHS,
) -> Unseen:  # fmt: skip
    """Returns the errors of a fitted model on unseen records, as `predict_fitted` has them."""
    names = model.fit.problem.unknowns.local.names
    fixed = {n: v for n, v in model.values.items() if n not in names}
    return predict_fitted(
        model.plant, confirm, horizon, model.scale, model.fit, fixed, near, others, lengths
    )
