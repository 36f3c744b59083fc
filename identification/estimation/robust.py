"""The influence of a residual on an estimate under a robust loss.

    V = Σ ρ(e²),   ψ(e) = ρ'(e²) e,   c = mean of ψ'(e) = mean of ρ' + 2 e² ρ''

Under a robust loss ψ takes the place of the residual e, and the curvature of the criterion is c
times that of least squares. So the std of the estimate is computed from ψ/c (Huber 1964). Computed
from e itself, it would grow with every outlier, although the loss has made the outlier harmless.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from identification.errors import unknown_name

# ρ' and ρ'' by z = e², of the losses of `scipy.optimize.least_squares`
_SLOPES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], Callable[[np.ndarray], np.ndarray]]]
_SLOPES = {
    "linear": (np.ones_like, np.zeros_like),
    "soft_l1": (lambda z: (1 + z) ** -0.5, lambda z: -0.5 * (1 + z) ** -1.5),
    "huber": (
        lambda z: np.maximum(z, 1.0) ** -0.5,
        lambda z: np.where(z > 1, -0.5 * np.maximum(z, 1.0) ** -1.5, 0.0),
    ),
    "cauchy": (lambda z: 1 / (1 + z), lambda z: -1 / (1 + z) ** 2),
    "arctan": (lambda z: 1 / (1 + z**2), lambda z: -2 * z / (1 + z**2) ** 2),
}


def influence(error: np.ndarray, loss: str) -> tuple[np.ndarray, float]:
    """Returns ψ of each residual, of the same shape, and c.

    c is at least 1 %: if it were smaller, nearly all residuals would be outliers, and no std could
    be believed.

    Raises:
        InputError: the loss is unknown.
    """
    if loss not in _SLOPES:
        raise unknown_name("loss", loss, _SLOPES)
    first, second = _SLOPES[loss]
    z = error**2
    return first(z) * error, max(0.01, float(np.mean(first(z) + 2 * z * second(z))))
