"""Other signs and places of a log's currents: does the twin move as the log only under these?

    γ = 1 - Σ_k ⟨y_k, ŷ_k⟩ / √(Σ_k ‖y_k‖² Σ_k ‖ŷ_k‖²)         over all angles together

One current moves all angles, so that all of them judge it together: an angle that hardly moves may
be anywhere in a right log, and then another current may bring it nearer by chance. Another reading
must leave a tenth of γ, and every angle as near to the twin as that of a right log. In 58 robots as
built (worlds 31000 to 31057, 4 s of PRBS or multisine) γ was 0.040 at most, and no other reading
left less than 0.63 of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain

import numpy as np

from identification import Log
from identification.errors import DivergenceError
from identification.logs.cures import how_to_turn
from identification.logs.names import listed
from identification.logs.readings import Reading, input_readings, misread
from inca_mj.twin.other_wiring import RIGHT, alike

ASTRAY = 0.02  # γ from which a log is looked at: it is √(2γ), a fifth of its motion, off the twin
NEARER = 0.1  # of γ, that another reading must leave

Predict = Callable[[np.ndarray], np.ndarray]  # currents (n, 8) [A] to the angles (n, k) [rad]


def other_currents(
    part: Log, predicted: np.ndarray, predict: Predict
) -> tuple[Reading, str] | None:
    """Other signs or places of currents, under which the twin moves as the log, and in words.

    Args:
        part: the first motion, n samples of k angles that all move.
        predicted: the twin's angles under the currents as they are read, shape (n, k) [rad].
        predict: what the twin does under other currents; it may raise a `DivergenceError`.
    """
    y = part.outputs - part.outputs[0]
    own = apart(part, predicted)
    if own <= ASTRAY:
        return None

    def unexplained(other: Log) -> np.ndarray | None:
        try:
            return np.full(y.shape[1], apart(other, predict(other.inputs)))
        except DivergenceError:
            return None

    def as_right(reading: Reading, left: np.ndarray) -> bool:
        near = 1 - np.diag(alike(y, predict(reading.log.inputs)))
        return bool((left < NEARER * own).all() and (near <= RIGHT).all())

    every = np.ones(y.shape[1], bool)
    column = {n: n for n in (*part.output_names, *part.input_names)}
    readings = chain(input_readings(part, every, column), _all_turned(part, every))
    return misread(part, own * every, readings, unexplained, as_right)


def _all_turned(part: Log, every: np.ndarray) -> Iterator[Reading]:
    """The other sign of all currents at once."""
    names = list(part.input_names)
    yield Reading(replace(part, inputs=-part.inputs), np.flatnonzero(every).tolist(),
                  "with the other sign of all currents",
                  f"turn the sign of {listed(names)}{how_to_turn(names)}")  # fmt: skip


def apart(part: Log, predicted: np.ndarray) -> float:
    """γ of the angles of a log and the twin's from its first sample on, shape (n, k) [rad]."""
    y = part.outputs - part.outputs[0]
    sizes = np.linalg.norm(y) * np.linalg.norm(predicted)
    return float(1 - np.sum(y * predicted) / sizes) if sizes > 0 else np.inf
