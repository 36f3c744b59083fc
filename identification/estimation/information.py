"""The information of an experiment on parameters: the Fisher information and its criteria.

    F = SᵀS,   S = ∂ŷ/∂q / σ  (n ny × p)                        white noise of std σ on each output
    cov(q̂) ≥ F⁻¹                                                  Cramér-Rao, all of q unknown
    S_a ← (I - S_n S_n⁺) S_a                                    nuisances S_n unknown, not asked for
    E = λ_min(F),   D = ln det F,   A = tr F⁻¹                  of the parameters that are asked for

For a positive parameter q = ln(value), so that its std is relative. E is the information on the
worst determined direction.
Source: Ljung, System Identification (1999), 7.4 and 13.2; Swevers et al. (1997) for robots.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification.errors import unknown_name
from identification.estimation.identifiability import (
    Identifiability,
    column_errors,
    identifiability,
    unresolved_directions,
)
from identification.estimation.resolution import Resolved
from identification.estimation.scaling_symmetry import Combination, ScalingSymmetry
from identification.model.coordinates import Coordinates


@dataclass(frozen=True, kw_only=True)
class Information:
    """The information of an experiment on p parameters."""

    names: tuple[str, ...]  # the parameters of interest, then the nuisances
    asked: int  # how many parameters are of interest
    logarithmic: np.ndarray  # true where q = ln(value), shape (p,)
    root: np.ndarray  # upper triangular, rootᵀ root = F of all, shape (p, p), in the coordinates q
    # errors of S, in rows of which the first p are those of `root`, shape (2 p, p), in the
    # coordinates q
    error: np.ndarray
    least: float  # norm of the round-off error of a column of S
    # the ways in which parameters can be scaled together while no output changes
    symmetries: tuple[ScalingSymmetry, ...] = ()

    @property
    def found(self) -> Identifiability:
        """Directions of the parameters of interest, where the nuisances are unknown too."""
        S, E = self._without_nuisances
        names = self.names[: self.asked]
        return identifiability(S, names, E, self.least, _among(self.symmetries, names))

    @property
    def std(self) -> np.ndarray:
        """Least std of q if all others are unknown, shape (asked,): relative where logarithmic."""
        return self.found.std

    @property
    def conditional(self) -> np.ndarray:
        """Least std of q if all others are known, shape (asked,)."""
        with np.errstate(divide="ignore"):
            return 1 / np.linalg.norm(self.root[:, : self.asked], axis=0)

    @property
    def ranking(self) -> tuple[str, ...]:
        """Parameters, best determined first."""
        return tuple(self.names[i] for i in np.argsort(self.std, kind="stable"))

    @property
    def combinations(self) -> list[Combination]:
        """Products that can be known where their factors cannot."""
        found = self.found
        return [c for c in found.combinations if not found.moved(c.row(found.names)[None])[0]]

    @property
    def condition(self) -> float:
        """Strength of the strongest direction over the weakest; infinite where one is blind."""
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

    def about(self, names: Sequence[str]) -> Information:
        """Returns the information on some of the parameters of interest when the others are known.

        The nuisances stay unknown.

        Raises:
            InputError: a name was not asked for.
        """
        known = self.names[: self.asked]
        for name in names:
            if name not in known:
                raise unknown_name("parameter", name, known)
        kept = [*map(known.index, names), *range(self.asked, len(self.names))]
        every = tuple(self.names[i] for i in kept)
        root, error = _compressed(self._rows[:, kept], self.error[:, kept])
        return replace(
            self,
            names=every,
            asked=len(names),
            logarithmic=self.logarithmic[kept],
            root=root,
            error=error,
            symmetries=_among(self.symmetries, every),
        )

    @property
    def _rows(self) -> np.ndarray:
        """S in the rows of `error`, shape (2 p, p)."""
        return np.vstack([self.root, np.zeros_like(self.root)])

    @property
    def _without_nuisances(self) -> tuple[np.ndarray, np.ndarray]:
        """Sensitivities to the parameters of interest that no change of the nuisances can imitate.

        Returns:
            The sensitivities S_a - S_n S_n⁺ S_a and, to first order, their errors
            E_a - E_n S_n⁺ S_a, each of shape (2 p, asked). Directions of the nuisances that are
            not felt imitate nothing and are left out of S_n⁺.
        """
        S, E, a = self._rows, self.error, self.asked
        wanted, nuisance = S[:, :a], S[:, a:]
        if not nuisance.shape[1]:
            return wanted, E
        size = np.linalg.norm(nuisance, axis=0)
        U, s, Vt = np.linalg.svd(nuisance / size, full_matrices=False)
        unfelt = unresolved_directions(nuisance, column_errors(E[:, a:], self.least))
        felt = len(s) - len(unfelt)
        U, s, Vt = U[:, :felt], s[:felt], Vt[:felt]
        along = U.T @ wanted
        return wanted - U @ along, E[:, :a] - E[:, a:] @ ((Vt.T / s) @ along / size[:, None])


def information_of(resolved: Resolved, space: Coordinates, asked: int | None = None) -> Information:
    """Returns the information of whitened sensitivities on all or the first `asked` parameters."""
    root, error = _compressed(resolved.S, resolved.E)
    return Information(
        names=space.names,
        asked=len(space.names) if asked is None else asked,
        logarithmic=space.logarithmic,
        root=root,
        error=error,
        least=resolved.least,
        symmetries=resolved.symmetries,
    )


def determinable(found: Information) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Returns parameters that can be determined, and those that must be held fixed for this.

    For each blind direction, the parameter that moves most along it is held fixed.
    """
    kept = list(found.names[: found.asked])
    held = []
    while len(blind := found.about(kept).found.blind):
        held.append(kept.pop(int(np.abs(blind[0]).argmax())))
        if not kept:
            break
    return tuple(kept), tuple(held)


def _compressed(S: np.ndarray, E: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns S and E (n, p) in fewer rows: R of S = Q R, and [QᵀE; R of the rest of E]."""
    Q, root = np.linalg.qr(S)
    along = Q.T @ E
    return root, np.vstack([along, np.linalg.qr(E - Q @ along).R])


def _among(
    symmetries: tuple[ScalingSymmetry, ...], names: Sequence[str]
) -> tuple[ScalingSymmetry, ...]:
    """Returns the symmetries that change no other parameters than the named ones."""
    return tuple(s for s in symmetries if s.powers.keys() <= set(names))
