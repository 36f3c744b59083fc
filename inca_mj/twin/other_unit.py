"""Angles in another unit than radians: they move much farther than the twin's, or much less.

    s_k = |⟨y_k, ŷ_k⟩| / ‖ŷ_k‖²

Wrong currents also change how far the twin moves. The unit alone is blamed only where every angle
has the shape of the twin's, whatever its size. Elsewhere the sentence says what else may be wrong,
and nothing is said of angles that move less: so does a robot whose motors get less current than was
logged (world 32279, with 2 A constant in one motor, moved 0.03 times as far as the twin).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification import Log
from identification.logs.cures import unit_lines
from identification.logs.names import listed
from identification.logs.units import UNITS
from identification.robot.same_units import NEAR
from inca_mj.twin.bounds import BOUNDS
from inca_mj.twin.other_wiring import alike


def other_unit(
    part: Log, predicted: np.ndarray, wiring_is_right: bool
) -> tuple[str, tuple[str, ...]] | None:
    """Returns what tells that angles are not in radians, and the cure; None if nothing does.

    Args:
        part: the first motion, n samples of angles that all move.
        predicted: the twin's angles, shape (n, angles) [rad].
        wiring_is_right: whether the user says so.

    Returns:
        The sentence, and the words of what it judges.
    """
    y = part.outputs - part.outputs[0]
    scales = np.abs((y * predicted).sum(0) / (predicted**2).sum(0))
    scale, far = float(np.exp(np.mean(np.log(scales)))), np.flatnonzero(scales > BOUNDS.far)
    of_all = not BOUNDS.little < scale < BOUNDS.far
    if not of_all and not len(far):
        return None
    is_alike = bool((1 - np.diag(alike(y, predicted)) <= BOUNDS.alike).all())
    if not is_alike and not len(far):
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


def _how_to_convert(columns: Sequence[str], scale: float) -> str:
    """Returns what the TOML must say of angles that move so many times as far as the twin's."""
    fitting = (word for word, (si, factor) in UNITS.items()
               if si == "rad" and 1 / NEAR < scale * factor < NEAR)  # fmt: skip
    word = next(fitting, None)
    if word is None:
        return ""
    return (
        f": {unit_lines(dict.fromkeys(columns, word))}, or correct the unit there if one is given"
    )
