"""What a log can and cannot say about parameters.

    S = C ∂ŷ/∂q (n ny × p),   F = SᵀS    Fisher information for noise whitened by C
    S = U Σ Vᵀ:   a move along v_i is felt as σ_i;  its std is 1/σ_i

A direction that is not felt at all leaves a product of powers of the parameters that can be known:
along v = (+1, -2)/√5 in (ln R_s, ln k_s) that is k_s R_s², and only it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

# Sensitivities are right to 1e-8 (central differences); a direction below 1e-6 of the strongest
# is one that they cannot tell from nothing.
BLIND = 1e-6


@dataclass(frozen=True)
class Identifiability:
    """The directions of a parameter space, and how much of each a log shows.

    Attributes:
        names: parameters, p of them.
        strengths: singular values of S, strongest first, shape (p,).
        directions: right singular vectors, one a row, shape (p, p).
        norms: of the columns of S, shape (p,): effect of each parameter alone, in noise units.
    """

    names: tuple[str, ...]
    strengths: np.ndarray
    directions: np.ndarray
    norms: np.ndarray

    @property
    def blind(self) -> np.ndarray:
        """Directions that the outputs do not feel, shape (k, p)."""
        return self.directions[self.strengths < BLIND * self.strengths[0]]

    @property
    def rank(self) -> int:
        """How many directions the outputs feel."""
        return len(self.names) - len(self.blind)

    @property
    def std(self) -> np.ndarray:
        """Cramér-Rao std of each q, infinite where a blind direction moves it, shape (p,)."""
        felt = self.strengths >= BLIND * self.strengths[0]
        variance = ((self.directions[felt] / self.strengths[felt, None]) ** 2).sum(axis=0)
        return np.where(self.undetermined, np.inf, np.sqrt(variance))

    @property
    def undetermined(self) -> np.ndarray:
        """Which parameters a blind direction moves, shape (p,)."""
        return np.abs(self.blind).max(axis=0, initial=0.0) > 1e-3

    def weakest(self) -> str:
        """The worst determined direction, as `R_s +0.45, k_s -0.89`."""
        return in_words(self.directions[-1], self.names)


def identifiability(S: np.ndarray, names: Sequence[str]) -> Identifiability:
    """Analyse whitened sensitivities, shape (n, p) with n rows of samples and outputs."""
    _, strengths, directions = np.linalg.svd(S, full_matrices=False)
    return Identifiability(tuple(names), strengths, directions, np.linalg.norm(S, axis=0))


def in_words(direction: np.ndarray, names: Sequence[str], least: float = 0.1) -> str:
    """A direction by its largest entries: `R_s +0.45, k_s -0.89`."""
    order = np.argsort(-np.abs(direction))
    return ", ".join(f"{names[i]} {direction[i]:+.2f}" for i in order if abs(direction[i]) > least)


@dataclass(frozen=True)
class Combination:
    """A product of powers of parameters that can be known although they cannot.

    Attributes:
        exponents: by name.
    """

    exponents: dict[str, Fraction]

    def __str__(self) -> str:
        return " ".join(
            name if power == 1 else f"{name}^{power}" for name, power in self.exponents.items()
        )

    def value(self, values: dict[str, float]) -> float:
        """Its value, in the product of the units."""
        return float(
            np.prod([values[name] ** float(power) for name, power in self.exponents.items()])
        )


def known_combinations(
    found: Identifiability, logarithmic: np.ndarray
) -> list[Combination]:  # fmt: skip
    """Products that survive the blind directions, with small whole exponents.

    Only blind directions among logarithmic coordinates are products; each set of parameters moved
    together yields as many products as it has parameters beyond its blind directions.
    """
    involved = np.flatnonzero(found.undetermined)
    if not involved.size or not logarithmic[involved].all():
        return []
    kept = _reduced(_null_space(found.blind[:, involved]))
    combinations = []
    for row in kept:
        least = np.abs(row[np.abs(row) > 1e-3]).min()
        powers = [Fraction(float(x / least)).limit_denominator(4) for x in row]
        names = [found.names[i] for i in involved]
        exponents = {n: p for n, p in zip(names, powers, strict=True) if p}
        first = min(exponents, key=lambda n: abs(exponents[n]))
        sign = 1 if exponents[first] > 0 else -1
        combinations.append(Combination({n: sign * p for n, p in sorted(
            exponents.items(), key=lambda item: abs(item[1]))}))  # fmt: skip
    return combinations


def _null_space(rows: np.ndarray) -> np.ndarray:
    _, s, vt = np.linalg.svd(rows)
    return vt[int((s > 1e-6).sum()) :]


def _reduced(rows: np.ndarray) -> np.ndarray:
    """Row echelon form, so that each product holds as few parameters as it can."""
    rows = rows.copy()
    lead = 0
    for column in range(rows.shape[1]):
        if lead == len(rows):
            break
        pivot = lead + int(np.abs(rows[lead:, column]).argmax())
        if abs(rows[pivot, column]) < 1e-6:
            continue
        rows[[lead, pivot]] = rows[[pivot, lead]]
        rows[lead] /= rows[lead, column]
        others = np.arange(len(rows)) != lead
        rows[others] -= np.outer(rows[others, column], rows[lead])
        lead += 1
    return rows
