"""What the values of a fit over windows are worth: their std, and their shift by finer steps.

    ν_j = ((Σ_b h_bj + w_j)/Σ_b h_bj)² ((Σ_b h_bj)²/Σ_b h_bj² - 1)
    h_bj = a_jᵀ H_b a_j,   w_j = a_jᵀ W² a_j,   a_j = H⁻¹ e_j,   H = Σ_b H_b + W²
    V_j = a_jᵀ (Σ_y v_y H_y + W²) a_j
    δ = H⁻¹ Σ_w S_wᵀ(I - P_w)(r_w(Δ/4) - r_w(Δ))
    V(Δ/4) = Σ_w ‖(I - P_w)(r_w(Δ/4) - S_w δ)‖²

The variance of a value is a sum over blocks b of windows and a share w of its prior. A variance of
ν degrees of freedom (Satterthwaite 1946, for clusters Bell and McCaffrey 2002) is too small by a
factor of up to ν/χ²(ν, 2.5 %): of one window it is nothing, whatever number comes out of it. With
few the variance is no smaller than V_j, which takes errors where the value is felt for as large as
elsewhere: H_y is of the rows of output y, v_y the mean square of its errors along what is slow
(`readings`).

The std by blocks knows noise and what the model leaves, and nothing of the steps Δ. Where
dry friction turns within a step, an integrator of any order errs by about Δ, and so does the
estimate: δ is the step of Gauss and Newton with which it answers to a quarter of the step. H, S_w,
P_w and r_w are those of `identification.windows.point`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.fitted import StepShift
from identification.model.protocol import finer
from identification.prediction.fits.readings import slow_square
from identification.windows.fit import STD_BLOCKS, WindowFit

MIN_FREEDOM = 3.0  # degrees of freedom: the std is right within a factor 4 in 19 cases of 20


def told_std(found: WindowFit) -> np.ndarray:
    """Returns the std of each value by blocks of windows, in its unit, shape (p,).

    It is inf where no window feels the parameter, and NaN where the value lies on a bound: there
    the bound holds it, and the windows would have moved it farther.

    Args:
        found: a fit.
    """
    std = found.std
    few = np.isfinite(std) & is_told_by_few(found)
    std = np.where(few, np.maximum(std, _pooled_std(found)), std) if few.any() else std
    on_bound = found.problem.prior.space.on_bound(found.q)
    return np.where(on_bound & np.isfinite(std), np.nan, std)


def is_told_by_few(found: WindowFit) -> np.ndarray:
    """Returns whether so few windows tell each value that their scatter is not known, shape (p,).

    Args:
        found: a fit.
    """
    return np.asarray(degrees_of_freedom(found) < MIN_FREEDOM)


def _pooled_std(found: WindowFit) -> np.ndarray:
    """Returns V^½ in the unit of each value, shape (p,)."""
    L, ny = found.problem.parts[0].cut.outputs.shape[1:]
    v, prior = slow_square(found), found.problem.prior
    inverse = np.linalg.pinv(found.curvature, rcond=1e-14, hermitian=True)
    meat = np.diag(prior.weight**2)
    for t in found.tangents:
        S = t.projected[0][:, : L * ny]
        S = (S.reshape(len(S), L, ny, -1) * np.sqrt(v)[:, None]).reshape(*S.shape)
        meat = meat + np.einsum("wmp,wmq->pq", S, S)
    return np.sqrt(np.diag(inverse @ meat @ inverse)) * prior.space.slope(found.q)


def degrees_of_freedom(found: WindowFit) -> np.ndarray:
    """Returns ν of the std of each value, shape (p,), without unit.

    Args:
        found: a fit.
    """
    columns = (t.projected[0] for t in found.tangents)
    windows = np.concatenate([np.swapaxes(S, 1, 2) @ S for S in columns])  # H_w, (W, p, p)
    blocks = np.array_split(windows, min(STD_BLOCKS, len(windows)))
    each = np.array([b.sum(axis=0) for b in blocks])
    W2 = np.diag(found.problem.prior.weight**2)
    a = np.linalg.pinv(each.sum(axis=0) + W2, rcond=1e-14, hermitian=True)
    h = np.einsum("pj,bpq,qj->bj", a, each, a)
    w = np.einsum("pj,pq,qj->j", a, W2, a)
    total = h.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        told = ((total + w) / total) ** 2 * (total**2 / np.sum(h**2, axis=0) - 1)
    return np.where(total > 0, told, np.inf)


@lru_cache(maxsize=2)  # a search asks again of the model that stays, and of the fit of its effect
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
    g, before, each = np.zeros(len(q)), 0.0, []
    for t, r in zip(found.tangents, errors, strict=True):
        S, own = t.projected
        finely = replace(t, r=r).projected[1]
        g, before = g + np.einsum("wmp,wm->p", S, finely - own), before + float(np.sum(own**2))
        each.append((S, finely))
    move = np.linalg.pinv(found.curvature, rcond=1e-14, hermitian=True) @ g
    # As V - gᵀδ it would be less than nothing where a prior pulls or the search ended early.
    after = sum(float(np.sum((finely - S @ move) ** 2)) for S, finely in each)
    error = float(np.sqrt(after / before)) if before > 0 else np.nan
    return StepShift(move * problem.prior.space.slope(q), error)
