"""One search for the smallest criterion, over horizons that grow, with few simulations.

- The outputs at a point are simulated once, for the residual and for the sensitivities.
- Sensitivities are forward differences from these outputs.
- A horizon ends at a relative gain of `ROUGH_TOLERANCE` if a longer one follows; the last horizon
  ends at the `tolerance` of the options.
- No sensitivities are computed at the point where the search ends.
- Sensitivities are kept where the outputs changed as they had promised:

    J₊ = J + (Δr - J s)(D s)ᵀ/(sᵀ D s)      where ‖Δr - J s‖ <= SLOPE_ERROR ‖Δr‖

s is the step, Δr the change of the residual, and D the diagonal of Jᵀ J, so that units of the
parameters change nothing. It is Broyden's correction (Broyden 1965): the slopes are right along the
step, and what they were across it. Near an optimum it saves a simulation for each free parameter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from scipy.optimize import least_squares

from identification.errors import DivergenceError, InputError
from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.estimation.priors import Priors
from identification.logs.noise import relative_weight, whitener_of
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import (
    forward_sensitivity,
    refuse_without_effect,
    sensitivity,
    without_effect,
)
from identification.runtime.progress import USUAL, Progress, stage

HORIZONS = (0.05, 0.2, 0.5, 1.0)  # of the log: a short one keeps a search from local minima
Status = Literal["converged", "iterations", "stopped"]
ROUGH_TOLERANCE = 1e-2  # relative gain at which a search ends that another one follows
PULL_WEIGHTS = (1.0, 0.1)  # towards the last result, on a short horizon and on the whole log
# If a horizon that is longer by less than this share diverges, the search fails.
CLOSE_HORIZON_SHARE = 0.1
EXACT_RESIDUAL = 1e-11  # over the outputs: below it only round-off is left


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of a search.

    Attributes:
        method: the `method` of `scipy.optimize.least_squares`; "lm" has no bounds.
        criterion: "trace" (least squares) or "det" (maximum likelihood, covariance estimated).
        loss: robust loss of `least_squares`: "linear", "soft_l1", "huber", "cauchy", "arctan".
        horizons: growing fractions of the log, of which the last is 1; (1.0,) is a single fit of
            the free run over the whole log.
        tolerance: relative change of cost and of q at which a search stops.
        max_evaluations: largest number of simulations of the outputs for each horizon.
        relative_noise: std of a sample's noise divided by the sample, where the noise grows with
            the signal. Each residual is then divided by this std, computed from the prediction.
        priors: std of the prior of q about the start, by name (of ln(value) where q is a
            logarithm).

    Raises:
        InputError: the horizons do not grow to 1, or a prior's std is not positive.
    """

    method: Literal["trf", "lm", "dogbox"] = "trf"
    criterion: Literal["trace", "det"] = "trace"
    loss: str = "linear"
    horizons: tuple[float, ...] = HORIZONS
    tolerance: float = 1e-8
    max_evaluations: int = 60
    relative_noise: float = 0.0
    priors: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        h = self.horizons
        if not h or not h[0] > 0 or h[-1] != 1 or not all(np.diff(h) > 0):
            raise InputError(f"horizons {h} must grow to 1, such as {HORIZONS}")
        if self.method == "lm" and self.loss != "linear":
            raise InputError(
                f"method 'lm' knows no robust loss; leave out {self.loss!r}, or search by 'trf'"
            )
        for name, std in self.priors.items():
            if not std > 0:
                raise InputError(f"the prior of {name} has std {std:g}; give a positive one")


@dataclass
class Search:
    """One search: what `least_squares` calls, and the best point it has seen."""

    predictor: Predictor  # the plant, the log and the names of the free parameters
    space: Coordinates  # their coordinates
    best: np.ndarray  # the point at which it begins, then the best one, shape (p,)
    whitener: np.ndarray  # C, shape (ny, ny)
    options: Options  # how to search
    progress: Progress | None  # is told one line per accepted step
    evaluations: int = 0  # how often the outputs were simulated
    jacobians: int = 0  # how often the sensitivities were computed

    def __post_init__(self) -> None:
        self.weight = relative_weight(self.predictor.log.outputs, self.options.relative_noise)
        self.priors = Priors.of(self.space, self.best, self.options.priors)
        self._last = np.full_like(self.best, np.nan), np.empty((0, 0))  # a point and its ŷ

    def refuse_idle(self) -> None:
        """Refuse parameters without effect; the first horizon is tried before the whole log."""
        for fraction in (self.options.horizons[0], 1.0):
            J = sensitivity(self.predictor, self.space, self.best, self.samples(fraction))
            if not without_effect(J, self.predictor.log.outputs).any():
                return
        refuse_without_effect(J, self.space.names, self.predictor.log)

    def samples(self, fraction: float) -> int:
        """Returns the number of samples of a horizon."""
        return max(3, round(fraction * len(self.predictor.log)))

    def run(self) -> Status:
        """Search all horizons, then again with the weights of relative noise or with `det`."""
        with stage("steps of the search", USUAL * len(self.options.horizons)) as self._advance:
            return self._run()

    def _run(self) -> Status:
        status: Status = "converged"
        try:
            status = self._grow()
            for _ in range(2 if self.options.relative_noise else 0):
                predicted = self.predicted(self.best, None)
                self.weight = relative_weight(predicted, self.options.relative_noise)
                status = self.solve(self.samples(1.0), self.options.tolerance)
            for _ in range(8 if self.options.criterion == "det" else 0):
                before = self.best
                self.whitener = whitener_of(self.weight * self.error(self.best, None))
                status = self.solve(self.samples(1.0), self.options.tolerance)
                if np.abs(self.best - before).max() < 1e-6:
                    break
        except KeyboardInterrupt:
            return "stopped"
        return status

    def _grow(self) -> Status:
        """Search all horizons; one that diverges at first is reached by horizons in between.

        Raises:
            DivergenceError: the first horizon diverges, or one that is longer by less than a tenth.
        """
        status: Status = "converged"
        reached, ahead = 0.0, list(self.options.horizons)
        while ahead:
            rough = self.options.tolerance if ahead[0] == 1 else ROUGH_TOLERANCE
            try:
                status = self.solve(self.samples(ahead[0]), max(rough, self.options.tolerance))
            except DivergenceError:
                if reached == 0 or ahead[0] < (1 + CLOSE_HORIZON_SHARE) * reached:
                    raise
                ahead.insert(0, (reached + ahead[0]) / 2)
            else:
                reached = ahead.pop(0)
        return status

    def error(self, q: np.ndarray, samples: int | None) -> np.ndarray:
        """Returns ε = y - ŷ, shape (samples, ny)."""
        return self.predictor.log.outputs[:samples] - self.predicted(q, samples)

    def predicted(self, q: np.ndarray, samples: int | None) -> np.ndarray:
        """Returns ŷ, shape (samples, ny); it is kept for the Jacobian at the same point."""
        samples = samples or len(self.predictor.log)
        at, known = self._last
        if len(known) != samples or not np.array_equal(at, q):
            self.evaluations += 1
            known = self.predictor.predict(self.space.decode(q), samples)[0]
            self._last = q.copy(), known
        return known

    def solve(self, samples: int, tolerance: float) -> Status:
        """Minimise the criterion over the first samples, from the best point."""
        self.error(self.best, samples)  # if the start diverges, the caller is told
        weight = self.weight[:samples]
        measured = (weight * self.predictor.log.outputs[:samples]) @ self.whitener.T
        exact = EXACT_RESIDUAL**2 * float(np.sum(measured**2))
        linear = self.options.loss == "linear"
        cost = gain = np.inf
        origin = self.best
        size = np.where(self.space.logarithmic, 1.0, np.maximum(1.0, np.abs(origin)))
        hold = PULL_WEIGHTS[samples == len(self.predictor.log)] / size

        slopes: Slopes | None = None

        def stacked(q: np.ndarray, weighed: np.ndarray) -> np.ndarray:
            return np.concatenate([weighed.ravel(), -self.priors.against(q), (q - origin) * hold])

        def residual(q: np.ndarray) -> np.ndarray:
            nonlocal cost, gain
            try:
                weighed = (weight * self.error(q, samples)) @ self.whitener.T
            except InputError:  # no simulation is possible here: the search must try another point
                weighed = np.full((samples, len(self.whitener)), np.inf)
            r = stacked(q, weighed)
            now = float(r @ r)
            if linear and cost <= now <= cost * (1 + tolerance):
                raise _Settled  # no step leads down any more
            if now < cost:
                gain, cost, self.best = cost - now, now, q.copy()
                self._tell(samples, weighed)
            return r

        def jacobian(q: np.ndarray) -> np.ndarray:
            # It is asked for also where it ends, and would cost the most of a short search.
            if linear and (gain <= tolerance * cost or cost <= exact):
                raise _Settled
            nonlocal slopes
            r = stacked(q, (weight * self.error(q, samples)) @ self.whitener.T)
            slopes = slopes and slopes.moved(q, r)
            if slopes is None:
                self.jacobians += 1
                J = forward_sensitivity(self.predictor, self.space, q, self.predicted(q, samples))
                J = weight[:, :, None] * J
                weighed = -np.einsum("ij,njp->nip", self.whitener, J).reshape(-1, len(q))
                J = np.concatenate([weighed, self.priors.rows, np.diag(hold)])
                slopes = Slopes(q.copy(), r, J)
            return slopes.J

        bounded: dict[str, Any] = {}
        if self.options.method != "lm":
            bounded = {"bounds": (self.space.lower, self.space.upper)}
        try:
            found = least_squares(
                residual, self.best, jacobian, method=self.options.method, x_scale="jac",
                loss=self.options.loss, ftol=tolerance, xtol=self.options.tolerance,
                gtol=1e-15, max_nfev=self.options.max_evaluations, **bounded,
            )  # fmt: skip
        except _Settled:
            return "converged"
        self.best = found.x
        return "converged" if found.status > 0 else "iterations"

    def _tell(self, samples: int, weighed: np.ndarray) -> None:
        self._advance()
        if self.progress is not None:
            error = np.linalg.solve(self.whitener, weighed.T).T / self.weight[:samples]
            seconds = samples * self.predictor.log.sampling_time
            rms = float(np.sqrt(np.mean(error**2)))
            self.progress(f"horizon {seconds:.2f} s: rms {rms:.4g} after {self.evaluations} runs")


class _Settled(Exception):
    """The search ends here: what would come next is not worth its simulations."""


@dataclass(frozen=True)
class Slopes:
    """Slopes J (n, p) of the weighed residual r (n,) at a point q (p,)."""

    q: np.ndarray
    r: np.ndarray
    J: np.ndarray

    def moved(self, q: np.ndarray, r: np.ndarray) -> Slopes | None:
        """Returns the slopes at another point, not simulated; None if they differ by too much."""
        step, change = q - self.q, r - self.r
        off = change - self.J @ step
        if not np.linalg.norm(off) <= SLOPE_ERROR * np.linalg.norm(change):
            return None
        along = np.sum(self.J**2, axis=0) * step  # lengths are those of the outputs' changes
        return Slopes(q, r, self.J + np.outer(off, along / (along @ step)))
