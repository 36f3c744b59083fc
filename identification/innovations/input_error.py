"""Errors of the inputs: are they random, and would another hold of the inputs explain them?

    w_k = Σ_i g_i r_i(k),   δx_{k+1} = A_k δx_k + B_k w_k,   S_i = C δx for g_i = 1
    (δ̂, ĝ) = argmin ‖E - F δ - S g‖² + Σ ((q_j + δ_j - q̄_j)/s_j)² + ‖g‖²       fitted samples
    Δ_b = ½ Σ_{k in b} ‖E_k‖² - ‖E_k - F_k δ̂ - S_k ĝ‖²                blocks b of unseen samples
                                                                       of one part

The noise model takes every error of the inputs for random. An error that follows inputs, outputs or
rates predicts unseen samples; a random one does not. Each regressor r_i has the rms of the error
that the noise model assumes, and the prior of g_i has the std 1. Flips of the blocks' signs tell
what is beyond chance, as in the proof of an effect.

A friction that changes along the way follows neither the output nor its rate, but sgn(v) f(y):
therefore curves of the output are tried for each direction too. An input that runs in straight
lines and is taken for steps comes half a sample late; that looks like an error of the inputs, and
is no effect of a robot.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.findings.evidence import InputHold, StructuredInputError
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.innovations.proof import Validation, flip_chance
from identification.kalman.point import evaluate_point, evaluate_sensitivities
from identification.kalman.problem import estimate_noise
from identification.kalman.refit import Refit
from identification.kalman.response import respond
from identification.kalman.system import System
from identification.logs.parts import Part
from identification.runtime.pool import one_blas_thread

HOLDS = ("foh", "zoh")  # straight lines, steps
# Of the inputs' error: the other hold is reported where it leaves less than this.
OTHER_HOLD_SHARE = 0.5
ERROR_KNOTS = 12  # of the curves over input, output and rate that an error of the inputs may follow


@dataclass(frozen=True)
class ErrorFamily:
    """Errors of the inputs that follow one thing that was logged."""

    name: str  # of what they follow
    r: np.ndarray  # the regressors, errors of the inputs, shape (N, nu, p), of rms 1 each or zero


@dataclass(frozen=True, eq=False)
class _Linear:
    """What the fits of all families share."""

    system: System  # of the plant and of the inputs' errors
    J: np.ndarray  # sensitivities, shape (N, ny, p)
    F: np.ndarray  # the same whitened, in units of σ
    rows: np.ndarray  # those of the fitted samples, shape (n, p)
    products: np.ndarray  # of these with each other, shape (p, p)


@dataclass(frozen=True)
class FamilyFit:
    """The prediction of unseen samples by a family of errors."""

    name: str  # of what the errors follow
    p_value: float  # chance that a random error is predicted as well
    share: float  # of the power of the unseen innovations that is predicted
    fall: float  # of the mean square of the free run on unseen samples
    error: np.ndarray  # rms of the error of each input, in its unit, shape (nu,)


def find_input_error(
    validation: Validation, options: DiscoveryOptions, part: Part = "select"
) -> tuple[Finding, ...]:
    """Returns what the inputs' error follows, beyond chance and by enough to matter; else nothing.

    Each family of errors is a test of its own.

    Args:
        validation: the prediction of the whole log by a fitted model.
        options: what is beyond chance, and large enough to matter.
        part: of the unseen samples, on which it is judged.
    """
    found = [
        f for f in fit_families(validation, options)[part]
        if f.p_value < options.structure_level
        and max(f.share, f.fall) > options.min_structure_share
    ]  # fmt: skip
    if not found:
        return ()
    best, log = max(found, key=lambda f: f.share), validation.log
    worst = log.input_names[best.error.argmax()]
    evidence = StructuredInputError(
        regressor=best.name,
        input=worst,
        unit=log.units.get(worst, ""),
        rms=float(np.sqrt(np.mean(best.error**2))),
        fall=max(best.fall, best.share),
    )
    return (Finding(FindingKind.STRUCTURED_INPUT_ERROR, evidence),)


@lru_cache(maxsize=4)  # the model that is tested for structure is often judged again at the end
def fit_families(
    validation: Validation, options: DiscoveryOptions
) -> Mapping[Part, tuple[FamilyFit, ...]]:
    """Returns how well each family predicts each part of the unseen samples.

    There is nothing to predict without an error of the inputs, or an input.

    Args:
        validation: the prediction of the whole log by a fitted model.
        options: the number of blocks.
    """
    nothing: dict[Part, tuple[FamilyFit, ...]] = {"select": (), "report": ()}
    system = validation.filter.system
    if system is None or not validation.log.inputs.shape[1]:
        return nothing
    fit = validation.refit
    # A small change of a parameter may make the simulation diverge.
    J = attempt(None, partial(evaluate_sensitivities, fit.point, validation.log))
    if J is None:
        return nothing
    with one_blas_thread():
        F = validation.filter(J) / fit.level.sigma
        rows = F[validation.seen].reshape(-1, J.shape[2])
        linear = _Linear(system, J, F, rows, rows.T @ rows)
        families = list_families(validation, ERROR_KNOTS)
        each = [_fit_family(validation, linear, f, options.proof_blocks) for f in families]
    return {part: tuple(fits[part] for fits in each) for part in nothing}


def list_families(validation: Validation, knots: int) -> Iterator[ErrorFamily]:
    """Yields the families of errors that are tried.

    Outputs and rates are among them where there are as many outputs as inputs: each output is then
    taken for the one that the input of the same index moves.

    Args:
        validation: the prediction of the whole log by a fitted model.
        knots: of each curve.
    """
    u, y = validation.log.inputs, validation.log.outputs - validation.e
    nu = u.shape[1]
    if nu > 1:
        yield ErrorFamily("other inputs", separate_inputs(u[:, None] * (1 - np.eye(nu))))
    yield ErrorFamily("own input", separate_inputs(draw_curves(u, knots)))
    if y.shape[1] == nu:
        rate, curves = np.gradient(y, axis=0), draw_curves(y, knots)
        yield ErrorFamily("output", separate_inputs(curves))
        yield ErrorFamily("output rate", separate_inputs(draw_curves(rate, knots)))
        turned = curves * np.sign(rate)[..., None]
        yield ErrorFamily("output and direction", separate_inputs(turned))


def draw_curves(x: np.ndarray, knots: int) -> np.ndarray:
    """Returns hat functions between quantiles of each column of x (N, nu), shape (N, nu, knots)."""
    out = np.empty((*x.shape, knots))
    for i, own in enumerate(x.T):
        places = np.quantile(own, np.linspace(0, 1, knots))
        # An input of two levels has equal quantiles; they are moved apart by a little.
        places += np.ptp(own) * 1e-9 * np.arange(knots)
        for k, hat in enumerate(np.eye(knots)):
            out[:, i, k] = np.interp(own, places, hat)
    return out


def separate_inputs(x: np.ndarray) -> np.ndarray:
    """Returns regressors with separate coefficients for each input: (N, nu, k) as (N, nu, nu k).

    They are centred and scaled to rms 1.
    """
    N, nu, k = x.shape
    x = x - x.mean(axis=0)
    rms = np.sqrt(np.mean(x**2, axis=0))
    x = np.where(rms > 0, x / np.where(rms > 0, rms, 1.0), 0.0)
    return np.einsum("nik,ij->nijk", x, np.eye(nu)).reshape(N, nu, nu * k)


def simulate_response(system: System, r: np.ndarray) -> np.ndarray:
    """Returns the response of the outputs of a free run to errors of the inputs.

    Args:
        system: the plant.
        r: the errors, shape (N, nu, p).

    Returns:
        shape (N, ny, p).
    """
    read = np.flatnonzero(system.C.any(axis=0))
    first, g = np.zeros((r.shape[2], system.A.shape[1])), np.moveaxis(r[:-1], 2, 0)
    x = respond(system.A, system.B, first, g, 1, read)
    return np.moveaxis(x @ system.C[:, read].T, 0, -1)


def _fit_family(
    validation: Validation, linear: _Linear, family: ErrorFamily, blocks: int
) -> dict[Part, FamilyFit]:
    """Returns how well a family that is fitted to the fitted samples predicts each other part."""
    J, F, rows = linear.J, linear.F, linear.rows
    fit, E, seen, p = validation.refit, validation.innovations, validation.seen, J.shape[2]
    r = fit.level.of_inputs(family.r.shape[1])[:, None] * family.r
    moved = simulate_response(linear.system, r)
    G = validation.filter(moved) / fit.level.sigma
    more = G[seen].reshape(len(rows), -1)
    weight = np.concatenate([fit.priors.weight, np.ones(r.shape[2])])
    off = np.concatenate([fit.priors.mean - fit.point.q, np.zeros(r.shape[2])])
    across = rows.T @ more
    H = np.block([[linear.products, across], [across.T, more.T @ more]]) + np.diag(weight**2)
    target = np.concatenate([E[seen].ravel() @ rows, E[seen].ravel() @ more]) + weight**2 * off
    scale = 1 / (np.sqrt(np.diag(H)) + 1e-300)
    H *= np.outer(scale, scale)
    δg = scale * np.linalg.lstsq(H, scale * target, rcond=1e-12)[0]
    error = np.sqrt(np.mean((r @ δg[p:]) ** 2, axis=0))

    def predict(part: Part) -> FamilyFit:
        some = validation.parts.rows(part)
        before, after = E[some], E[some] - F[some] @ δg[:p] - G[some] @ δg[p:]
        fewer = np.sum(before**2 - after**2, axis=1) / 2
        gains = np.array([block.mean() for block in np.array_split(fewer, blocks)])
        free = validation.e[some]
        remaining = free - J[some] @ δg[:p] - moved[some] @ δg[p:]
        return FamilyFit(
            name=family.name,
            p_value=flip_chance(gains),
            share=1 - float(np.sum(after**2) / np.sum(before**2)),
            fall=1 - float(np.sum(remaining**2) / np.sum(free**2)),
            error=error,
        )

    return {"select": predict("select"), "report": predict("report")}


def find_input_hold(fit: Refit) -> tuple[Finding, ...]:
    """Returns the other hold of the inputs if it makes their error far smaller; else nothing.

    Args:
        fit: the nominal model, fitted.
    """
    point = fit.point
    if not point.log.inputs.any():  # of a free swing, which no hold changes
        return ()
    other = HOLDS[1 - HOLDS.index(point.log.hold)]
    predictor = replace(point.predictor, log=replace(point.log, hold=other))
    evaluate = partial(evaluate_point, predictor, point.space, point.q, point, point.small)
    there = attempt(None, evaluate)
    if there is None:
        return ()
    level = estimate_noise(there, fit.priors, fit.level)
    if level.input_std >= OTHER_HOLD_SHARE * fit.level.input_std:
        return ()
    unit = point.log.units.get(point.log.input_names[0], "")
    evidence = InputHold(other, unit, level.input_std, fit.level.input_std)
    return (Finding(FindingKind.INPUT_HOLD, evidence),)
