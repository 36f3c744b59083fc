"""The wrenches that cables can exert within tension limits, over many poses at once.

With T = W⁺ w + N λ (N: basis of the null space, rows n_i in the plane), w is feasible if some λ
satisfies 16 linear inequalities. In the plane they have a common solution exactly if every
three of them have one (Helly). For cables i < j < k the combination that removes λ is

    y_i = n_j × n_k,   y_j = n_k × n_i,   y_k = n_i × n_j,   all other y = 0,   |y| = 1,

and with h(y) = Σ max(y low, y high), the largest yᵀ T within the limits, w is feasible exactly if

    yᵀ W⁺ w ≤ h(y)   for all 56 y and their negatives.

These are the facets of the zonotope of all wrenches (Bouchard, Gosselin, Moore 2010, On the ability
of a cable-driven robot to generate a prescribed set of wrenches). All wrenches of a set are
feasible exactly if the support of the set, the largest yᵀ W⁺ w over it, obeys the inequality. The
set here is the load, plus any force up to f, plus any torque up to τ:

    support(y) = cᵀ w₀ + f |c_force| + τ |c_torque|,   c = W⁺ᵀ y
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from identification.errors import InputError
from inca_mj.robot.geometry import DRIVES

TRIPLES = np.array(list(combinations(range(DRIVES), 3)))
AT_ONCE = 1000  # poses whose arrays stay in the processor's cache
LEAST = 1e-12  # a combination of less is that of parallel rows, and says nothing


@dataclass(frozen=True)
class Wrenches:
    """A set of wrenches that the cables shall exert: a load, and what may come in any direction.

    Attributes:
        load: wrench in the middle of the set, in O, shape (6,) [N, N m].
        force: largest additional force, in any direction [N].
        torque: largest additional torque, about any axis [N m].

    Raises:
        InputError: a number is not finite, or a size is negative.
    """

    load: np.ndarray
    force: float = 0.0
    torque: float = 0.0

    def __post_init__(self) -> None:
        if np.shape(self.load) != (6,) or not np.isfinite(self.load).all():
            raise InputError(f"a load is six finite numbers [N, N m], not {self.load}")
        for name, unit in (("force", "N"), ("torque", "N m")):
            if not 0 <= getattr(self, name) < np.inf:
                raise InputError(
                    f"{name} {getattr(self, name):g} {unit} is no size; give zero or more"
                )


def wrench_margin(
    plus: np.ndarray, N: np.ndarray, full: np.ndarray, low: np.ndarray, high: np.ndarray,
    wanted: Wrenches,
) -> np.ndarray:  # fmt: skip
    """Returns how far the worst wrench of a set is inside what cables can exert [N], shape (N,).

    Positive: all wrenches of the set are feasible; the number is a tension, because |y| = 1.
    Negative: some wrench of the set is not. −∞ where the rank is below 6.

    Args:
        plus: pseudo-inverses of the wrench matrices, shape (N, 8, 6) [-, 1/m].
        N: bases of their null spaces, shape (N, 8, 2), without unit.
        full: whether the rank is 6, shape (N,) of bool.
        low: smallest tensions, shape (8,) or (N, 8) [N].
        high: largest tensions, shape (8,) or (N, 8) [N].
        wanted: the wrenches.
    """
    low, high = (np.broadcast_to(limit, (len(N), DRIVES)) for limit in (low, high))
    margin = np.full(len(N), -np.inf)
    possible = np.flatnonzero(full & (low <= high).all(axis=1))
    for part in np.array_split(possible, len(possible) // AT_ONCE + 1):
        margin[part] = _margin(plus[part], N[part], low[part], high[part], wanted)
    return margin


def _margin(
    plus: np.ndarray, N: np.ndarray, low: np.ndarray, high: np.ndarray, wanted: Wrenches
) -> np.ndarray:
    i, j, k = TRIPLES.T
    y = np.stack([_across(N, j, k), _across(N, k, i), _across(N, i, j)])  # (3, N, 56)
    size = np.sqrt((y * y).sum(axis=0))
    y = np.divide(y, size, where=size > LEAST, out=np.zeros_like(y))
    T = plus @ wanted.load
    middle = sum(part * T[:, at] for part, at in zip(y, (i, j, k), strict=True))
    reach = np.zeros_like(size)
    for extent, axes in ((wanted.force, slice(0, 3)), (wanted.torque, slice(3, 6))):
        if extent:
            c = sum(
                part[..., None] * plus[:, at, axes] for part, at in zip(y, (i, j, k), strict=True)
            )
            reach += extent * np.linalg.norm(c, axis=2)
    ends = [(part * low[:, at], part * high[:, at]) for part, at in zip(y, (i, j, k), strict=True)]
    above = sum(np.maximum(a, b) for a, b in ends) - middle - reach
    below = middle - sum(np.minimum(a, b) for a, b in ends) - reach
    return np.where(size > LEAST, np.minimum(above, below), np.inf).min(axis=1)


def _across(N: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns n_a × n_b of pairs of rows, shape (N, 56)."""
    return N[:, a, 0] * N[:, b, 1] - N[:, a, 1] * N[:, b, 0]
