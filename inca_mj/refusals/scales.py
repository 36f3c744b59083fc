"""Columns of another scale: all angles, one angle or one current, far too small or too large.

**Angles in another unit** move much farther than the twin's, or much less:

    s_k = |⟨y_k, ŷ_k⟩| / ‖ŷ_k‖²

Wrong currents also change how far the twin moves. The unit alone is blamed only where every angle
has the shape of the twin's, whatever its size. Elsewhere the sentence says what else may be wrong,
and nothing is said of angles that move less: so does a robot whose motors get less current than was
logged (world 32279, with 2 A constant in one motor, moved 0.03 times as far as the twin).

**One angle** is judged by the cables alone: multiplied by the right factor f, it belongs with the
other seven to poses of the platform (κ of `inca_mj.refusals.agreement`). Currents have no say, so
that this proposes an angle also where a current is wrong. An angle is refused where its motion also
has the twin's shape and is in the twin's proportion to the others. One that hardly moves is not.

    κ_f <= κ/10,    f < 0, or beyond 1.6 or 1/1.6;    ε_k <= 0.2,    f s_k / median s within 1.6

**One current** is judged by a free run in which it is multiplied by the factor that feedback tells:
it must leave a tenth of γ, and every angle as near to the twin as that of a right log. A motor of
the next winding has a torque constant that is off by a quarter, which is well within 1.6; a motor
that has half its torque constant looks the same as a current that is logged twice, and a user who
has one overrules the check.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from identification import Log
from identification.logs.cures import how_to_turn, unit_lines
from identification.logs.names import listed
from identification.logs.units import UNITS
from identification.refusals.same_units import NEAR
from identification.storage.files import toml_key
from inca_mj.refusals import bounds
from inca_mj.refusals.agreement import angles_under, follow, shares_of, some, unreached_share
from inca_mj.refusals.angles import apart, is_right, off
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin

FACTORS = np.geomspace(1 / 60, 60, 25)  # that are tried first: √2 apart, to degrees and back
FINER = np.geomspace(1 / 1.4, 1.4, 25)  # around the best of them: 3 % apart
BOTH = (1.0, -1.0)  # signs


def other_unit(
    part: Log, predicted: np.ndarray, wiring_is_right: bool
) -> tuple[str, tuple[str, ...]] | None:
    """Returns what tells that angles are not in radians, and the cure; None if nothing does.

    All angles of the first motion move; the twin's are predicted, shape (n, angles) [rad]. With the
    sentence come the words of what it judges.
    """
    y = part.outputs - part.outputs[0]
    scales = np.abs((y * predicted).sum(0) / (predicted**2).sum(0))
    scale, far = float(np.exp(np.mean(np.log(scales)))), np.flatnonzero(scales > bounds.FAR)
    of_all = not bounds.LITTLE < scale < bounds.FAR
    is_alike = bool((off(part, predicted) <= bounds.ALIKE).all())
    if not len(far) and not (of_all and is_alike):
        return None
    if not is_alike and not wiring_is_right:
        how_far = f"{scale:.2g}" if of_all else f"up to {scales.max():.2g}"
        return (
            f"the angles move {how_far} times as far as the twin's under these currents, and in"
            " another way, so that it is not clear what is wrong: check that angles are in radians"
            " and currents in ampere, then give current to one motor after the other and check"
            " that the current and the angle with its number change, each with its sign"
        ), ("wiring", "units")
    if of_all:
        return (
            f"the angles move {scale:.2g} times as far as the twin's under these"
            " currents; they must be in radians (a revolution is 6.28, a degree 0.0175) and"
            f" currents in ampere, each with its sign{_how_to_convert(['angle'], scale)}"
        ), ("units",)
    names, most = [part.output_names[k] for k in far], float(scales[far].max())
    return (
        f"{listed(names)}: moves {most:.2g} times as far as the twin's"
        " under these currents, and the other angles do not; all must be in radians (a degree"
        f" is 0.0175){_how_to_convert(names, most)}"
    ), ("units",)


def scaled_angle(plant: Twin, part: Log, predicted: np.ndarray) -> str | None:
    """Returns which angle is far too small or large beside the others, and the cure, or None.

    The part is the first motion of all eight angles; the twin's are predicted, (n, 8) [rad].
    """
    found = odd_angle(plant, some(part.outputs), (1.0,))
    if found is None:
        return None
    k, factor = found
    moved = part.outputs - part.outputs[0]
    sizes = np.linalg.norm(moved, axis=0) / np.linalg.norm(predicted, axis=0)
    proportion = factor * sizes[k] / np.median(np.delete(sizes, k))
    if not _is_near(proportion) or off(part, predicted)[k] > bounds.RIGHT:
        return None
    return odd_words(part, k, factor)


def scaled_current(plant: Twin, part: Log, longer: Log, predicted: np.ndarray) -> str | None:
    """Returns which current is far too small or large beside the others, and the cure, or None.

    Feedback tells more of the longer log; the twin's angles in the part are predicted, (n, 8)
    [rad].
    """
    as_read = apart(part, predicted)
    if as_read <= bounds.ASTRAY:
        return None
    tried = [each for log in (longer, part) if (each := _odd_current(plant, log)) is not None]
    if not tried:
        return None
    scales = np.ones((len(tried), DRIVES))
    for n, (k, factor) in enumerate(tried):
        scales[n, k] = factor
    every = angles_under(plant, part, part.inputs * scales[:, None])
    rest = [apart(part, angles) if np.isfinite(angles).all() else np.inf for angles in every]
    best = int(np.argmin(rest))
    if not (rest[best] < bounds.NEARER * as_read and is_right(part, every[best])):
        return None
    k, factor = tried[best]
    name = part.input_names[k]
    return (
        f"{name} is {1 / factor:.2g} times as large as the one that moves the robot so, and the"
        f" other currents are not: {_as_factor(name, factor)}, or correct its unit"
    )


def odd_angle(
    plant: Twin, y: np.ndarray, signs: tuple[float, ...] = BOTH
) -> tuple[int, float] | None:
    """Returns the angle that fits no pose with the others, and the factor f with which it does.

    Angles count from the first sample on, (n, 8) [rad]; factors of the given signs are tried. The
    angle is the number of its drive from zero. None is returned where no factor brings the angles
    near enough to poses of the platform.
    """
    tried = np.concatenate([sign * FACTORS for sign in signs])
    shares = np.stack([_shares(plant, y, k, tried) for k in range(DRIVES)])
    k, at = (int(i) for i in np.unravel_index(int(shares.argmin()), shares.shape))
    finer = tried[at] * FINER
    shares = _shares(plant, y, k, finer)
    factor, as_read = float(finer[shares.argmin()]), float(unreached_share(plant, y[None])[0])
    return None if _is_near(factor) or shares.min() > bounds.CLOSER * as_read else (k, factor)


def mended_angle(log: Log, k: int, factor: float) -> Log:
    """Returns a log with angle k multiplied; a factor near -1 changes the sign alone."""
    scale = np.ones(DRIVES)
    scale[k] = -1.0 if is_turned(factor) else factor
    return replace(log, outputs=log.outputs * scale)


def odd_words(log: Log, k: int, factor: float) -> str:
    """Returns what tells that angle k is turned or of another scale, and the cure."""
    name = log.output_names[k]
    if is_turned(factor):
        return (
            f"{name} fits the cables of one platform, as the other angles say, only with the other"
            f" sign: {how_to_turn([name], log.factors)}"
        )
    word = _unit(1 / factor)
    cure = f"{unit_lines({name: word})}, or correct the unit of {name} there" if word else ""
    return (
        f"{name} moves {1 / factor:.2g} times as far as the other angles say, with which it must"
        f" fit the cables of one platform: {cure or _as_factor(name, factor)}"
    )


def is_turned(factor: float) -> bool:
    """Returns whether a factor changes the sign and nothing else."""
    return _is_near(-factor)


def _is_near(factor: float) -> bool:
    return 1 / bounds.BEYOND < factor < bounds.BEYOND


def _odd_current(plant: Twin, log: Log) -> tuple[int, float] | None:
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
    return None if _is_near(factor) else (k, factor)


def _shares(plant: Twin, y: np.ndarray, k: int, factors: np.ndarray) -> np.ndarray:
    """Returns κ of angles (n, 8) of which that of drive k is multiplied by each factor."""
    scaled = np.repeat(y[None], len(factors), axis=0)
    scaled[:, :, k] *= factors[:, None]
    return unreached_share(plant, scaled)


def _unit(scale: float) -> str:
    """Returns the unit of angles that move so many times as far as in radians, "" for none."""
    fitting = (word for word, (si, factor) in UNITS.items()
               if si == "rad" != word and 1 / NEAR < scale * factor < NEAR)  # fmt: skip
    return next(fitting, "")


def _how_to_convert(columns: Sequence[str], scale: float) -> str:
    """Returns what the TOML must say of angles that move so many times as far as the twin's."""
    if not (word := _unit(scale)):
        return ""
    lines = unit_lines(dict.fromkeys(columns, word))
    return f": {lines}, or correct the unit there if one is given"


def _as_factor(name: str, factor: float) -> str:
    """Returns what the TOML must say of a column that has to be multiplied."""
    return (
        f"write {toml_key(name)} = {factor:.2g} under [factors] of the log's TOML, or, if {name}"
        " already has a factor there, multiply that factor by this one (it is an estimate; the true"
        " one is likely a round number)"
    )
