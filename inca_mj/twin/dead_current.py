"""A logged current that stands still though the motor had another one.

The twin is simulated with the logged currents of all drives but one, whose motor follows the
measured angle by feedback (`inca_mj.twin.followed_log`). If the current of that drive alone is
wrong, the other seven angles are as those of a right log now:

    γ_others <= γ/10,    ε_j <= 0.2 for every other angle j

A current that a user keeps constant is right, and then the feedback brings the others no nearer: in
90 robots as built with effects (worlds 32200 to 32289, 4 s, one current constant at 0 to 2 A) it
left 0.36 of γ or more; where a current was logged as zero, it left 0.026 in the middle of 30. Two
currents may stand still, and others may have the other sign: feedback of all motors tells which.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from identification import Log
from identification.logs.cures import how_to_turn
from identification.logs.names import listed
from inca_mj.twin.followed_log import SETTLED, follow, shares_of
from inca_mj.twin.other_currents import ASTRAY, NEARER, apart, is_right, likely_units
from inca_mj.twin.twin import Twin

MOST = 2  # currents that were not logged; the angles of the other drives judge
CONSTANT = 0.01  # range of a current that stands still, of the median range of all


def dead_current(plant: Twin, part: Log, predicted: np.ndarray) -> str | None:
    """Which logged current stands still, by what that is told, and the cure; None if none does.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles, which all move.
        predicted: the twin's angles under the logged currents, shape (n, 8) [rad].
    """
    ranges, own = np.ptp(part.inputs, axis=0), apart(part, predicted)
    still = np.flatnonzero(ranges <= CONSTANT * np.median(ranges)).tolist()
    if own <= ASTRAY or not still:
        return None
    for factor in likely_units(part, predicted):
        scaled = replace(part, outputs=factor * part.outputs)
        for dead, signs in _likely(plant, scaled, still):
            read = replace(scaled, inputs=scaled.inputs * signs)
            followed = follow(plant, read, dead)
            if followed is None:
                continue
            angles, names = np.delete(followed[1], dead, axis=1), part.output_names
            others = replace(
                part, outputs=np.delete(part.outputs, dead, axis=1), units={}, extras={},
                output_names=tuple(n for k, n in enumerate(names) if k not in dead),
            )  # fmt: skip
            if apart(others, angles) < NEARER * own and is_right(others, angles):
                return _said(part, dead, followed[0][SETTLED:, dead], signs)
    return None


def _likely(plant: Twin, log: Log, still: list[int]) -> Iterator[tuple[list[int], np.ndarray]]:
    """Drives whose currents may be missing, each with the signs of all currents, shape (8,)."""
    right = np.ones(log.inputs.shape[1])
    yield from (([k], right) for k in still)
    if 1 < len(still) <= MOST:
        yield still, right
    followed = follow(plant, log)
    if followed is None:
        return
    signs = np.where(np.diag(shares_of(log, followed[0])) < 0, -1.0, 1.0)
    signs[still] = 1.0
    if (signs < 0).any():
        yield from (([k], signs) for k in still)
        if 1 < len(still) <= MOST:
            yield still, signs


def _said(part: Log, dead: list[int], currents: np.ndarray, signs: np.ndarray) -> str:
    """What tells it, and the cure.

    Args:
        part: the first motion.
        dead: drives whose currents were not logged.
        currents: those that they had, shape (n, number of these) [A].
        signs: of all currents, shape (8,).
    """
    names = [part.input_names[k] for k in dead]
    stand = "stands" if len(dead) == 1 else "stand"
    level = ", ".join(f"{part.inputs[0, k]:.3g}" for k in dead)
    back = [part.input_names[k] for k in np.flatnonzero(signs < 0)]
    turn = f"; and {how_to_turn(back, part.factors)}" if back else ""
    return (
        f"{listed(names)} {stand} still at {level} A, but"
        f" {listed(part.output_names[k] for k in dead)} and the other angles move as under"
        f" {currents.min():.2g} to {currents.max():.2g} A; look for a dead current"
        f" sensor or a column that was not filled, and record again{turn}"
    )
