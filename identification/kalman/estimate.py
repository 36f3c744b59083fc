"""Estimation by innovations, where the inputs differ from what the log says.

    e_k = y_k - ŷ_k(q) = noise of the sensors + response to an unlogged error of the inputs

A free run accumulates what disturbs the plant: its residual is many times the noise, and a fit of
it bends the parameters. The Kalman predictor corrects itself with each sample. The level and the
correlation time of the inputs' error are estimated together with the parameters by maximum
likelihood (Ljung 1999, section 7.4).
"""

from __future__ import annotations

import time
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError
from identification.estimation.estimation import Estimate
from identification.estimation.fit import Fit, assess, combinations_of
from identification.estimation.information import information_of
from identification.estimation.priors import Priors, free_parameters
from identification.estimation.residuals import residual_tests
from identification.estimation.resolution import resolve
from identification.estimation.search import Options, Status
from identification.kalman.noise_fit import NoiseLevel
from identification.kalman.noise_model import Noise, Whitener, build_whitener
from identification.kalman.options import KalmanOptions
from identification.kalman.point import Point, evaluate_point, extend_point
from identification.kalman.refit import Refit, conclude, descend
from identification.logs.log import Log
from identification.model.predictor import Plant
from identification.model.sensitivity import refuse_without_effect, without_effect
from identification.runtime.pool import one_blas_thread
from identification.runtime.progress import Progress

MIN_SAMPLES = 50  # with fewer, the noise of the sensors cannot be told from that of the inputs
STEPS = 30  # at most
RIDGE_WEIGHT = 0.1  # 1/std of q: holds directions that have no effect on the outputs


@dataclass(frozen=True)
class InnovationsFit:
    """An estimate by innovations."""

    # the values; std, correlation and tests are those of the innovations, residual and fit
    # percentages those of a free run
    fit: Fit
    level: NoiseLevel  # the noise of sensors and inputs
    # of the whole log, in the outputs' unit, shape (N, ny); of the fitted samples alone where the
    # search was stopped
    innovations: np.ndarray
    first: int  # first sample that was not fitted

    @property
    def rms(self) -> float:
        """Rms of the innovations on the fitted samples, in the outputs' unit."""
        return float(np.sqrt(np.mean(self.innovations[: self.first] ** 2)))

    @property
    def validation_rms(self) -> float | None:
        """Rms of the innovations on the samples that were not fitted; None without such."""
        rest = self.innovations[self.first :]
        return float(np.sqrt(np.mean(rest**2))) if len(rest) > 2 else None


def estimate_innovations(
    plant: Plant,
    log: Log,
    names: Sequence[str],
    start: Mapping[str, float] | None = None,
    progress: Progress | None = None,
) -> InnovationsFit:
    """Estimate parameters by the innovations of a log's part `estimation`; confirm on the rest.

    An interrupt (Ctrl-C) ends the search and keeps the best values so far.

    Args:
        plant: the model, with nominal values for whatever is not named.
        log: what was measured.
        names: the free parameters.
        start: starting values by name; the plant's own where not given.
        progress: is told one line per accepted step.

    Raises:
        InputError: a name is unknown or has no effect, or the log is too short.
        DivergenceError: the start cannot be simulated.
    """
    began = time.perf_counter()
    part = log.part("estimation")
    if len(part) < MIN_SAMPLES:
        raise InputError(
            f"the log has {len(part)} samples to fit; innovations need at least {MIN_SAMPLES}"
        )
    predictor, space, first = free_parameters(plant, part, names, start or {})
    mean = space.encode(first)
    held = Priors(space, mean, np.full(len(mean), RIDGE_WEIGHT))
    first_point = evaluate_point(predictor, space, mean)
    if without_effect(first_point.J, part.outputs).any():
        refuse_without_effect(first_point.J, space.names, part)
    seen = [(first_point, NoiseLevel(Noise(0.0, 1.0), 1.0, 0.0))]
    points = descend(first_point, held, KalmanOptions(), steps=STEPS)
    status = _search(points, seen, progress)
    taken = max(0, len(seen) - 2)
    end = conclude(*seen[-1], held, taken)
    ends = Estimate(
        predictor=predictor,
        space=space,
        start=first,
        q=end.point.q,
        whitener=np.diag(1 / end.level.of_outputs(part.outputs.shape[1])),
        weight=np.ones_like(part.outputs),
        options=Options(),
        evaluations=taken + 1,
        jacobians=taken + 1,
        status=status,
        seconds=0.0,
    )
    fit = assess(ends, log)
    with one_blas_thread():
        filter_ = build_whitener(end.point.linear, end.level.noise, part.sampling_time)
        E = filter_.s * filter_(end.point.e)
    if status != "stopped":  # else nobody waits for std, nor for unseen data
        fit, E = _of_innovations(end, fit, filter_, E), compute_innovations(end, log)
    fit = replace(fit, estimate=replace(ends, seconds=time.perf_counter() - began))
    return InnovationsFit(fit, end.level, E, len(part))


def _search(
    points: Generator[tuple[Point, NoiseLevel], None, bool],
    seen: list[tuple[Point, NoiseLevel]],
    progress: Progress | None,
) -> Status:
    """Follow a search until it ends, and append its points to `seen`."""
    try:
        while True:
            point, level = next(points)
            seen.append((point, level))
            if progress is not None:
                sizes = f"sensors {level.sigma:.4g}, inputs {level.input_std:.3g} rms"
                progress(f"step {len(seen) - 2}: {sizes}")
    except StopIteration as end:
        return "converged" if end.value else "iterations"
    except KeyboardInterrupt:
        return "stopped"


def compute_innovations(end: Refit, whole: Log) -> np.ndarray:
    """Returns the innovations over a log whose beginning was fitted, shape (N, ny)."""
    longer = extend_point(end.point, whole)
    with one_blas_thread():
        filter_ = build_whitener(longer.linear, end.level.noise, whole.sampling_time)
        return np.asarray(filter_.s * filter_(longer.e))


def _of_innovations(end: Refit, fit: Fit, filter_: Whitener, E: np.ndarray) -> Fit:
    """Returns the fit with the uncertainty and the tests of the innovations E (n, ny)."""
    point, σ = end.point, end.level.sigma
    with one_blas_thread():
        resolved = resolve(
            point.predictor, point.space, point.q, point.log.outputs - point.e,
            lambda J: filter_(J).reshape(point.e.size, -1) / σ,
        )  # fmt: skip
    S, found = resolved.S, resolved.found
    covariance = np.linalg.pinv(S.T @ S + np.diag(end.priors.weight**2), hermitian=True)
    std = np.sqrt(np.diag(covariance))
    return replace(
        fit,
        std=np.where(found.undetermined, np.inf, std) * point.space.slope(point.q),
        correlation=covariance / np.outer(std, std),
        combinations=combinations_of(found, fit.estimate, covariance),
        found=found,
        information=information_of(resolved, point.space),
        tests=residual_tests(E, point.log.inputs),
    )
