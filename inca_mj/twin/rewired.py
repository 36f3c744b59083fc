"""A log whose columns have other places and signs, in words, and the lines that repair it.

    y' = y Pᵀ,    u' = u Qᵀ;    P_km = ±1 where column m is the angle of drive k with this sign

P and Q are signed permutations, the identity where a log is right.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from identification import Log
from identification.logs.cures import how_to_rename, how_to_turn
from identification.logs.names import listed
from identification.logs.readings import Reading


@dataclass(frozen=True)
class Places:
    """The places of the columns of a log.

    Attributes:
        angles: P, shape (k, k).
        currents: Q, shape (8, 8).
    """

    angles: np.ndarray
    currents: np.ndarray

    @property
    def are_right(self) -> bool:
        """Whether nothing is in another place or has another sign."""
        return all(np.array_equal(x, np.eye(len(x))) for x in (self.angles, self.currents))


def rewired(part: Log, places: Places) -> Reading:
    """Returns a log read with other places and signs.

    Args:
        part: as it is read, n samples of k angles.
        places: P and Q, not both the identity.
    """
    renamed: dict[str, str] = {}
    turned: list[str] = []
    for names, matrix in ((part.output_names, places.angles), (part.input_names, places.currents)):
        for k, m in zip(*np.nonzero(matrix), strict=True):
            if k != m:
                renamed[names[m]] = names[k]
            if matrix[k, m] < 0:
                turned.append(names[k])  # a sign belongs to the name that a column will have
    log = replace(
        part, outputs=part.outputs @ places.angles.T, inputs=part.inputs @ places.currents.T
    )
    return Reading(log, range(len(part.output_names)), _said(renamed, turned),
                   _cure(dict(sorted(renamed.items())), turned, part.factors))  # fmt: skip


def _said(renamed: dict[str, str], turned: Sequence[str]) -> str:
    """Returns what the columns would be, in words."""
    said = []
    if renamed:
        said.append(f"were {listed(sorted(renamed))} exchanged")
    if turned:
        said.append(f"with the other sign of {listed(turned)}")
    return " and ".join(said)


def _cure(renamed: dict[str, str], turned: Sequence[str], factors: Mapping[str, float]) -> str:
    """Returns what to write into the TOML of the log."""
    if not renamed:
        return how_to_turn(turned, factors)
    turn = f", and {how_to_turn(turned, renamed=True)}" if turned else ""
    pairs = [(old, new) for old, new in renamed.items() if renamed[new] == old and old < new]
    if 2 * len(pairs) == len(renamed):
        told = f"exchange {', and '.join(f'{a} and {b}' for a, b in pairs)}"
    else:
        told = f"rename {listed(f'{old} to {new}' for old, new in renamed.items())}"
    return f"{told}{how_to_rename(renamed)}{turn}"
