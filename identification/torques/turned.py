"""Do the torques want the inertia of the robot with the other sign?

    a_k = θ_k/σ_k,  b_k = θ̄_k/σ_k        c = a·b/(|a| |b|),  z = a·b/|b|

θ ± σ: base parameters of the fit, θ̄ those of the model. Where all drives' forces have the other
sign than the model gives them, the fit finds the robot's numbers with the other sign: c is nearly
-1, for inertias and masses as for first moments [kg m]. Gravity that is turned, as of an arm that
hangs where its model stands, changes the sign of first moments alone. An inertia cannot be
negative, and what a model lacks makes none of many inertias negative at once.
"""

from __future__ import annotations

import numpy as np

from identification.torques.equations.base import BaseParameters

# c below which numbers are those of the model with the other sign. It is the cosine of 45 degrees:
# nearer to these than to anything that has nothing to do with the model.
OPPOSITE = -(0.5**0.5)
SURE = -6.0  # z below which this is no chance: 1e-9 of a normal number
MOMENT = "kg m"  # unit of what gravity acts on


def find_turned(base: BaseParameters, θ: np.ndarray, std: np.ndarray) -> int | None:
    """Returns the surest inertia of the other sign, where all are turned; else None.

    Args:
        base: of the model.
        θ: base parameters of the fit, shape (r,).
        std: of these, shape (r,).
    """
    seen = std > 0
    σ = np.where(seen, std, 1.0)
    a, b = np.where(seen, θ / σ, 0.0), np.where(seen, base.values / σ, 0.0)
    is_moment = np.array([unit == MOMENT for unit in base.units])
    moments, inertias = (is_opposite(a[some], b[some]) for some in (is_moment, ~is_moment))
    if not inertias or moments is False:
        return None
    return int(np.argmin(np.where(is_moment, np.inf, a * b)))


def is_opposite(a: np.ndarray, b: np.ndarray) -> bool | None:
    """Returns whether a is b with the other sign; None where b is too small to tell.

    Args:
        a: fitted numbers over their std, shape (n,).
        b: numbers of the model over the same, shape (n,).
    """
    size = float(np.linalg.norm(b))
    if size < -SURE:
        return None
    z = float(a @ b) / size
    return z < min(SURE, OPPOSITE * float(np.linalg.norm(a)))
