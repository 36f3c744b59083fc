"""The uncertainty of an estimate: its covariance, robust losses, and the effect of finer steps.

    cov(q) = A⁺ B A⁺,   A = Σ_k S_kᵀ S_k,   B = Σ_blocks g_b g_bᵀ,   g_b = Σ_{k in b} S_kᵀ ψ_k/c
    V = Σ ρ(e²),   ψ(e) = ρ'(e²) e,   c = mean of ψ'(e) = mean of ρ' + 2 e² ρ''
    δ = (SᵀS + P)⁻¹ Sᵀ C(ŷ_Δ - ŷ_Δ/4)

This covariance is the sandwich estimator (White 1980), with blocks for coloured noise. It stays
right when the noise is not the same everywhere, as in the thesis' trial 4, where it is 5 % of each
sample. A prior of std s adds 1/s² to A and to B.

Under a robust loss ψ takes the place of the residual e = C ε, and the curvature of the criterion is
c times that of least squares (Huber 1964). Computed from e itself, the std would grow with every
outlier, although the loss has made the outlier harmless. For least squares ψ = e and c = 1.

δ is the step of Gauss and Newton with which an estimate under the step Δ answers when the model is
simulated with a quarter of it. The covariance knows the noise, and nothing of this; δ² is added to
the variances that are told. Where dry friction turns within a step, an integrator of any order errs
by about Δ, and so does the estimate. S are the whitened slopes, P the priors, C whitens.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from identification.errors import DivergenceError, InputError, unknown_name
from identification.estimation.estimation import Estimate
from identification.estimation.identifiability import Identifiability
from identification.estimation.residuals import correlation_time
from identification.model.protocol import finer


class Loss(NamedTuple):
    """A loss of `scipy.optimize.least_squares` as functions of z = e²: ρ, ρ' and ρ''."""

    value: Callable[[np.ndarray], np.ndarray]
    slope: Callable[[np.ndarray], np.ndarray]
    curvature: Callable[[np.ndarray], np.ndarray]


LOSSES: Mapping[str, Loss] = {
    "linear": Loss(lambda z: z, np.ones_like, np.zeros_like),
    "soft_l1": Loss(
        lambda z: 2 * (np.sqrt(1 + z) - 1),
        lambda z: (1 + z) ** -0.5,
        lambda z: -0.5 * (1 + z) ** -1.5,
    ),
    "huber": Loss(
        lambda z: np.where(z <= 1, z, 2 * np.sqrt(z) - 1),
        lambda z: np.maximum(z, 1.0) ** -0.5,
        lambda z: np.where(z > 1, -0.5 * np.maximum(z, 1.0) ** -1.5, 0.0),
    ),
    "cauchy": Loss(np.log1p, lambda z: 1 / (1 + z), lambda z: -1 / (1 + z) ** 2),
    "arctan": Loss(np.arctan, lambda z: 1 / (1 + z**2), lambda z: -2 * z / (1 + z**2) ** 2),
}
# Least c: if it were smaller, nearly all residuals would be outliers, and no std could be believed.
MIN_CURVATURE = 0.01
MOSTLY = 0.7  # of a std: from here on the error of the steps is the larger part


def sandwich(
    S: np.ndarray,
    pull: np.ndarray,
    share: float,
    error: np.ndarray,
    found: Identifiability,
    prior: np.ndarray,
) -> np.ndarray:
    """Returns the covariance of q along directions that log or priors determine, shape (p, p)."""
    n, ny, p = S.shape
    length = min(int(np.ceil(3 * correlation_time(error) - 2)), max(1, n // 30))
    scores = np.einsum("nip,ni->np", S, pull / share)
    blocks = np.add.reduceat(scores, np.arange(0, n, length), axis=0)
    felt, strengths = found.directions[: found.rank], found.strengths[: found.rank]
    inverse = (felt.T / strengths**2) @ felt
    freedom = n * ny / max(1, n * ny - p)
    return inverse @ (freedom * blocks.T @ blocks + prior**2) @ inverse


def bounded(correlation: np.ndarray) -> np.ndarray:
    """Returns a correlation without its rounding: within ±1, and 1 of a parameter with itself."""
    # What no record determines has no variance and keeps its zero.
    inside = np.clip(correlation, -1.0, 1.0)
    diagonal = np.diag(inside)
    np.fill_diagonal(inside, np.where(np.isclose(diagonal, 1.0), 1.0, diagonal))
    return inside


def influence(error: np.ndarray, loss: str) -> tuple[np.ndarray, float]:
    """Returns ψ of each residual, of the same shape, and c.

    Raises:
        InputError: the loss is unknown.
    """
    if loss not in LOSSES:
        raise unknown_name("loss", loss, LOSSES)
    _, first, second = LOSSES[loss]
    z = error**2
    return first(z) * error, max(MIN_CURVATURE, float(np.mean(first(z) + 2 * z * second(z))))


def share_left(error: float) -> float:
    """Returns the share of an rms error that finer steps would leave: 1 where all of it.

    Args:
        error: the error with finer steps over what it is, no unit; NaN where it is not known.
    """
    return min(1.0, error) if np.isfinite(error) else 1.0


def step_shift(
    estimate: Estimate, predicted: np.ndarray, S: np.ndarray, prior: np.ndarray,
    whiten: Callable[[np.ndarray], np.ndarray],
) -> tuple[np.ndarray, float]:  # fmt: skip
    """Returns what a quarter of the model's step would change of an estimate, to first order.

    The first is by how much each value would move, shape (p,), the second the rms of the whitened
    residual then, over what it is now.

    NaN where the plant's step cannot be changed, where it cannot be simulated with a finer one, and
    of a value that a bound holds.

    Args:
        estimate: where a search ended.
        predicted: ŷ there, shape (n, ny), in the outputs' units.
        S: whitened slopes there, shape (n ny, p).
        prior: 1/std of each prior on the diagonal, shape (p, p).
        whiten: C, of columns (n, ny, m) to (n ny, m).
    """
    predictor, q = estimate.predictor, estimate.q
    plant = finer(predictor.plant)
    unknown = np.full(len(q), np.nan)
    if plant is None or estimate.status == "stopped":
        return unknown, np.nan
    values = estimate.space.decode(q)
    try:
        finely = replace(predictor, plant=plant).predict(values)[0]
    except (DivergenceError, InputError):
        return unknown, np.nan
    free = ~estimate.space.on_bound(q)
    S, prior = S[:, free], prior[:, free]
    g = S.T @ whiten((predicted - finely)[:, :, None])[:, 0]
    A = S.T @ S + prior.T @ prior
    out = unknown
    out[free] = np.linalg.pinv(A, rcond=1e-14, hermitian=True) @ g
    measured = predictor.log.outputs
    before, after = (whiten((measured - y)[:, :, None])[:, 0] for y in (predicted, finely))
    size = float(np.linalg.norm(before))
    left = float(np.linalg.norm(after - S @ out[free])) / size if size > 0 else np.nan
    return out * estimate.space.slope(q), left


def with_steps(std: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """Returns √(std² + shift²): std that contain the error of the simulation's steps.

    Args:
        std: of noise and of what the model leaves, shape (p,).
        shift: change of each value with a quarter of the step, shape (p,); NaN where not known.
    """
    return np.hypot(std, np.where(np.isfinite(shift), shift, 0.0))


def mostly_steps(shift: np.ndarray, std: Mapping[str, float]) -> list[str]:
    """Returns the values whose std, by name, is mostly their shift (p,), the worst first."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.abs(shift) / np.array([*std.values()])
    names = [*std]
    return [names[k] for k in np.argsort(-share) if share[k] > MOSTLY]
