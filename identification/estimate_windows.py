"""Estimation over windows: for a robot that a free run would lose.

V(q) = Σ_w min over x_w of ‖ε_w(q, x_w)‖²,   cov(q) = s² (SᵀS)⁺,   S projected (see `windows`)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from identification.coordinates import coordinates
from identification.errors import InputError
from identification.identifiability import Identifiability, identifiability
from identification.log import Log
from identification.noise import noise_floor
from identification.predictor import Plant, Predictor
from identification.rollout import State
from identification.sensitivity import refuse_without_effect
from identification.windows import Windowed, first_states, windowed_residual, windows


@dataclass(frozen=True)
class WindowEstimate:
    """Where a search over windows ended.

    Attributes:
        values: the estimates by name.
        std: for white noise, infinite where the windows cannot say, shape (p,).
        found: the directions that the windows show.
        residual: y - ŷ of all windows, shape (W, L, ny).
        states: where each window began, W rows.
        converged: whether the search ended by itself.
    """

    values: dict[str, float]
    std: np.ndarray
    found: Identifiability
    residual: np.ndarray
    states: State
    converged: bool

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

    Raises:
        InputError: a name is unknown or has no effect, or the windows do not fit the log.
        DivergenceError: the start itself cannot be simulated.
    """
    cut = windows(log, length)
    for name in (*names, *(start or {})):
        plant.parameters[name]
    own = {**plant.parameters.values(), **(start or {})}
    first = np.array([own[name] for name in names])
    space = coordinates(plant.parameters, names, first)
    predictor = Predictor(plant, log, tuple(names), dict(start or {}))
    sigma = float(np.sqrt(np.mean(noise_floor(log.outputs) ** 2))) or 1.0
    C = np.eye(log.outputs.shape[1]) / sigma
    begin = windowed_residual(
        predictor, space, space.encode(first), cut, first_states(predictor, first, cut), C
    )
    refuse_without_effect(begin.J.reshape(-1, *begin.J.shape[2:]) * sigma, space.names, log)
    seen: dict[bytes, Windowed] = {}
    states = begin.states

    def at(q: np.ndarray) -> Windowed:
        nonlocal states
        if q.tobytes() not in seen:
            seen.clear()
            seen[q.tobytes()] = windowed_residual(predictor, space, q, cut, states, C)
        return seen[q.tobytes()]

    def residual(q: np.ndarray) -> np.ndarray:
        try:
            return at(q).residual.ravel()
        except InputError:  # it diverged: the search must go elsewhere
            return np.full(begin.residual.size, np.inf)

    def jacobian(q: np.ndarray) -> np.ndarray:
        nonlocal states
        states = at(q).states  # of an accepted step
        return at(q).J.reshape(-1, len(q))

    search = least_squares(
        residual, space.encode(first), jacobian, bounds=(space.lower, space.upper), x_scale="jac",
        ftol=tolerance, xtol=tolerance, gtol=1e-15, max_nfev=max_evaluations,
    )  # fmt: skip
    end = at(search.x)
    found = identifiability(end.J.reshape(-1, len(first)), space.names)
    freedom = max(1, end.residual.size - end.freedom - len(first))
    scale = float(np.sqrt(np.sum(end.residual**2) / freedom))
    values = dict(zip(names, space.decode(search.x).tolist(), strict=True))
    return WindowEstimate(
        values, scale * found.std * space.slope(search.x), found, end.residual * sigma,
        end.states, search.status > 0,
    )  # fmt: skip
