"""One search for the least criterion, by horizons that grow, without a simulation too many.

the outputs at a point are simulated once, for the residual and for its sensitivities
sensitivities are forward differences from them
a horizon that a longer one follows ends at a relative gain of `ROUGH`, the last at `tolerance`
no sensitivities are taken at a point where the search ends
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import least_squares

from identification.errors import DivergenceError, InputError
from identification.estimation.options import Options, Progress, Status, prior_weight
from identification.logs.noise import relative_weight, whitener_of
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import (
    forward_sensitivity,
    refuse_without_effect,
    sensitivity,
    without_effect,
)

ROUGH = 1e-2  # relative gain that ends a horizon which a longer one follows
HOLD = (1.0, 0.1)  # noise std per unit of q, on a short horizon and on the whole log
CLOSER = 0.1  # relative growth of a horizon below which a divergence is final
EXACT = 1e-11  # residual over outputs at which nothing but round-off is left


class _Settled(Exception):
    """The next sensitivities would be the last, and not be used."""


class Search:
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
        self.weight = relative_weight(predictor.log.outputs, options.relative_noise)
        self.prior = prior_weight(options, space.names)
        self.evaluations = self.jacobians = 0
        self._last = np.full_like(q, np.nan), np.empty((0, 0))  # a point and its ŷ

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
        """All horizons, then the weights of relative noise and the covariance of `det`."""
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
        """All horizons; one that diverges from where the last ended is reached in smaller steps.

        Raises:
            DivergenceError: the first horizon diverges, or one no longer than a tenth more.
        """
        status: Status = "converged"
        reached, ahead = 0.0, list(self.options.horizons)
        while ahead:
            rough = self.options.tolerance if ahead[0] == 1 else ROUGH
            try:
                status = self.solve(self.samples(ahead[0]), max(rough, self.options.tolerance))
            except DivergenceError:
                if reached == 0 or ahead[0] < (1 + CLOSER) * reached:
                    raise
                ahead.insert(0, (reached + ahead[0]) / 2)
            else:
                reached = ahead.pop(0)
        return status

    def error(self, q: np.ndarray, samples: int | None) -> np.ndarray:
        """ε = y - ŷ, shape (samples, ny)."""
        return self.predictor.log.outputs[:samples] - self.predicted(q, samples)

    def predicted(self, q: np.ndarray, samples: int | None) -> np.ndarray:
        """ŷ, shape (samples, ny); the last one is kept, for the Jacobian at the same point."""
        samples = samples or len(self.predictor.log)
        at, known = self._last
        if len(known) != samples or not np.array_equal(at, q):
            self.evaluations += 1
            known = self.predictor.predict(self.space.decode(q), samples)[0]
            self._last = q.copy(), known
        return known

    def solve(self, samples: int, tolerance: float) -> Status:
        """Minimise the criterion over the first samples, from the best point.

        `least_squares` asks for sensitivities where it ends, the dearest of a short search; a step
        that gained too little to go on ends it before them.
        """
        self.error(self.best, samples)  # a start that diverges is the caller's to know
        weight = self.weight[:samples]
        measured = (weight * self.predictor.log.outputs[:samples]) @ self.whitener.T
        exact = EXACT**2 * float(np.sum(measured**2))
        linear = self.options.loss == "linear"
        cost = gain = np.inf
        origin = self.best
        size = np.where(self.space.logarithmic, 1.0, np.maximum(1.0, np.abs(origin)))
        hold = HOLD[samples == len(self.predictor.log)] / size

        def residual(q: np.ndarray) -> np.ndarray:
            nonlocal cost, gain
            try:
                weighed = (weight * self.error(q, samples)) @ self.whitener.T
            except InputError:  # it diverged, or has no start: the search must go elsewhere
                weighed = np.full((samples, len(self.whitener)), np.inf)
            r = np.concatenate(
                [weighed.ravel(), (q - self.first) * self.prior, (q - origin) * hold]
            )
            if (now := float(r @ r)) < cost:
                gain, cost, self.best = cost - now, now, q.copy()
                self._tell(samples, weighed)
            return r

        def jacobian(q: np.ndarray) -> np.ndarray:
            if linear and (gain <= tolerance * cost or cost <= exact):
                raise _Settled
            self.jacobians += 1
            J = forward_sensitivity(self.predictor, self.space, q, self.predicted(q, samples))
            J = weight[:, :, None] * J
            weighed = -np.einsum("ij,njp->nip", self.whitener, J).reshape(-1, len(q))
            return np.concatenate([weighed, np.diag(self.prior), np.diag(hold)])

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
        if self.progress is not None:
            error = np.linalg.solve(self.whitener, weighed.T).T / self.weight[:samples]
            seconds = samples * self.predictor.log.sampling_time
            rms = float(np.sqrt(np.mean(error**2)))
            self.progress(f"horizon {seconds:.2f} s: rms {rms:.4g} after {self.evaluations} runs")
