"""Models of a robot that its logs leave, and what a further experiment would tell of them.

    F = Σ_w S_wᵀ(I - P_w) S_w,   P = F_logs + W²               information of windows, and before
    std = √diag (P + F)⁻¹                                       expected after the experiment
    λ_ij = min over x of ‖(ŷ_i - ŷ_j) - S_j x‖² + xᵀ P_j x     what j cannot imitate, i is right

The windows, the sensitivities S (with the windows' initial states projected out) and the priors W
are those of a fit (`identification.windows`). Along a free run there is one window. The errors are
taken as white, as large as those of the fit. λ/2 is the expected logarithm of the odds of i against
j, by linearisation: an experiment with the largest λ is T-optimal (Atkinson, Fedorov 1975).
Values that each record has for itself are unknown in the experiment too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np

from identification.discovery.nominal_model import NominalModel, without_starts
from identification.effects.plant.jointed import JointPlant
from identification.logs.log import Log
from identification.model.coordinates import Coordinates
from identification.prediction.fits.nominal_fit import fit_alone
from identification.runtime.progress import Progress
from identification.windows.fit import WindowFit, solve
from identification.windows.problem import Problem, no_moves, problem, with_scale
from identification.windows.records import Record


@dataclass(frozen=True)
class Hypothesis:
    """A model, fitted to the logs."""

    name: str  # in words
    share: float  # probability that it is right, before the experiment
    fit: WindowFit  # of the logs
    horizon: float  # of the windows [s]
    scale: np.ndarray  # s: rms error of each output in the fit, shape (ny,), in its unit

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free values that all records share, p of them."""
        return self.fit.problem.unknowns.shared.names

    @property
    def space(self) -> Coordinates:
        """Their coordinates."""
        return self.fit.problem.unknowns.shared.space

    @cached_property
    def known(self) -> np.ndarray:
        """P: precision of the shared values before the experiment, shape (p, p)."""
        return _without(self.fit.curvature, len(self.names))

    @property
    def plant(self) -> JointPlant:
        """The plant at the fitted values."""
        part = self.fit.problem.parts[0]
        plant = cast(JointPlant, part.predictor.plant)  # of a robot of a file
        plain = replace(plant, steps=min(1, plant.steps), slope_steps=1)
        return plain.with_values({**part.predictor.fixed, **self.values})

    @property
    def values(self) -> dict[str, float]:
        """The fitted values that all records share, and means of those that each has for itself."""
        space, q = self.fit.problem.unknowns.local.space, self._q
        return dict(zip(space.names, space.decode(q).tolist(), strict=True))

    @property
    def _q(self) -> np.ndarray:
        unknowns, p = self.fit.problem.unknowns, len(self.names)
        own = self.fit.q[p:].reshape(len(unknowns.records), -1).mean(axis=0)
        return np.concatenate([self.fit.q[:p], own])

    def std(self, precision: np.ndarray) -> np.ndarray:
        """Returns the std of the shared values for a precision (p, p), in their units, (p,)."""
        covariance = np.linalg.pinv(precision, rcond=1e-14, hermitian=True)
        slope = np.abs(self.space.slope(self.fit.q[: len(self.names)]))
        return np.asarray(np.sqrt(np.maximum(np.diag(covariance), 0.0)) * slope)

    def task(self, log: Log, plant: JointPlant) -> Problem:
        """Returns the windows of an experiment, whose log has its inputs and expected outputs.

        The plant is at the fitted values, with the start of the experiment.
        """
        unknowns = self.fit.problem.unknowns
        length = min(self.horizon, log.duration)
        fixed = {**self.fit.problem.parts[0].predictor.fixed, **self.values}
        return problem(plant, [Record(log, "fit", log.values)], unknowns.shared, unknowns.own,
                       length, fixed, self.scale)  # fmt: skip

    def seen(self, log: Log, plant: JointPlant) -> Seen:
        """Returns the hypothesis linearised along an experiment; see `task`.

        Raises:
            DivergenceError: it cannot be simulated there.
        """
        task = self.task(log, plant)
        (t,) = task.tangents(self._q, no_moves(task))
        U = t.U * (t.s > 0)[:, None]
        return Seen(self, task.parts[0].cut.outputs[0].size, t.r, t.projected[0], U)


@dataclass(frozen=True)
class Seen:
    """A hypothesis along an experiment."""

    of: Hypothesis
    readings: int  # in a window
    r: np.ndarray  # expected outputs less its own, over s; then the prior of states, (W, m)
    S: np.ndarray  # without what states make up for, shape (W, m, p + own)
    U: np.ndarray  # what states make up for, orthonormal columns, shape (W, m, nx)

    @property
    def information(self) -> np.ndarray:
        """F of the shared values and the record's own ones, with the prior of these."""
        own, p = self.of.fit.problem.unknowns.own.weight, len(self.of.names)
        F = np.einsum("wmp,wmq->pq", self.S, self.S)
        F[p:, p:] += np.diag(own**2)
        return F

    @property
    def precision(self) -> np.ndarray:
        """Precision of the shared values after the experiment, shape (p, p)."""
        return self.of.known + _without(self.information, len(self.of.names))

    def against(self, right: Seen) -> float:
        """Returns λ: what this hypothesis cannot imitate where another one is right."""
        r = np.zeros_like(self.r)
        n = self.readings
        r[:, :n] = self.r[:, :n] - right.r[:, :n]
        r -= np.einsum("wmk,wk->wm", self.U, np.einsum("wmk,wm->wk", self.U, r))
        g, H, p = np.einsum("wmp,wm->p", self.S, r), self.information, len(self.of.names)
        H[:p, :p] += self.of.known
        size = 1 / np.sqrt(np.maximum(np.diag(H), 1e-300))
        x = np.linalg.lstsq(H * np.outer(size, size), g * size, rcond=1e-14)[0]
        return max(0.0, float(np.sum(r**2) - (g * size) @ x))


def separations(seen: Sequence[Seen]) -> np.ndarray:
    """Returns λ, shape (n, n): row i is right, column j imitates it; infinite on the diagonal."""
    out = np.full((len(seen), len(seen)), np.inf)
    for i, right in enumerate(seen):
        for j, wrong in enumerate(seen):
            if i != j:
                out[i, j] = wrong.against(right)
    return out


def shares_after(shares: Sequence[float], λ: np.ndarray) -> np.ndarray:
    """Returns the expected probability of each hypothesis where it is the right one, shape (n,)."""
    p = np.asarray(shares, float)
    others = np.exp(-0.5 * λ) * p[None, :] / p[:, None]
    return np.asarray(1 / (1 + np.where(np.eye(len(p), dtype=bool), 0.0, others).sum(axis=1)))


def fitted(
    name: str, share: float, model: NominalModel, logs: Sequence[Log],
    scale: np.ndarray | None = None, progress: Progress | None = None,
) -> Hypothesis:  # fmt: skip
    """Returns a model, fitted to logs, with a name and the probability that it is right.

    Its errors count against the scale s of another hypothesis, or else its own.

    Raises:
        InputError: windows do not fit the logs, or a free value has no effect.
        DivergenceError: its start cannot be simulated.
    """
    base = without_starts(model)
    horizon = base.horizon or min(log.duration for log in logs)
    base = replace(base, horizon=horizon)
    found, own = fit_alone(base, [Record(log, "fit", log.values) for log in logs], progress)
    if scale is None:
        return Hypothesis(name, share, found, horizon, own)
    found = solve(with_scale(found.problem, scale), found.q, found.moves)
    return Hypothesis(name, share, found, horizon, scale)


def _without(F: np.ndarray, p: int) -> np.ndarray:
    """Returns the precision of the first p values where the others are unknown, shape (p, p)."""
    if F.shape[0] == p:
        return F
    rest = np.linalg.pinv(F[p:, p:], rcond=1e-14, hermitian=True)
    return np.asarray(F[:p, :p] - F[:p, p:] @ rest @ F[p:, :p])
