"""The shift of an estimate by the steps of the simulation.

    δ = H⁻¹ Σ_w S_wᵀ(I - P_w)(r_w(Δ/4) - r_w(Δ))

It is the step of Gauss and Newton with which an estimate under the step Δ, as the search took it,
answers when the model is simulated with a quarter of its own step. The std of an estimate knows
noise and what the model leaves, and nothing of this. Where dry friction turns within a step, an
integrator of any order errs by about Δ, and so does the estimate. H, S_w, P_w and r_w are those of
`identification.prediction.point`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.fitted import StepShift
from identification.model.protocol import finer
from identification.prediction.fit import WindowFit


def step_shift(found: WindowFit) -> StepShift:
    """Returns the change of a fit with a quarter of the model's step.

    Args:
        found: a fit.
    """
    problem, q = found.problem, found.q
    plant, unknown = finer(problem.plant), StepShift(np.full(len(q), np.nan), np.nan)
    if plant is None:
        return unknown
    parts = (replace(p, predictor=replace(p.predictor, plant=plant)) for p in problem.parts)
    finer_problem = replace(problem, parts=tuple(parts))
    errors = attempt(None, lambda: finer_problem.held(q).residuals(found.moves))
    if errors is None or attempt(None, partial(problem.cost_of, q, errors)) is None:
        return unknown
    g, before, after = np.zeros(len(q)), 0.0, 0.0
    for t, r in zip(found.tangents, errors, strict=True):
        S, own = t.projected
        finely = replace(t, r=r).projected[1]
        g = g + np.einsum("wmp,wm->p", S, finely - own)
        before, after = before + float(np.sum(own**2)), after + float(np.sum(finely**2))
    move = np.linalg.pinv(found.curvature, rcond=1e-14, hermitian=True) @ g
    after -= float(g @ move)
    error = float(np.sqrt(max(after, 0.0) / before)) if before > 0 else np.nan
    return StepShift(move * problem.prior.space.slope(q), error)
