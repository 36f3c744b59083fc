"""Is the unlogged error of the inputs random, or does it go along with what was logged?

    w_k = Σ_i g_i r_i(k),   δx_{k+1} = A_k δx_k + B_k w_k,   S_i = C δx for g_i = 1
    (δ̂, ĝ) = argmin ‖E - F δ - S g‖² + Σ ((q_j + δ_j - q̄_j)/s_j)² + ‖g‖²       fitted samples
    Δ_b = ½ Σ_{k in b} ‖E_k‖² - ‖E_k - F_k δ̂ - S_k ĝ‖²                blocks b of unseen samples

A noise model takes any error of the inputs for chance. One that follows from inputs, outputs or
rates predicts samples that no fit has seen; chance does not. Each r_i has the size of the error
that the noise model takes for granted, and g_i is held by that.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.stats import ttest_1samp
from threadpoolctl import threadpool_limits

from identification.discovery.fitted_model import FittedModel
from identification.discovery.proof import BLOCKS, Validation
from identification.errors import DivergenceError
from identification.kalman.innovations import MATTERS, SURE
from identification.kalman.noise_model import Whitener
from identification.kalman.point import evaluate_sensitivities
from identification.quantities import quantity

KNOTS = 12  # of a curve


@dataclass(frozen=True)
class Family:
    """Errors of the inputs that would go along with something.

    Attributes:
        what: it is.
        r: errors of the inputs, shape (N, nu, p), rms 1 each where they are not zero.
    """

    what: str
    r: np.ndarray


@dataclass(frozen=True)
class Followed:
    """How well a family predicts unseen samples.

    Attributes:
        what: it goes along with.
        chance: that an error without structure is predicted as well.
        share: of the innovations' power that is predicted.
        fall: of the free run's mean square.
        error: rms of each input's error, shape (nu,).
    """

    what: str
    chance: float
    share: float
    fall: float
    error: np.ndarray


def find_input_error(step: FittedModel) -> tuple[str, ...]:
    """A sentence on what the inputs' error goes along with; none where it is random.

    Args:
        step: a fitted model, seen on the whole log.
    """
    tried = followed(step.validation)  # each a test of its own, as the others of what is left
    found = [f for f in tried if f.chance < SURE and max(f.share, f.fall) > MATTERS]
    if not found:
        return ()
    best, log = max(found, key=lambda f: f.share), step.validation.whole
    rms, worst = float(np.sqrt(np.mean(best.error**2))), log.input_names[best.error.argmax()]
    size = quantity(rms, unit=log.units.get(worst, ""))
    return (
        f"an error of the inputs that nobody logged, {size} rms, that is not random: it goes along"
        f" with {best.what}, most of all on {worst}, and with it the mean square on unseen data is"
        f" {100 * max(best.fall, best.share):.0f} % less",
    )


def followed(seen: Validation) -> tuple[Followed, ...]:
    """How well each family predicts; none where no error of the inputs is taken for granted."""
    if not seen.filter.A.size:
        return ()
    fit = seen.refit
    try:
        J = evaluate_sensitivities(fit.point, seen.whole)
    except DivergenceError:  # where a parameter that is moved a little loses the robot
        return ()
    with threadpool_limits(1, "blas"):
        F = seen.filter(J) / fit.level.sigma
        each = [_followed(seen, J, F, family) for family in families(seen)]
    return tuple(each)


def families(seen: Validation) -> Iterator[Family]:
    """What errors of the inputs are tried; as many outputs as inputs are taken for theirs."""
    u, y = seen.whole.inputs, seen.whole.outputs - seen.e
    nu = u.shape[1]
    if nu > 1:
        yield Family("the other inputs", _apart(u[:, None] * (1 - np.eye(nu))))
    yield Family("its own input", _apart(_curves(u)))
    if y.shape[1] == nu:
        yield Family("its output", _apart(_curves(y)))
        yield Family("the rate of its output", _apart(_curves(np.gradient(y, axis=0))))


def _curves(x: np.ndarray) -> np.ndarray:
    """Hat functions of each column of x between its quantiles, shape (N, nu, KNOTS)."""
    out = np.empty((*x.shape, KNOTS))
    for i, own in enumerate(x.T):
        knots = np.quantile(own, np.linspace(0, 1, KNOTS))
        knots += np.ptp(own) * 1e-9 * np.arange(KNOTS)  # an input of two levels has equal ones
        for k, hat in enumerate(np.eye(KNOTS)):
            out[:, i, k] = np.interp(own, knots, hat)
    return out


def _apart(x: np.ndarray) -> np.ndarray:
    """Each input with coefficients of its own: (N, nu, k) as (N, nu, nu k), centred, rms 1."""
    N, nu, k = x.shape
    x = x - x.mean(axis=0)
    rms = np.sqrt(np.mean(x**2, axis=0))
    x = np.where(rms > 0, x / np.where(rms > 0, rms, 1.0), 0.0)
    return np.einsum("nik,ij->nijk", x, np.eye(nu)).reshape(N, nu, nu * k)


def response(filter_: Whitener, r: np.ndarray) -> np.ndarray:
    """What errors of the inputs do to the outputs of a free run.

    Args:
        filter_: its A and C are those of state and input error.
        r: the errors, shape (N, nu, p).

    Returns:
        shape (N, ny, p).
    """
    nu = r.shape[1]
    A, B = filter_.A[:, :-nu, :-nu], filter_.A[:, :-nu, -nu:]
    x, C = np.zeros((A.shape[1], r.shape[2])), filter_.C[:, :-nu]
    out = [C @ x]
    for k in range(len(r) - 1):
        x = A[k] @ x + B[k] @ r[k]
        out.append(C @ x)
    return np.array(out)


def _followed(seen: Validation, J: np.ndarray, F: np.ndarray, family: Family) -> Followed:
    fit, E, first, p = seen.refit, seen.innovations, seen.first, J.shape[2]
    r = fit.level.input_std * family.r
    moved = response(seen.filter, r)
    X = np.concatenate([F, seen.filter(moved) / fit.level.sigma], axis=2)
    held = np.concatenate([fit.prior, np.ones(r.shape[2])])
    off = np.concatenate([fit.mean - fit.point.q, np.zeros(r.shape[2])])
    rows = np.vstack([X[:first].reshape(-1, X.shape[2]), np.diag(held)])
    target = np.concatenate([E[:first].ravel(), held * off])
    scale = 1 / (np.linalg.norm(rows, axis=0) + 1e-300)
    rows *= scale
    δg = scale * np.linalg.lstsq(rows.T @ rows, rows.T @ target, rcond=1e-12)[0]
    before, after = E[first:], E[first:] - X[first:] @ δg
    fewer = np.sum(before**2 - after**2, axis=1) / 2
    blocks = [part.mean() for part in np.array_split(fewer, BLOCKS)]
    chance = float(ttest_1samp(blocks, 0.0, alternative="greater").pvalue)
    free, left = seen.e[first:], seen.e[first:] - np.concatenate([J, moved], axis=2)[first:] @ δg
    return Followed(
        family.what,
        chance,
        1 - float(np.sum(after**2) / np.sum(before**2)),
        1 - float(np.sum(left**2) / np.sum(free**2)),
        np.sqrt(np.mean((r @ δg[p:]) ** 2, axis=0)),
    )
