"""Identifiability: what a log can and cannot say about parameters.

    S = C ∂ŷ/∂q (n ny × p),   F = SᵀS    Fisher information for noise whitened by C
    S = U Σ Vᵀ:   a move along v_i is felt as σ_i;  its std is 1/σ_i

S is computed by finite differences, so only S + E is known, where E is the error of the
differences. What the differences cannot resolve does not count as information. Let D = diag(d),
where d_j is the norm of column j of an estimate of E. Then

    |σ_i((S + E) D⁻¹) - σ_i(S D⁻¹)| ≤ ‖E D⁻¹‖₂ ≤ ‖E D⁻¹‖_F = √p                 (Weyl 1912)

A direction counts as felt only if its singular value exceeds √p when each column is divided by its
error. All columns then have equal errors, so that the count does not depend on units (Stewart 1984,
Rank degeneracy). The other directions span the blind directions. A blind direction b is itself
uncertain: to first order its error is -S_f⁺ E b, where S_f = U_f Σ_f V_fᵀ is the part of S that is
felt. A parameter, or a product of parameters with powers w, counts as moved by b only if it moves
by more than this error:

    |wᵀb| > std(w) ‖U_fᵀ E b‖,    std(w)² = Σ_felt (wᵀv_i)²/σ_i²
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from identification.estimation.scaling_symmetry import (
    Combination,
    ScalingSymmetry,
    known_products,
)

ENTRY_ROUNDING = 1e-3  # an entry of a direction of norm 1 that is smaller than this is round-off


@dataclass(frozen=True, kw_only=True)
class Identifiability:
    """The directions of a parameter space, and how strongly the outputs of a log feel each."""

    names: tuple[str, ...]  # parameters, p of them
    # ‖S v‖ of each direction v, shape (p,). The directions that are felt come first, then the
    # others; in both groups the strongest is first.
    strengths: np.ndarray
    # orthogonal, of norm 1, one in each row, shape (p, p). First those that are felt, then those
    # whose effect cannot be told from the error of the differences, then the proven symmetries.
    directions: np.ndarray
    rank: int  # how many directions the outputs feel
    # norms of the columns of S, shape (p,): the effect of each parameter alone, in units of the
    # noise
    norms: np.ndarray
    errors: np.ndarray  # d, the norms of the errors of the columns of S, shape (p,)
    leaks: np.ndarray  # ‖U_fᵀ E b‖ of each blind direction b, shape (p - rank,); 0 for a symmetry
    # the ways in which parameters can be scaled together while no output changes
    symmetries: tuple[ScalingSymmetry, ...] = ()

    @property
    def blind(self) -> np.ndarray:
        """Directions that the outputs do not feel, shape (k, p)."""
        return self.directions[self.rank :]

    @property
    def unresolved(self) -> np.ndarray:
        """Blind directions that are no proven symmetry: the differences cannot resolve them."""
        return self.directions[self.rank : len(self.names) - len(self.symmetries)]

    @property
    def std(self) -> np.ndarray:
        """Cramér-Rao std of each q, infinite where a blind direction moves it, shape (p,)."""
        return np.where(self.undetermined, np.inf, self._std(np.eye(len(self.names))))

    @property
    def undetermined(self) -> np.ndarray:
        """True for each parameter that a blind direction moves, shape (p,)."""
        return self.moved(np.eye(len(self.names)))

    @property
    def moved_by_unresolved(self) -> np.ndarray:
        """True for each parameter that a direction that is no symmetry moves, shape (p,)."""
        moves = self._moves(np.eye(len(self.names)))[:, : len(self.unresolved)]
        return np.asarray(moves.any(axis=1))

    def moved(self, powers: np.ndarray) -> np.ndarray:
        """Returns which products of powers of parameters (m, p) a blind direction moves, (m,)."""
        return np.asarray(self._moves(powers).any(axis=1))

    def _moves(self, powers: np.ndarray) -> np.ndarray:
        """Returns whether each blind direction moves each product of powers (m, p): (m, blind)."""
        least = ENTRY_ROUNDING * np.linalg.norm(powers, axis=1)[:, None]
        off = self._std(powers)[:, None] * self.leaks
        return np.abs(powers @ self.blind.T) > np.maximum(least, off)

    def _std(self, powers: np.ndarray) -> np.ndarray:
        """Returns the Cramér-Rao std of powersᵀq along the directions that are felt, shape (m,)."""
        felt = self.directions[: self.rank] / self.strengths[: self.rank, None]
        return np.sqrt(((powers @ felt.T) ** 2).sum(axis=1))

    @property
    def combinations(self) -> list[Combination]:
        """Products of parameters that no symmetry changes, although it changes their factors."""
        return known_products(self.symmetries, self.names)

    def weakest(self) -> str:
        """Returns the worst determined direction, as `R_s +0.45, k_s -0.89`."""
        return in_words(self.directions[-1], self.names)


def identifiability(
    S: np.ndarray,
    names: Sequence[str],
    E: np.ndarray,
    least: float,
    symmetries: tuple[ScalingSymmetry, ...] = (),
) -> Identifiability:
    """Analyse whitened sensitivities.

    Args:
        S: sensitivities, shape (n, p), a row for each reading; zero along the symmetries.
        names: the parameters.
        E: estimated errors of S, shape (n, p).
        least: norm of the round-off error of a column.
        symmetries: the proven symmetries.
    """
    S, E, p = _tall(S), _tall(E), S.shape[1]
    errors = column_errors(E, least)
    U, strengths, directions = np.linalg.svd(S, full_matrices=False)
    still = _basis(np.array([s.row(names) for s in symmetries]).reshape(-1, p))
    blind = unresolved_directions(S, errors)
    rank = p - len(blind)
    if len(blind):
        rest = _basis(blind - blind @ still.T @ still)[: len(blind) - len(still)]
        rest = np.linalg.svd(S @ rest.T, full_matrices=False)[2] @ rest  # strongest first
        blind = np.vstack([rest, still])
        U, strengths, directions = np.linalg.svd(S - S @ blind.T @ blind, full_matrices=False)
        strengths = np.concatenate([strengths[:rank], np.linalg.norm(S @ blind.T, axis=0)])
        directions = np.vstack([directions[:rank], blind])
    leaks = np.linalg.norm(U[:, :rank].T @ E @ blind.T, axis=0)
    leaks[len(leaks) - len(still) :] = 0.0
    return Identifiability(
        names=tuple(names),
        strengths=strengths,
        directions=directions,
        rank=rank,
        norms=np.linalg.norm(S, axis=0),
        errors=errors,
        leaks=leaks,
        symmetries=symmetries,
    )


def column_errors(E: np.ndarray, least: float) -> np.ndarray:
    """Returns d: norms of the columns of E (n, p), each at least that of round-off, shape (p,)."""
    return np.maximum(np.linalg.norm(E, axis=0), least)


def unresolved_directions(S: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Returns orthonormal directions whose effect is within the errors of S (n, p): (k, p)."""
    _, strengths, directions = np.linalg.svd(_tall(S) / errors, full_matrices=False)
    return _basis(directions[strengths <= np.sqrt(len(errors))] / errors)


def _tall(S: np.ndarray) -> np.ndarray:
    """Returns S with at least as many rows as columns; rows that are added are zero."""
    return np.vstack([S, np.zeros((max(0, S.shape[1] - len(S)), S.shape[1]))])


def _basis(rows: np.ndarray) -> np.ndarray:
    """Returns orthonormal rows that span the same space, the strongest first, shape like `rows`."""
    size = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.linalg.svd(rows / np.where(size > 0, size, 1.0), full_matrices=False)[2]


def in_words(direction: np.ndarray, names: Sequence[str], least: float = 0.1) -> str:
    """Returns a direction as text, by its largest entries: `R_s +0.45, k_s -0.89`."""
    order = np.argsort(-np.abs(direction))
    return ", ".join(f"{names[i]} {direction[i]:+z.2f}" for i in order if abs(direction[i]) > least)
