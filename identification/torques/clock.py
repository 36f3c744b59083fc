"""Whether the inputs act later or earlier than their stamps say, as the torques have it.

    E_0, E_τ, F       sums of squares that curves of the joints leave in blocks that they were not
                      fitted to, without the clock and with it, and that noise makes

Every fit has the clock as a nuisance. A force that is missing looks a little like any other cause,
so that a clock of some std is no shift yet: a bump of a rail made 25 ms of stamps that were exact.
Where much more than noise is left, it is told only if it takes away most of what curves that the
joints could have leave, E_τ - F < (E_0 - F)/2, and then with the value that it has beside them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.discovery.smooth_force import MUCH_LEFT, takes_most
from identification.torques.candidates import together
from identification.torques.equations import Equations, unseen_squares
from identification.torques.fits import CLOCK, FIXED, Fitted, extended
from identification.torques.laws import Missing
from identification.torques.scores import FAR


def find_clock(
    equations: Equations, whole: Fitted, curves: Sequence[Missing], noise: np.ndarray
) -> tuple[float, float] | None:
    """Returns how much later the inputs act than their stamps say, and its std [s]; None if not.

    Args:
        equations: of the records.
        whole: the base fit, which has the clock.
        curves: of the joints.
        noise: what noise alone would leave of each joint, shape (nv,) [N m or N].
    """
    fit, clock = whole.fit, whole.names.index(CLOCK)
    if not abs(fit.θ[clock]) > FAR * fit.std[clock]:
        return None
    n, σ = equations.counts.sum(axis=1), np.nan_to_num(fit.σ)
    if fit.weights @ (n * σ**2) > MUCH_LEFT**2 * (fit.weights @ (n * noise**2)):
        smooth = [c for c in curves if not c.name.endswith("_time")]  # over time they follow all
        whole = extended(equations, whole, together(smooth)) if smooth else whole
        left, without = (_left(equations, whole, held) for held in (None, clock))
        floor = float(whole.fit.weights @ (n * noise**2))
        if not takes_most(without, left, floor):
            return None
    late, std = float(whole.fit.θ[clock]), max(float(f.std[clock]) for f in (fit, whole.fit))
    return (late, std) if abs(late) > FAR * std else None


def _left(equations: Equations, fitted: Fitted, held: int | None) -> float:
    """Returns the weighted squares of all blocks by fits that did not see them, one size held."""
    base = fitted.base
    P, none = base.P.copy(), np.zeros(len(equations.record), bool)
    if held is not None:
        P[held] = FIXED * base.fit.H[held, held]
    squares = unseen_squares(base.M, base.fit.weights, P, base.θ_0, none)
    return float(base.fit.weights @ squares.sum(axis=1))
