"""An error of the free run that neither noise nor the std of the fitted values makes.

    e = J δ + G w + σ s n,    δ ~ N(0, C),  w, n: errors of the inputs and of the sensors
    ν = 2 E[‖e‖²]²/Var[‖e‖²],    chance = P(χ²_ν >= ν ‖e‖²/E[‖e‖²])          (Satterthwaite 1946)

J = ∂ŷ/∂q, C: covariance of q, G: what errors of the inputs do to a free run. Errors of a free run
last for seconds, so that a record has few that are independent: ν is that of `DRAWS` errors that
are drawn. An innovation one sample ahead need not show that a robot changed: a slow change, such as
that of a friction, is corrected at each sample. The free run adds it up.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from identification.chances import chi2_above
from identification.discovery.attempts import attempt
from identification.discovery.findings.evidence import UnexpectedError
from identification.discovery.findings.finding import Finding, FindingKind
from identification.discovery.options import DiscoveryOptions
from identification.innovations.proof import Validation
from identification.kalman.point import evaluate_sensitivities
from identification.runtime.pool import one_blas_thread

# Of the rms of an error to what is expected of it, from which it matters. Chances alone would not
# do: they rest on the linearised noise model. In 180 logs of a slider in which nothing is missing
# the ratio had an rms of 1.06 and was 3.1 at most, and 3 chances were below 1 %; in null logs of
# INCA it was 0.9 to 1.6.
MIN_RATIO = 3.0
DRAWS = 200  # which tell ν to a tenth


def find_unexpected_error(validation: Validation, options: DiscoveryOptions) -> tuple[Finding, ...]:
    """Returns the error of the free run where it is far larger than expected; else nothing.

    It is of the samples on which the search has not decided.

    Args:
        validation: the prediction of the whole log by a fitted model.
        options: what is beyond chance.
    """
    # A small change of a parameter may make the simulation diverge.
    draws = attempt(None, partial(draw_squares, validation))
    if draws is None:
        return ()
    square = float(np.mean(validation.e[validation.parts.report] ** 2))
    ratio = float(np.sqrt(square / draws.mean()))
    if not (ratio > MIN_RATIO and chance_of(square, draws) < options.structure_level):
        return ()
    return (Finding(FindingKind.UNEXPECTED_ERROR, UnexpectedError(ratio)),)


def chance_of(square: float, draws: np.ndarray) -> float:
    """Returns the chance of a mean square as large, of which mean squares (n,) were drawn."""
    freedom = 2 * draws.mean() ** 2 / draws.var(ddof=1)
    return float(chi2_above(freedom * square / draws.mean(), freedom))


def draw_squares(validation: Validation) -> np.ndarray:
    """Returns mean squares that the free run's error may have on what is told, shape (DRAWS,).

    They are in the square of the outputs' unit, over all outputs.

    Args:
        validation: the prediction of the whole log by a fitted model.

    Raises:
        DivergenceError: the model cannot be simulated with another parameter.
    """
    fit, told, rng = validation.refit, validation.parts.report, np.random.default_rng(0)
    J = evaluate_sensitivities(fit.point, validation.log)[told]
    values, vectors = np.linalg.eigh(fit.problem.covariance)
    δ = vectors * np.sqrt(np.maximum(values, 0.0)) @ rng.standard_normal((len(values), DRAWS))
    with one_blas_thread():
        e = J @ δ + fit.level.sigma * _by_inputs(validation, rng)[told]
    e += validation.noise[:, None] * rng.standard_normal(e.shape)
    return np.asarray(np.mean(e**2, axis=(0, 1)))


def _by_inputs(validation: Validation, rng: np.random.Generator) -> np.ndarray:
    """Returns what drawn errors of the inputs do to a free run, over σ, shape (N, ny, DRAWS)."""
    system, out = validation.filter.system, np.zeros((*validation.e.shape, DRAWS))
    if system is None:
        return out
    nx, nu, _ = system.sizes
    fresh = np.sqrt(system.fresh)[..., None]
    x, w = np.zeros((nx, DRAWS)), fresh[0] * rng.standard_normal((nu, DRAWS))
    for k, (A, B, a) in enumerate(zip(system.A, system.B, system.a, strict=True)):
        x = A @ x + B @ w  # of another record nothing is known: A, B and a are zero there
        w = a * w + fresh[k + 1] * rng.standard_normal((nu, DRAWS))
        out[k + 1] = system.C @ x
    return out
