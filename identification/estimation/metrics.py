"""Agreement of a simulation with a log: fit, rms and loss, each over n samples."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.logs.sampling import FloatArray
from identification.shares import percent


def by_unit(rms: np.ndarray, log: Log) -> dict[str, float]:
    """Returns the rms over the outputs of each unit, in it, by unit; "" for outputs without one.

    Args:
        rms: of each output, shape (ny,), in its unit.
        log: which outputs they are.
    """
    units = [*output_units(log).values()]
    return {
        unit: float(np.sqrt(np.mean(rms[[u == unit for u in units]] ** 2)))
        for unit in dict.fromkeys(units)
    }


def rms_by_unit(errors: np.ndarray, log: Log) -> dict[str, float]:
    """Returns the rms of errors by unit, in it.

    Args:
        errors: shape (…, ny), in the outputs' units.
        log: which outputs they are.
    """
    return by_unit(np.sqrt(np.mean(errors.reshape(-1, errors.shape[-1]) ** 2, axis=0)), log)


def output_units(log: Log) -> dict[str, str]:
    """Returns the unit of each output by name; "" where it has none."""
    return {name: log.units.get(name, "") for name in log.output_names}


def of_outputs(values: Mapping[str, float], log: Log) -> np.ndarray:
    """Returns for each output the value that is given for its unit, shape (ny,)."""
    return np.array([values[log.units.get(name, "")] for name in log.output_names])


def relative(errors: Mapping[str, float], of: Mapping[str, float]) -> float:
    """Returns errors by unit relative to others, in one number; infinite where these are zero."""
    if not all(of[unit] > 0 for unit in errors):
        return float("inf")
    return float(np.sqrt(np.mean([(e / of[unit]) ** 2 for unit, e in errors.items()])))


def fit_percent(y: FloatArray, y_hat: FloatArray) -> FloatArray:
    """Returns the fit of each channel, 100 (1 − ‖ŷ − y‖ / ‖y − ȳ‖) [%].

    100 is perfect, 0 is no better than the mean of the measurement, and less is worse than that. A
    channel that never moves has no scale to compare with: its fit is NaN.

    Args:
        y: measured outputs, shape (n, ny), each column in a unit of its own.
        y_hat: simulated outputs, shape (n, ny), in the same units.

    Returns:
        Fit (ny,) [%].

    Raises:
        InputError: the shapes differ or are not (n, ny).

    Source:
        Thesis, eq. 3.4, whose bracket is misprinted; this is the normalised root-mean-square fit
        that MATLAB's `compare` shows.
    """
    if y.shape != y_hat.shape:
        raise InputError(
            f"measured outputs have shape {y.shape} and simulated ones {y_hat.shape}; "
            "compare the same samples of the same channels"
        )
    _check_matrix(y)
    # A constant is found by its range: its mean is rounded, so its deviations need not be zero.
    scale = np.ptp(y, axis=0)
    moving = scale > 0
    scale = np.where(moving, scale, 1.0)
    error = np.linalg.norm((y_hat - y) / scale, axis=0)
    spread = np.linalg.norm((y - y.mean(axis=0)) / scale, axis=0)
    ratio = np.divide(error, spread, out=np.full(len(spread), np.nan), where=moving)
    return 100 * (1 - ratio)


def mean_fit(fit: FloatArray) -> str:
    """Returns the mean fit in words; outputs that never move have none, and are left out."""
    moving = fit[~np.isnan(fit)]
    if not len(moving):
        return "undefined: no output moves"
    still = len(fit) - len(moving)
    return percent(float(moving.mean()) / 100, 5) + (
        f" ({still} outputs never move)" if still else ""
    )


def rms(residual: FloatArray) -> FloatArray:
    """Returns the root mean square (ny,) of each channel of a residual (n, ny), in its unit.

    Raises:
        InputError: the residual is not (n, ny).
    """
    _check_matrix(residual)
    return np.sqrt(np.mean(residual**2, axis=0))


def loss(residual: FloatArray) -> float:
    """Returns the quadratic loss (1/N) Σ_k ε_kᵀ ε_k of a residual ε (N, ny): thesis, eq. 3.5.

    All outputs must be in one unit; the loss is in its square.

    Raises:
        InputError: the residual is not (n, ny).
    """
    _check_matrix(residual)
    return float(np.sum(residual**2) / len(residual))


def _check_matrix(values: FloatArray) -> None:
    if values.ndim != 2 or len(values) == 0:
        raise InputError(
            f"outputs have shape {values.shape}; give (n, ny), a row for each of n > 0 samples"
        )
