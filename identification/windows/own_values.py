"""Parameters that an unseen record has for itself: one half of it tells them for the other half."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from identification.estimation.priors import Priors
from identification.estimation.search import ROUGH_TOLERANCE
from identification.model.predictor import Plant
from identification.windows.fit import solve
from identification.windows.problem import no_moves, problem
from identification.windows.records import Record


@dataclass(frozen=True)
class Own:
    """Parameters of which each record has a value of its own."""

    prior: Priors = field(default_factory=Priors)  # what is known of them
    # where their search begins, shape (m,), in coordinates
    start: np.ndarray = field(default_factory=lambda: np.zeros(0))


def own_values(
    plant: Plant, record: Record, horizon: float, scale: np.ndarray, values: Mapping[str, float],
    own: Own,
) -> tuple[dict[str, float], dict[str, float]]:  # fmt: skip
    """Returns a record's own values for each of its halves, as the other half tells them."""
    if not own.prior.names:
        return {}, {}
    task = problem(plant, [record], Priors(), own.prior, horizon, values, scale)
    (part,) = task.parts
    is_late = part.cut.starts >= len(record.log) // 2
    out = []
    for half in (is_late, ~is_late):
        if not half.any():  # nothing tells them but the records that were fitted
            start = own.prior.space.decode(own.start).tolist()
            out.append(dict(zip(own.prior.names, start, strict=True)))
            continue
        mine = replace(task, parts=(part.rows(half),))
        out.append(solve(mine, own.start, no_moves(mine), tolerance=ROUGH_TOLERANCE).of_record(0))
    return out[0], out[1]


def of_halves(a: Mapping[str, float], b: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Returns the mean of values that two halves of a record tell, and its std."""
    return {n: ((a[n] + b[n]) / 2, abs(a[n] - b[n]) / 2) for n in a}
