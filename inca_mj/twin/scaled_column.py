"""One angle or one current that is far too small or too large beside the others.

An angle is judged by the cables alone: multiplied by the right factor f, it belongs with the other
seven to poses of the platform (`inca_mj.twin.agreement`), and its motion has the twin's shape
and is in the twin's proportion to theirs. Where it hardly moves, nothing is said.

    κ_f <= κ/10,    f beyond 1.6 or 1/1.6,    ε_k <= 0.2,    f s_k / median s within 1.6

A current is judged by a free run in which it is multiplied by the factor that feedback tells
(`inca_mj.twin.agreement`): it must leave a tenth of γ, and every angle as near to the twin as
that of a right log. A motor of the next winding has a torque constant that is off by a quarter,
which is well within 1.6; a motor that has half its torque constant looks the same as a current that
is logged twice, and a user who has one overrules the check.
"""

from __future__ import annotations

import numpy as np

from identification import Log
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.agreement import angles_under, follow, shares_of, some
from inca_mj.twin.bounds import BOUNDS
from inca_mj.twin.odd_angle import as_factor, odd_angle, scaled_words
from inca_mj.twin.other_currents import apart, is_right
from inca_mj.twin.other_wiring import alike
from inca_mj.twin.twin import Twin


def scaled_angle(plant: Twin, part: Log, predicted: np.ndarray) -> str | None:
    """Returns which angle is far too small or large beside the others, and the cure, or None.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles.
        predicted: the twin's angles, shape (n, 8) [rad].
    """
    found = odd_angle(plant, some(part.outputs), (1.0,))
    if found is None:
        return None
    k, factor = found
    moved = part.outputs - part.outputs[0]
    off = 1 - alike(moved, predicted)[k, k]
    sizes = np.linalg.norm(moved, axis=0) / np.linalg.norm(predicted, axis=0)
    proportion = factor * sizes[k] / np.median(np.delete(sizes, k))
    if not 1 / BOUNDS.beyond < proportion < BOUNDS.beyond or off > BOUNDS.right:
        return None
    return scaled_words(part.output_names[k], factor)


def scaled_current(plant: Twin, part: Log, longer: Log, predicted: np.ndarray) -> str | None:
    """Returns which current is far too small or large beside the others, and the cure, or None.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles.
        longer: the log a little longer, of which feedback tells more.
        predicted: the twin's angles under the logged currents, shape (n, 8) [rad].
    """
    own = apart(part, predicted)
    if own <= BOUNDS.astray:
        return None
    tried = [each for log in (longer, part) if (each := _odd_one(plant, log)) is not None]
    if not tried:
        return None
    scales = np.ones((len(tried), DRIVES))
    for n, (k, factor) in enumerate(tried):
        scales[n, k] = factor
    every = angles_under(plant, part, part.inputs * scales[:, None])
    left = [apart(part, angles) if np.isfinite(angles).all() else np.inf for angles in every]
    best = int(np.argmin(left))
    if not (left[best] < BOUNDS.nearer * own and is_right(part, every[best])):
        return None
    k, factor = tried[best]
    name = part.input_names[k]
    return (
        f"{name} is {1 / factor:.2g} times as large as the one that moves the robot so, and the"
        f" other currents are not: {as_factor(name, factor)}, or correct its unit"
    )


def _odd_one(plant: Twin, log: Log) -> tuple[int, float] | None:
    """Returns the current that is farthest from the proportion of the others, and its factor."""
    followed = follow(plant, log)
    if followed is None:
        return None
    gain = np.diag(shares_of(log, followed[0]))
    usual = float(np.median(gain))
    if not (gain > 0).all():
        return None
    k = int(np.abs(np.log(gain / usual)).argmax())
    factor = float(gain[k]) / usual
    return None if 1 / BOUNDS.beyond < factor < BOUNDS.beyond else (k, factor)
