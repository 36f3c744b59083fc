"""Distribution of a wrench to the cables: closed form, minimum norm, and with limits.

    W T = w                                 6 equations for 8 tensions
    T = t₀ + W⁺ (w − W t₀)                  nearest to t₀ without limits; t₀ = 0: minimum norm
    min |T − t₀|²   subject to   W T = w,   low ≤ T ≤ high

With limits, T = T_c + N λ, where T_c is the closed form above and the columns of N are an
orthonormal basis of the null space of W (two columns for eight cables). T_c − t₀ lies in the row
space of W and is orthogonal to N, so |T − t₀|² = |T_c − t₀|² + |λ|², and only λ is left:

    min |λ|²   subject to   G λ ≥ h,   G = [N; −N],   h = [low − T_c; T_c − high]

This is a problem of least distance. Lawson and Hanson reduce it to one problem of least squares
with variables that are not negative,

    u = argmin |E u − f|², u ≥ 0,   E = [Gᵀ; hᵀ],  f = (0, …, 0, 1),   r = E u − f,   λ = −r_λ/r_h

which `scipy.optimize.nnls` solves by an active set method in finitely many steps, so the result is
exact to rounding. r = 0 means that no λ satisfies the limits.

Sources: Lawson, Hanson 1974, Solving Least Squares Problems, chapter 23; Pott 2018, Cable-Driven
Parallel Robots, chapter 3.7 (tension distribution). Thesis section 2.4 for the start pretension.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

from identification.errors import InputError
from inca_mj.robot.parameters import PRETENSION

RANK = 1e-9  # a singular value this far below the largest is zero
BALANCED = 1e-8  # largest relative error of W T = w and of the limits


def nearest(W: np.ndarray, w: np.ndarray, t_0: float | np.ndarray = PRETENSION) -> np.ndarray:
    """Returns tensions of a wrench nearest to t₀, without limits: T = t₀ + W⁺ (w − W t₀), (n,) [N].

    Arguments are those of `distribute`; t₀ = 0 gives the minimum norm. Some tensions may be
    negative, which no cable can do. Raises InputError if a shape is wrong, a number is not finite,
    or the cables cannot exert w.
    """
    W, w, t_0 = _checked(W, w, t_0)
    return _split(W, w, t_0)[0]


def distribute(
    W: np.ndarray,
    w: np.ndarray,
    low: float | np.ndarray,
    high: float | np.ndarray,
    t_0: float | np.ndarray = PRETENSION,
) -> np.ndarray:
    """Returns tensions of a wrench, nearest to t₀: argmin |T − t₀|², W T = w, low ≤ T ≤ high.

    The solution is unique, and it is continuous in w wherever it exists.

    Args:
        W: wrench of the cables on the platform per tension, shape (6, n) [-, m].
        w: wrench that the cables shall exert, force then torque, shape (6,) [N, N m].
        low: smallest tensions, one number or shape (n,) [N].
        high: largest tensions, one number or shape (n,) [N]; may be infinite.
        t_0: tensions to stay near to, one number or shape (n,) [N]; 0 gives the minimum norm.

    Returns:
        Tensions, shape (n,) [N].

    Raises:
        InputError: a shape is wrong, a number is not finite, a lower limit is above the upper one,
            the cables cannot exert w at all, or cannot within the limits.
    """
    W, w, t_0 = _checked(W, w, t_0)
    low, high = (_each(x, name, len(t_0)) for x, name in ((low, "low"), (high, "high")))
    if not np.isfinite(low).all() or not (low <= high).all():
        raise InputError(
            f"tension limits {low.tolist()} to {high.tolist()} N: give finite lower limits, none"
            " above its upper limit"
        )
    T_c, N = _split(W, w, t_0)
    if (low <= T_c).all() and (T_c <= high).all():
        return T_c
    T = T_c + N @ _least(N, low - T_c, high - T_c)
    slack = BALANCED * max(1.0, float(np.abs(T_c).max()))
    if not ((low - slack <= T) & (high + slack >= T)).all():
        raise InputError(
            f"no tensions between {low.min():g} and {high.max():g} N exert the wrench"
            f" {np.round(w, 4).tolist()} [N, N m]; widen the limits, ask for a smaller wrench, or"
            " move the platform towards the middle"
        )
    return np.clip(T, low, high)


def _least(N: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Returns λ of least norm with low ≤ N λ ≤ high; NaN where there is none."""
    G, h = np.vstack([N, -N]), np.concatenate([low, -high])
    bounded = np.isfinite(h)
    G, h = G[bounded], h[bounded]
    scale = float(np.abs(h).max()) or 1.0
    E = np.vstack([G.T, h / scale])
    f = np.zeros(len(E))
    f[-1] = 1.0
    u, _ = nnls(E, f, maxiter=100 * len(h))
    r = E @ u - f
    if -r[-1] < RANK:  # -r_h = |r|² = 1/(1 + |λ/scale|²): zero where the limits exclude each other
        return np.full(N.shape[1], np.nan)
    return -scale * r[:-1] / r[-1]


def _split(W: np.ndarray, w: np.ndarray, t_0: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the tensions nearest to t₀, and an orthonormal basis of the null space of W."""
    U, s, V = np.linalg.svd(W)
    rank = int((s > RANK * s[0]).sum())
    T = t_0 + V[:rank].T @ ((U[:, :rank].T @ (w - W @ t_0)) / s[:rank])
    if np.abs(W @ T - w).max() > BALANCED * max(1.0, float(np.abs(w).max())):
        raise InputError(
            f"the cables cannot exert the wrench {np.round(w, 4).tolist()} [N, N m]: their wrench"
            f" matrix has rank {rank} of {len(W)} here; move the platform or the connectors"
        )
    return T, V[rank:].T


def _checked(
    W: np.ndarray, w: np.ndarray, t_0: float | np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    W, w = np.asarray(W, float), np.asarray(w, float)
    if W.ndim != 2 or w.shape != W.shape[:1]:
        raise InputError(
            f"a wrench matrix of shape {W.shape} and a wrench of shape {w.shape} do not belong"
            " together; give shapes (6, n) and (6,)"
        )
    t_0 = _each(t_0, "t_0", W.shape[1])
    if not (np.isfinite(W).all() and np.isfinite(w).all() and np.isfinite(t_0).all()):
        raise InputError("wrench matrix, wrench and t_0 must be finite numbers")
    return W, w, t_0


def _each(value: float | np.ndarray, name: str, n: int) -> np.ndarray:
    """Returns one tension for each of n cables."""
    if np.shape(value) not in ((), (n,)):
        raise InputError(
            f"{name} has shape {np.shape(value)}; give one tension, or one for each of {n} cables"
        )
    return np.broadcast_to(np.asarray(value, float), (n,))
