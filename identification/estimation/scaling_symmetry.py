"""Scaling symmetries, found in sensitivities and proven by simulations.

    θ_j → θ_j c^v_j for all c        a scaling symmetry v: the outputs stay as they are

The numbers v are small fractions. So they are rounded from sensitivities that are only roughly
known, and then proven by simulations: a move of 10 % to each side along v must change all outputs
together by less than one std of the noise. Along a symmetry a long step is as good as a short one.
So the roughness of a simulation, which spoils short differences, does not matter here (scaling
symmetries: Yates, Evans and Chappell 2009).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from identification.errors import DivergenceError, InputError
from identification.model.coordinates import Coordinates
from identification.model.predictor import Predictor

SYMMETRY_MOVE = 0.1  # of q: the move to each side that proves a symmetry
MAX_DENOMINATOR = 4  # of the powers, the largest being 1
# Norm of a change of all outputs in units of the noise, from which it can be seen.
VISIBLE_CHANGE = 1.0
# whitens (samples, ny, k) into k columns, shape (n, k), so that the noise has the std 1
Whiten = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class ScalingSymmetry:
    """Parameters that can be scaled together."""

    powers: dict[str, Fraction]  # v by name; parameters that are not named have 0

    def row(self, names: Sequence[str]) -> np.ndarray:
        """Returns v as a direction of q, of norm 1, shape (p,)."""
        v = np.array([float(self.powers.get(name, 0)) for name in names])
        return v / np.linalg.norm(v)


@dataclass(frozen=True)
class Combination:
    """A product of powers of parameters that can be known although the parameters cannot."""

    exponents: dict[str, Fraction]  # the powers, by name

    def __str__(self) -> str:
        return " ".join(
            name if power == 1 else f"{name}^{power}" for name, power in self.exponents.items()
        )

    def value(self, values: dict[str, float]) -> float:
        """Returns the value of the product, in the product of the units."""
        return float(
            np.prod([values[name] ** float(power) for name, power in self.exponents.items()])
        )

    def row(self, names: Sequence[str]) -> np.ndarray:
        """Returns the exponents, shape (p,)."""
        return np.array([float(self.exponents.get(name, 0)) for name in names])


def known_products(
    symmetries: Sequence[ScalingSymmetry], names: Sequence[str]
) -> list[Combination]:
    """Returns products that no symmetry changes, of the parameters that symmetries change.

    A set of k parameters that m symmetries change together gives k - m products.
    """
    moved = [name for name in names if any(name in s.powers for s in symmetries)]
    rows, held = _reduced([[s.powers.get(n, Fraction(0)) for n in moved] for s in symmetries])
    products = []
    for free in (j for j in range(len(moved)) if j not in held):
        powers = {moved[free]: Fraction(1)}
        for row, pivot in zip(rows, held, strict=True):
            powers[moved[pivot]] = -row[free]
        powers = {name: powers[name] for name in moved if powers.get(name)}
        products.append(_whole(powers))
    return products


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


def _whole(powers: dict[str, Fraction]) -> Combination:
    """Returns the product scaled so that its smallest power is 1, in the order of the powers."""
    least = min(powers.values(), key=abs)
    return Combination({n: x / least for n, x in sorted(
        powers.items(), key=lambda item: abs(item[1]))})  # fmt: skip


def _reduced(rows: list[list[Fraction]]) -> tuple[list[list[Fraction]], list[int]]:
    """Returns the echelon form reduced from the last column on, and each row's leading column."""
    rows, held = [list(row) for row in rows], list[int]()
    for column in reversed(range(len(rows[0]) if rows else 0)):
        lead = len(held)
        pivot = next((i for i in range(lead, len(rows)) if rows[i][column]), None)
        if pivot is None:
            continue
        rows[lead], rows[pivot] = rows[pivot], rows[lead]
        rows[lead] = [x / rows[lead][column] for x in rows[lead]]
        for i, row in enumerate(rows):
            if i != lead:
                rows[i] = [x - row[column] * y for x, y in zip(row, rows[lead], strict=True)]
        held.append(column)
    return rows[: len(held)], held


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
        rest = root[:, j] - root[:, chosen] @ share
        if chosen and np.linalg.norm(rest) <= errors[j] + np.abs(share) @ errors[chosen]:
            break
        along = {k: abs(root[:, k] @ rest) / size[k] for k in free if size[k] > 0}
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
