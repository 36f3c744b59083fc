"""Combinations of parameters that can be known where the parameters themselves cannot.

    θ_j → θ_j c^v_j for all c        a scaling symmetry v: the outputs stay as they are
    Π θ_j^w_j,  Σ_j w_j v_j = 0       products that no symmetry changes: these can be known

For example, R_s → c R_s, k_s → c⁻² k_s leaves k_s R_s² unchanged.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np


@dataclass(frozen=True)
class ScalingSymmetry:
    """Parameters that can be scaled together.

    Attributes:
        powers: v by name; parameters that are not named have 0.
    """

    powers: dict[str, Fraction]

    def row(self, names: Sequence[str]) -> np.ndarray:
        """Returns v as a direction of q, of norm 1, shape (p,)."""
        v = np.array([float(self.powers.get(name, 0)) for name in names])
        return v / np.linalg.norm(v)


@dataclass(frozen=True)
class Combination:
    """A product of powers of parameters that can be known although the parameters cannot.

    Attributes:
        exponents: the powers, by name.
    """

    exponents: dict[str, Fraction]

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
