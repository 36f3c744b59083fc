"""The inverse of a twin: the currents that make its platform move as asked, whatever is in its law.

    M a + c = f + W T                      platform: f all that is not a cable's pull
    T = argmin |T - t₀|²,  W T = M a + c - f,  low <= T <= high
    ω = -ḋ/R,   ḋ = -Wᵀ v,   ω̇ = -d̈/R      the motors wind what the cables need
    d₀:  T(d, ḋ, d₀, ω) = T                the elastic cable, solved for its no-load length
    K_t i' = J ω̇ + R T - R_s F_s + friction,   i' = i + Δi(i)

None of these terms is coded here. Each is asked of the twin's own compiled law by `mj_forward`: W
and ∂T/∂d₀ by lengthening one cable after another, R by the rate of d₀ at 1 rad/s, the torque by
what the law puts on the motors, i by what reaches the motors. So every effect of the twin that acts
in its law counts, those that a discovery has named too. Effects with states of their own are taken
at rest; a delay, a lag and errors of the encoders act outside the law and are not inverted.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.errors import InputError
from inca_mj.control.paths import Motion
from inca_mj.robot.geometry import DRIVES
from inca_mj.robot.spread import at_drives
from inca_mj.statics.tensions import distribute, nearest
from inca_mj.twin import native
from inca_mj.twin.statics import activations
from inca_mj.twin.twin import Twin

PULLED = 1e-5  # of its length, by which a cable is shortened to see what its tension does
TIGHTENINGS = 200  # steps until a slack cable is taut
# The drum springs hold the platform without current. A positive current winds the cable in, so that
# no current below zero is needed, and no current slackens a cable at rest. 2 A is the largest
# current of the thesis (Figure 2.16); it is assumed that the motors can bear it continuously.
LOWEST_CURRENT, HIGHEST_CURRENT = 0.0, 2.0  # [A]

SOLVES = 3  # Newton steps for d₀; the law is nearly linear in it
CURRENT_STEPS, CURRENT_ERROR = 30, 1e-9  # [A], of the search for the current


@dataclass(frozen=True)
class Tensions:
    """The tensions that a controlled robot should have.

    Attributes:
        near: t₀, to stay near to: above the springs' 4 N, so that all motors pull [N].
        low: least tension [N].
        high: largest tension [N].
    """

    near: float = 7.0
    low: float = 1.0
    high: float = 14.0


@dataclass(frozen=True)
class Needed:
    """The currents, tensions and rates that a motion needs."""

    currents: np.ndarray  # of the motors, shape (8,) [A]
    tension: np.ndarray  # of the cables, shape (8,) [N]
    rate: np.ndarray  # of the motors, shape (8,) [rad/s]


class Inverse:
    """The inverse of one twin.

    Args:
        robot: the twin that is inverted.
        wanted: tensions to stay near to, and their limits.
    """

    def __init__(self, robot: Twin, wanted: Tensions | None = None) -> None:
        native.install(robot.layout)
        self.robot, self.wanted = robot, wanted or Tensions()
        self._data = mujoco.MjData(robot.model)
        begin = robot.start
        self._d_0 = begin.no_load_length.copy()
        self._act = activations(begin)
        self._length = self._d_0 * (1 + begin.strain)
        first = int(robot.model.sensor("tension_1").adr[0])
        self._tension_sensors = slice(first, first + DRIVES)
        self._K_t = np.array(robot.model.actuator_gear[:DRIVES, 0])
        self._λ = at_drives("lambda", robot.parameters.values())

    def needed(
        self, motion: Motion, more: np.ndarray, angle: np.ndarray, time: float = 0.0
    ) -> Needed:
        """Returns what an upright motion needs at measured motor angles (8,) [rad] and a time [s].

        `more` is asked beside the acceleration of the motion, linear in O and angular, shape (6,)
        [m/s², rad/s²].
        """
        data, model = self._data, self.robot.model
        v = np.concatenate([motion.velocity, np.zeros(3)])
        a = np.concatenate([motion.acceleration, np.zeros(3)]) + more
        data.time = time
        data.qpos[:] = [*motion.position, 1, 0, 0, 0, *angle]
        data.qvel[:6], data.qvel[6:], data.ctrl[:] = v, 1.0, 0.0
        self._strain_as_before()
        T, force = self._pull(self._d_0)
        per_radian = data.act_dot[:: self.robot.layout.states] * (1 + T / self._λ)  # -R
        W, stiffness = self._wrench_matrix(T, force)

        ω = -(W.T @ v) / per_radian
        data.qvel[6:] = ω
        T, force = self._pull(self._d_0)
        inertial = np.zeros(model.nv)
        data.qacc[:6], data.qacc[6:] = a, (self._swing(W, v) - W.T @ a) / per_radian
        mujoco.mj_mulM(model, data, inertial, data.qacc.copy())
        inertial += data.qfrc_bias
        low, high = self._limits(
            T, self._currents(inertial[6:] - data.qfrc_passive[6:]), -per_radian
        )
        T_wanted = self._share(W, W @ T + inertial[:6] - force, low, high)
        for _ in range(SOLVES):
            self._d_0 = self._d_0 + (T - T_wanted) / stiffness
            T, _ = self._pull(self._d_0)
        return Needed(
            currents=self._currents(inertial[6:] - data.qfrc_passive[6:]), tension=T, rate=ω
        )

    def _limits(
        self, T: np.ndarray, currents: np.ndarray, R: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns tension limits (8,) [N] of the amplifiers; T at `currents`, dT/di = K_t/R."""
        slope, wanted = self._K_t / R, self.wanted
        low = np.maximum(wanted.low, T + (LOWEST_CURRENT - currents) * slope)
        high = np.minimum(wanted.high, T + (HIGHEST_CURRENT - currents) * slope)
        return low, np.maximum(low, high)

    def _strain_as_before(self) -> None:
        """Sets no-load lengths for the new pose that strain the cables as before, or until taut."""
        data, model = self._data, self.robot.model
        mujoco.mj_fwdPosition(model, data)
        self._d_0 = self._d_0 * (data.ten_length / self._length)
        self._length = data.ten_length.copy()
        for _ in range(TIGHTENINGS):
            slack = self._pull(self._d_0)[0] < self.wanted.low
            if not slack.any():
                return
            self._d_0 = np.where(slack, self._d_0 * (1 - self.wanted.near / self._λ), self._d_0)

    def _share(self, W: np.ndarray, w: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Returns tensions (8,) [N] of a wrench; if none exist, the nearest, cut to the limits."""
        try:
            return distribute(W, w, low, high, self.wanted.near)
        except InputError:
            return np.clip(nearest(W, w, self.wanted.near), low, high)

    def _pull(self, d_0: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns tensions (8,) [N] and all that acts on the platform (6,) at no-load lengths."""
        data = self._data
        data.act[:] = self._act
        data.act[:: self.robot.layout.states] = d_0
        mujoco.mj_forward(self.robot.model, data)
        return data.sensordata[self._tension_sensors].copy(), data.qfrc_passive[:6].copy()

    def _wrench_matrix(self, T: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns ∂(wrench)/∂T, shape (6, 8), and -∂T/∂d₀, shape (8,) [N/m]."""
        W, stiffness = np.empty((6, DRIVES)), np.empty(DRIVES)
        for k in range(DRIVES):
            d_0 = self._d_0.copy()
            d_0[k] *= 1 - PULLED
            pulled, moved = self._pull(d_0)
            W[:, k] = (moved - force) / (pulled[k] - T[k])
            stiffness[k] = (pulled[k] - T[k]) / (self._d_0[k] * PULLED)
        return W, stiffness

    def _swing(self, W: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Returns the part of d̈ due to the cables' turning, shape (8,) [m/s²] (thesis 2.18).

        (v_bx² + v_by²)/d: the velocity across the cable.
        """
        along = W[:3].T @ v[:3]
        return (v[:3] @ v[:3] - along**2) / self._d_0

    def _currents(self, torque: np.ndarray) -> np.ndarray:
        """Returns the currents (8,) [A] that give torques (8,) [N m] to the motors."""
        data, model = self._data, self.robot.model
        currents = torque / self._K_t
        for _ in range(CURRENT_STEPS):
            data.ctrl[:] = currents
            mujoco.mj_fwdActuation(model, data)
            step = (torque - data.qfrc_actuator[6:]) / self._K_t
            currents = currents + step
            if np.abs(step).max() < CURRENT_ERROR:
                break
        return currents
