"""One angle or one current that is far too small or too large beside the others.

An angle is judged by the cables alone: multiplied by the right factor f, it belongs with the other
seven to poses of the platform (`inca_mj.twin.cable_lengths`), and its motion has the twin's shape
and is in the twin's proportion to theirs. Where it hardly moves, nothing is said.

    κ_f <= κ/10,    f beyond 1.6 or 1/1.6,    ε_k <= 0.2,    f s_k / median s within 1.6

A current is judged by a free run in which it is multiplied by the factor that feedback tells
(`inca_mj.twin.followed_log`): it must leave a tenth of γ, and every angle as near to the twin as
that of a right log. A motor of the next winding has a torque constant that is off by a quarter,
which is well within 1.6; a motor that has half its torque constant looks the same as a current that
is logged twice, and a user who has one overrules the check.
"""

from __future__ import annotations

import numpy as np

from identification import Log
from identification.logs.cures import toml_key, unit_lines
from identification.logs.units import UNITS
from identification.robot.same_units import NEAR
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.angles_under import angles_under
from inca_mj.twin.cable_lengths import some, unreached_share
from inca_mj.twin.followed_log import follow, shares_of
from inca_mj.twin.other_currents import ASTRAY, NEARER, apart, is_right
from inca_mj.twin.other_wiring import RIGHT, alike
from inca_mj.twin.twin import Twin

BEYOND = 1.6  # factor from 1; revolutions are at 6.3, and a gear that was forgotten at 2 or more
CLOSER = 0.1  # of κ, that a factor must leave
FACTORS = np.geomspace(1 / 60, 60, 25)  # that are tried first: √2 apart, to degrees and back
FINER = np.geomspace(1 / 1.4, 1.4, 25)  # around the best of them: 3 % apart


def scaled_angle(plant: Twin, part: Log, predicted: np.ndarray) -> str | None:
    """Which angle is far too small or too large beside the others, and the cure; None if none is.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles.
        predicted: the twin's angles, shape (n, 8) [rad].
    """
    y = some(part.outputs)
    own = float(unreached_share(plant, y[None])[0])
    shares = np.stack([_shares(plant, y, k, FACTORS) for k in range(DRIVES)])
    k, at = (int(i) for i in np.unravel_index(int(shares.argmin()), shares.shape))
    finer = FACTORS[at] * FINER
    shares = _shares(plant, y, k, finer)
    factor, least = float(finer[shares.argmin()]), float(shares.min())
    moved = part.outputs - part.outputs[0]
    off = 1 - alike(moved, predicted)[k, k]
    sizes = np.linalg.norm(moved, axis=0) / np.linalg.norm(predicted, axis=0)
    proportion = factor * sizes[k] / np.median(np.delete(sizes, k))
    if not (
        least <= CLOSER * own
        and not 1 / BEYOND < factor < BEYOND
        and 1 / BEYOND < proportion < BEYOND
        and off <= RIGHT
    ):
        return None
    name = part.output_names[k]
    return (
        f"{name} moves {1 / factor:.2g} times as far as the other angles say, with which it must"
        f" fit the cables of one platform: {_as_unit(name, factor)}"
    )


def _shares(plant: Twin, y: np.ndarray, k: int, factors: np.ndarray) -> np.ndarray:
    """κ of angles (n, 8) of which that of drive k is multiplied by each factor."""
    scaled = np.repeat(y[None], len(factors), axis=0)
    scaled[:, :, k] *= factors[:, None]
    return unreached_share(plant, scaled)


def scaled_current(plant: Twin, part: Log, longer: Log, predicted: np.ndarray) -> str | None:
    """Which current is far too small or too large beside the others, and the cure; None if none is.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles.
        longer: the log a little longer, of which feedback tells more.
        predicted: the twin's angles under the logged currents, shape (n, 8) [rad].
    """
    own = apart(part, predicted)
    if own <= ASTRAY:
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
    if not (left[best] < NEARER * own and is_right(part, every[best])):
        return None
    k, factor = tried[best]
    name = part.input_names[k]
    return (
        f"{name} is {1 / factor:.2g} times as large as the one that moves the robot so, and the"
        f" other currents are not: {_as_factor(name, factor)}, or correct its unit"
    )


def _odd_one(plant: Twin, log: Log) -> tuple[int, float] | None:
    """The current that is farthest from the proportion of the others, and its factor."""
    followed = follow(plant, log)
    if followed is None:
        return None
    gain = np.diag(shares_of(log, followed[0]))
    usual = float(np.median(gain))
    if not (gain > 0).all():
        return None
    k = int(np.abs(np.log(gain / usual)).argmax())
    factor = float(gain[k]) / usual
    return None if 1 / BEYOND < factor < BEYOND else (k, factor)


def _as_unit(name: str, factor: float) -> str:
    """What the TOML must say of an angle that has to be multiplied."""
    for word, (si, of) in UNITS.items():
        if si == "rad" != word and 1 / NEAR < factor / of < NEAR:
            return f"{unit_lines({name: word})}, or correct the unit that it has"
    return _as_factor(name, factor)


def _as_factor(name: str, factor: float) -> str:
    """What the TOML must say of a column that has to be multiplied."""
    return (
        f"write {toml_key(name)} = {factor:.2g} under [factors] of the log's TOML, or multiply the"
        " factor that it has by this one (it is an estimate; the true one is likely a round number)"
    )
