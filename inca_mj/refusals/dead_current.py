"""A logged current that stands still though the motor had another one.

The twin is simulated with the logged currents of all drives but one, whose motor follows the
measured angle by feedback (`inca_mj.refusals.agreement`). If the current of that drive alone is
wrong, the other seven angles are as those of a right log now:

    γ_others <= γ/10,    ε_j <= 0.2 for every other angle j

A current that a user keeps constant is right, and then the feedback brings the others no nearer.
Two currents may stand still, and others may have the other sign: feedback of all motors tells it.

One angle may be turned or scaled beside them. The cables tell so without a current
(`inca_mj.refusals.scales`), and the currents are judged with the angle mended.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from identification import Log
from identification.logs.cures import how_to_turn
from identification.logs.names import listed
from inca_mj.refusals import bounds
from inca_mj.refusals.agreement import SETTLED, follow, shares_of, some
from inca_mj.refusals.angles import apart, is_right, with_outputs
from inca_mj.refusals.currents import likely_units
from inca_mj.refusals.scales import is_turned, mended_angle, odd_angle, odd_words
from inca_mj.twin.twin import Twin


def dead_current(
    plant: Twin, part: Log, predicted: np.ndarray
) -> tuple[str, tuple[str, ...]] | None:
    """Returns which logged current stands still, what tells it, and the cure; None if none does.

    All eight angles move in the first motion; the twin's are predicted, shape (n, 8) [rad]. With
    the sentence come words of `JUDGED`, which it judges.
    """
    ranges = np.ptp(part.inputs, axis=0)
    still = np.flatnonzero(ranges <= bounds.CONSTANT * np.median(ranges)).tolist()
    if not still or apart(part, predicted) <= bounds.ASTRAY:
        return None
    for factor in likely_units(part, predicted):
        scaled = replace(part, outputs=factor * part.outputs)
        odd = odd_angle(plant, some(scaled.outputs))
        for angle in (None,) if odd is None else (odd, None):
            mended = scaled if angle is None else mended_angle(scaled, *angle)
            as_read = apart(mended, predicted)
            if as_read <= bounds.ASTRAY:
                continue
            for dead, signs in _likely(plant, mended, still):
                currents = _missing(plant, mended, dead, signs, as_read)
                if currents is not None:
                    words = _said(part, dead, currents, signs)
                    if angle is None:
                        return words, ("sensors",)
                    other = "wiring" if is_turned(angle[1]) else "units"
                    return f"{words}; beside it, {odd_words(part, *angle)}", ("sensors", other)
    return None


def _missing(
    plant: Twin, log: Log, dead: list[int], signs: np.ndarray, as_read: float
) -> np.ndarray | None:
    """Returns the currents that drives had, shape (n, drives) [A]; None if others do not fit."""
    followed = follow(plant, replace(log, inputs=log.inputs * signs), dead)
    if followed is None:
        return None
    kept = ~np.isin(np.arange(log.outputs.shape[1]), dead)
    others, angles = with_outputs(log, kept), followed[1][:, kept]
    if apart(others, angles) >= bounds.NEARER * as_read or not is_right(others, angles):
        return None
    currents: np.ndarray = followed[0][SETTLED:, dead]
    return currents


def _likely(plant: Twin, log: Log, still: list[int]) -> Iterator[tuple[list[int], np.ndarray]]:
    """Yields drives whose currents may be missing, with the signs of all currents, shape (8,)."""
    groups = [*([k] for k in still), *([still] if 1 < len(still) <= bounds.MAX_DEAD else [])]
    right = np.ones(log.inputs.shape[1])
    yield from ((dead, right) for dead in groups)
    followed = follow(plant, log)
    if followed is None:
        return
    signs = np.where(np.diag(shares_of(log, followed[0])) < 0, -1.0, 1.0)
    signs[still] = 1.0
    if (signs < 0).any():
        yield from ((dead, signs) for dead in groups)


def _said(part: Log, dead: list[int], currents: np.ndarray, signs: np.ndarray) -> str:
    """Returns what tells that currents are dead, and the cure, in words."""
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
