"""Windows that feel inputs from before or after their record, once its clocks are known to differ.

    u(t - τ) acts at t; of a record from 0 to T it is not logged where t - τ < 0 or t - τ > T

τ: how much later the inputs act than their stamps say. While no shift is known, each window counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.prediction.fits.model import WindowModel, predict_fitted
from identification.prediction.scoring.first_fit import (
    MAX_LINEARISATIONS,
    REFIT_TOLERANCE,
    thinned,
    thinned_moves,
)
from identification.prediction.task import WindowSearch
from identification.prediction.verdict.told_effects import fitted_sizes
from identification.windows.fit import solve
from identification.windows.records import Record
from identification.windows.windows import logged


def without_edges(state: WindowSearch) -> WindowSearch:
    """Returns the state without windows whose inputs a shift of the clocks takes from elsewhere.

    Args:
        state: whose model may have shifts; without them the state itself is returned.

    Raises:
        InputError: no window of the horizon is left in a record.
        DivergenceError: the model cannot be simulated.
    """
    task, model = state.task, state.model
    shifts = [c for c in model.candidates if c.effect.is_of_records and "input" in c.effect.hooks]
    sizes = [v for c in shifts for v, _, _ in fitted_sizes(model, c)[1].values()]
    steps = np.ceil(np.max(np.abs(sizes), initial=0.0) / task.records[0].log.sampling_time)
    edge = float(steps) * task.records[0].log.sampling_time  # a refit moves τ a little
    if not edge > max(r.edge for r in task.records):
        return state
    records = tuple(replace(r, edge=edge) for r in task.records)
    cut = _cut(model, [r for r in records if r.role == "confirm"], edge, task.horizon)
    return replace(state, task=replace(task, records=records), model=cut, exchanged=None)


def _cut(model: WindowModel, confirm: Sequence[Record], edge: float, horizon: float) -> WindowModel:
    """Returns the model fitted and judged without the windows at the edges of records."""
    at = [
        np.flatnonzero(logged(p.predictor.log, p.cut.places, edge)) for p in model.fit.problem.parts
    ]
    found = solve(
        thinned(model.fit.problem, at), model.fit.q, thinned_moves(model.fit.moves, at),
        tolerance=REFIT_TOLERANCE, most=MAX_LINEARISATIONS,
    )  # fmt: skip
    seen = predict_fitted(model.plant, confirm, horizon, model.scale, found, model.held)
    return replace(model, fit=found, unseen=seen)
