"""A model with one effect more, or with fewer, refitted from where it is.

Size zero is the parent, so that a child never explains less.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.nominal_model import NominalModel
from identification.effects.effect import Candidate
from identification.errors import InputError
from identification.prediction.first_fit import FINE, Begun, shapes_of
from identification.prediction.fit import solve
from identification.prediction.model import WindowModel, predict_fitted
from identification.prediction.problem import with_unknowns
from identification.prediction.records import Record

MOST_REFIT = 12  # its linearisations; an effect that takes more is not what is missing


def with_effect(
    parent: WindowModel, begun: Begun, horizon: float, confirm: Sequence[Record]
) -> WindowModel | None:
    """The model with one effect more, refitted; None where it explains no more than its parent.

    Args:
        parent: the model without it.
        begun: the effect fitted to some of the windows.
        horizon: [s].
        confirm: records that no fit may see.

    Raises:
        InputError: it cannot be simulated on all windows.
    """
    fit = begun.parent.fit
    moves, _ = begun.task.settled(begun.q, fit.moves, fit.tangents, is_thorough=True)
    found = solve(begun.task, begun.q, moves, tolerance=FINE, most=MOST_REFIT)
    if found.cost >= parent.fit.cost:
        return None
    values = {n: v for o in parent.candidates for n, v in (*o.fixed.items(), *o.whole.items())}
    fixed, plant = {**values, **begun.fixed}, begun.parent.plant
    seen = predict_fitted(plant, confirm, horizon, parent.scale, found, fixed, parent.unseen)
    return WindowModel((*parent.candidates, begun.candidate), found, seen, parent.scale)


def refitted(
    model: WindowModel,
    candidates: Sequence[Candidate],
    nominal_model: NominalModel,
    confirm: Sequence[Record],
) -> WindowModel | None:
    """A model with fewer effects, refitted from where it is; None where it cannot be simulated.

    Args:
        model: with more effects.
        candidates: those that it keeps.
        nominal_model: its other free parameters, and the horizon.
        confirm: records that no fit may see.
    """
    fit, old = model.fit, model.fit.problem.unknowns
    keep = {*nominal_model.names, *(n for c in candidates for n in (*c.free, *shapes_of(c)))}
    values = {n: v for c in candidates for n, v in (*c.fixed.items(), *c.whole.items())}
    absent = {
        n: 0.0 for c in model.candidates for n in c.sizes if n not in values and n not in keep
    }
    fixed = {**absent, **values}
    task = with_unknowns(fit.problem, old.shared.only([*keep]), old.own.only([*keep]), fixed)
    q = np.array([fit.q[fit.problem.names.index(n)] for n in task.names])
    horizon = float(nominal_model.horizon or 0.0)
    try:
        found = solve(task, q, fit.moves)
        seen = predict_fitted(
            model.plant, confirm, horizon, model.scale, found, fixed, model.unseen
        )
    except InputError:
        return None
    return WindowModel(tuple(candidates), found, seen, model.scale)
