"""The columns of J: sensitivities of the outputs to the free parameters at one point.

    S_j = (ŷ(q + h e_j) - ŷ(q))/h        by simulations, or by the sensitivity equations

Few columns are simulated, which is exact. Where many are asked, or where others are borrowed from a
point nearby, they come from the sensitivity equations if these agree with a simulation along all of
them at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from identification.estimation.levenberg_marquardt import SLOPE_ERROR
from identification.kalman.linear import Linearisation
from identification.kalman.sensitivity_equations import can_solve, solve_sensitivities
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor
from identification.model.sensitivity import STEP

# Of STEP, and of an effect's probe, for differences of accelerations: large ones nearly cancel each
# other, such as those of an anchor that moves and of the cable that is longer at rest for it.
EQUATION_STEP_SHARE = 1e-2
MAX_SIMULATED_COLUMNS = 12  # with more, the sensitivity equations are worth it


def compute_columns(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    known: Mapping[str, np.ndarray], predicted: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Computes the sensitivities of the outputs to the free parameters.

    Args:
        predictor: plant, log and free parameters.
        space: coordinates of the free parameters.
        q: shape (p,).
        records: the linearisation of each record there.
        known: columns that need not be computed, by name, each (N, ny).
        predicted: ŷ, shape (N, ny).

    Returns:
        J, shape (N, ny, p).

    Raises:
        DivergenceError: a simulation left the finite numbers.
    """
    asked = np.array([name not in known for name in space.names])
    J = np.empty((*predictor.log.outputs.shape, len(q)))
    for j in np.flatnonzero(~asked):
        J[..., j] = known[space.names[j]]
    moves = np.diag(np.where(q + STEP > space.upper, -STEP, STEP))[asked]
    # Columns that are borrowed are of a point nearby: those beside them need not be exact either.
    if (len(moves) > MAX_SIMULATED_COLUMNS or known) and can_solve(predictor, records):
        short = EQUATION_STEP_SHARE * moves
        S = _solve(predictor, space, q, records, short, short.sum(axis=1))
        to = space.inside(q + STEP * _along(S, asked))
        (ahead,) = predictor.predict(space.decode(to[None]))
        if _agree(S @ (to - q)[asked], ahead - predicted):
            J[..., asked] = S
            return J
    if not len(moves):
        return J
    runs = predictor.predict(space.decode(q + moves))
    moved = (runs - predicted) / moves.sum(axis=1)[:, None, None]
    J[..., asked] = np.moveaxis(moved, 0, -1)
    return J


def _solve(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    moves: np.ndarray, size: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Solves the sensitivity equations for m moves (m, p) of q, of some sizes, (N, ny, m)."""
    there = space.decode(q + moves)
    return solve_sensitivities(predictor, records, space.decode(q), there, size)


def _along(columns: np.ndarray, asked: np.ndarray) -> np.ndarray:
    """Returns a direction of q with entries up to 1, to which all columns add alike, shape (p,)."""
    size = np.sqrt(np.mean(columns**2, axis=(0, 1)))
    signs = np.random.default_rng(0).choice([-1.0, 1.0], len(size))
    weight = np.where(size > 0, signs / np.where(size > 0, size, 1.0), 0.0)
    out = np.zeros(len(asked))
    out[asked] = weight / np.abs(weight).max(initial=1e-300)
    return out


def _agree(one: np.ndarray, other: np.ndarray) -> bool:
    """Returns whether two changes of the outputs agree to a relative error of `SLOPE_ERROR`."""
    return bool(np.linalg.norm(one - other) <= SLOPE_ERROR * np.linalg.norm(other))


def do_equations_hold(
    predictor: Predictor, space: Coordinates, q: np.ndarray, records: Sequence[Linearisation],
    J: np.ndarray,
) -> bool:  # fmt: skip
    """Returns whether the sensitivity equations agree with the columns J, with all of them at once.

    They do not where a joint hits its limit.

    Args:
        predictor: plant, log and free parameters.
        space: coordinates of the free parameters.
        q: shape (p,).
        records: the linearisation of each record there.
        J: shape (N, ny, p).
    """
    if not J.size or not can_solve(predictor, records):
        return False
    to = space.inside(q + EQUATION_STEP_SHARE * STEP * _along(J, np.ones(len(q), bool)))
    size = np.array([EQUATION_STEP_SHARE * STEP])
    solved = _solve(predictor, space, q, records, (to - q)[None], size)[..., 0]
    return _agree(solved * size, J @ (to - q))
