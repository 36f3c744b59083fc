"""Scaling symmetries, found in sensitivities and proven by simulations.

    θ_j → θ_j c^v_j for all c        a scaling symmetry v: the outputs stay as they are

The numbers v are small fractions. So they are rounded from sensitivities that are only roughly
known, and then proven by simulations: a move of 10 % to each side along v must change all outputs
together by less than one std of the noise. Along a symmetry a long step is as good as a short one.
So the roughness of a simulation, which spoils short differences, does not matter here (scaling
symmetries: Yates, Evans and Chappell 2009).
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.estimation.combination import ScalingSymmetry
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor

SYMMETRY_MOVE = 0.1  # of q: the move to each side that proves a symmetry
MAX_DENOMINATOR = 4  # of the powers, the largest being 1
# Norm of a change of all outputs in units of the noise, from which it can be seen.
VISIBLE_CHANGE = 1.0

# whitens (samples, ny, k) into k columns, shape (n, k), so that the noise has the std 1
Whiten = Callable[[np.ndarray], np.ndarray]


def scaling_symmetries(
    predictor: Predictor,
    space: Coordinates,
    q: np.ndarray,
    whiten: Whiten,
    S: np.ndarray,
    errors: np.ndarray,
) -> tuple[ScalingSymmetry, ...]:
    """Returns the scaling symmetries that whitened sensitivities suggest and simulations prove.

    Args:
        predictor: predicts the outputs.
        space: coordinates of the parameters.
        q: the point, shape (p,).
        whiten: makes the noise of the outputs white, of std 1.
        S: sensitivities, shape (n, p).
        errors: norms of the errors of their columns, shape (p,).
    """
    proven: list[np.ndarray] = []
    found = []
    for v in _candidates(S, errors, space.logarithmic):
        size = np.array(v, float)
        if np.linalg.matrix_rank(np.array([*proven, size])) <= len(proven):
            continue  # it follows from symmetries that are proven already
        if _unseen(predictor, space, q, whiten, size):
            proven.append(size)
            powers = {name: power for name, power in zip(space.names, v, strict=True) if power}
            found.append(ScalingSymmetry(powers))
    return tuple(found)


def _unseen(
    predictor: Predictor, space: Coordinates, q: np.ndarray, whiten: Whiten, v: np.ndarray
) -> bool:
    """Returns whether a long move along v changes the outputs by less than the noise."""
    try:
        move = SYMMETRY_MOVE * v
        ahead, behind = predictor.predict(space.decode(np.stack([q + move, q - move])))
    except (DivergenceError, InputError):  # no start or no simulation is possible there
        return False
    return bool(np.linalg.norm(whiten((ahead - behind)[:, :, None])) < VISIBLE_CHANGE)


def _candidates(
    S: np.ndarray, errors: np.ndarray, logarithmic: np.ndarray
) -> list[tuple[Fraction, ...]]:
    """Returns directions of small fractions along which S is zero within errors, shortest first."""
    root = np.linalg.qr(S).R
    rows = [_parallel(root, errors, logarithmic, int(j)) for j in np.flatnonzero(logarithmic)]
    rounded = {_rounded(row) for row in rows if row is not None}
    possible = [
        v for v in rounded
        if np.linalg.norm(root @ np.array(v, float)) <= np.abs(np.array(v, float)) @ errors
    ]  # fmt: skip
    return sorted(possible, key=lambda v: (sum(x != 0 for x in v), v))


def _parallel(
    root: np.ndarray, errors: np.ndarray, logarithmic: np.ndarray, j: int
) -> np.ndarray | None:
    """Returns a combination of a few columns that is column j within the errors, found greedily.

    This is orthogonal matching pursuit (Pati, Rezaiifar and Krishnaprasad 1993).
    """
    chosen: list[int] = []
    free = [int(k) for k in np.flatnonzero(logarithmic) if k != j]
    size = np.linalg.norm(root, axis=0)
    while True:
        share = np.linalg.lstsq(root[:, chosen], root[:, j], rcond=None)[0]
        left = root[:, j] - root[:, chosen] @ share
        if chosen and np.linalg.norm(left) <= errors[j] + np.abs(share) @ errors[chosen]:
            break
        along = {k: abs(root[:, k] @ left) / size[k] for k in free if size[k] > 0}
        if not along:
            return None
        chosen.append(max(along, key=lambda k: along[k]))
        free.remove(chosen[-1])
    v = np.zeros(len(errors))
    v[j], v[chosen] = 1.0, -share
    return v


def _rounded(v: np.ndarray) -> tuple[Fraction, ...]:
    """Returns the nearest small fractions, the largest being 1 and the first positive."""
    v = v / np.abs(v).max()
    powers = [Fraction(float(x)).limit_denominator(MAX_DENOMINATOR) for x in v]
    first = next(x for x in powers if x)
    return tuple(x if first > 0 else -x for x in powers)
