"""Residual and sensitivities under one noise, with the free parameters projected out.

    r⊥ = r - Φ (ΦᵀΦ + P)⁻¹ Φᵀ r        whitened; the priors P enter as further measurements
    H = S⊥ᵀS⊥,   b = S⊥ᵀE⊥,   and of each block of samples:   G_b, a_b, Z_b = (ΦᵀΦ + P)^-½ Φ_bᵀS⊥_b
    b = Sᵀu,   u = Wᵀ E⊥               W: the whitening filter; no sensitivity is whitened for it

The priors are a block of their own. What blocks tell of the chance of a score is told in
`identification.estimation.block_test`.

A candidate has few sizes. Of its sensitivities nothing is needed but products of few columns, never
a product with those of another candidate.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from identification.kalman.noise_model import Noise, whiten
from identification.kalman.refit import Refit

# Of the largest eigenvalue of ΦᵀΦ: less is no direction that the outputs feel.
MIN_EIGENVALUE_SHARE = 1e-14


@dataclass(frozen=True)
class Products:
    """Products of the sensitivities of J candidates with m sizes each, under one noise."""

    raw: np.ndarray  # sum of squares before the projection, shape (J,)
    H: np.ndarray  # shape (J, m, m)
    b: np.ndarray  # shape (J, m)


class Projection:
    """Residual and free parameters of a fit under one noise.

    Args:
        fit: the model.
        noise: what the residual and the sensitivities are whitened with.

    Attributes:
        noise: the same.
        samples: number of measured values.
        rest: sum of squares of the residual, without what the free parameters explain.
        dual: u, shape (N, ny).
    """

    def __init__(self, fit: Refit, noise: Noise) -> None:
        point = fit.point
        self.noise, self.samples = noise, point.e.size
        self._whiten = partial(whiten, point.linear, point.J, noise, point.log.sampling_time)
        white = self._whiten()
        self._filter, F = white.filter, white.F
        E = self._filter(point.e).ravel()
        # The priors enter as further measurements: rows below the samples, in units of σ.
        self._ridge = fit.priors.weight * fit.level.sigma
        below = self._ridge * (fit.priors.mean - point.q)
        w, V = np.linalg.eigh(white.H + np.diag(self._ridge**2))
        kept = w > MIN_EIGENVALUE_SHARE * w.max(initial=0.0)
        self._w, self._V = w[kept], V[:, kept]
        c = self._coefficients(F.T @ E + self._ridge * below)
        self._e, self._below = E - F @ c, below - self._ridge * c
        self.rest = float(self._e @ self._e + self._below @ self._below)
        self.dual = self._filter.transposed(self._e.reshape(point.e.shape))

    @cached_property
    def _F(self) -> np.ndarray:
        """The whitened sensitivities of the parameters; most noises never need them again."""
        return self._whiten().F

    def log_likelihood(self, squares: np.ndarray) -> np.ndarray:
        """Returns the log likelihood of sums of squares, up to a constant of the log."""
        n = self.samples
        log_determinant = self._filter.log_determinant
        return np.asarray(-0.5 * (n * np.log(squares / n) + log_determinant))

    def products(self, S: np.ndarray) -> Products:
        """Returns the products of candidates with sensitivities S, shape (N, ny, J, m)."""
        W, below, raw = self._projected(S)
        X, J, m = W.reshape(len(W), *S.shape[2:]), *S.shape[2:]
        b = (self._e @ W + self._below @ below).reshape(J, m)
        return Products(raw, _gram(X) + _gram(below.reshape(-1, J, m)), b)

    def by_blocks(
        self, S: np.ndarray, starts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns what blocks of samples, and the priors as one more, tell of candidates.

        Args:
            S: sensitivities, shape (N, ny, J, m).
            starts: the first sample of each block, shape (B,).

        Returns:
            G, Z and a, shapes (B + 1, J, m, m), (B + 1, p, J, m) and (B + 1, J, m).
        """
        ny, J, m = S.shape[1:]
        W, below, _ = self._projected(S)
        e, F, half = self._e, self._F, self._V / np.sqrt(self._w)
        rows = [slice(*pair) for pair in pairwise([*(ny * starts), len(e)])]
        parts = [*((e[some], F[some], W[some]) for some in rows),
                 (self._below, np.diag(self._ridge), below)]  # fmt: skip
        a = np.stack([r @ X for r, _, X in parts]).reshape(-1, J, m)
        G = np.stack([_gram(X.reshape(-1, J, m)) for _, _, X in parts])
        Z = np.stack([half.T @ (Φ.T @ X) for _, Φ, X in parts]).reshape(len(parts), -1, J, m)
        return G, Z, a

    def _projected(self, S: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns S⊥, its rows of the priors, and sums of squares before the projection, (J,)."""
        N, ny, J, m = S.shape
        W = self._filter(S.reshape(N, ny, -1)).reshape(self.samples, -1)
        raw = np.einsum("ij,ij->j", W, W).reshape(J, m).sum(axis=1)
        C = self._coefficients(self._F.T @ W)
        W -= self._F @ C
        return W, -self._ridge[:, None] * C, raw

    def _coefficients(self, FtX: np.ndarray) -> np.ndarray:
        """Returns (ΦᵀΦ + P)⁻¹ ΦᵀX; the shortest where outputs do not feel every direction."""
        return np.asarray((self._V / self._w) @ (self._V.T @ FtX))


def is_refused(size: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Returns which candidates have one size of a sign that physics does not admit, shape (J,)."""
    return np.asarray((signs.shape[1] == 1) & (signs[:, 0] * size[:, 0] < 0))


def _gram(X: np.ndarray) -> np.ndarray:
    """Returns XᵀX of each candidate, shape (J, m, m), of rows (n, J, m)."""
    if X.shape[2] == 1:
        return np.einsum("njm,njm->jm", X, X)[..., None]
    return np.einsum("njp,njq->jpq", X, X)
