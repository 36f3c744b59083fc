"""Is a log wired as the robot is: angles of the right drive, sign and unit?

    c_ij = ⟨y_i, ŷ_j⟩ / (‖y_i‖ ‖ŷ_j‖),    s_i = ⟨y_i, ŷ_i⟩ / ‖ŷ_i‖²       over the first two seconds

ŷ is what the nominal twin does under the logged currents. A model that lacks something is off by a
few percent there: c_ii >= 0.89 and 0.77 <= s <= 1.2 over 89 simulated logs of 25 effects. A
swapped pair, a reversed encoder or another unit is off by far more.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from identification import Log, Predictor
from identification.errors import DivergenceError, InputError
from inca_mj.logs import ANGLES
from inca_mj.twin import Twin

BEGINNING = 2.0  # [s]; later even a good model has drifted
DEAD = 1e-3  # share of the others' motion below which an encoder does not count
REVERSED = -0.5  # correlation
NEARER = 0.2  # of 1 - c, that another drive's motion must leave to be the likelier one
UNIT = (0.3, 10.0)  # of the motion; revolutions are at 0.16, degrees at 57
ADVICE = "; `inca compare` shows the log beside the model"


def refuse_miswired(log: Log, plant: Twin) -> None:
    """Refuse a log whose angles cannot be those of the drives they are named after.

    Args:
        log: of the robot.
        plant: its nominal twin.

    Raises:
        InputError: an encoder is dead, reversed, swapped with another or in another unit.
    """
    end = float(log.time[0]) + min(BEGINNING, log.duration)
    part = log.between(float(log.time[0]), end)
    y = part.outputs - part.outputs[0]
    size = np.linalg.norm(y, axis=0)
    dead = np.flatnonzero(size <= DEAD * np.median(size))
    if len(dead):
        names = ", ".join(ANGLES[i] for i in dead)
        raise InputError(f"{names}: stands still while the others move; is its encoder dead?")
    try:
        predicted = Predictor(plant, part, (), {}).predict(np.zeros((1, 0)))[0]
    except DivergenceError:  # the search says what to do
        return
    c = (y / size).T @ (predicted / np.linalg.norm(predicted, axis=0))
    back = np.flatnonzero(np.diag(c) < REVERSED)
    if len(back):
        names = ", ".join(ANGLES[i] for i in back)
        raise InputError(f"{names}: moves against the model; reverse its sign" + ADVICE)
    _, best = linear_sum_assignment(1 - c)
    for i, j in enumerate(best):
        if i != j and 1 - c[i, j] < NEARER * (1 - c[i, i]):
            raise InputError(
                f"{ANGLES[i]} moves as the model's {ANGLES[j]} does; swap the columns" + ADVICE
            )
    scale = float(np.exp(np.mean(np.log(np.abs((y * predicted).sum(0) / (predicted**2).sum(0))))))
    if not UNIT[0] < scale < UNIT[1]:
        raise InputError(
            f"the angles move {scale:.2g} times as far as the model's under these currents; they"
            " must be in radians (a revolution is 6.28, a degree 0.0175) and currents in ampere"
            + ADVICE
        )
