"""An error of the free run that neither noise nor the std of the fitted values makes.

    E[e_k²] = σ² s² + d_k² + diag(J_k C J_kᵀ)       of an unseen sample k, output by output

σ s: noise of the sensors, d: what unlogged errors of the inputs do to a free run
(`Validation.moved`), J = ∂ŷ/∂q, C: covariance of q. An innovation one sample ahead need not show
that a robot changed: a slow change, such as that of a friction, is corrected at each sample. The
free run adds it up.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from identification.discovery.attempts import attempt
from identification.discovery.findings.evidence import UnexpectedError
from identification.discovery.findings.finding import Finding, FindingKind
from identification.innovations.proof import Validation
from identification.kalman.point import evaluate_sensitivities
from identification.pool import one_blas_thread

# Of the rms of an error to what is expected of it. Errors of a free run last for seconds, so that
# a record has few that are independent, and the ratio scatters: in 72 logs of a slider in which
# nothing is missing its rms was 0.97, and its largest value 1.6.
MAX_EXPECTED_RATIO = 3.0


def find_unexpected_error(validation: Validation) -> tuple[Finding, ...]:
    """Returns the error of the free run where it is far larger than expected; else nothing.

    It is of the samples on which the search has not decided.

    Args:
        validation: the prediction of the whole log by a fitted model.
    """
    # A small change of a parameter may make the simulation diverge.
    expected = attempt(None, partial(expect_error, validation))
    if expected is None:
        return ()
    rms = validation.rms("report")
    if not rms > MAX_EXPECTED_RATIO * expected:
        return ()
    return (Finding(FindingKind.UNEXPECTED_ERROR, UnexpectedError(rms / expected)),)


def expect_error(validation: Validation) -> float:
    """Returns the rms that the free run's error should have on what is told, over all outputs.

    Args:
        validation: the prediction of the whole log by a fitted model.

    Raises:
        DivergenceError: the model cannot be simulated with another parameter.
    """
    fit, told = validation.refit, validation.parts.report
    J = evaluate_sensitivities(fit.point, validation.log)[told]
    with one_blas_thread():
        by_values = np.einsum("nip,pq,niq->ni", J, fit.problem.covariance, J, optimize=True)
    by_inputs = fit.level.sigma**2 * validation.moved[told]
    return float(np.sqrt(np.mean(by_values + by_inputs + validation.noise**2)))
