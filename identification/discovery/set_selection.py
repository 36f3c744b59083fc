"""A set of effects that explain a residual together, of which none may explain much alone.

    e ≈ Σ_{j in A} S_j η_j                              A: some of the candidates
    η̂_-f = (Σ_{b not in f} G_b)⁻¹ Σ_{b not in f} a_b    G_b = S_bᵀS_b, a_b = S_bᵀe_b, of the set
    gain_f = 2 a_fᵀη̂_-f - η̂_-fᵀ G_f η̂_-f                of blocks f that η̂_-f was not fitted to

A grows by the candidate with which the gain is the largest, and each member then gives way to any
other candidate that gains more beside the rest, until none does (floating selection; Pudil,
Novovičová, Kittler 1994). A member must gain more than its scatter over the folds (Stone 1974). A
size must have the sign that physics gives it, beside the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FOLDS = 10  # of neighbouring blocks
MAX_EXCHANGES = 3  # sweeps over the members of a set


@dataclass(frozen=True)
class Columns:
    """What blocks of samples tell of the sizes of all candidates.

    Attributes:
        G: SᵀS of each of F folds of blocks, shape (F, k, k).
        a: Sᵀe, shape (F, k).
        of: the columns of each candidate.
        signs: that its sizes must have, 0 for either, shape (k,).
        largest: that a size may be, shape (k,).
    """

    G: np.ndarray
    a: np.ndarray
    of: Sequence[np.ndarray]
    signs: np.ndarray
    largest: np.ndarray

    def gains(self, members: Sequence[int]) -> np.ndarray:
        """Returns gain_f of a set, shape (F,); all of them -∞ where physics forbids a size."""
        at = np.concatenate([self.of[j] for j in members])
        G, a = self.G[:, at[:, None], at], self.a[:, at]
        every, b = G.sum(axis=0), a.sum(axis=0)
        diagonal = np.diag(every)
        scale = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
        unit = every / np.outer(scale, scale)
        both = np.concatenate([unit[None], unit - G / np.outer(scale, scale)])
        right = np.concatenate([b[None], b - a]) / scale
        ridge = 1e-9 * np.eye(len(at))  # two candidates that are one force share it
        η = np.linalg.solve(both + ridge, right[..., None])[..., 0] / scale
        if np.any(self.signs[at] * η[0] < 0) or np.any(np.abs(η[0]) > self.largest[at]):
            return np.full(len(G), -np.inf)
        out = η[1:]
        return 2 * np.sum(a * out, axis=1) - np.einsum("fi,fij,fj->f", out, G, out)


def folded(
    G: np.ndarray, a: np.ndarray, of: Sequence[np.ndarray], signs: np.ndarray, largest: np.ndarray
) -> Columns:
    """Returns the columns of candidates by folds of neighbouring blocks.

    Args:
        G: of B blocks, shape (B, k, k).
        a: shape (B, k).
        of: the columns of each candidate.
        signs: of its sizes, shape (k,).
        largest: of its sizes, shape (k,).
    """
    folds = np.array_split(np.arange(len(a)), min(FOLDS, len(a)))
    return Columns(
        np.array([G[f].sum(axis=0) for f in folds]), np.array([a[f].sum(axis=0) for f in folds]),
        of, signs, largest,
    )  # fmt: skip


def select_set(
    columns: Columns, alike: Sequence[str], most: int, members: Sequence[int] = ()
) -> tuple[int, ...]:
    """Returns the candidates of the set that gains most, in the order in which they were added.

    Args:
        columns: of all candidates.
        alike: a word for each candidate; of those with the same word, a set has one.
        most: members.
        members: of the set where the search begins.
    """
    chosen, last = [*members], _gains(columns, members)
    chosen, last = _exchanged(columns, alike, chosen, last)
    while len(chosen) < most:
        best, gains = _best(columns, alike, chosen)
        if best is None or not _is_beyond(gains, last):
            break
        chosen, last = _exchanged(columns, alike, [*chosen, best], gains)
    while chosen:  # what later ones do as well
        less = [[*chosen[:k], *chosen[k + 1 :]] for k in range(len(chosen))]
        rest = max(less, key=lambda some: _gains(columns, some).sum())
        gains = _gains(columns, rest)
        if _is_beyond(last, gains):
            break
        chosen, last = rest, gains
    return tuple(chosen)


def _gains(columns: Columns, members: Sequence[int]) -> np.ndarray:
    """Returns the gains of a set, zero of an empty one."""
    return columns.gains(members) if members else np.zeros(len(columns.a))


def _best(
    columns: Columns, alike: Sequence[str], beside: Sequence[int]
) -> tuple[int | None, np.ndarray]:
    """Returns the candidate that gains most beside others, and the gains of all of them."""
    taken = {alike[j] for j in beside}
    best, most = None, np.full(len(columns.a), -np.inf)
    for j, word in enumerate(alike):
        if word in taken:
            continue
        gains = columns.gains([*beside, j])
        if gains.sum() > most.sum():
            best, most = j, gains
    return best, most


def _exchanged(
    columns: Columns, alike: Sequence[str], members: Sequence[int], gains: np.ndarray
) -> tuple[list[int], np.ndarray]:
    """Returns a set in which no candidate gains more in the place of a member, and its gains."""
    members = [*members]
    for _ in range(MAX_EXCHANGES):
        before = [*members]
        for k in range(len(members)):
            rest = [*members[:k], *members[k + 1 :]]
            best, found = _best(columns, alike, rest)
            if best is not None and found.sum() > gains.sum():
                members, gains = [*members[:k], best, *members[k + 1 :]], found
        if members == before:
            break
    return members, gains


def _is_beyond(gains: np.ndarray, other: np.ndarray) -> bool:
    """Returns whether a set gains more than another by more than their scatter over the folds."""
    if not np.isfinite(other).all():
        return bool(np.isfinite(gains).all())
    more = gains - other
    return bool(more.sum() > np.sqrt(len(more) * np.var(more, ddof=1)))
