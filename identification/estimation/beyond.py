"""Predictions of a fit on the samples after the fitted ones, and their uncertainty."""

from __future__ import annotations

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.estimation import Estimate
from identification.estimation.metrics import fit_percent, rms
from identification.logs.log import Log
from identification.model.predictor import Predictor
from identification.model.sensitivity import sensitivity


def beyond(
    estimate: Estimate, whole: Log | None, covariance: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray | None, np.ndarray]:
    """Returns fit in %, rms error, and rms spread of the prediction by the covariance of q: (ny,).

    All three are of the samples after the fitted ones, in a free run from the start of the log.
    """
    n, ny = estimate.predictor.log.outputs.shape
    if whole is None or len(whole) <= n + 2:
        return None, None, np.zeros(ny)
    p = estimate.predictor
    longer = Predictor(p.plant, whole, p.names, p.fixed)
    try:
        predicted = longer.predict(estimate.space.decode(estimate.q))[0][n:]
        J = sensitivity(longer, estimate.space, estimate.q)[n:]
    except DivergenceError:
        return np.full(ny, -np.inf), np.full(ny, np.inf), np.zeros(ny)
    measured = whole.outputs[n:]
    spread = np.sqrt(np.mean(np.einsum("nip,pq,niq->ni", J, covariance, J), axis=0))
    return fit_percent(measured, predicted), rms(measured - predicted), spread
