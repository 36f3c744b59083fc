"""Do eight angles belong to poses of one platform, whatever moved it?

    κ = Σ_k min_x ‖d(x) - d(x₀) + R y_k‖² / Σ_k ‖R y_k‖²           share of the cables' motion

Eight cables hold a platform that has six degrees of freedom, so that two statements are left which
every sample of a right log fulfils, but for the strain of the cables. Neither currents nor masses
nor friction have a say. In 90 robots as built (worlds 33000 to 33089, 4 s, most with an effect) κ
was 1e-4 in the middle and 0.0012 at most. The same angles in reverse order had 0.003 to 0.016.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from inca_mj.kinematics.inverse_geometry import cables_at
from inca_mj.kinematics.jacobians import jacobian
from inca_mj.kinematics.rotations import rotation, turn
from inca_mj.robot.geometry import DRIVES
from inca_mj.twin.twin import Twin

STEPS = 3  # of Gauss and Newton from the pose at rest
SAMPLES = 20  # that are looked at: the platform moves on smoothly between them
SMALL = 1e-6  # added to JᵀJ, where poses without a unique motion must not stop the search


def unreached_share(plant: Twin, angles: np.ndarray) -> np.ndarray:
    """Returns κ of several logs, without unit; inf where no search ends.

    Args:
        plant: the twin, with its geometry and the pose where all angles are zero.
        angles: from the first sample on, shape (m, n, 8) [rad].

    Returns:
        Shape (m,).
    """
    wanted = -plant.parameters.values()["R"] * angles
    start = np.array(plant.start.pose, float)
    shape = angles.shape[:2]
    p = np.broadcast_to(start[:3], (*shape, 3))
    R = np.broadcast_to(rotation(*start[3:]), (*shape, 3, 3))
    there = cables_at(p, R, plant.geometry)
    goal = there.lengths + wanted
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            J = jacobian(there)
            JT = np.swapaxes(J, -1, -2)
            left = (goal - there.lengths)[..., None]
            step = np.linalg.solve(JT @ J + SMALL * np.eye(6), JT @ left)[..., 0]
            step /= np.maximum(1.0, np.linalg.norm(step, axis=-1, keepdims=True))
            p, R = p + step[..., :3], turn(step[..., 3:]) @ R
            there = cables_at(p, R, plant.geometry)
        share = np.sum((goal - there.lengths) ** 2, axis=(1, 2)) / np.sum(wanted**2, axis=(1, 2))
    return np.where(np.isfinite(share), share, np.inf)


def likely_orders(plant: Twin, angles: np.ndarray, most: int) -> np.ndarray:
    """Returns the orders of the angles that have least κ near the pose at rest, shape (most, 8).

    All 40320 orders are compared, with the slopes of the cables' lengths at rest; column k of the
    angles in an order is that of drive order[k].

    Args:
        plant: the twin.
        angles: from the first sample on, shape (n, 8) [rad].
        most: orders that are returned.
    """
    start = np.array(plant.start.pose, float)
    L = jacobian(cables_at(start[:3], rotation(*start[3:]), plant.geometry))
    no_pose = np.linalg.svd(L)[0][:, L.shape[1] :]  # what no motion of the platform does
    orders, squares = np.array([*permutations(range(DRIVES))]), angles.T @ angles
    left = np.zeros(len(orders))
    weight = no_pose @ no_pose.T
    for i in range(DRIVES):
        for j in range(DRIVES):
            left += weight[i, j] * squares[orders[:, i], orders[:, j]]
    return orders[np.argsort(left, kind="stable")[:most]]


def some(angles: np.ndarray) -> np.ndarray:
    """Returns the first samples of angles that are enough to judge κ, shape (n, 8) [rad]."""
    rows = np.linspace(0, len(angles) - 1, min(SAMPLES, len(angles))).round().astype(int)
    return angles[rows] - angles[0]
