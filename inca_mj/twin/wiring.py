"""Is a log wired as the robot is: angles of the right drive, sign and unit?

    c_ij = ⟨y_i, ŷ_j⟩ / (‖y_i‖ ‖ŷ_j‖),    s_i = ⟨y_i, ŷ_i⟩ / ‖ŷ_i‖²   over two seconds of motion

ŷ is what the nominal twin does under the logged currents, from where it begins to move. A model
that lacks something is off by a few percent there: c_ii >= 0.89 and 0.77 <= s <= 1.2 over 89
simulated logs of 25 effects; an anchor that is 0.1 m off makes even c_ii = -0.5. So a log is
refused only where another sign, or another drive's motion, explains it far better than its own:
1 - c falls to a fifth. Where the model does not move, nothing is said.
"""

from __future__ import annotations

import numpy as np

from identification import Log, Predictor
from identification.errors import DivergenceError, InputError
from identification.logs.frozen import refuse_frozen
from inca_mj.twin.logs import ANGLES
from inca_mj.twin.twin import Twin

LONGEST = 10.0  # [s] in which motion must begin
MOTION = 0.05  # [rad] of the model; a hundred times an encoder's noise
BEGINNING = 2.0  # [s] from there; later even a good model has drifted
DEAD = 1e-3  # of the model's motion
NEARER = 0.2  # of 1 - c, that another sign or drive must leave to be the likelier one
UNIT = (0.3, 10.0)  # of the motion; revolutions are at 0.16, degrees at 57
ADVICE = "; `inca compare` shows the log beside the model"


def refuse_miswired(log: Log, plant: Twin) -> None:
    """Refuse a log whose angles cannot be those of the drives they are named after.

    Args:
        log: of the robot.
        plant: its nominal twin.

    Raises:
        InputError: an encoder is dead, frozen, reversed, swapped with another or in another unit.
    """
    for k in range(log.outputs.shape[1]):
        refuse_frozen(log, k, log.inputs[:, [k]], log.outputs[:, :0])
    y, predicted = _motion(log, plant)
    moving = np.sqrt(np.mean(predicted**2, axis=0)) > MOTION if len(y) else np.zeros(0, bool)
    if not moving.all() or not len(y):
        return
    size = np.linalg.norm(y, axis=0)
    dead = np.flatnonzero(size <= DEAD * np.linalg.norm(predicted, axis=0))
    if len(dead) == len(size):
        raise InputError("nothing moves in the log though the currents would move the robot")
    if len(dead):
        raise InputError(f"{_names(dead)}: stands still though its motor turns; dead encoder?")
    c = (y / size).T @ (predicted / np.linalg.norm(predicted, axis=0))
    own = np.diag(c)
    back = np.flatnonzero(1 + own < NEARER * (1 - own))
    if len(back) == len(size):
        raise InputError("all angles, or all currents, have the wrong sign" + ADVICE)
    from scipy.optimize import linear_sum_assignment  # slow to import

    _, best = linear_sum_assignment(1 - c)
    moved = np.flatnonzero(best != np.arange(len(best)))
    if len(moved) and (1 - c[moved, best[moved]] < NEARER * (1 - own[moved])).all():
        pairs = ", ".join(f"{ANGLES[i]} moves as the model's {ANGLES[best[i]]} does" for i in moved)
        raise InputError(f"{pairs}; exchange the columns" + ADVICE)
    if len(back):
        raise InputError(f"{_names(back)}: moves against the model; reverse its sign" + ADVICE)
    scale = float(np.exp(np.mean(np.log(np.abs((y * predicted).sum(0) / (predicted**2).sum(0))))))
    if not UNIT[0] < scale < UNIT[1]:
        raise InputError(
            f"the angles move {scale:.2g} times as far as the model's under these currents; they"
            " must be in radians (a revolution is 6.28, a degree 0.0175) and currents in ampere"
            + ADVICE
        )


def _motion(log: Log, plant: Twin) -> tuple[np.ndarray, np.ndarray]:
    """Measured and predicted angles from where the model begins to move, shapes (n, 8)."""
    start = float(log.time[0])
    part = log.between(start, start + LONGEST) if log.duration > LONGEST else log
    try:
        predicted = Predictor(plant, part, (), {}).predict(np.zeros((1, 0)))[0]
    except DivergenceError:  # the search says what to do
        return np.zeros((0, 8)), np.zeros((0, 8))
    late = np.flatnonzero(np.abs(predicted).max(axis=1) > MOTION)
    first = int(late[0]) if len(late) else len(predicted)
    rows = slice(first, first + round(BEGINNING / log.sampling_time))
    return part.outputs[rows] - part.outputs[0], predicted[rows]


def _names(drives: np.ndarray) -> str:
    return ", ".join(ANGLES[i] for i in drives)
