"""Scores: how much each candidate would explain of a residual, the free parameters re-tuned.

    E, Φ, S_j                    whitened residual and sensitivities
    r⊥ = r - Φ (ΦᵀΦ + P)⁻¹ Φᵀ r  what re-tuning within the priors P cannot imitate
    η̂_j = (S⊥ᵀS⊥)⁻¹ S⊥ᵀE⊥       the estimate of the size in one linear step
    LR_j = 2 max_ρ log L_j(ρ) - 2 max_ρ log L_0(ρ)       the gain

Each candidate is judged with the noise that is the most likely *with it*, because a missing effect
looks like input noise as long as the model lacks it. Its chance is that of a test by blocks under
the noise of the nominal model (`identification.estimation.block_test`), in which candidates scatter
no less than that noise says.

All columns are whitened by the nominal noise and by the largest one, which mostly are the same. The
covariance V of another, smaller ρ is less, so that H(ρ) is no less than that of the largest, and

    LR_j under ρ  ≤  that with a fall of  bᵀ H⁻¹ b         b of ρ, H of the largest ρ

Only where this bound comes near the best noise yet, columns are whitened by ρ too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Candidate
from identification.estimation.block_test import (
    Scatter,
    common_scatter,
    make_blocks,
    p_values,
    scatter_of,
)
from identification.innovations.scoring.projection import (
    Products,
    Projection,
    is_refused,
)
from identification.innovations.scoring.sensitivities import Sensitivity
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.refit import Refit
from identification.runtime.pool import one_blas_thread, run_parts, split

MIN_SCORE_SAMPLES = 10  # of a block of fitted samples
MAX_COLUMNS, MAX_COLUMN_BYTES = 96, 2**24  # that are projected at once
LIKELIHOOD_ROUNDING = 1e-6  # of twice a log likelihood: far more than rounding, and of no account
RATIO_FACTORS = (1.0, 0.3, 0.1, 0.03, 0.01, 0.0)  # of the nominal model's ρ, that are tried


@dataclass(frozen=True, kw_only=True)
class Score:
    """A candidate with what it would explain."""

    candidate: Candidate  # the effect, its place and its shapes
    size: np.ndarray  # η̂, shape (m,), in the units of its sizes
    std: np.ndarray  # of η̂, under the noise with the candidate, shape (m,)
    gain: float  # LR_j
    p_value: float  # chance that as much is explained by luck
    identifiable: float  # share of its sensitivity that re-tuning cannot imitate, 0 to 1
    level: NoiseLevel  # the noise with the candidate
    freedom: float = np.inf  # degrees of freedom of that chance

    @property
    def explains(self) -> float:
        """The measure by which candidates are told: the gain."""
        return self.gain


def score(
    fit: Refit, sensitivities: Sequence[Sensitivity], options: DiscoveryOptions
) -> tuple[Score, ...]:
    """Score candidates on a fitted model, the best first.

    Args:
        fit: the model.
        sensitivities: of the candidates, on the fitted samples.
        options: the number of blocks.
    """
    blocks = max(1, min(options.score_blocks, len(fit.point.e) // MIN_SCORE_SAMPLES))
    with one_blas_thread():
        scorer = _scorer(fit, blocks)
        scorer.add([s for s in sensitivities if id(s) not in scorer.known])
        found = scorer.scores(sensitivities)
    return tuple(sorted(found, key=lambda s: -s.gain))


@lru_cache(maxsize=1)
def _scorer(fit: Refit, blocks: int) -> _Scorer:
    """Returns what scores candidates on the last fit: a score does not depend on the others."""
    noise, samples = fit.level.noise, len(fit.point.e)
    noises = [noise.scaled(share) for share in (RATIO_FACTORS if noise.ratio else (1.0,))]
    levels = run_parts(partial(Projection, fit), noises)
    return _Scorer(levels, np.linspace(0, samples, blocks, endpoint=False).astype(int))


def _numbers(sensitivities: Sequence[Sensitivity]) -> list[int]:
    """Returns the numbers of sizes that candidates have, in ascending order."""
    return sorted({s.S.shape[2] for s in sensitivities})


def _groups(sensitivities: Sequence[Sensitivity], m: int) -> list[list[int]]:
    """Returns groups of indices of candidates with m sizes, as many as are projected at once."""
    places = [j for j, s in enumerate(sensitivities) if s.S.shape[2] == m]
    most = min(MAX_COLUMNS // m, MAX_COLUMN_BYTES // max(1, sensitivities[0].S[..., 0].nbytes * m))
    return [places[some] for some in split(len(places), max(1, most))]


@dataclass
class _Best:
    """Results on J candidates under the likeliest noise that was tried for each."""

    level: np.ndarray  # index of that noise, shape (J,)
    likely: np.ndarray  # log likelihood with the candidate, shape (J,)
    squares: np.ndarray  # the sum of squares, shape (J,)
    size: np.ndarray  # η̂, shape (J, m)
    products: Products  # under that noise

    def improve(self, places: np.ndarray, other: _Best) -> None:
        """Take over what another noise has found for the candidates at some places."""
        better = other.likely > self.likely[places]
        better |= (other.likely == self.likely[places]) & (other.level < self.level[places])
        to, took = places[better], np.flatnonzero(better)
        for name in ("level", "likely", "squares", "size"):
            getattr(self, name)[to] = getattr(other, name)[took]
        self.products.H[to] = other.products.H[took]


@dataclass(frozen=True)
class _Known:
    """A candidate that is scored, but for its chance, which depends on what others scatter."""

    sensitivity: Sensitivity  # of the candidate, which is kept so that its identity is no other's
    score: Score  # with a chance of 1
    scatter: Scatter  # of the candidates that were scored with it
    place: int  # its own one among them


class _Scorer:
    """Scores of candidates on a fit, by the identity of their sensitivities."""

    def __init__(self, levels: Sequence[Projection], starts: np.ndarray) -> None:
        self.levels, self.starts = levels, starts
        self.known: dict[int, _Known] = {}
        self.scatters: list[Scatter] = []
        self.without = np.array([float(p.log_likelihood(np.array(p.rest))) for p in levels])
        self.null = int(self.without.argmax())
        self.largest = int(np.argmax([p.noise.ratio for p in levels]))

    def add(self, new: Sequence[Sensitivity]) -> None:
        """Score candidates that are not known yet."""
        places = [some for m in _numbers(new) for some in _groups(new, m)]
        groups = [[new[j] for j in some] for some in places]
        for found in run_parts(self._scored, groups):
            self.scatters.append(found[0].scatter)
            self.known |= {id(k.sensitivity): k for k in found}

    def scores(self, sensitivities: Sequence[Sensitivity]) -> list[Score]:
        """Returns the scores of known candidates; all that are known tell how they scatter."""
        common = common_scatter(self.scatters, least=1.0)
        chances: dict[int, np.ndarray] = {}
        out = []
        for known in (self.known[id(s)] for s in sensitivities):
            scatter = known.scatter
            if id(scatter) not in chances:
                chances[id(scatter)] = p_values(scatter, common)
            freedom = common.freedom + float(scatter.blocks.freedom[known.place])
            chance = float(chances[id(scatter)][known.place])
            out.append(replace(known.score, p_value=chance, freedom=freedom))
        return out

    def _scored(self, some: Sequence[Sensitivity]) -> list[_Known]:
        """Returns candidates that have the same number of sizes, scored, in their order."""
        S = np.stack([s.S for s in some], axis=2)
        signs = np.array([[size.sign for size in s.candidate.effect.sizes] for s in some])
        null = self._try(self.null, S, signs)
        first = null if self.largest == self.null else self._try(self.largest, S, signs)
        bound = self._bound(S, first.products)
        own = np.trace(null.products.H, axis1=1, axis2=2)
        identifiable = own / np.maximum(null.products.raw, 1e-300)
        scatter = self._scatter(S, signs, null.squares)
        best, every = null, np.arange(len(some))
        best.improve(every, first)
        for k in range(len(self.levels)):
            near = every[2 * (bound[k] - best.likely) > -LIKELIHOOD_ROUNDING]
            if k not in (self.null, self.largest) and near.size:
                best.improve(near, self._try(k, S[:, :, near], signs[near]))
        return self._made(some, best, scatter, identifiable)

    def _try(self, k: int, S: np.ndarray, signs: np.ndarray) -> _Best:
        """Returns what candidates explain under a noise."""
        level = self.levels[k]
        products = level.products(S)
        inverse = np.linalg.pinv(products.H, rcond=1e-12, hermitian=True)
        size = np.einsum("jpq,jq->jp", inverse, products.b)
        fall = np.einsum("jp,jp->j", products.b, size)
        fall[is_refused(size, signs)] = 0.0
        squares = np.maximum(level.rest - fall, 1e-12 * level.rest)
        return _Best(np.full(len(size), k), level.log_likelihood(squares), squares, size, products)

    def _bound(self, S: np.ndarray, largest: Products) -> np.ndarray:
        """Returns bounds of each candidate's log likelihood under each noise, shape (levels, J).

        Args:
            S: the sensitivities.
            largest: the products under the largest noise.
        """
        N, ny, J, m = S.shape
        duals = np.stack([p.dual.ravel() for p in self.levels])
        b = (duals @ S.reshape(N * ny, J * m)).reshape(-1, J, m)
        inverse = np.linalg.pinv(largest.H, rcond=1e-12, hermitian=True)
        fall = np.einsum("kjp,jpq,kjq->kj", b, inverse, b)
        # Where H says nothing of a direction, nothing bounds what another noise makes of it.
        is_open = np.linalg.matrix_rank(largest.H, rtol=1e-12, hermitian=True) < m
        fall[is_open & np.any(b != 0, axis=2)] = np.inf
        rest = np.array([p.rest for p in self.levels])[:, None]
        squares = np.maximum(rest - fall, 1e-12 * rest)
        return np.stack([p.log_likelihood(s) for p, s in zip(self.levels, squares, strict=True)])

    def _scatter(self, S: np.ndarray, signs: np.ndarray, squares: np.ndarray) -> Scatter:
        """Returns the scatter of candidates under the noise without them.

        The likeliest noise with a candidate is chosen to make much of it, so that its chance under
        that noise would be too small.
        """
        level = self.levels[self.null]
        G, Z, a = level.by_blocks(S, self.starts)
        return scatter_of(make_blocks(G, Z), a, squares / level.samples, signs)

    def _made(
        self, some: Sequence[Sensitivity], best: _Best, scatter: Scatter, identifiable: np.ndarray
    ) -> list[_Known]:
        samples, products = self.levels[0].samples, best.products
        variance, nominal = best.squares / samples, self.without.max()
        inverse = np.linalg.pinv(products.H, rcond=1e-12, hermitian=True)
        std = np.sqrt(variance[:, None] * np.diagonal(inverse, axis1=1, axis2=2))
        scores = (
            Score(
                candidate=s.candidate, size=best.size[j], std=std[j],
                gain=float(2 * (best.likely[j] - nominal)), p_value=1.0,
                identifiable=float(identifiable[j]),
                level=NoiseLevel(
                    self.levels[best.level[j]].noise, float(np.sqrt(variance[j])),
                    float(best.likely[j]),
                ),
            )
            for j, s in enumerate(some)
        )  # fmt: skip
        return [_Known(*one, scatter, j) for j, one in enumerate(zip(some, scores, strict=True))]
