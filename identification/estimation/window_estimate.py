"""Estimation over windows: for a robot that a free run would lose.

    V(q) = Σ_w min over d_w of ‖r_w(q, d_w)‖²,   cov(q) = s² (SᵀS)⁺

r, d and the projected S are those of `identification.estimation.shooting`.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.estimation.identifiability import Identifiability
from identification.estimation.options import Progress
from identification.estimation.resolution import resolve_columns, round_off
from identification.estimation.shooting import Shooting, Tangent, tangent
from identification.estimation.windows import apart, first_states, windows
from identification.logs.log import Log
from identification.logs.noise import noise_floor
from identification.model.coordinates import coordinates
from identification.model.predictor import Plant, Predictor
from identification.model.rollout import State
from identification.model.sensitivity import FORWARD_STEP, refuse_without_effect

BELIEFS = 3  # the states' belief follows the values that were found with the last one
ROUGH = 1e-2  # relative gain that ends a search which another follows
FIRST_DAMPING = 1e-2  # of the squared norms of X's and S's columns
STEPS = (FORWARD_STEP, 100 * FORWARD_STEP)  # of the differences that the std rest on
LEAST_DAMPING = 1e-12
MOST_DAMPING = 1e8


@dataclass(frozen=True)
class WindowEstimate:
    """Where a search over windows ended.

    Attributes:
        values: the estimates by name.
        std: for white noise, infinite where the windows cannot say, shape (p,), in their units.
        start: starting values, shape (p,), in their units.
        at_bound: true where a value lies on a bound, shape (p,).
        found: the directions that the windows show.
        residual: y - ŷ of all windows, shape (W, L, ny), in the outputs' units.
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
    tolerance: float = 1e-6,
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
        max_evaluations: linearisations of the windows, at most.
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
    q, tangents = space.encode(first), 0
    begun = first_states(predictor, first, cut).states
    for k in range(1, BELIEFS + 1):
        believed = first_states(predictor, space.decode(q), cut)
        shooting = Shooting(predictor, space, cut, believed, C)
        d = apart(plant.model, believed.states, begun)
        enough = tolerance if k == BELIEFS else max(ROUGH, tolerance)
        end = _search(shooting, q, d, enough, max_evaluations, progress, k == 1)
        q, begun, tangents = end.q, shooting.states(end.d), tangents + end.tangents
    found = _resolved(shooting, end)
    # A belief counts as one reading for each state that it bears on.
    readings = cut.outputs.size + len(end.d) * int((shooting.first.weight > 0).sum())
    freedom = max(1, readings - end.tangent.freedom - len(first))
    scale = float(np.sqrt(np.sum(end.tangent.r**2) / freedom))
    return WindowEstimate(
        dict(zip(names, space.decode(q).tolist(), strict=True)),
        scale * found.std * space.slope(q),
        first,
        space.on_bound(q),
        found,
        shooting.error(end.tangent.r),
        begun,
        length,
        end.converged,
        tangents,
        time.perf_counter() - began,
    )


@dataclass(frozen=True)
class _End:
    """Where the search ended: q (p,), d (W, nx), their tangent, and how it got there."""

    q: np.ndarray
    d: np.ndarray
    tangent: Tangent
    converged: bool
    tangents: int


def _search(
    shooting: Shooting,
    q: np.ndarray,
    d: np.ndarray,
    tolerance: float,
    most: int,
    progress: Progress | None,
    fresh: bool,
) -> _End:
    """Levenberg-Marquardt over q and the states of all windows; steps end at the bounds.

    What has no effect is refused where the search is fresh: later, a friction that the data do not
    want may well have gone to nothing.
    """
    low, high = shooting.space.lower, shooting.space.upper
    at = tangent(shooting, q, d)
    if fresh:
        refuse_without_effect(*_felt(shooting, at))
    damping = FIRST_DAMPING
    for tangents in range(1, most + 1):
        cost = float(np.sum(at.r**2))
        if progress is not None:
            rms = float(np.sqrt(np.mean(shooting.error(at.r) ** 2)))
            progress(f"windows: rms {rms:.4g} after {tangents} linearisations")
        while True:
            dq, dd = at.step(damping)
            trial = np.clip(q + dq, low, high)
            try:
                after = float(np.sum(shooting.residual(trial, d + dd) ** 2))
            except InputError:  # it diverged, or has no start: it must go elsewhere
                after = np.inf
            if after < cost:
                break
            if damping > MOST_DAMPING or np.abs(dq).max() < tolerance:
                return _End(q, d, at, damping <= MOST_DAMPING, tangents)
            damping *= 5
        small = np.abs(trial - q).max() < tolerance or cost - after < tolerance * cost
        q, d, damping = trial, d + dd, max(damping / 10, LEAST_DAMPING)
        at = tangent(shooting, q, d)
        if small:
            return _End(q, d, at, True, tangents + 1)
    return _End(q, d, at, False, tangents + 1)


def _resolved(shooting: Shooting, end: _End) -> Identifiability:
    """What the windows show where a search ended, with the errors of their differences."""

    def at(step: float) -> tuple[np.ndarray, np.ndarray]:
        first = end.tangent if step == STEPS[0] else tangent(shooting, end.q, end.d, step)
        return first.projected, tangent(shooting, end.q, end.d, 2 * step).projected

    y = shooting.joined(np.zeros_like(shooting.cut.outputs), end.d) - end.tangent.r
    return resolve_columns(shooting.space.names, at, round_off(y), STEPS).found


def _felt(shooting: Shooting, at: Tangent) -> tuple[np.ndarray, tuple[str, ...], Log]:
    """Sensitivities of the outputs to q, states projected out, for `refuse_without_effect`."""
    outputs, p = shooting.cut.outputs, at.S.shape[2]
    J = at.projected.reshape(*at.r.shape, p)[:, : outputs[0].size]
    J = np.einsum(
        "ij,njp->nip", np.linalg.inv(shooting.whitener), J.reshape(-1, outputs.shape[2], p)
    )
    return J, shooting.space.names, shooting.predictor.log
