"""How far the steps of the simulation move an estimate.

    δ = H⁻¹ Σ_w S_wᵀ(I - P_w)(r_w(Δ/4) - r_w(Δ))

It is the step of Gauss and Newton with which an estimate under the step Δ, as the search took it,
answers when the model is simulated with a quarter of its own step. The std of an estimate knows
noise and what the model leaves, and nothing of this. Where dry friction turns within a step, an
integrator of any order errs by about Δ, and so does the estimate. H, S_w, P_w and r_w are those of
`identification.prediction.point`.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification.effects.jointed import JointPlant
from identification.errors import DivergenceError
from identification.model.plant import ModelPlant
from identification.model.predictor import Plant
from identification.prediction.fit import WindowFit
from identification.prediction.point import projected

FINER = 4  # an error that is proportional to the step falls by three quarters


def step_shift(found: WindowFit) -> np.ndarray:
    """By how much each value would change with a quarter of the model's step, shape (p,).

    Args:
        found: a fit.

    Returns:
        In the units of the values; zero where the windows do not feel a value, and NaN where they
        cannot be simulated with finer steps.
    """
    problem, q = found.problem, found.q
    plant = _finer(problem.plant)
    if plant is None:
        return np.full(len(q), np.nan)
    parts = (replace(p, predictor=replace(p.predictor, plant=plant)) for p in problem.parts)
    try:
        errors = replace(problem, parts=tuple(parts)).held(q).residuals(found.moves)
        problem.cost_of(q, errors)
    except DivergenceError:
        return np.full(len(q), np.nan)
    return _answer(found, errors) * problem.prior.space.slope(q)


def _answer(found: WindowFit, errors: Sequence[np.ndarray]) -> np.ndarray:
    """The step of q that other residuals ask for, shape (p,)."""
    H = np.diag(found.problem.prior.weight**2)
    g = np.zeros(len(found.q))
    for t, r in zip(found.tangents, errors, strict=True):
        S, change = projected(replace(t, r=r - t.r))
        H = H + np.einsum("wmp,wmq->pq", S, S)
        g = g + np.einsum("wmp,wm->p", S, change)
    return np.asarray(np.linalg.pinv(H, rcond=1e-14, hermitian=True) @ g)


def _finer(plant: Plant) -> JointPlant | ModelPlant | None:
    """The same plant with a quarter of its model's own step; None for a plant of another kind."""
    if isinstance(plant, JointPlant):
        return plant.with_step(1 / FINER)
    if not isinstance(plant, ModelPlant):
        return None
    model = copy.copy(plant.model)
    model.opt.timestep /= FINER
    return replace(plant, model=model)
