"""A constant external force on the platform: G at the point b_G (thesis 2.35, 2.36).

    m v̇ = ... + Rᵀ G,   I ω̇ = ... + ᴮb_G × Rᵀ G

G is fixed in O and acts from the first instant on; b_G is fixed in the platform.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import InputError
from inca_mj.effects.platform import PULL
from inca_mj.twin.twin import Twin, rebuild

CENTRE = (0.0, 0.0, 0.0)


def with_force(robot: Twin, force: Sequence[float], at: Sequence[float] = CENTRE) -> Twin:
    """Returns the twin with a constant force on its platform, as a part of its law.

    A run of it is saved, reloaded and filmed with the force.

    Args:
        robot: the twin.
        force: G in O, shape (3,) [N].
        at: the point b_G where it acts, in the platform frame, shape (3,) [m].

    Raises:
        InputError: force or point is not three finite numbers, or out of bounds (100 N and 1 m).
    """
    if len(force) != 3 or len(at) != 3:
        raise InputError(
            f"a force and its point are three numbers each, not {len(force)} and {len(at)};"
            " give x, y and z"
        )
    if not np.isfinite([*force, *at]).all():
        raise InputError(f"force {tuple(force)} N at {tuple(at)} m: give finite numbers")
    values = dict(zip(("pull.x", "pull.y", "pull.z"), map(float, force), strict=True))
    point = dict(zip(("pull.b_x", "pull.b_y", "pull.b_z"), map(float, at), strict=True))
    others = tuple(e for e in robot.effects if e.name != PULL.name)
    return rebuild(robot, effects=(*others, PULL)).with_values({**values, **point})
