"""How many names a set must hold so that the true one is in it (split-conformal sets).

    s_i: share of the odds of the true name of world i, 0 where it was not among the names
    τ: the ⌊α (n + 1)⌋-th smallest s_i of n worlds;  the set of a world: names with a share ≥ τ

The set of another world then holds its true name with a probability of at least 1 - α, whatever the
odds are worth (Vovk, Gammerman, Shafer 2005; Sadinle, Lei, Wasserman 2019). The worlds are halved
by chance, τ is of one half, and coverage and size are of the other. A verdict without a name is no
set and does not count.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from joint_statistics import first, is_null, is_of_several, is_unlisted, right_names

from identification.sweep.statistics import rate

MISSED = 0.1  # α
HALVINGS = 400


def odds(row: Mapping[str, Any]) -> dict[str, float]:
    """Returns the share of the odds of the first name of a world and of each of its rivals."""
    named = row["named"][0]
    shares: dict[str, float] = {}
    for name, share in zip((named["name"], *named["rivals"]),
                           (named["confidence"], *named["shares"]), strict=True):  # fmt: skip
        shares[name] = max(share, shares.get(name, 0.0))
    return shares


def share_of_truth(row: Mapping[str, Any]) -> float:
    """Returns the share of the odds of the true name, 0 where it is not among the names."""
    shares, true = odds(row), right_names(row)
    return max((share for name, share in shares.items() if name in true), default=0.0)


def threshold(shares: Sequence[float], missed: float = MISSED) -> float:
    """Returns τ, 0 where the worlds are too few.

    Args:
        shares: of the true names, one for each world.
        missed: α.
    """
    k = int(np.floor(missed * (len(shares) + 1)))
    return float(np.sort(shares)[k - 1]) if k else 0.0


def sets_of(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Returns what sets of names hold.

    Args:
        rows: of worlds; those count in which one effect of the catalogue acts and a law is named.

    Returns:
        `compared`, in how many worlds the true name is among the names at all; `threshold`, τ of
        all worlds; `coverage`, the mean share of worlds of the other half whose set holds the true
        name, and `low` and `high`, between which nine of ten halvings lie; `size`, the mean number
        of names of a set. None of the last five where there are no worlds.
    """
    mine = [r for r in rows if r["named"] and not first(r).startswith("curve_")
            and not (is_null(r) or is_unlisted(r) or is_of_several(r))]  # fmt: skip
    out: dict[str, Any] = {"compared": rate(mine, lambda r: share_of_truth(r) > 0)}
    keys = ("threshold", "coverage", "low", "high", "size")
    if len(mine) < 2:
        return out | dict.fromkeys(keys)
    true, every = np.array([share_of_truth(r) for r in mine]), [[*odds(r).values()] for r in mine]
    rng, held, sizes = np.random.default_rng(0), [], []
    for _ in range(HALVINGS):
        a, b = np.array_split(rng.permutation(len(mine)), 2)
        τ = threshold(true[a].tolist())
        held.append(np.mean(true[b] >= τ))
        sizes.append(np.mean([sum(share >= τ for share in every[k]) for k in b]))
    low, high = np.quantile(held, (0.05, 0.95))
    found = (threshold(true.tolist()), np.mean(held), low, high, np.mean(sizes))
    return out | dict(zip(keys, map(float, found), strict=True))
