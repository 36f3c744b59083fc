"""Prediction-error estimation by a horizon that grows.

    V(q) = Σ_k ‖C ε_k‖² + Σ_j ((q_j - q̄_j)/s_j)²,    ε_k = y_k - ŷ_k(q)            (thesis 3.2)

There are two criteria. `trace`: C = I/σ, where σ is the noise over all outputs of one unit. `det`:
CᵀC = Λ⁻¹, where Λ is the covariance of the residual. Λ is estimated again from each fit until it no
longer changes; this is maximum likelihood for Gaussian noise of unknown covariance.

Over several seconds, the free run of a stiff robot depends on its parameters in a very nonlinear
way; over a quarter of a second it is nearly linear. So the fit begins on a short horizon and
lengthens it, and each fit starts from the result of the one before. A single fit over the whole log
ends in a local minimum, as the thesis' fit did.

A short horizon may say nothing about some parameter, and no output may feel some direction. Neither
noise nor round-off may then move the parameters. So each q is pulled weakly towards its result on
the horizon before: one unit of q (a factor e, or 1 m) costs as much as one std of the noise, and on
the last horizon a tenth of that. Any information in the log outweighs this.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError, refuse_kind
from identification.estimation.metrics import by_unit, of_outputs
from identification.estimation.priors import Priors, free_parameters
from identification.estimation.search import Options as Options
from identification.estimation.search import Search, Status
from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.model.coordinates import Coordinates
from identification.model.predictor import Plant, Predictor
from identification.runtime.pool import one_blas_thread
from identification.runtime.progress import Progress


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """The end of a search: the estimate, and how it was found."""

    predictor: Predictor  # the plant, the log and the names of the free parameters
    space: Coordinates  # their coordinates
    start: np.ndarray  # starting values, shape (p,), in their units
    q: np.ndarray  # the estimate, shape (p,), in the coordinates of `space`
    whitener: np.ndarray  # C of the criterion, shape (ny, ny), in one over the outputs' units
    # weight of each residual where the noise is relative, shape (n, ny); ones where it is not
    weight: np.ndarray
    options: Options  # the options of the search
    evaluations: int  # how often the outputs were simulated
    jacobians: int  # how often the sensitivities were computed
    # `converged`, `iterations` (the largest number was reached), or `stopped` by the user
    status: Status
    seconds: float  # wall time [s]

    @property
    def priors(self) -> Priors:
        """Returns what was known of the parameters before the search."""
        return Priors.of(self.space, self.space.encode(self.start), self.options.priors)

    @property
    def values(self) -> dict[str, float]:
        """The estimated values by name, in their units."""
        return dict(zip(self.space.names, self.space.decode(self.q).tolist(), strict=True))

    def about(self, asked: int) -> Estimate:
        """Returns the estimate of the first parameters, the others fixed at their estimates."""
        p, every, keep = self.predictor, self.values, np.arange(asked)
        names = self.space.names[:asked]
        held = {n: v for n, v in every.items() if n not in names}
        known = replace(p, names=names, fixed={**p.fixed, **held})
        space = Priors(self.space, self.q, np.zeros_like(self.q)).taken(keep).space
        priors = {n: std for n, std in self.options.priors.items() if n in names}
        return replace(
            self, predictor=known, space=space, start=self.start[keep], q=self.q[keep],
            options=replace(self.options, priors=priors),
        )  # fmt: skip


@one_blas_thread()
def estimate(
    plant: Plant,
    log: Log,
    names: Sequence[str],
    start: Mapping[str, float] | None = None,
    options: Options | None = None,
    progress: Progress | None = None,
    whitener: np.ndarray | None = None,
) -> Estimate:
    """Estimate parameters of a plant from the free run of a log, from its first sample.

    An interrupt (Ctrl-C) ends the search and keeps the best values so far.

    Args:
        plant: the model; parameters that are not named keep its values.
        log: the log that is fitted.
        names: the free parameters.
        start: starting values by name; the plant's own where not given.
        options: how to search.
        progress: is told one line per accepted step.
        whitener: C of the `trace` criterion, shape (ny, ny), in one over the outputs' units; when
            None it is I/σ, where σ is the noise floor over all outputs of an output's unit.

    Raises:
        InputError: a name is unknown or has no effect on the outputs, or a start is out of bounds.
        DivergenceError: the start itself cannot be simulated.
    """
    refuse_kind(log, Log, "estimate takes a Log (read_log)")
    if isinstance(names, str) or not hasattr(plant, "parameters"):
        raise InputError(
            "estimate takes a plant (joint_plant, ModelPlant), a Log and a list of names of its"
            " parameters, in this order"
        )
    began = time.perf_counter()
    options = options or Options()
    for name in options.priors:
        plant.parameters[name]
    predictor, space, first = free_parameters(plant, log, names, start or {})
    sigma = of_outputs(by_unit(noise_floor(log.outputs), log), log)
    sigma = np.where(sigma > 0, sigma, 1.0)
    search = Search(
        predictor,
        space,
        space.encode(first),
        np.eye(log.outputs.shape[1]) / sigma if whitener is None else whitener,
        options,
        progress,
    )
    search.refuse_idle()
    status = search.run()
    return Estimate(
        predictor=predictor,
        space=space,
        start=first,
        q=search.best,
        whitener=search.whitener,
        weight=search.weight,
        options=options,
        evaluations=search.evaluations,
        jacobians=search.jacobians,
        status=status,
        seconds=time.perf_counter() - began,
    )
