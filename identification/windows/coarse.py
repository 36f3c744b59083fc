"""Simulations for slopes with longer steps than the model's own.

    ‖S_n - S_1‖ <= ε ‖S_1‖     for each column of the tangent, n steps of the model in one

The residual is exact, so that slopes only say where a search goes: with a relative error ε a step
of Gauss and Newton leaves ε of the way, and misses ε² of what the criterion can gain (inexact
Newton; Dembo, Eisenstat, Steihaug 1982). The number of steps is the largest that keeps it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.effects.jointed import JointPlant
from identification.errors import DivergenceError
from identification.model.rollout import substeps
from identification.windows.shooting import Shooting, tangent

ERROR = 0.1  # ε: a step then misses a hundredth of what it can gain
WINDOWS = 10  # on which slopes are compared


def longest_steps(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], d: Sequence[np.ndarray]
) -> list[Shooting]:
    """The same windows with the longest steps of simulations for slopes that keep the bound.

    Args:
        parts: windows of each record, all of one plant.
        q: the parameters of each, shape (p,).
        d: moves of the states of its windows, shape (W, nx).
    """
    plant = parts[0].predictor.plant
    if not isinstance(plant, JointPlant):
        return [*parts]
    slower = replace(plant, slope_steps=_slope_steps(parts, q, d))
    return [_of(part, slower) for part in parts]


def _slope_steps(
    parts: Sequence[Shooting], q: Sequence[np.ndarray], d: Sequence[np.ndarray]
) -> int:
    """How many steps of the model one step of the simulations for slopes may take."""
    each = [_every(part) for part in parts]
    few = [_some(*at, len(parts)) for at in zip(parts, q, d, strict=True)]
    exact = [_columns(1, *at) for at in few]
    best = 1
    for n in (n for n in range(2, min(each) + 1) if all(k % n == 0 for k in each)):
        try:
            coarse = [_columns(n, *at) for at in few]
        except DivergenceError:
            break
        errors = zip(coarse, exact, strict=True)
        if any(np.any(_size(S - S_1) > ERROR * _size(S_1)) for S, S_1 in errors):
            break
        best = n
    return best


def _of(part: Shooting, plant: JointPlant) -> Shooting:
    return replace(part, predictor=replace(part.predictor, plant=plant))


def _every(part: Shooting) -> int:
    """Steps of the model in a sample."""
    predictor = part.predictor
    return substeps(predictor.log.sampling_time, predictor.plant.model.opt.timestep)


def _some(
    part: Shooting, q: np.ndarray, d: np.ndarray, records: int
) -> tuple[Shooting, np.ndarray, np.ndarray]:
    """A few windows of one record of so many."""
    few = max(2, WINDOWS // records)
    at = np.unique(np.linspace(0, len(d) - 1, few).astype(int))
    return part.rows(at), q, d[at]


def _columns(steps: int, part: Shooting, q: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Slopes of states and parameters, shape (W m, nx + p)."""
    plant = part.predictor.plant
    if isinstance(plant, JointPlant):
        part = _of(part, replace(plant, slope_steps=steps))
    t = tangent(part, q, d)
    X = (t.U * t.s[:, None]) @ t.Vt * t.size[:, None]
    S = np.concatenate([X, t.S], axis=2)
    return np.asarray(S.reshape(-1, S.shape[2]))


def _size(columns: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.norm(columns, axis=0))
