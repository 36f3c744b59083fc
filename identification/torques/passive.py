"""Joints without a drive, whose equations say nothing of the scale of what hangs on them.

    0 = Y(q, v, a) π + I a + friction           also for π = 0, I = 0 and no friction
    M(π) δ = y - X(a) θ                         over the joints p without a drive
    y' = y + M(π_0) δ,   X' = X(a + δ)          δ, M: of the fit of all numbers, π_0: the model's

No force is measured there, so that nothing but zero is on the left, and what a fit leaves is the
noise of its own columns. Least squares make it small by small numbers, and a weight by the
residual grows as they fall, until all are zero and the joint is fulfilled. What is measured there
is the acceleration: the equation is to be solved for it, and its error is δ = M⁻¹ r, which is the
same for any multiple of all numbers. This is the least of Σ r²/M² instead of Σ r² by steps of Gauss
and Newton: the columns have the accelerations that the balance expects, and the error stays on the
other side, as force of the model's inertia. So the residual of such a joint falls only by what
explains its motion, and the scale of its numbers is told by the joints with drives that feel them,
and by what was known. A column with the measured acceleration would explain its own noise, as a
gain's would with the measured torque.
"""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np

from identification.torques.equations.base import BaseParameters, all_columns, known_numbers
from identification.torques.equations.bodies import regressor
from identification.torques.equations.equations import Equations, list_passive
from identification.torques.equations.others import Others
from identification.torques.fits import Fitted, base_fit, model_fit

ROUNDS = 4  # of δ: each leaves an error of second order
LIGHT = 1e-2  # of the model's inertia: a fit with less has lost the scale, and δ stays as it was


def fit_base(
    model: mujoco.MjModel, measured: Equations, base: BaseParameters, others: Others,
    has_clocks: bool = False,
) -> tuple[Equations, Fitted]:  # fmt: skip
    """Returns equations solved as `with_expected_motion` does, and the base fit to them."""
    plain = others.without_gains()
    equations = with_expected_motion(model, measured, base, plain)
    return equations, base_fit(model, equations, base, plain, has_clocks)


def with_expected_motion(
    model: mujoco.MjModel, equations: Equations, base: BaseParameters, others: Others
) -> Equations:
    """Returns measured equations solved for the accelerations of joints without a drive."""
    p = np.flatnonzero(list_passive(model, equations))
    if not len(p):
        return equations
    unit = _unit_forces(model, equations, p)
    M_0 = _inertia([all_columns(*u) for u in unit], known_numbers(model), p)
    held = model_fit(model, equations, (), others)
    δ = np.linalg.solve(M_0, (held.base.y - held.predicted())[:, p, None])[..., 0]
    least = LIGHT * np.linalg.eigvalsh(M_0)[:, 0]
    of_base = [base.columns(*u) for u in unit]
    out = _moved(equations, unit, p, δ, M_0)
    for _ in range(ROUNDS):
        fitted = base_fit(model, out, base, others)
        M = _inertia(of_base, fitted.fit.θ[: len(base.names)], p)
        if (np.linalg.eigvalsh(M)[:, 0] < least).any():
            break
        left = (fitted.base.y - fitted.predicted())[:, p, None] + (M - M_0) @ δ[..., None]
        δ = np.linalg.solve(M, left)[..., 0]
        out = _moved(equations, unit, p, δ, M_0)
    return out


def _unit_forces(
    model: mujoco.MjModel, equations: Equations, p: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Returns dY/da_k (N, nv, bodies, 10), and the accelerations e_k (N, nv), of each joint k."""
    q, out = equations.stacked("q"), []
    still = regressor(model, q, np.zeros_like(q), np.zeros_like(q))[0]
    for k in p:
        one = np.broadcast_to((np.arange(model.nv) == k).astype(float), q.shape)
        out.append((regressor(model, q, np.zeros_like(q), one)[0] - still, one))
    return out


def _inertia(columns: list[np.ndarray], numbers: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Returns M_pp of numbers at all equations, shape (N, P, P)."""
    return np.stack([c[:, p] @ numbers for c in columns], axis=2)


def _moved(
    equations: Equations, unit: list[tuple[np.ndarray, np.ndarray]], p: np.ndarray, δ: np.ndarray,
    M: np.ndarray,
) -> Equations:  # fmt: skip
    """Returns equations with accelerations of joints p that are δ (N, P) more."""
    bodies, a, y = (equations.stacked(n).copy() for n in ("bodies", "a", "y"))
    for i, (Y, _) in enumerate(unit):
        bodies[:, p] += Y[:, p] * δ[:, i, None, None, None]
    a[:, p] += δ
    y[:, p] += np.einsum("nij,nj->ni", M, δ)
    parts = zip(equations.rows, *map(equations.divided, (bodies, a, y)), strict=True)
    return replace(equations, rows=tuple(replace(r, bodies=b, a=c, y=d) for r, b, c, d in parts))
