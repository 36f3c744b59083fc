"""One angle of the other sign, or far too small or too large, as the cables of the others tell.

    κ_f <= κ/10,    f < 0, or beyond 1.6 or 1/1.6

Multiplied by the right factor f, an angle belongs with the other seven to poses of the platform
(`inca_mj.twin.agreement`). Currents have no say, so that this holds also where one of them is
wrong. It is a proposal and no verdict.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification import Log
from identification.logs.cures import how_to_turn, toml_key, unit_lines
from identification.logs.units import UNITS
from identification.robot.same_units import NEAR
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.agreement import unreached_share
from inca_mj.twin.bounds import BOUNDS
from inca_mj.twin.twin import Twin

FACTORS = np.geomspace(1 / 60, 60, 25)  # that are tried first: √2 apart, to degrees and back
FINER = np.geomspace(1 / 1.4, 1.4, 25)  # around the best of them: 3 % apart
BOTH = (1.0, -1.0)  # signs


def odd_angle(
    plant: Twin, y: np.ndarray, signs: tuple[float, ...] = BOTH
) -> tuple[int, float] | None:
    """Returns the angle that belongs to no pose with the others, and the factor with which it does.

    Args:
        plant: the twin.
        y: angles from the first sample on, shape (n, 8) [rad].
        signs: of the factors that are tried.

    Returns:
        The number of the drive from zero, and f, without unit; None where no factor brings the
        angles near enough to poses of the platform.
    """
    tried = np.concatenate([sign * FACTORS for sign in signs])
    shares = np.stack([_shares(plant, y, k, tried) for k in range(DRIVES)])
    k, at = (int(i) for i in np.unravel_index(int(shares.argmin()), shares.shape))
    finer = tried[at] * FINER
    shares = _shares(plant, y, k, finer)
    factor, own = float(finer[shares.argmin()]), float(unreached_share(plant, y[None])[0])
    is_near = 1 / BOUNDS.beyond < factor < BOUNDS.beyond
    return None if is_near or shares.min() > BOUNDS.closer * own else (k, factor)


def mended_angle(log: Log, k: int, factor: float) -> Log:
    """Returns a log with one angle multiplied; a factor near -1 changes the sign alone.

    Args:
        log: with all eight angles.
        k: number of the drive from zero.
        factor: of `odd_angle`, without unit.
    """
    scale = np.ones(DRIVES)
    scale[k] = -1.0 if is_turned(factor) else factor
    return replace(log, outputs=log.outputs * scale)


def odd_words(log: Log, k: int, factor: float) -> str:
    """Returns what tells that an angle is turned or of another scale, and the cure.

    Args:
        log: as it is read.
        k: number of the drive from zero.
        factor: of `odd_angle`, without unit.
    """
    name = log.output_names[k]
    if not is_turned(factor):
        return scaled_words(name, factor)
    return (
        f"{name} fits the cables of one platform, as the other angles say, only with the other"
        f" sign: {how_to_turn([name], log.factors)}"
    )


def scaled_words(name: str, factor: float) -> str:
    """Returns what tells that an angle is of another scale, and the cure.

    Args:
        name: of the angle.
        factor: with which it must be multiplied, without unit.
    """
    return (
        f"{name} moves {1 / factor:.2g} times as far as the other angles say, with which it must"
        f" fit the cables of one platform: {_as_unit(name, factor)}"
    )


def as_factor(name: str, factor: float) -> str:
    """Returns what the TOML must say of a column that has to be multiplied."""
    return (
        f"write {toml_key(name)} = {factor:.2g} under [factors] of the log's TOML, or, if {name}"
        " already has a factor there, multiply that factor by this one (it is an estimate; the true"
        " one is likely a round number)"
    )


def _as_unit(name: str, factor: float) -> str:
    """Returns what the TOML must say of an angle that has to be multiplied."""
    for word, (si, of) in UNITS.items():
        if si == "rad" != word and 1 / NEAR < factor / of < NEAR:
            return f"{unit_lines({name: word})}, or correct the unit of {name} there"
    return as_factor(name, factor)


def is_turned(factor: float) -> bool:
    """Returns whether a factor changes the sign and nothing else."""
    return 1 / BOUNDS.beyond < -factor < BOUNDS.beyond


def _shares(plant: Twin, y: np.ndarray, k: int, factors: np.ndarray) -> np.ndarray:
    """Returns κ of angles (n, 8) of which that of drive k is multiplied by each factor."""
    scaled = np.repeat(y[None], len(factors), axis=0)
    scaled[:, :, k] *= factors[:, None]
    return unreached_share(plant, scaled)
