"""Other wirings of a log's first motion: signs and places of its angles that the twin explains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain

import numpy as np

from identification import Log
from identification.logs.cures import how_to_rename, how_to_turn
from identification.logs.names import listed
from identification.logs.readings import Reading, misread, output_readings, turned
from inca_mj.twin.agreement import assigned
from inca_mj.twin.bounds import BOUNDS


def other_wiring(part: Log, predicted: np.ndarray) -> tuple[Reading, str] | None:
    """Returns another wiring that explains the first motion as a right log's, and that in words.

    Args:
        part: the first motion, n samples of angles that all move.
        predicted: the twin's angles, shape (n, angles) [rad].
    """

    def unexplained(other: Log) -> np.ndarray:
        return 1 - np.diag(alike(other.outputs - other.outputs[0], predicted))

    def as_right(reading: Reading, left: np.ndarray) -> bool:
        return bool((left <= BOUNDS.right).all())

    y = part.outputs - part.outputs[0]
    column = {n: n for n in (*part.output_names, *part.input_names)}
    every = np.ones(y.shape[1], bool)
    # A cable pulls and does not push: other signs of all currents are no mirror of all angles.
    readings = chain(output_readings(part, every, column, False), _several(part, y, predicted))
    return misread(
        part, unexplained(part), readings, lambda reading: unexplained(reading.log), as_right
    )


def _several(part: Log, y: np.ndarray, predicted: np.ndarray) -> Iterator[Reading]:
    """Yields readings with several wrong encoders: signs, and an exchange of more than two."""
    names, back = part.output_names, np.flatnonzero((y * predicted).sum(axis=0) < 0).tolist()
    if 1 < len(back) < y.shape[1]:
        outputs = turned(part.outputs, back)
        yield Reading(replace(part, outputs=outputs), back, "with the other sign",
                      how_to_turn([names[k] for k in back], part.factors))  # fmt: skip
    every = np.arange(y.shape[1])
    cosine = alike(y, predicted)
    for likeness in (cosine, np.abs(cosine)):  # whatever the signs, in the second
        at = assigned(likeness)
        moved = np.flatnonzero(at != every).tolist()
        back = np.flatnonzero(cosine[every, at] < 0).tolist() if likeness is not cosine else []
        if len(moved) > 2 or (moved and back):
            outputs = part.outputs.copy()
            outputs[:, at] = turned(part.outputs, back)
            new_names = {names[i]: names[at[i]] for i in moved}
            pairs = listed(f"{old} to {new}" for old, new in new_names.items())
            new = [names[at[i]] for i in back]
            turn = f", and {how_to_turn(new, renamed=True)}" if back else ""
            changed = [k for k in every.tolist() if k in (*at[moved], *at[back])]
            wrong = [
                k for k in changed if 1 - cosine[k, k] > BOUNDS.right
            ]  # others are right by a mirror
            if not wrong:
                continue
            how = " and turned" if back else ""
            yield Reading(replace(part, outputs=outputs), wrong, f"were they exchanged{how}",
                          f"rename {pairs}{how_to_rename(new_names)}{turn}")  # fmt: skip


def alike(y: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Returns cosines of measured and predicted angles, each (N, n): entry i, j of y_i and ŷ_j."""
    sizes = np.linalg.norm(y, axis=0)[:, None] * np.linalg.norm(predicted, axis=0)
    return np.asarray(y.T @ predicted / sizes)
