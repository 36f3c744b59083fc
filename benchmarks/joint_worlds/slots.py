"""The numbers of a joint, columns of an array of shape (n joints, SLOTS), and what compiles them.

Every number of an effect is zero where the effect is absent; a limit of the input is infinite.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from identification.runtime.kept_code import kept_code

compiled = kept_code(Path(__file__).parent)
# friction that holds: stiffness and damping of the contact, then what the largest friction is of
STIFF, DAMP = 0, 1
COULOMB, UNEVEN, PEAK, PEAK_SPEED, PEAK_POWER, LOAD = 2, 3, 4, 5, 6, 7
GRIP_COS, GRIP_SIN, GRIP_WAVES = 8, 9, 10
# forces
VISCOUS, UNEVEN_VISCOUS, SQUARE, ROOT, ROOT_POWER, CUBE, PUSH = 11, 12, 13, 14, 15, 16, 17
COG_COS, COG_SIN, COG_WAVES = 18, 19, 20
# the input on its way to the joint
DELAY, LAG, LIMIT, SAG = 21, 22, 23, 24
# the angle on its way into the log
SHIFT, SCALE, OFF_COS, OFF_SIN = 25, 26, 27, 28
WEAK, ZERO = 29, 30  # a drive that weakens with its force; an offset of the angle
GIVE = 31  # compliance of friction that gives before it slips
# forces that are in no catalogue (`unlisted`)
BUMP, BUMP_PLACE, BUMP_WIDTH, STOP, STOP_PLACE, FAST, FAST_SPEED = 32, 33, 34, 35, 36, 37, 38
BESIDE, BESIDE_WAVES, BESIDE_PHASE, DRAG, RIPPLE, RIPPLE_WAVES = 39, 40, 41, 42, 43, 44
FLOAT = 45  # share of gravity that the drive takes away
SLOTS = 46


def plain_joints(n: int) -> np.ndarray:
    """Joints without any effect, shape (n, SLOTS)."""
    joints = np.zeros((n, SLOTS))
    joints[:, [PEAK_SPEED, PEAK_POWER, ROOT_POWER, GRIP_WAVES, COG_WAVES]] = 1.0
    joints[:, LIMIT] = np.inf
    return joints
