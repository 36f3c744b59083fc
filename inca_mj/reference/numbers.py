"""The constants of the equations in one flat array, in the order of `layout`.

Every drive has numbers of its own, and every point its own place: `inca_mj.robot.spread` says how
the deviations and displacements of the parameters give them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.errors import InputError
from identification.model.parameter import ParameterSet
from inca_mj.reference import layout as at
from inca_mj.reference.statics import rest
from inca_mj.robot.geometry import Geometry
from inca_mj.robot.parameters import GRAVITY
from inca_mj.robot.spread import at_drives, displaced

NO_FORCE = (0.0, 0.0, 0.0)


def pack(
    parameters: ParameterSet,
    geometry: Geometry,
    *,
    force: Sequence[float] = NO_FORCE,
    force_at: Sequence[float] = NO_FORCE,
) -> np.ndarray:
    """Returns the numbers q of `derivative(x, i, q)`, shape (147,).

    The drum springs balance the pretension of the parameters' start pose; `force` is not part
    of that balance, it acts from the first instant on.

    Args:
        parameters: values of the robot, and its start pose; deviations of its drives and
            displacements of its points count where they are among them.
        geometry: nominal exit points and connectors.
        force: constant external force G on the platform, in O [N].
        force_at: the point b_G where it acts, in the platform frame [m].

    Raises:
        InputError: `force` or `force_at` is not 3 finite numbers, or no rest exists at the
            start pose.
    """
    value = parameters.values()
    q = np.empty(at.NUMBERS)
    q[at.ROWS] = np.column_stack([at_drives(name, value) for name in at.EACH_DRIVE]).ravel()
    q[at.M], q[at.INERTIA] = value["m"], [value[name] for name in ("I_x", "I_y", "I_z")]
    q[at.G_EARTH] = GRAVITY
    q[at.FORCE], q[at.FORCE_AT] = _three("force", force, "N"), _three("force_at", force_at, "m")
    placed = displaced(geometry, value)
    q[at.EXITS], q[at.CONNECTORS] = placed.A.ravel(), placed.B.ravel()
    q[at.PRETENSION] = rest(parameters, geometry).tension
    return q


def _three(name: str, numbers: Sequence[float], unit: str) -> np.ndarray:
    try:
        array = np.asarray(numbers, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise InputError(f"{name} must be 3 finite numbers [{unit}], got {numbers!r}")
    return array
