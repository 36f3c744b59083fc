"""What of an effect shows in windows, beside noise: the part that nothing else imitates.

Without any noise, the robot with the effect moves under control; its inputs are then replayed
without the effect, in windows that begin where the log says that it was. The differences e are what
the effect does. Starts of windows (X, block by block) and free parameters (Φ) may be chosen anew:

    ratio = rms((I - P) e / σ),     P: projection onto the columns of X and Φ

σ is what the true model would err by: the noise of each sensor, and what unlogged torque moves the
joint within a window whose start is chosen. A ratio of 3 raises the nominal model's error over
windows from σ to √10 σ, after every free parameter has been fitted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from joint_worlds import slots as at
from joint_worlds.motion import encoder, windows
from joint_worlds.robot import Free, JointRobot

STEP = 0.02  # of a parameter, relative, for differences
START = 3.0  # of a window's start, in σ
WINDOWS = 15  # of a record, in which it is seen what an effect does


@dataclass(frozen=True)
class Numbers:
    """A robot's numbers: of its dynamics, shape (p,), and of its joints, shape (n, SLOTS)."""

    p: np.ndarray
    joints: np.ndarray

    def moved(self, free: Free, factor: float) -> Numbers:
        """With one free parameter multiplied."""
        p, joints = self.p.copy(), self.joints.copy()
        if free.number is not None:
            p[free.number] *= factor
        if free.slot is not None:
            joints[free.slot] *= factor
        return Numbers(p, joints)


def logged(robot: JointRobot, joints: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Positions as a log has them, without noise: by encoders, and late.

    Between samples the motion is Hermite's cubic.

    Args:
        robot: the robot.
        joints: its numbers, shape (n, SLOTS).
        states: at samples, shape (N, 4, n).

    Returns:
        Shape (N, n).
    """
    h, N = robot.sampling_time, len(states)
    out = np.empty((N, robot.n))
    for i, joint in enumerate(joints):
        t = np.clip(np.arange(N) - joint[at.SHIFT] / h, 0, N - 1)
        k = np.minimum(t.astype(int), N - 2)
        s = t - k
        q, v = states[:, 0, i], states[:, 1, i] * h
        value = (
            (1 + 2 * s) * (1 - s) ** 2 * q[k] + s * (1 - s) ** 2 * v[k]
            + s**2 * (3 - 2 * s) * q[k + 1] - s**2 * (1 - s) * v[k + 1]
        )  # fmt: skip
        out[:, i] = [encoder(joint, x) for x in value]
    return out


def ratio(
    robot: JointRobot, true: Numbers, without: Numbers, free: tuple[Free, ...],
    states: np.ndarray, u: np.ndarray, push: np.ndarray,
) -> float:  # fmt: skip
    """How much of an effect shows over windows, in units of the sensors' noise.

    Args:
        robot: the robot.
        true: its numbers with the effect.
        without: and without it.
        free: parameters that a fit may choose.
        states: of a motion without noise, shape (N, 4, n).
        u: its inputs, shape (N, n).
        push: unlogged torque as a log may have it, shape (N, n).
    """
    h, length = robot.sampling_time, round(robot.horizon / robot.sampling_time)
    count = WINDOWS
    begins = np.linspace(length, len(u) - 2 * length, count).astype(int)
    y = logged(robot, true.joints, states)
    rate = (logged(robot, true.joints, states)[begins + 1] - y[begins - 1]) / (2 * h)
    starts = states[begins].copy()
    starts[:, 0], starts[:, 1], starts[:, 3] = y[begins], rate, u[begins]

    def run(numbers: Numbers, first: np.ndarray, pushed: np.ndarray | None = None) -> np.ndarray:
        out = windows(
            robot.code, numbers.p, numbers.joints, begins, first, u,
            np.zeros_like(push) if pushed is None else pushed, length, h / robot.substeps,
            robot.substeps,
        )  # fmt: skip
        return np.asarray(out)

    base = run(without, starts)
    shown = np.stack([y[b + 1 : b + 1 + length] for b in begins]) - base
    moved = run(without, starts, push) - base
    X = []
    for row in (0, 1):
        for i in range(robot.n):
            other, size = starts.copy(), START * robot.noise[i] / (robot.horizon if row else 1.0)
            other[:, row, i] += size
            X.append((run(without, other) - base).reshape(count, -1) / size)
    Phi = [(run(without.moved(f, 1 + STEP), starts) - base).reshape(count, -1) for f in free]
    bases = [np.linalg.qr(np.array([x[k] for x in X]).T)[0] for k in range(count)]

    def less_starts(columns: np.ndarray) -> np.ndarray:
        rows = columns.reshape(count, -1)
        return np.array([row - Q @ (Q.T @ row) for row, Q in zip(rows, bases, strict=True)])

    left = less_starts(moved).reshape(moved.shape)
    sigma = np.sqrt(robot.noise**2 + np.mean(left**2, axis=(0, 1)))
    scale = np.broadcast_to(1 / sigma, moved.shape).ravel()
    e = less_starts(shown).ravel() * scale
    if Phi:
        A = np.array([less_starts(column).ravel() * scale for column in Phi]).T
        A /= np.maximum(np.linalg.norm(A, axis=0), 1e-12)
        e -= A @ np.linalg.lstsq(A, e, rcond=1e-6)[0]
    return float(np.sqrt(np.mean(e**2)))
