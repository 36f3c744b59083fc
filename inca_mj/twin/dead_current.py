"""A logged current that stands still though the motor had another one.

The twin is simulated with the logged currents of all drives but one, whose motor follows the
measured angle by feedback (`inca_mj.twin.followed_log`). If the current of that drive alone is
wrong, the other seven angles are as those of a right log now:

    γ_others <= γ/10,    ε_j <= 0.2 for every other angle j

A current that a user keeps constant is right, and then the feedback brings the others no nearer: in
90 robots as built with effects (worlds 32200 to 32289, 4 s, one current constant at 0 to 2 A) it
left 0.36 of γ or more; where a current was logged as zero, it left 0.026 in the middle of 30.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification import Log
from inca_mj.twin.followed_log import SETTLED, follow
from inca_mj.twin.other_currents import ASTRAY, NEARER, apart, is_right, likely_units
from inca_mj.twin.twin import Twin

CONSTANT = 0.01  # range of a current that stands still, of the median range of all


def dead_current(plant: Twin, part: Log, predicted: np.ndarray) -> str | None:
    """Which logged current stands still, by what that is told, and the cure; None if none does.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles, which all move.
        predicted: the twin's angles under the logged currents, shape (n, 8) [rad].
    """
    ranges, own = np.ptp(part.inputs, axis=0), apart(part, predicted)
    still = np.flatnonzero(ranges <= CONSTANT * np.median(ranges))
    if own <= ASTRAY or not len(still):
        return None
    for factor in likely_units(part, predicted):
        scaled = replace(part, outputs=factor * part.outputs)
        for k in still.tolist():
            followed = follow(plant, scaled, [k])
            if followed is None:
                continue
            currents, angles = followed[0][SETTLED:, k], np.delete(followed[1], k, axis=1)
            others = replace(
                part, outputs=np.delete(part.outputs, k, axis=1),
                output_names=(*part.output_names[:k], *part.output_names[k + 1 :]),
                units={}, extras={},
            )  # fmt: skip
            if apart(others, angles) < NEARER * own and is_right(others, angles):
                return (
                    f"{part.input_names[k]} stands still at {part.inputs[0, k]:.3g} A, but"
                    f" {part.output_names[k]} and the other angles move as under"
                    f" {currents.min():.2g} to {currents.max():.2g} A; look for a dead current"
                    " sensor or a column that was not filled, and record again"
                )
    return None
