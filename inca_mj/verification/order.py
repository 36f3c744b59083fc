"""The order with which the twin's error falls with its step.

    e(h) ≈ c₄ h⁴ + c₂ h²

RK4 gives the first term while the motion is smooth. The second is MuJoCo's: its RK4 turns the
quaternion of a free joint by the average of the stages' angular velocities, which is right for
vectors; for rotations that do not commute it leaves an error of h² (the commutators of a
Magnus expansion are missing). A kink, where a cable turns slack or taut within a step, costs
RK4 its order too. So the order is measured twice: over all steps, and where c₄ h⁴ leads.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import nnls

ROUND_OFF = 1e-10  # errors below are the reference's tolerance, not the twin's step


Steps = Sequence[float] | np.ndarray
Errors = Sequence[float | None] | np.ndarray


def slope(steps: Steps, errors: Errors) -> float | None:
    """Returns the slope of log error against log step; None when fewer than two steps show it."""
    h, e = _resolved(steps, errors)
    return float(np.polyfit(np.log(h), np.log(e), 1)[0]) if len(h) > 1 else None


def crossing(steps: Steps, errors: Errors) -> float:
    """Returns the step h = √(c₂/c₄) below which the h² term leads; 0 when it cannot be seen."""
    h, e = _resolved(steps, errors)
    if len(h) < 3:
        return 0.0
    unit = h.max()
    columns = np.column_stack([(h / unit) ** 4, (h / unit) ** 2])
    columns *= (e.max() / e)[:, None]  # relative errors, of numbers near 1
    (c_4, c_2), _ = nnls(columns, np.ones(len(h)))
    return float(unit * np.sqrt(c_2 / c_4)) if c_4 > 0 else np.inf


def leading_slope(steps: Steps, errors: Errors) -> float | None:
    """Returns the slope over the steps where RK4's own error leads.

    That is where c₄ h⁴ is twice c₂ h² or more, less the longest step while two others are left:
    it is the nearest to RK4's limit of stability, |λ| h = 2.8 (2 ms have 1.6 and 1.9 in the
    thesis' two parameter sets). None when fewer than three steps show the terms apart.
    """
    h, e = _resolved(steps, errors)
    if len(h) < 3:
        return None
    leads = h >= np.sqrt(2) * crossing(steps, errors)
    if leads.sum() > 2:
        leads &= h < h.max()
    return slope(h[leads], e[leads])


def _resolved(steps: Steps, errors: Errors) -> tuple[np.ndarray, np.ndarray]:
    shown = [(h, e) for h, e in zip(steps, errors, strict=True) if e is not None and e > ROUND_OFF]
    h, e = np.array(shown).reshape(-1, 2).T
    return h, e
