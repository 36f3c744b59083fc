"""The prediction of a whole log by a fitted model, which has seen a part of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.discovery.disturbance import propagate_input_error
from identification.discovery.effect_results import Gap
from identification.estimation.metrics import fit_percent
from identification.kalman.noise_model import Whitener, build_whitener
from identification.kalman.point import extend_point
from identification.kalman.refit import Refit
from identification.logs.by_unit import rms_by_unit
from identification.logs.joined import rows_of
from identification.logs.log import Log
from identification.pool import one_blas_thread


@dataclass(frozen=True, kw_only=True, eq=False)
class Validation:
    """The prediction of a whole log by a model that was fitted on a part of it.

    Attributes:
        refit: the fit.
        log: the whole log, of N samples.
        e: residual of the free run, shape (N, ny).
        innovations: whitened residual in units of σ, shape (N, ny).
        filter: the whitening filter.
        seen: true for the samples that were fitted, shape (N,).
        disturbances: rms of what input errors do to the judged error of each output, shape (ny,),
            in its unit.
        measured: outputs of the unseen samples that are judged, shape (n, ny).
        judged: their error, of the free run or of the windows, shape (n, ny).
    """

    refit: Refit
    log: Log
    e: np.ndarray
    innovations: np.ndarray
    filter: Whitener
    seen: np.ndarray
    disturbances: np.ndarray
    measured: np.ndarray
    judged: np.ndarray

    @property
    def rms(self) -> float:
        """Rms of the judged error, over all outputs."""
        return float(np.sqrt(np.mean(self.judged**2)))

    @property
    def disturbance(self) -> float:
        """Rms of what input errors do to the judged error, over all outputs, in their unit."""
        return float(np.sqrt(np.mean(self.disturbances**2)))

    @property
    def noise(self) -> np.ndarray:
        """Rms of the fitted samples' innovations, of each output, shape (ny,), in its unit."""
        E = self.innovations[self.seen]
        return np.asarray(self.refit.level.sigma * np.sqrt(np.mean(E**2, axis=0)))

    @property
    def gap(self) -> Gap:
        """The judged error as a gap."""
        percent = fit_percent(self.measured, self.measured - self.judged)
        return Gap(self.rms, percent, rms_by_unit(self.judged, self.log))


def validate(fit: Refit, log: Log) -> Validation:
    """Predict a whole log with a fit.

    Args:
        fit: of the log's part `estimation`.
        log: the whole log.

    Raises:
        DivergenceError: the model cannot be simulated over the whole log.
    """
    point = extend_point(fit.point, log)
    seen = rows_of(log, "estimation")
    with one_blas_thread():
        filter_ = build_whitener(point.linear, fit.level.noise, log.sampling_time)
        E = filter_(point.e) / fit.level.sigma
        nu, ratio = point.linear.B.shape[2], fit.level.noise.ratio
        measured, judged = log.outputs[~seen], point.e[~seen]
        moved = propagate_input_error(filter_.A, filter_.C, ratio, nu)
        moved = moved[~seen] if moved.size else moved
    disturbances = np.zeros(log.outputs.shape[1])
    if moved.size:
        disturbances = fit.level.sigma * np.sqrt(moved.mean(axis=0))
    return Validation(
        refit=fit, log=log, e=point.e, innovations=E, filter=filter_, seen=seen,
        disturbances=disturbances, measured=measured, judged=judged,
    )  # fmt: skip
