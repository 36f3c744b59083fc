"""Prediction-error estimation by a horizon that grows.

    V(q) = Σ_k ‖C ε_k‖² + Σ_j ((q_j - q̄_j)/s_j)²,    ε_k = y_k - ŷ_k(q)            (thesis 3.2)

`trace`: C = I/σ. `det`: CᵀC = Λ⁻¹ with Λ the covariance of the residual, re-estimated from the
last fit until it stays, which is maximum likelihood for Gaussian noise of unknown covariance.

A free run of a stiff robot is a wild function of its parameters over seconds and a tame one over a
quarter of a second. So the fit begins on a short horizon and lengthens it, each time from the last
result; a single fit over the whole log ends in a local minimum, as the thesis' did. A horizon that
is too short to say something of a parameter must not carry it away, nor may round-off carry it
along a direction that no output feels: each q is held to where the horizon before left it, by one
noise std per unit (a factor e, or 1 m), a tenth on the last, which any information outweighs.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from scipy.optimize import least_squares

from identification.coordinates import Coordinates, coordinates
from identification.errors import InputError
from identification.log import Log
from identification.noise import noise_floor, whitener_of
from identification.predictor import Plant, Predictor
from identification.sensitivity import refuse_without_effect, sensitivity, without_effect

HORIZONS = (0.05, 0.2, 0.5, 1.0)
HOLD = (1.0, 0.1)  # noise std per unit of q, on a short horizon and on the whole log
Progress = Callable[[str], None]
Status = Literal["converged", "iterations", "stopped"]


@dataclass(frozen=True)
class Options:
    """How to search.

    Attributes:
        method: of `scipy.optimize.least_squares`; "lm" knows no bounds.
        criterion: "trace" (least squares) or "det" (maximum likelihood, covariance estimated).
        loss: robust loss of `least_squares`: "linear", "soft_l1", "huber", "cauchy", "arctan".
        horizons: growing fractions of the log, the last is 1; (1.0,) is a single free-run fit.
        tolerance: relative change of cost and of q at which a search stops.
        max_evaluations: of the outputs, per horizon.
        priors: std by name of q about the start (of ln(value) where q is a logarithm).

    Raises:
        InputError: the horizons do not grow to 1, or a prior's std is not positive.
    """

    method: Literal["trf", "lm", "dogbox"] = "trf"
    criterion: Literal["trace", "det"] = "trace"
    loss: str = "linear"
    horizons: tuple[float, ...] = HORIZONS
    tolerance: float = 1e-8
    max_evaluations: int = 60
    priors: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        h = self.horizons
        if not h or h[0] <= 0 or h[-1] != 1 or any(np.diff(h) <= 0):
            raise InputError(f"horizons {h} must grow to 1, such as {HORIZONS}")
        for name, std in self.priors.items():
            if not std > 0:
                raise InputError(f"the prior of {name} has std {std:g}; give a positive one")


@dataclass(frozen=True)
class Estimate:
    """Where a search ended.

    Attributes:
        predictor: the plant, the log and the names of the free parameters.
        space: their coordinates.
        start: starting values, shape (p,).
        q: the estimate, shape (p,).
        whitener: C of the criterion, shape (ny, ny).
        options: how it was searched.
        evaluations: how often the outputs were simulated.
        jacobians: how often their sensitivities were.
        status: `converged`, `iterations` (out of them) or `stopped` by the user.
        seconds: wall time [s].
    """

    predictor: Predictor
    space: Coordinates
    start: np.ndarray
    q: np.ndarray
    whitener: np.ndarray
    options: Options
    evaluations: int
    jacobians: int
    status: Status
    seconds: float

    @property
    def prior(self) -> np.ndarray:
        """1/std of the prior of each q, zero where there is none, shape (p,)."""
        return prior_weight(self.options, self.space.names)

    @property
    def values(self) -> dict[str, float]:
        """The estimated values by name, in their units."""
        return dict(zip(self.space.names, self.space.decode(self.q).tolist(), strict=True))


def estimate(
    plant: Plant,
    log: Log,
    names: Sequence[str],
    start: Mapping[str, float] | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
    whitener: np.ndarray | None = None,
) -> Estimate:
    """Estimate parameters of a plant from a log, free-running from its first sample.

    An interrupt (Ctrl-C) ends the search and keeps the best values so far.

    Args:
        plant: the model, with nominal values for whatever is not named.
        log: what to explain.
        names: the free parameters.
        start: starting values by name; the plant's own where not given.
        options: how to search.
        progress: is told one line per accepted step.
        whitener: C of the `trace` criterion, shape (ny, ny); I/σ, σ the noise floor, when None.

    Raises:
        InputError: a name is unknown or has no effect on the outputs, or a start is out of bounds.
        DivergenceError: the start itself cannot be simulated.
    """
    began = time.perf_counter()
    options = options or Options()
    for name in (*names, *(start or {}), *options.priors):
        plant.parameters[name]
    own = {**plant.parameters.values(), **(start or {})}
    first = np.array([own[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    sigma = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2))) or 1.0
    search = _Search(
        Predictor(plant, log, tuple(names), dict(start or {})),
        space,
        space.encode(first),
        np.eye(log.outputs.shape[1]) / sigma if whitener is None else whitener,
        options,
        progress,
    )
    search.refuse_idle()
    status = search.run()
    return Estimate(
        search.predictor, space, first, search.best, search.whitener, options,
        search.evaluations, search.jacobians, status, time.perf_counter() - began,
    )  # fmt: skip


def prior_weight(options: Options, names: Sequence[str]) -> np.ndarray:
    """1/std of the prior of each q, zero where there is none, shape (p,)."""
    return np.array([1 / options.priors.get(name, np.inf) for name in names])


class _Search:
    """One search: what `least_squares` calls, and the best point it has seen."""

    def __init__(
        self,
        predictor: Predictor,
        space: Coordinates,
        q: np.ndarray,
        whitener: np.ndarray,
        options: Options,
        progress: Progress | None,
    ) -> None:
        self.predictor, self.space, self.options, self.progress = (
            predictor,
            space,
            options,
            progress,
        )
        self.first = self.best = q
        self.whitener = whitener
        self.weight = prior_weight(options, space.names)
        self.evaluations = self.jacobians = 0

    def refuse_idle(self) -> None:
        """Refuse parameters without effect; most show theirs on the first horizon."""
        for fraction in (self.options.horizons[0], 1.0):
            J = sensitivity(self.predictor, self.space, self.best, self.samples(fraction))
            if not without_effect(J, self.predictor.log.outputs).any():
                return
        refuse_without_effect(J, self.space.names, self.predictor.log)

    def samples(self, fraction: float) -> int:
        """Samples of a horizon."""
        return max(3, round(fraction * len(self.predictor.log)))

    def run(self) -> Status:
        """All horizons, then the covariance of `det`."""
        status: Status = "converged"
        try:
            for fraction in self.options.horizons:
                status = self.solve(self.samples(fraction))
            for _ in range(8 if self.options.criterion == "det" else 0):
                before = self.best
                self.whitener = whitener_of(self.error(self.best, None))
                status = self.solve(self.samples(1.0))
                if np.abs(self.best - before).max() < 1e-6:
                    break
        except KeyboardInterrupt:
            return "stopped"
        return status

    def error(self, q: np.ndarray, samples: int | None) -> np.ndarray:
        """ε = y - ŷ, shape (samples, ny)."""
        self.evaluations += 1
        predicted = self.predictor.predict(self.space.decode(q), samples)[0]
        return self.predictor.log.outputs[:samples] - predicted

    def solve(self, samples: int) -> Status:
        """Minimise the criterion over the first samples, from the best point."""
        self.error(self.best, samples)  # a start that diverges is the caller's to know
        cost, origin = np.inf, self.best
        size = np.where(self.space.logarithmic, 1.0, np.maximum(1.0, np.abs(origin)))
        hold = HOLD[samples == len(self.predictor.log)] / size

        def residual(q: np.ndarray) -> np.ndarray:
            nonlocal cost
            try:
                weighed = self.error(q, samples) @ self.whitener.T
            except InputError:  # it diverged, or has no start: the search must go elsewhere
                weighed = np.full((samples, len(self.whitener)), np.inf)
            r = np.concatenate(
                [weighed.ravel(), (q - self.first) * self.weight, (q - origin) * hold]
            )
            if (now := float(r @ r)) < cost:
                cost, self.best = now, q.copy()
                self._tell(samples, weighed)
            return r

        def jacobian(q: np.ndarray) -> np.ndarray:
            self.jacobians += 1
            J = sensitivity(self.predictor, self.space, q, samples)
            weighed = -np.einsum("ij,njp->nip", self.whitener, J).reshape(-1, len(q))
            return np.concatenate([weighed, np.diag(self.weight), np.diag(hold)])

        bounded: dict[str, Any] = {}
        if self.options.method != "lm":
            bounded = {"bounds": (self.space.lower, self.space.upper)}
        found = least_squares(
            residual, self.best, jacobian, method=self.options.method, x_scale="jac",
            loss=self.options.loss, ftol=self.options.tolerance, xtol=self.options.tolerance,
            gtol=1e-15, max_nfev=self.options.max_evaluations, **bounded,
        )  # fmt: skip
        self.best = found.x
        return "converged" if found.status > 0 else "iterations"

    def _tell(self, samples: int, weighed: np.ndarray) -> None:
        if self.progress is not None:
            error = np.linalg.solve(self.whitener, weighed.T)
            seconds = samples * self.predictor.log.sampling_time
            rms = float(np.sqrt(np.mean(error**2)))
            self.progress(f"horizon {seconds:.2f} s: rms {rms:.4g} after {self.evaluations} runs")
