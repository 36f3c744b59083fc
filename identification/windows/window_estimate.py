"""Estimation over windows: for a robot that a free run would lose.

    V(q) = Σ_w min over d_w of ‖r_w(q, d_w)‖²,   cov(q) = s² (SᵀS)⁺

r, d and the projected S are those of `identification.windows.shooting`. The parameters q and the
initial states of all windows share one step and one damping.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from identification.errors import InputError
from identification.estimation.identifiability import Identifiability
from identification.estimation.levenberg_marquardt import (
    Cost,
    Criterion,
    Damping,
    levenberg_marquardt,
)
from identification.estimation.priors import free_parameters
from identification.estimation.resolution import LONG_STEP_RATIO, resolve_columns, round_off
from identification.estimation.search import ROUGH_TOLERANCE
from identification.logs.log import Log
from identification.model.predictor import Plant
from identification.model.rollout import State
from identification.model.sensitivity import FORWARD_STEP, refuse_without_effect
from identification.runtime.pool import one_blas_thread
from identification.runtime.progress import Progress, stage
from identification.windows.shooting import Shooting, Tangent, tangent
from identification.windows.windows import apart, first_states, noise_whitener, windows

# Relative to the squared norms of the columns of X and S.
DAMPING = Damping(first=1e-2, raised=5.0, least=1e-12)
MAX_SEARCH_DAMPING = 1e8  # beyond it no step is long enough to matter, and the search has ended
BELIEF_ROUNDS = 3  # the states' belief follows the values that were found with the last one
STD_STEPS = (FORWARD_STEP, LONG_STEP_RATIO * FORWARD_STEP)


@dataclass(frozen=True, kw_only=True)
class WindowEstimate:
    """The result of a search over windows.

    Attributes:
        values: the estimates by name.
        std: for white noise, infinite where the windows cannot say and NaN where a bound holds the
            value, shape (p,), in their units.
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
        """Rms of the residual over all windows and outputs."""
        return float(np.sqrt(np.mean(self.residual**2)))


@one_blas_thread()
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
    predictor, space, first = free_parameters(plant, log, names, start or {})
    C = noise_whitener(log)
    q, tangents = space.encode(first), 0
    begun = first_states(predictor, first, cut).states
    for k in range(1, BELIEF_ROUNDS + 1):
        believed = first_states(predictor, space.decode(q), cut)
        shooting = Shooting(predictor, space, cut, believed, C)
        d = apart(plant.model, believed.states, begun)
        enough = tolerance if k == BELIEF_ROUNDS else max(ROUGH_TOLERANCE, tolerance)
        at = _windows_at(shooting, q, d)
        if k == 1:  # later, a friction that the data do not want may well have gone to nothing
            refuse_without_effect(*_felt(at))
        at, converged, taken = _search(at, enough, max_evaluations, progress)
        tangents += taken
        q, begun = at.q, shooting.states(at.d)
    found = _resolved(at)
    # A belief counts as one reading for each state that it bears on.
    readings = cut.outputs.size + len(at.d) * int((shooting.first.weight > 0).sum())
    freedom = max(1, readings - at.tangent.freedom - len(first))
    scale = float(np.sqrt(np.sum(at.tangent.r**2) / freedom))
    at_bound = space.on_bound(q)
    std = np.where(at_bound & np.isfinite(found.std), np.nan, scale * found.std * space.slope(q))
    return WindowEstimate(
        values=dict(zip(names, space.decode(q).tolist(), strict=True)),
        std=std,
        start=first,
        at_bound=at_bound,
        found=found,
        residual=shooting.error(at.tangent.r),
        states=begun,
        length=length,
        converged=converged,
        tangents=tangents,
        seconds=time.perf_counter() - began,
    )


@dataclass(frozen=True)
class WindowsAtPoint(Criterion[tuple[np.ndarray, np.ndarray]]):
    """The criterion of the parameters and the initial states, linearised at a point."""

    shooting: Shooting  # the windows
    q: np.ndarray  # the parameters, shape (p,)
    d: np.ndarray  # changes of the initial states, shape (W, nx)
    tangent: Tangent  # the linearisation of the windows at q and d

    @property
    def cost(self) -> float:
        """The sum of squares of all windows."""
        return float(np.sum(self.tangent.r**2))

    def step(self, μ: Cost) -> tuple[np.ndarray, np.ndarray]:
        """Returns the step Δq (p,), which `after` clips to the bounds, and Δd (W, nx)."""
        return self.tangent.step(float(μ))

    def after(self, step: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """Returns q, clipped to its bounds, and d after a step."""
        space = self.shooting.space
        return np.clip(self.q + step[0], space.lower, space.upper), self.d + step[1]

    def cost_after(self, step: tuple[np.ndarray, np.ndarray]) -> float:
        """Returns the sum of squares after a step; infinite where it cannot be simulated."""
        try:
            return float(np.sum(self.shooting.residual(*self.after(step)) ** 2))
        except InputError:  # the simulation diverged, or the robot has no such start
            return np.inf

    def moved(self, step: tuple[np.ndarray, np.ndarray], taken: np.ndarray) -> WindowsAtPoint:
        """Returns the criterion after a step."""
        return _windows_at(self.shooting, *self.after(step))


def _windows_at(shooting: Shooting, q: np.ndarray, d: np.ndarray) -> WindowsAtPoint:
    """Returns all windows, linearised at q (p,) and d (W, nx)."""
    return WindowsAtPoint(shooting, q, d, tangent(shooting, q, d))


def _search(
    at: WindowsAtPoint, tolerance: float, most: int, progress: Progress | None
) -> tuple[WindowsAtPoint, bool, int]:
    """Fits q and the initial states of all windows, with at most `most` linearisations more.

    Returns:
        The criterion at the last point, whether the search ended by itself rather than out of
        linearisations or of damping, and the number of linearisations.
    """
    tangents = 1
    trials = levenberg_marquardt(at, DAMPING)
    with stage("steps of a fit") as advance:
        _tell(at, tangents, progress)
        while True:
            trial = next(trials)
            if not trial.taken:
                is_stuck = bool(trial.μ > MAX_SEARCH_DAMPING)
                if is_stuck or np.abs(trial.step[0]).max() < tolerance:
                    return at, not is_stuck, tangents
                continue
            before, at, tangents = at, trial.criterion, tangents + 1
            advance()
            gain = trial.before - trial.after
            small = np.abs(at.q - before.q).max() < tolerance or gain < tolerance * trial.before
            if small or tangents > most:
                return at, bool(small), tangents
            _tell(at, tangents, progress)


def _tell(at: WindowsAtPoint, tangents: int, progress: Progress | None) -> None:
    if progress is not None:
        rms = float(np.sqrt(np.mean(at.shooting.error(at.tangent.r) ** 2)))
        progress(f"windows: rms {rms:.4g} after {tangents} linearisations")


def _resolved(at: WindowsAtPoint) -> Identifiability:
    """Returns what the windows show where a search ended, with the errors of their differences."""
    shooting, q, d = at.shooting, at.q, at.d

    def at_two_steps(step: float) -> tuple[np.ndarray, np.ndarray]:
        once = at.tangent if step == STD_STEPS[0] else tangent(shooting, q, d, step)
        twice = tangent(shooting, q, d, 2 * step)
        S, S_twice = (t.projected[0].reshape(-1, len(q)) for t in (once, twice))
        return S, S_twice

    y = shooting.joined(np.zeros_like(shooting.cut.outputs), d) - at.tangent.r
    return resolve_columns(shooting.space.names, at_two_steps, round_off(y), STD_STEPS).found


def _felt(at: WindowsAtPoint) -> tuple[np.ndarray, tuple[str, ...], Log]:
    """Returns sensitivities of outputs to q, states projected out, for `refuse_without_effect`."""
    shooting, tangent = at.shooting, at.tangent
    outputs, p = shooting.cut.outputs, tangent.S.shape[2]
    J = tangent.projected[0].reshape(*tangent.r.shape, p)[:, : outputs[0].size]
    J = np.einsum(
        "ij,njp->nip", np.linalg.inv(shooting.whitener), J.reshape(-1, outputs.shape[2], p)
    )
    return J, shooting.space.names, shooting.predictor.log
