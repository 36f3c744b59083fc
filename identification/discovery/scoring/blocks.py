"""The chance of a score by the scatter over blocks of the log, which needs no noise model.

It is a Wald test with the candidate in the model (White 1980):

    W = η̂ᵀ H (Σ_b g_b g_bᵀ)⁻¹ H η̂,   g_b = Σ_{k in b} S⊥ᵀ(E⊥ - S⊥ η̂) = a_b - G_b η̂,   H = S⊥ᵀS⊥
    W (B - m)/(B m) ~ F(m, B - m)        B blocks, m sizes
"""

from __future__ import annotations

import numpy as np

from identification.chances import f_above
from identification.discovery.scoring.projection import Products


def compute_block_p_values(products: Products, size: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Returns p-values of the Wald test by blocks, shape (J,).

    Args:
        products: of J candidates.
        size: η̂, shape (J, m).
        signs: of their sizes, shape (J, m); 0 where physics admits both.
    """
    m, blocks = signs.shape[1], len(products.a)
    g = products.a - np.einsum("bjpq,jq->bjp", products.G, size)
    moved = np.einsum("jpq,jq->jp", products.H, size)
    spread = np.einsum("bjp,bjq->jpq", g, g)
    inverse = np.linalg.pinv(spread, rcond=1e-12, hermitian=True)
    W = np.einsum("jp,jpq,jq->j", moved, inverse, moved)
    p = f_above(W * (blocks - m) / (blocks * m), m, blocks - m)
    p = np.where(is_one_sided(signs), p / 2, p)
    return np.where(is_refused(size, signs), 1.0, p)


def is_one_sided(signs: np.ndarray) -> np.ndarray:
    """Returns which candidates have one size of which physics admits one sign only, shape (J,)."""
    return np.asarray((signs.shape[1] == 1) & (signs[:, 0] != 0))


def is_refused(size: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """Returns which candidates have one size of a sign that physics does not admit, shape (J,)."""
    return np.asarray((signs.shape[1] == 1) & (signs[:, 0] * size[:, 0] < 0))
