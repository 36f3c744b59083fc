"""Slopes of a residual that are kept from one point of a search to the next.

    J₊ = J + (Δr - J s)(D s)ᵀ/(sᵀ D s)      where ‖Δr - J s‖ <= SLOPE_ERROR ‖Δr‖

s is the step, Δr the change of the residual, and D the diagonal of Jᵀ J, so that units of the
parameters change nothing. It is Broyden's correction (Broyden 1965): the slopes are right along the
step, and what they were across it. Near an optimum it saves a simulation for each free parameter.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Relative: a step of Gauss and Newton then misses a hundredth of what it can gain.
SLOPE_ERROR = 0.1


@dataclass(frozen=True)
class Slopes:
    """Slopes J (n, p) of the weighed residual r (n,) at a point q (p,)."""

    q: np.ndarray
    r: np.ndarray
    J: np.ndarray

    def moved(self, q: np.ndarray, r: np.ndarray) -> Slopes | None:
        """Returns the slopes at another point, not simulated; None if they differ by too much."""
        step, change = q - self.q, r - self.r
        off = change - self.J @ step
        if not np.linalg.norm(off) <= SLOPE_ERROR * np.linalg.norm(change):
            return None
        along = np.sum(self.J**2, axis=0) * step  # lengths are those of the outputs' changes
        return Slopes(q, r, self.J + np.outer(off, along / (along @ step)))
