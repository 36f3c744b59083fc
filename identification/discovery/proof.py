"""Proof on unseen data: does an effect predict samples better that no fit has seen?

    Δ_b = ½ Σ_{k in b} ‖E_k(without)‖² - ‖E_k(with)‖²        over blocks b of unseen samples
    t = mean(Δ_b)/(std(Δ_b)/√B)

    share = (rms²(without) - rms²(with))/(rms²(without) - σ² - d²)

Both residuals pass the filter of the model without the effect, so that neither predictor follows
the data more closely than the other. rms is that of a free run, d what input errors do to it; where
a free run drifts by them, rms and d are those over a horizon (see
`identification.estimation.window_error`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from identification.discovery.disturbance import propagate_input_error, propagate_over_windows
from identification.discovery.result import Gap, Proof
from identification.errors import InputError
from identification.estimation.metrics import fit_percent
from identification.estimation.window_error import window_error
from identification.estimation.windows import windows
from identification.kalman.noise_model import Whitener, build_whitener
from identification.kalman.point import extend_point
from identification.kalman.refit import Refit
from identification.logs.log import Log

BLOCKS = 20


@dataclass(frozen=True)
class Validation:
    """A fit on the whole log, of which it has seen the beginning.

    Attributes:
        refit: the fit.
        whole: the log.
        e: free-run residual, shape (N, ny).
        innovations: whitened, in units of σ, shape (N, ny).
        filter: what whitened them.
        first: first unseen sample.
        disturbance: rms of what input errors do to the error that is judged.
        measured: outputs of the unseen samples that are judged, shape (n, ny).
        judged: error there, of the free run or over the horizon, shape (n, ny).
    """

    refit: Refit
    whole: Log
    e: np.ndarray
    innovations: np.ndarray
    filter: Whitener
    first: int
    disturbance: float
    measured: np.ndarray
    judged: np.ndarray

    @property
    def rms(self) -> float:
        """Of the error that is judged."""
        return float(np.sqrt(np.mean(self.judged**2)))

    @property
    def gap(self) -> Gap:
        """The error on the unseen samples."""
        return Gap(self.rms, fit_percent(self.measured, self.measured - self.judged))


def validate(fit: Refit, whole: Log, horizon: float | None = None) -> Validation:
    """A fit, predicted over the whole log.

    Args:
        fit: on the beginning of the log.
        whole: the log.
        horizon: of the errors that are judged [s]; those of the free run when None.
    """
    point = extend_point(fit.point, whole)
    first = len(fit.point.log)
    with threadpool_limits(1, "blas"):
        filter_ = build_whitener(point.linear, fit.level.noise, whole.sampling_time)
        E = filter_(point.e) / fit.level.sigma
        nu, ratio = point.linear.B.shape[2], fit.level.noise.ratio
        measured, judged = whole.outputs[first:], point.e[first:]
        if horizon is None:
            moved = propagate_input_error(filter_.A, filter_.C, ratio, nu)[first:]
        else:
            errors = window_error(point.predictor.plant, whole, horizon, point.values)
            starts = windows(whole, horizon).starts
            late, L = starts >= first, errors.shape[1]
            if not late.any():
                raise InputError(f"no window of {horizon:g} s begins in the unseen samples")
            judged = errors[late].reshape(-1, errors.shape[2])
            measured = windows(whole, horizon).outputs[late].reshape(judged.shape)
            moved = propagate_over_windows(filter_, ratio, nu, starts[late], L)
    disturbance = fit.level.sigma * np.sqrt(moved.mean()) if moved.size else 0.0
    return Validation(fit, whole, point.e, E, filter_, first, float(disturbance), measured, judged)


def prove(without: Validation, with_it: Validation) -> Proof:
    """What the second of two fits does for the unseen samples."""
    with threadpool_limits(1, "blas"):
        E = without.filter(with_it.e) / without.refit.level.sigma
    fewer = np.sum(without.innovations**2 - E**2, axis=1) / 2
    gain = fewer[with_it.first :]
    starts = np.linspace(0, len(gain), min(BLOCKS, len(gain) // 5), endpoint=False).astype(int)
    blocks = np.add.reduceat(gain, starts)
    scatter = blocks.std(ddof=1) / np.sqrt(len(blocks))
    t = float(blocks.mean() / scatter) if scatter > 0 else 0.0
    floor = with_it.refit.level.sigma**2 + with_it.disturbance**2
    above = without.rms**2 - min(floor, with_it.rms**2)
    closed = without.rms**2 - with_it.rms**2
    sensed = without.rms**2 - min(with_it.refit.level.sigma, with_it.rms) ** 2
    return Proof(
        float(gain.sum()),
        t,
        float(closed / above) if above > 0 else 0.0,
        float(closed / without.rms**2),
        float(closed / sensed) if sensed > 0 else 0.0,
    )
