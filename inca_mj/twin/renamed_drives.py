"""Angles and currents that bear the numbers of other drives together, as in reverse order.

Each current still moves its own angle, so that signs and cosines tell nothing. What tells is where
the cables are: only in the right order do eight angles belong to poses of the platform
(`inca_mj.twin.agreement`). The frame is symmetric, and eight orders are alike in that; a free
run of the twin under each decides between them, as far as the start and the load are not symmetric
too. A log is refused only if both say the same. 90 right logs of robots as built (worlds 33000 to
33089) are not; of 14 in reverse or cycled order (worlds 33007 to 33087) all are.

    κ' <= κ/10,    γ' <= γ/3,    ε_k <= 0.2 for every angle

γ may fall less than where it is the only witness (`inca_mj.twin.other_currents`).
"""

from __future__ import annotations

import numpy as np

from identification import Log
from identification.logs.readings import Reading
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.agreement import angles_under, likely_orders, some, unreached_share
from inca_mj.twin.bounds import BOUNDS
from inca_mj.twin.other_currents import apart, is_right
from inca_mj.twin.rewired import Places, rewired
from inca_mj.twin.twin import Twin


def renamed_drives(plant: Twin, part: Log, predicted: np.ndarray) -> tuple[Reading, str] | None:
    """Returns another order of the drives under which the twin moves as the log.

    Args:
        plant: the twin.
        part: the first motion, n samples of all eight angles.
        predicted: the twin's angles under the currents as they are read, shape (n, 8) [rad].

    Returns:
        The reading, and what tells it; None where there is no such order. Of orders that are about
        as near, it is the one that changes fewest drives.
    """
    own, y = apart(part, predicted), some(part.outputs)
    share = float(unreached_share(plant, y[None])[0])
    orders = likely_orders(plant, y, BOUNDS.max_orders)
    shares = unreached_share(plant, np.moveaxis(y[:, orders], 1, 0))
    first = np.argsort(shares, kind="stable")[: BOUNDS.max_simulated]
    close = [k for k in first.tolist() if shares[k] <= BOUNDS.closer * share]
    if not close:
        return None
    places = [np.eye(DRIVES)[orders[k]] for k in close]
    every = angles_under(plant, part, np.stack([part.inputs @ P.T for P in places]))
    found: list[tuple[float, int, int, Reading]] = []
    for k, P, angles in zip(close, places, every, strict=True):
        if not np.isfinite(angles).all():
            continue
        reading = rewired(part, Places(P, P))
        left = apart(reading.log, angles)
        if left <= BOUNDS.nearer_renamed * own and is_right(reading.log, angles):
            found.append((left, int(np.sum(orders[k] != np.arange(DRIVES))), k, reading))
    if not found:
        return None
    as_near = [each for each in found if each[0] <= BOUNDS.nearly * min(each[0] for each in found)]
    left, _, k, reading = min(as_near, key=lambda each: (each[1], each[0]))
    before, after = (100 * max(0.0, 1 - γ) for γ in (own, left))
    moved = [str(m + 1) for m in np.flatnonzero(orders[k] != np.arange(DRIVES))]
    others = f" (so they do in {len(as_near)} orders, since the robot is symmetric)"
    return reading, (
        f"explains {before:.0f} % of the motion, and {after:.0f} % were the drives"
        f" {', '.join(moved)} numbered in another order, in which the angles also fit the cables of"
        f" one platform {share / shares[k]:.0f} times as well"
        f"{others if len(as_near) > 1 else ''}; {reading.cure}"
    )
