"""Estimation over windows: for a robot that a free run would lose.

    V(q) = Σ_w min over d_w of ‖r_w(q, d_w)‖²,   cov(q) = s² (SᵀS)⁺

r, d and the projected S are those of `identification.shooting`.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from identification.coordinates import coordinates
from identification.errors import InputError
from identification.identifiability import Identifiability, identifiability
from identification.log import Log
from identification.noise import noise_floor
from identification.options import Progress
from identification.predictor import Plant, Predictor
from identification.rollout import State
from identification.sensitivity import refuse_without_effect
from identification.shooting import Shooting, settle, tangent
from identification.windows import first_states, windows


@dataclass(frozen=True)
class WindowEstimate:
    """Where a search over windows ended.

    Attributes:
        values: the estimates by name.
        std: for white noise, infinite where the windows cannot say, shape (p,).
        start: starting values, shape (p,).
        at_bound: which values lie on a bound, shape (p,).
        found: the directions that the windows show.
        residual: y - ŷ of all windows, shape (W, L, ny).
        states: where each window began, W rows.
        length: of a window [s].
        converged: whether the search ended by itself.
        tangents: how often all windows were linearised.
        seconds: wall time [s].
    """

    values: dict[str, float]
    std: np.ndarray
    start: np.ndarray
    at_bound: np.ndarray
    found: Identifiability
    residual: np.ndarray
    states: State
    length: float
    converged: bool
    tangents: int
    seconds: float

    @property
    def rms(self) -> float:
        """Of the residual over all windows and outputs."""
        return float(np.sqrt(np.mean(self.residual**2)))


def estimate_windows(
    plant: Plant,
    log: Log,
    names: Sequence[str],
    length: float,
    start: Mapping[str, float] | None = None,
    tolerance: float = 1e-8,
    max_evaluations: int = 40,
    progress: Progress | None = None,
) -> WindowEstimate:
    """Estimate parameters over windows, the state at the start of each being free.

    Args:
        plant: the model.
        log: what to explain.
        names: the free parameters; an initial condition has no place among them.
        length: of a window [s].
        start: starting values by name; the plant's own where not given.
        tolerance: relative change of cost and of q at which the search stops.
        max_evaluations: of the windows.
        progress: is told one line per linearisation.

    Raises:
        InputError: a name is unknown or has no effect, or the windows do not fit the log.
        DivergenceError: the start itself cannot be simulated.
    """
    began = time.perf_counter()
    cut = windows(log, length)
    for name in (*names, *(start or {})):
        plant.parameters[name]
    own = {**plant.parameters.values(), **(start or {})}
    first = np.array([own[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    predictor = Predictor(plant, log, tuple(names), dict(start or {}))
    sigma = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2))) or 1.0
    C = np.eye(log.outputs.shape[1]) / sigma
    shooting = Shooting(predictor, space, cut, first_states(predictor, first, cut), C)
    search = _Search(shooting, space.encode(first), progress)
    J = search.tangent.projected.reshape(len(cut.starts), -1, len(first))[:, : cut.outputs[0].size]
    refuse_without_effect(J.reshape(-1, C.shape[0], len(first)) * sigma, space.names, log)
    end = least_squares(
        search.residual, space.encode(first), search.jacobian, bounds=(space.lower, space.upper),
        x_scale="jac", ftol=tolerance, xtol=tolerance, gtol=1e-15, max_nfev=max_evaluations,
    )  # fmt: skip
    search.jacobian(end.x)
    d, r = settle(shooting, search.tangent, end.x)
    S = search.tangent.projected
    found = identifiability(S, space.names)
    # A belief counts as one reading for each state that it bears on.
    readings = cut.outputs.size + len(d) * int((shooting.first.weight > 0).sum())
    freedom = max(1, readings - search.tangent.freedom - len(first))
    scale = float(np.sqrt(np.sum(r**2) / freedom))
    return WindowEstimate(
        dict(zip(names, space.decode(end.x).tolist(), strict=True)),
        scale * found.std * space.slope(end.x),
        first,
        space.on_bound(end.x),
        found,
        shooting.error(r),
        shooting.states(d),
        length,
        end.status > 0,
        search.tangents,
        time.perf_counter() - began,
    )


class _Search:
    """What `least_squares` calls: the states follow q by the tangent of the last accepted point."""

    def __init__(self, shooting: Shooting, q: np.ndarray, progress: Progress | None) -> None:
        self.shooting, self.progress = shooting, progress
        W, nx = len(shooting.cut.starts), len(shooting.first.weight)
        self.tangents = 0
        self._linearise(q, np.zeros((W, nx)))
        self._last = q, *settle(shooting, self.tangent, q)

    def _linearise(self, q: np.ndarray, d: np.ndarray) -> None:
        self.tangent = tangent(self.shooting, q, d)
        self.tangents += 1
        if self.progress is not None:
            rms = float(np.sqrt(np.mean(self.shooting.error(self.tangent.r) ** 2)))
            self.progress(f"windows: rms {rms:.4g} after {self.tangents} linearisations")

    def residual(self, q: np.ndarray) -> np.ndarray:
        if not np.array_equal(self._last[0], q):
            try:
                self._last = q, *settle(self.shooting, self.tangent, q)
            except InputError:  # it diverged: the search must go elsewhere
                return np.full(self.tangent.r.size, np.inf)
        return self._last[2].ravel()

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        self.residual(q)  # least_squares may have tried another point since it accepted this one
        if not np.array_equal(self.tangent.q, q) or not np.array_equal(
            self.tangent.d, self._last[1]
        ):
            self._linearise(q, self._last[1])
        return -self.tangent.projected
