"""The pose of the platform from the motor angles alone, through elastic cables.

    d₀ ← d₀ + (∂d₀/∂φ) Δφ,    ∂d₀/∂φ = -R d₀/d at the middle angle          (thesis 2.30)
    W T(d(x), d₀) + f(x) = M a + c           solved for the pose x by Newton steps
    δx = -(W k Wᵀ)⁻¹ r,   k = λ/d₀           r: the wrench that is still missing
    T = k (d - d₀)                           also below zero, where the law has a slack cable

The robot has encoders and nothing else. Each cable's no-load length follows from how far its motor
has wound it, from the start on, where the pose is known (the robot's homing). The pose is then
where the cables' pull balances gravity and the acceleration a that is asked of the platform:
forward kinematics through elastic cables at rest, with d'Alembert's force. As in
`inca_mj.control.inverse`, every term is asked of the twin's own law, so that an eccentric roller or
a pulley of the twin is taken into account. What the twin does not have makes the pose wrong, and no
feedback mends that.

A controller keeps its cables taut. Where the wound lengths say that one is slack, the twin is wrong
(half a millimetre of one length suffices), and a law that then does nothing would lose the pose.
With tensions below zero the pose is the least-squares one, weighted by stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import InputError
from inca_mj.kinematics.rotations import quaternion
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import at_drives
from inca_mj.twin import native
from inca_mj.twin.statics import activations
from inca_mj.twin.twin import Twin

SHORTENINGS, SHORTER = 500, 2e-4  # steps that make a slack cable taut, relative
STEPS, NEAR = 20, 1e-9  # Newton steps, and the last of them [m, rad]


@dataclass(frozen=True)
class Pose:
    """The pose of the platform."""

    position: np.ndarray  # in O, shape (3,) [m]
    orientation: np.ndarray  # unit quaternion w, x, y, z, shape (4,)


class Observer:
    """Follows the pose of a robot from its start, by its motor angles.

    Args:
        robot: the twin that is believed; its start is where the angles are zero.
    """

    def __init__(self, robot: Twin) -> None:
        native.install(robot.layout)
        self.robot, begin = robot, robot.start
        self._data = mujoco.MjData(robot.model)
        self._act = activations(begin)
        self._d_0 = begin.no_load_length.copy()
        self._λ = at_drives("lambda", robot.parameters.values())
        self._angle = np.zeros(DRIVES)
        self._qpos = np.concatenate([begin.pose[:3], quaternion(*begin.pose[3:])])

    def seen(self, angle: np.ndarray, acceleration: np.ndarray, time: float = 0.0) -> Pose:
        """Returns the pose after the motors have turned to new angles (8,) [rad], at a time [s].

        `acceleration` is asked of the platform, linear in O and angular, shape (6,) [m/s², rad/s²].
        Raises InputError if no pose belongs to these angles.
        """
        self._data.time = time
        self._wind(np.asarray(angle, float))
        for _ in range(STEPS):
            W, missing = self._balance(acceleration)
            stiffness = (W * (self._λ / self._d_0)) @ W.T
            step = -np.linalg.solve(stiffness, missing)
            mujoco.mj_integratePos(self.robot.model, self._data.qpos, _as_rates(step), 1.0)
            self._qpos = self._data.qpos[:7].copy()
            if np.abs(step).max() < NEAR:
                return Pose(self._qpos[:3].copy(), self._qpos[3:].copy())
        raise InputError(
            "no pose of the platform belongs to the motor angles"
            f" {np.round(self._angle, 2).tolist()} rad; check the geometry, the start pose and the"
            " sign of the angles (positive winds in)"
        )

    def _wind(self, angle: np.ndarray) -> None:
        """Wind the cables from the last angles to these."""
        turned = angle - self._angle
        self._forward((self._angle + angle) / 2, 1.0, self._d_0)
        per_radian = self._data.act_dot[:: self.robot.layout.states]
        self._d_0, self._angle = self._d_0 + per_radian * turned, angle.copy()

    def _balance(self, acceleration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns W, shape (6, 8), and the wrench that the acceleration lacks, shape (6,)."""
        data, model = self._data, self.robot.model
        taut = self._forward_taut()
        inertial = np.zeros(model.nv)
        mujoco.mj_mulM(model, data, inertial, _as_rates(acceleration))
        J = np.empty((DRIVES, model.nv))
        mujoco.mju_sparse2dense(
            J, data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind
        )
        W = -J[:, :6].T
        pushed = W @ (self._λ * (taut - self._d_0) / self._d_0)
        return W, inertial[:6] + data.qfrc_bias[:6] - data.qfrc_passive[:6] - pushed

    def _forward_taut(self) -> np.ndarray:
        """Ask the law at the pose; returns the no-load lengths (8,) [m], shorter where slack."""
        d_0, first = self._d_0, int(self.robot.model.sensor("tension_1").adr[0])
        for _ in range(SHORTENINGS):
            self._forward(self._angle, 0.0, d_0)
            slack = self._data.sensordata[first : first + DRIVES] <= 0
            if not slack.any():
                break
            d_0 = np.where(slack, d_0 * (1 - SHORTER), d_0)
        return d_0

    def _forward(self, angle: np.ndarray, rate: float, d_0: np.ndarray) -> None:
        data = self._data
        data.qpos[:7], data.qpos[7:] = self._qpos, angle
        data.qvel[:6], data.qvel[6:] = 0.0, rate
        data.act[:] = self._act
        data.act[:: self.robot.layout.states] = d_0
        mujoco.mj_forward(self.robot.model, data)


def _as_rates(platform: np.ndarray) -> np.ndarray:
    return np.concatenate([platform, np.zeros(DRIVES)])
