"""Scores: how much each candidate would explain of a residual, the free parameters re-tuned.

    E, Φ, S_j                    whitened residual and sensitivities
    r⊥ = r - Φ (ΦᵀΦ + P)⁻¹ Φᵀ r  what re-tuning within the priors P cannot imitate
    η̂_j = (S⊥ᵀS⊥)⁻¹ S⊥ᵀE⊥       the estimate of the size in one linear step
    LR_j = 2 max_ρ log L_j(ρ) - 2 max_ρ log L_0(ρ)       the gain

Each candidate is judged with the noise that is the most likely *with it*, because a missing effect
looks like input noise as long as the model lacks it. The p-value takes the noise of the nominal
model,

    p_j = P(χ²_m > η̂ᵀ S⊥ᵀS⊥ η̂/σ²)          halved where physics admits one sign only,

and is checked by a Wald test that needs no noise model: it takes the scatter of the scores over
blocks of the log, with the candidate in the model (White 1980):

    W = η̂ᵀ H (Σ_b g_b g_bᵀ)⁻¹ H η̂,   g_b = Σ_{k in b} S⊥ᵀ(E⊥ - S⊥ η̂),   H = S⊥ᵀS⊥
    W (B - m)/(B m) ~ F(m, B - m)        B blocks, m sizes
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2
from scipy.stats import f as f_distribution

from identification.blas import one_blas_thread
from identification.discovery.options import DiscoveryOptions
from identification.discovery.scoring.sensitivities import Sensitivity
from identification.effects.effect import Candidate
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise, build_whitener
from identification.kalman.refit import Refit

SHORTEST = 10  # samples of a block at least
SMALLER = (1.0, 0.3, 0.1, 0.03, 0.01, 0.0)  # ρ that are tried, in units of the nominal model's


@dataclass(frozen=True, kw_only=True)
class Score:
    """What a candidate would explain.

    Attributes:
        candidate: the effect, its place and its shapes.
        size: η̂, shape (m,), in the units of its sizes.
        std: of η̂, under the noise with the candidate, shape (m,).
        gain: LR_j.
        p_value: chance that as much is explained by luck, by the noise model.
        block_p_value: the same by blocks.
        identifiable: share of its sensitivity that re-tuning cannot imitate, 0 to 1.
        level: the noise with the candidate.
    """

    candidate: Candidate
    size: np.ndarray
    std: np.ndarray
    gain: float
    p_value: float
    block_p_value: float
    identifiable: float
    level: NoiseLevel


def score(
    fit: Refit, sensitivities: Sequence[Sensitivity], options: DiscoveryOptions
) -> tuple[Score, ...]:
    """Score candidates on a fitted model, the best first.

    Args:
        fit: the model.
        sensitivities: of the candidates, on the fitted samples.
        options: the number of blocks.
    """
    point, noise = fit.point, fit.level.noise
    stacked = np.concatenate([point.e[..., None], point.J, *(s.S for s in sensitivities)], axis=2)
    with one_blas_thread():
        seen = [
            _Projected(fit, noise.scaled(share), stacked, sensitivities)
            for share in (SMALLER if noise.ratio else (1.0,))
        ]
        nominal = max(p.log_likelihood(p.rest) for p in seen)
        out = [_score(j, s, seen, nominal, options) for j, s in enumerate(sensitivities)]
    return tuple(sorted(out, key=lambda s: -s.gain))


class _Projected:
    """Residual and sensitivities under one noise, with the free parameters projected out."""

    def __init__(
        self, fit: Refit, noise: Noise, stacked: np.ndarray, each: Sequence[Sensitivity]
    ) -> None:
        point = fit.point
        filter_ = build_whitener(point.linear, noise, point.log.sampling_time)
        W = filter_(stacked)
        p = point.J.shape[2]
        self.noise, self.samples = noise, point.e.size
        self.log_determinant = filter_.log_determinant
        rest = np.delete(W, np.s_[1 : 1 + p], axis=2)
        flat = rest.reshape(point.e.size, -1)
        self.raw = np.einsum("ij,ij->j", flat, flat)[1:]
        # The priors enter as further measurements: rows below the samples, in units of σ.
        ridge = fit.prior * fit.level.sigma
        F = np.vstack([W[..., 1 : 1 + p].reshape(-1, p), np.diag(ridge)])
        below = np.zeros((p, flat.shape[1]))
        below[:, 0] = ridge * (fit.mean - point.q)
        flat = np.vstack([flat, below])
        C = np.linalg.lstsq(F.T @ F, F.T @ flat, rcond=1e-14)[0]
        flat = flat - F @ C
        self.gram = flat.T @ flat
        self.rest = float(self.gram[0, 0])
        self.perpendicular = flat[: point.e.size].reshape(*rest.shape)
        counts = [s.S.shape[2] for s in each]
        ends = 1 + np.cumsum(counts)
        self.slices = [slice(e - m, e) for m, e in zip(counts, ends, strict=True)]

    def log_likelihood(self, sum_of_squares: float) -> float:
        n = self.samples
        return -0.5 * (n * np.log(sum_of_squares / n) + self.log_determinant)

    def solve(self, j: int, signs: Sequence[int]) -> tuple[np.ndarray, np.ndarray, float]:
        """η̂, its Gram matrix, and the sum of squares with the candidate."""
        s = self.slices[j]
        H, b = self.gram[s, s], self.gram[s, 0]
        size = np.linalg.lstsq(H, b, rcond=1e-12)[0]
        if len(signs) == 1 and signs[0] * size[0] < 0:
            return size, H, self.rest  # physics does not admit the sign
        return size, H, max(self.rest - float(b @ size), 1e-12 * self.rest)


def _score(
    j: int,
    sensitivity: Sensitivity,
    seen: Sequence[_Projected],
    nominal: float,
    options: DiscoveryOptions,
) -> Score:
    signs = [s.sign for s in sensitivity.candidate.effect.sizes]
    solved = [(p, *p.solve(j, signs)) for p in seen]
    best = max(solved, key=lambda s: s[0].log_likelihood(s[3]))
    with_it, size, H, squares = best
    sigma = np.sqrt(squares / with_it.samples)
    gain = 2 * (with_it.log_likelihood(squares) - nominal)
    null = max(solved, key=lambda s: s[0].log_likelihood(s[0].rest))
    m = len(signs)
    statistic = (null[0].rest - null[3]) / (null[0].rest / null[0].samples)
    one_sided = m == 1 and signs[0] != 0
    s = null[0].slices[j]
    e, S = with_it.perpendicular[..., 0], with_it.perpendicular[..., s]
    own = np.trace(null[2])
    return Score(
        candidate=sensitivity.candidate,
        size=size,
        std=sigma * np.sqrt(np.diag(np.linalg.pinv(H, rcond=1e-12, hermitian=True))),
        gain=float(gain),
        p_value=float(chi2.sf(statistic, m)) * (0.5 if one_sided else 1.0),
        block_p_value=_by_blocks(e, S, size, H, signs, options.score_blocks),
        identifiable=float(own / max(null[0].raw[s.start - 1 : s.stop - 1].sum(), 1e-300)),
        level=NoiseLevel(with_it.noise, float(sigma), with_it.log_likelihood(squares)),
    )


def _by_blocks(
    e: np.ndarray,
    S: np.ndarray,
    size: np.ndarray,
    H: np.ndarray,
    signs: Sequence[int],
    most: int,
) -> float:
    """p-value of the Wald test by `most` blocks, or by fewer where they would be too short."""
    m = S.shape[2]
    if m == 1 and signs[0] * size[0] < 0:
        return 1.0
    blocks = min(most, len(e) // SHORTEST)
    starts = np.linspace(0, len(e), blocks, endpoint=False).astype(int)
    scores = np.einsum("nip,ni->np", S, e - S @ size)
    g = np.add.reduceat(scores, starts, axis=0)
    moved = H @ size
    W = float(moved @ np.linalg.pinv(g.T @ g, rcond=1e-12, hermitian=True) @ moved)
    p = float(f_distribution.sf(W * (blocks - m) / (blocks * m), m, blocks - m))
    return p / 2 if m == 1 and signs[0] != 0 else p
