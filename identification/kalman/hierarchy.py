"""The scatter of the parts of a robot: the std of a group's prior, from the data.

    x = q - q̄,   x_j ~ N(0, s_g²) for the n values j of a group g,   p(s_g) ∝ s_g
    V = (FᵀF + S⁻²)⁻¹,   x̂ = V Fᵀ y,   s_g² ← sum over j of (x̂_j² + V_jj) / (n - 1)     (EM)

F and y are the whitened sensitivities and the residual about a fit. The s that this ends at is the
most probable one where x is integrated out (type-II maximum likelihood: MacKay 1992; Tipping 2001).
The prior p(s) ∝ s makes n - 1 of n. Without it the best s is often almost zero though the data tell
little of it, and then the std of every x_j is far too small (Chung, Rabe-Hesketh, Dorie, Gelman,
Liu 2013, Psychometrika 78). With it s falls only where the data say so, by more than one unit of
log likelihood.

The table's s is the largest that is believed: what deviates farther is an effect, and no scatter.
Where the parts are alike s falls to a fraction of what the data can tell of one part, and the
deviations are almost free of charge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.kalman.problem import linearise_criterion
from identification.kalman.refit import Refit

MAX_EM_ROUNDS = 200  # each costs one inverse of FᵀF
EM_TOLERANCE = 1e-3  # relative change of every s below which EM ends
MIN_STD_SHARE = 1e-2  # of the table's s: below it a deviation moves nothing that a log would show


def estimate_scatter(fit: Refit, groups: Mapping[str, Sequence[str]]) -> dict[str, float]:
    """Returns the most probable std of each group's prior, given the fitted data, by group.

    Args:
        fit: a fit under the table's std.
        groups: names of free parameters that share one std; that of a single one stays.
    """
    point = fit.point
    places = {g: [point.space.names.index(n) for n in names] for g, names in groups.items()}
    table = {g: 1 / fit.prior[at[0]] for g, at in places.items()}
    problem = linearise_criterion(point, fit.level, fit.mean, fit.prior)
    F, y = problem.rows[: point.e.size], problem.target[: point.e.size]
    x = point.q - fit.mean
    H, b = F.T @ F, F.T @ (y + F @ x)
    prior, s = fit.prior.copy(), dict(table)
    for _ in range(MAX_EM_ROUNDS):
        V = np.linalg.inv(H + np.diag(prior**2))
        power = (V @ b) ** 2 + np.diag(V)
        new = {
            g: float(np.clip(_most_probable(power[at]), MIN_STD_SHARE * table[g], table[g]))
            for g, at in places.items()
        }
        moved = max((abs(new[g] / s[g] - 1) for g in new), default=0.0)
        s = new
        for g, at in places.items():
            prior[at] = 1 / s[g]
        if moved < EM_TOLERANCE:
            break
    return s


def _most_probable(power: np.ndarray) -> float:
    """Returns the s of a group from x̂² + V of its n values; infinite where it has only one."""
    n = len(power)
    return float(np.sqrt(power.sum() / (n - 1))) if n > 1 else np.inf
