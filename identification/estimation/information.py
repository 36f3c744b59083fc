"""What an experiment says about parameters: Fisher information and its criteria.

    F = SᵀS,   S = ∂ŷ/∂q / σ  (n ny × p)                        white noise of std σ on each output
    cov(q̂) ≥ F⁻¹                                                  Cramér-Rao, all of q unknown
    S_a ← (I - S_n S_n⁺) S_a                                    nuisances S_n unknown, not asked for
    E = λ_min(F),   D = ln det F,   A = tr F⁻¹                  of the parameters that are asked for

q = ln(value) for a positive parameter, so its std is relative. E is the information on the worst
determined direction: F of an experiment is the sum of its parts', and none of them can lower E.
Source: Ljung, System Identification (1999), 7.4 and 13.2; Swevers et al. (1997) for robots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import InputError, unknown_name
from identification.estimation.identifiability import (
    BLIND,
    Combination,
    Identifiability,
    identifiability,
    known_combinations,
)


@dataclass(frozen=True)
class Information:
    """What an experiment says about p parameters.

    Attributes:
        names: the parameters that are asked for, then the nuisances.
        asked: how many are asked for.
        logarithmic: true where q = ln(value), shape (p,).
        root: upper triangular, rootᵀ root = F of all, shape (p, p), in the coordinates q.
    """

    names: tuple[str, ...]
    asked: int
    logarithmic: np.ndarray
    root: np.ndarray

    @property
    def found(self) -> Identifiability:
        """Directions of the parameters asked for, the nuisances being unknown too."""
        return identifiability(_without(self.root, self.asked), self.names[: self.asked])

    @property
    def fisher(self) -> np.ndarray:
        """F of the parameters asked for, the nuisances being unknown, shape (asked, asked)."""
        S = _without(self.root, self.asked)
        return S.T @ S

    @property
    def std(self) -> np.ndarray:
        """Least std of q with all others unknown, shape (asked,): relative where logarithmic."""
        return self.found.std

    @property
    def conditional(self) -> np.ndarray:
        """Least std of q were all others known, shape (asked,)."""
        with np.errstate(divide="ignore"):
            return 1 / np.linalg.norm(self.root[:, : self.asked], axis=0)

    @property
    def ranking(self) -> tuple[str, ...]:
        """Parameters, best determined first."""
        return tuple(self.names[i] for i in np.argsort(self.std, kind="stable"))

    @property
    def combinations(self) -> list[Combination]:
        """Products that can be known where their factors cannot."""
        return known_combinations(self.found, self.logarithmic[: self.asked])

    @property
    def condition(self) -> float:
        """Strongest over weakest direction; infinite where one is blind."""
        strengths = self.found.strengths
        return float(strengths[0] / strengths[-1]) if not len(self.found.blind) else np.inf

    @property
    def e_value(self) -> float:
        """Smallest eigenvalue of F: 1/variance of the worst direction; 0 where one is blind."""
        return 0.0 if len(self.found.blind) else float(self.found.strengths[-1] ** 2)

    @property
    def d_value(self) -> float:
        """ln det F, -inf where a direction is blind."""
        return -np.inf if len(self.found.blind) else float(2 * np.log(self.found.strengths).sum())

    @property
    def a_value(self) -> float:
        """Sum of the variances, infinite where a direction is blind."""
        return float((self.std**2).sum())

    def with_data(self, other: Information) -> Information:
        """Of both experiments together.

        Raises:
            InputError: the other is about other parameters.
        """
        if other.names != self.names or other.asked != self.asked:
            raise InputError("two experiments add up when both are about the same parameters")
        return replace(self, root=root_of(np.vstack([self.root, other.root])))

    def about(self, names: Sequence[str]) -> Information:
        """Of some of the parameters asked for, the rest being known; nuisances stay.

        Raises:
            InputError: a name was not asked for.
        """
        known = self.names[: self.asked]
        for name in names:
            if name not in known:
                raise unknown_name("parameter", name, known)
        kept = [*map(known.index, names), *range(self.asked, len(self.names))]
        root = root_of(self.root[:, kept])
        return Information(
            tuple(self.names[i] for i in kept), len(names), self.logarithmic[kept], root
        )


def determinable(found: Information) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Parameters that can be told apart, and those to hold fixed so that they can.

    Of each blind direction the parameter that moves most along it is held.
    """
    kept = list(found.names[: found.asked])
    held = []
    while len(blind := found.about(kept).found.blind):
        held.append(kept.pop(int(np.abs(blind[0]).argmax())))
        if not kept:
            break
    return tuple(kept), tuple(held)


def root_of(S: np.ndarray) -> np.ndarray:
    """Upper triangular with rootᵀ root = SᵀS, shape (p, p)."""
    return np.asarray(np.linalg.qr(S).R)


def _without(root: np.ndarray, asked: int) -> np.ndarray:
    """Sensitivities to what is asked for that no move of the nuisances can imitate."""
    wanted, nuisance = root[:, :asked], root[:, asked:]
    if not nuisance.shape[1]:
        return wanted
    U, s, _ = np.linalg.svd(nuisance / np.linalg.norm(nuisance, axis=0), full_matrices=False)
    U = U[:, s > BLIND * s[0]]
    return wanted - U @ (U.T @ wanted)
