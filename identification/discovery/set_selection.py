"""A set of effects that explain a residual together, of which none may explain much alone.

    e ≈ Σ_{j in A} S_j η_j                              A: some of the candidates
    η̂_-f = (Σ_{b not in f} G_b)⁻¹ Σ_{b not in f} a_b    G_b = S_bᵀS_b, a_b = S_bᵀe_b, of the set
    gain_f = 2 a_fᵀη̂_-f - η̂_-fᵀ G_f η̂_-f                of blocks f that η̂_-f was not fitted to

A begins with the best of all pairs, because two effects may hide each other. It grows by the
candidate with which the gain is the largest, and each member, and each two of them, then give way
to others that gain more beside the rest, until none do (floating selection; Pudil, Novovičová,
Kittler 1994). A member must gain on blocks that it was not fitted to (Stone 1974); whether that is
beyond chance, unseen records have to tell. A size must have the sign that physics gives it, beside
the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

FOLDS = 10  # of neighbouring blocks
MAX_EXCHANGES = 3  # sweeps over the members of a set
RIDGE = 1e-9  # of a column's own square: two candidates that are one force share it
MOST_AT_ONCE = 4000  # sets whose equations are solved at once: bounds the memory

Set = tuple[int, ...]


@dataclass(frozen=True)
class Columns:
    """What blocks of samples tell of all candidates' sizes, and of one size that does nothing."""

    # SᵀS of each of F folds of blocks, shape (F, k + 1, k + 1); the last size does nothing
    G: np.ndarray
    a: np.ndarray  # Sᵀe, shape (F, k + 1)
    of: np.ndarray  # the columns of each candidate, shape (c, m), filled up with k
    alike: Sequence[str]  # a word for each candidate; of those with the same word, a set has one
    signs: np.ndarray  # that sizes must have, 0 for either, shape (k + 1,)
    largest: np.ndarray  # that sizes may be, shape (k + 1,)

    def gains(self, sets: Sequence[Set]) -> np.ndarray:
        """Returns gain_f of sets of equally many members, shape (n, F).

        All of a set are -∞ where physics forbids a size, or where two members are alike.
        """
        each = [self._gains(sets[k : k + MOST_AT_ONCE])
                for k in range(0, len(sets), MOST_AT_ONCE)]  # fmt: skip
        return np.concatenate(each)

    def _gains(self, sets: Sequence[Set]) -> np.ndarray:
        at = self.of[np.array(sets, int)].reshape(len(sets), -1)  # (n, s)
        G = self.G[:, at[:, :, None], at[:, None, :]]
        a = self.a[:, at]
        every, b = G.sum(axis=0), a.sum(axis=0)
        diagonal = np.einsum("nii->ni", every)
        scale = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
        both = np.concatenate([every[None], every - G]) / (scale[:, :, None] * scale[:, None, :])
        right = np.concatenate([b[None], b - a]) / scale
        both = both + RIDGE * np.eye(at.shape[1])
        sizes = np.linalg.solve(both, right[..., None])[..., 0] / scale
        out = sizes[1:]
        found = 2 * np.sum(a * out, axis=2) - np.einsum("fni,fnij,fnj->fn", out, G, out)
        is_forbidden = (self.signs[at] * sizes[0] < 0) | (np.abs(sizes[0]) > self.largest[at])
        is_twice = [len({self.alike[j] for j in some}) < len(some) for some in sets]
        found[:, is_forbidden.any(axis=1) | np.array(is_twice)] = -np.inf
        return np.asarray(found.T)

    def best(self, sets: Sequence[Set]) -> tuple[Set, np.ndarray]:
        """Returns the set that gains most of sets of equally many members, and its gains."""
        found = self.gains(sets)
        k = int(np.argmax(found.sum(axis=1)))
        return sets[k], found[k]


def folded(
    G: np.ndarray, a: np.ndarray, counts: Sequence[int], alike: Sequence[str], signs: np.ndarray,
    largest: np.ndarray,
) -> Columns:  # fmt: skip
    """Returns the columns of candidates by folds of neighbouring blocks.

    Args:
        G: of B blocks, shape (B, k, k).
        a: shape (B, k).
        counts: number of sizes of each candidate; their sum is k.
        alike: a word for each candidate.
        signs: of the sizes, shape (k,).
        largest: of the sizes, shape (k,).
    """
    B, k = a.shape
    folds = np.array_split(np.arange(B), min(FOLDS, B))
    ends = np.cumsum(counts)
    of = np.full((len(counts), max(counts)), k)
    for j, (count, end) in enumerate(zip(counts, ends, strict=True)):
        of[j, :count] = np.arange(end - count, end)
    return Columns(
        np.pad(np.array([G[f].sum(axis=0) for f in folds]), ((0, 0), (0, 1), (0, 1))),
        np.pad(np.array([a[f].sum(axis=0) for f in folds]), ((0, 0), (0, 1))),
        of, alike, np.append(signs, 0.0), np.append(largest, np.inf),
    )  # fmt: skip


def select_set(columns: Columns, most: int, members: Set = ()) -> Set:
    """Returns the candidates of the set that gains most.

    Args:
        columns: of all candidates.
        most: members.
        members: of the set where the search begins; where there are none, it is the best pair.
    """
    count = len(columns.of)
    if not count:
        return ()
    if not members and most > 1 and count > 1:
        members = columns.best([*combinations(range(count), 2)])[0]
    chosen, gains = _exchanged(columns, members)
    while len(chosen) < most:
        more, found = columns.best([(*chosen, j) for j in range(count)])
        if not found.sum() > gains.sum():
            break
        chosen, gains = _exchanged(columns, more)
    while chosen:  # what the others do as well is left out
        less: Set = ()
        found = np.zeros(len(columns.a))
        if len(chosen) > 1:
            less, found = columns.best([(*chosen[:k], *chosen[k + 1 :])
                                        for k in range(len(chosen))])  # fmt: skip
        if gains.sum() > found.sum():
            break
        chosen, gains = less, found
    return chosen


def _exchanged(columns: Columns, members: Set) -> tuple[Set, np.ndarray]:
    """Returns a set in which no candidate gains more in the place of a member, and its gains."""
    if not members:
        return (), np.zeros(len(columns.a))
    gains = columns.gains([members])[0]
    every = range(len(columns.of))
    for _ in range(MAX_EXCHANGES):
        before = members
        for m in (1, 2)[: len(members)]:
            for out in combinations(before, m):
                if not set(out) <= set(members):
                    continue
                rest = tuple(j for j in members if j not in out)
                best, found = columns.best([(*rest, *new) for new in combinations(every, m)])
                if found.sum() > gains.sum():
                    members, gains = best, found
        if set(members) == set(before):
            break
    return members, gains
