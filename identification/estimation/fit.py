"""A fit: the estimated values, their uncertainty, and how well they explain the log.

The covariance is that of `identification.estimation.uncertainty`. What the log alone can say about
the parameters is computed without priors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from identification.errors import DivergenceError
from identification.estimation.estimation import Estimate
from identification.estimation.identifiability import Identifiability, identifiability
from identification.estimation.information import Information, information_of
from identification.estimation.metrics import (
    by_unit,
    fit_percent,
    loss,
    output_units,
    rms,
    rms_by_unit,
)
from identification.estimation.residuals import ResidualTests, residual_tests
from identification.estimation.resolution import nothing_resolved, resolve
from identification.estimation.scaling_symmetry import Combination
from identification.estimation.uncertainty import (
    bounded,
    influence,
    mostly_steps,
    sandwich,
    step_shift,
    with_steps,
)
from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.logs.rest import RESTING, share_of_motion
from identification.model.predictor import Predictor
from identification.model.sensitivity import sensitivity
from identification.runtime.progress import stage


@dataclass(frozen=True, kw_only=True)
class Fit:
    """The result of an estimation.

    Attributes:
        estimate: where the search ended.
        std: std of the values, in their units, shape (p,), in which the error of the model's steps
            counts; infinite where neither the log nor a
            prior determines a value, NaN where a bound holds it.
        correlation: correlation of the estimates, shape (p, p), without unit.
        at_bound: true where a value lies on a bound, shape (p,).
        found: the directions that the outputs feel, and those that they do not feel.
        combinations: products of parameters that can be known although the parameters cannot, with
            value and std; the std is infinite where the simulation is too rough to tell.
        residual: y - ŷ, shape (n, ny), in the outputs' units.
        fit_percent: on the log, shape (ny,) [%].
        validation_fit_percent: on data that the fit has not seen, shape (ny,) [%], or None.
        validation_rms: rms error on these data, over all outputs, or None.
        validation_expected: the rms error to expect on these data if the model is right, from the
            fitted residual and from the uncertainty of the parameters, or None.
        validation_rms_by_unit: the same by the outputs' units, each in it, or None.
        validation_expected_by_unit: likewise, or None.
        validation_rests: whether the outputs hardly move on these data.
        floor: std of the noise seen in the measurement alone, shape (ny,), in the outputs' units.
        tests: tests of the residual.
        information: Fisher information of the log at the estimate, for white noise.
        step_shift: change of each value with a quarter of the model's step, shape (p,), in their
            units; NaN where that cannot be known.
        step_error: rms of the whitened residual with a quarter of the model's step over what it is;
            NaN likewise.
    """

    estimate: Estimate
    std: np.ndarray
    correlation: np.ndarray
    at_bound: np.ndarray
    found: Identifiability
    combinations: tuple[tuple[Combination, float, float], ...]
    residual: np.ndarray
    fit_percent: np.ndarray
    validation_fit_percent: np.ndarray | None
    validation_rms: float | None
    validation_expected: float | None
    validation_rms_by_unit: dict[str, float] | None
    validation_expected_by_unit: dict[str, float] | None
    validation_rests: bool
    floor: np.ndarray
    tests: ResidualTests
    information: Information
    step_shift: np.ndarray
    step_error: float

    @property
    def values(self) -> dict[str, float]:
        """The fitted values by name, in their units."""
        return self.estimate.values

    shared = values

    @property
    def own_values(self) -> dict[str, dict[str, float]]:
        """No record has values that the others have not."""
        return {}

    @property
    def start(self) -> np.ndarray:
        """The values with which the fit began, in their units, shape (p,)."""
        return self.estimate.start

    @property
    def converged(self) -> bool:
        """Tells whether the search ended by itself."""
        return self.estimate.status == "converged"

    @property
    def stopped(self) -> bool:
        """Tells whether the user stopped the search; its best values are kept."""
        return self.estimate.status == "stopped"

    @property
    def worse(self) -> None:
        """The proof that the fit predicts unseen data worse, which nobody asks of a free run."""
        return None

    @property
    def horizon(self) -> None:
        """The length of the windows that were fitted [s]; None for a free run."""
        return None

    @property
    def far(self) -> list[str]:
        """Values whose std is mostly the error of the steps, the worst first."""
        std = dict(zip(self.estimate.space.names, self.std.tolist(), strict=True))
        return mostly_steps(self.step_shift, std)

    @property
    def rms(self) -> float:
        """Rms of the residual over all outputs."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def rms_by_unit(self) -> dict[str, float]:
        """Rms of the residual by the outputs' units, each in it."""
        return rms_by_unit(self.residual, self.estimate.predictor.log)

    @property
    def floor_by_unit(self) -> dict[str, float]:
        """Rms of the noise by the outputs' units, each in it."""
        return by_unit(self.floor, self.estimate.predictor.log)

    @property
    def loss(self) -> float:
        """The thesis' loss function (3.5)."""
        return loss(self.residual)


def assess(estimate: Estimate, validation: Log | None = None, asked: int | None = None) -> Fit:
    """Assess an estimate: its uncertainty, its residual, and its error on unseen data.

    Whoever stopped a search does not wait: its uncertainty and unseen data are then not asked, and
    every std is infinite.

    Args:
        estimate: where a search ended.
        validation: the whole log, of which the estimation used the beginning; the rest is unseen
            data. None when there is none.
        asked: how many of the first parameters are asked for; all when None. The others are unknown
            too, which the std contain, and are fixed in what is returned.

    Raises:
        InputError: the robot cannot start with the estimated values.
        DivergenceError: a simulation near the estimate left the finite numbers.
    """
    with stage("std of the values, and tests of what is left"):
        return _assessed(estimate, validation, asked)


def _assessed(estimate: Estimate, validation: Log | None, asked: int | None) -> Fit:
    predictor, space, q = estimate.predictor, estimate.space, estimate.q
    log = predictor.log
    predicted = predictor.predict(space.decode(q))[0]
    residual = log.outputs - predicted

    def whiten(J: np.ndarray) -> np.ndarray:
        S = np.einsum("ij,njp->nip", estimate.whitener, estimate.weight[:, :, None] * J)
        return S.reshape(-1, J.shape[2])

    if estimate.status == "stopped":
        validation, prior = None, np.zeros((len(q), len(q)))
        resolved = nothing_resolved(space.names, residual.size)
    else:
        prior = estimate.priors.rows
        resolved = resolve(predictor, space, q, predicted, whiten)
    S, found = resolved.S, resolved.found
    E = np.concatenate([resolved.E, np.zeros_like(prior)])
    known = identifiability(np.concatenate([S, prior]), space.names, E, resolved.least)
    error = (estimate.weight * residual) @ estimate.whitener.T
    pull, share = influence(error, estimate.options.loss)
    covariance = sandwich(S.reshape(*error.shape, -1), pull, share, error, known, prior)
    at_bound = space.on_bound(q)
    std_q = np.where(at_bound, np.nan, np.sqrt(np.diag(covariance)))
    std_q[known.undetermined] = np.inf
    scale = np.sqrt(np.maximum(np.diag(covariance), np.finfo(float).tiny))
    fit, unseen, spread = beyond(estimate, validation, covariance)
    expected = np.hypot(rms(residual), spread)
    moves, step_error = step_shift(estimate, predicted, S, prior, whiten)
    shift = np.where(np.isfinite(std_q), moves, np.nan)
    correlation = covariance / np.outer(scale, scale)
    std = with_steps(std_q * space.slope(q), shift)
    information = information_of(resolved, space, asked)
    if asked is not None and asked < len(q):
        estimate, found = estimate.about(asked), information.found
        covariance = covariance[:asked, :asked]
    return Fit(
        estimate=estimate,
        std=std[:asked],
        correlation=bounded(correlation[:asked, :asked]),
        at_bound=at_bound[:asked],
        found=found,
        combinations=combinations_of(found, estimate, covariance),
        residual=residual,
        fit_percent=fit_percent(log.outputs, predicted),
        validation_fit_percent=fit,
        validation_rms=None if unseen is None else _over_all(unseen),
        validation_expected=None if unseen is None else _over_all(expected),
        validation_rms_by_unit=None if unseen is None else by_unit(unseen, log),
        validation_expected_by_unit=None if unseen is None else by_unit(expected, log),
        validation_rests=unseen is not None and _rests(log, validation),
        floor=noise_floor(log.outputs),
        tests=residual_tests(residual, log.inputs),
        information=information,
        step_shift=shift[:asked],
        step_error=step_error,
    )


def _rests(log: Log, whole: Log | None) -> bool:
    """Returns whether the outputs hardly move after the samples that were fitted."""
    if whole is None:
        return False
    units, behind = [*output_units(log).values()], whole.outputs[len(log) :]
    return share_of_motion([log.outputs], behind, units) < RESTING


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


def combinations_of(
    found: Identifiability, estimate: Estimate, covariance: np.ndarray
) -> tuple[tuple[Combination, float, float], ...]:
    """Returns products of parameters, with the value and the std of each product.

    The std is infinite where the product also changes along a direction that the differences
    cannot resolve.
    """
    out = []
    for combination in found.combinations:
        powers = combination.row(found.names)
        value = combination.value(estimate.values)
        std = np.inf if found.moved(powers[None])[0] else np.sqrt(powers @ covariance @ powers)
        out.append((combination, value, value * float(std)))
    return tuple(out)


def _over_all(rms: np.ndarray) -> float:
    """Returns the rms over all outputs, from that of each output, shape (ny,)."""
    return float(np.sqrt(np.mean(rms**2)))
