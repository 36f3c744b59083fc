"""What an engineer writes first: the equations in numpy, solve_ivp, a 2-point Jacobian.

    m v̇ = -Σ T_i s_i - m g e_z,   J ω̇ = K_t i - R T + R_s F_s - b_v ω - b_c tanh(β ω)
    T = max(0, λ ε + b (ḋ - ḋ₀)),   d₀' = -R ω d₀/d,   I ω̇_P = -Σ b_i × T_i s_i - ω_P × I ω_P

States: p, v (both in O), roll-pitch-yaw, body rates, φ, ω, d₀; the symbols are the thesis'.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.integrate import solve_ivp

from inca_mj.kinematics.rotations import rotation
from inca_mj.robot.geometry import INCA
from inca_mj.robot.parameters import GRAVITY
from inca_mj.twin.statics import start_from

TOLERANCE = 1e-6  # relative, of solve_ivp


def rates(t: float, x: np.ndarray, u: np.ndarray, h: float, q: Mapping, T_0: np.ndarray):
    """ẋ of the robot under currents u (n, 8), each held for h."""
    v, (φ, θ, _), w = x[3:6], x[6:9], x[9:12]
    angle, speed, d_0 = x[12:20], x[20:28], x[28:36]
    A = rotation(*x[6:9])
    arm = INCA.B @ A.T
    span = x[:3] + arm - INCA.A
    d = np.linalg.norm(span, axis=1)
    s = span / d[:, None]
    d_0_rate = -q["R"] * speed * d_0 / d
    d_rate = (s * (v + np.cross(A @ w, arm))).sum(1)
    T = np.maximum(0, q["lambda"] * (d - d_0) / d_0 + q["b"] * (d_rate - d_0_rate))
    inertia = np.array([q["I_x"], q["I_y"], q["I_z"]])
    torque = -A.T @ np.cross(arm, T[:, None] * s).sum(0) - np.cross(w, inertia * w)
    turn = np.array(
        [
            [1, np.sin(φ) * np.tan(θ), np.cos(φ) * np.tan(θ)],
            [0, np.cos(φ), -np.sin(φ)],
            [0, np.sin(φ) / np.cos(θ), np.cos(φ) / np.cos(θ)],
        ]
    )
    spring = np.maximum(0, q["R"] / q["R_s"] * T_0 - q["k_s"] * q["R_s"] * angle)
    current = u[min(int(t / h + 1e-9), len(u) - 1)]
    motor = q["K_t"] * current - q["R"] * T + q["R_s"] * spring
    friction = q["b_v"] * speed + q["b_c"] * np.tanh(q["beta"] * speed)
    fall = np.array([0, 0, -GRAVITY])
    return np.concatenate(
        [v, -(T @ s) / q["m"] + fall, turn @ w, torque / inertia,
         speed, (motor - friction) / q["J"], d_0_rate]
    )  # fmt: skip


def predict(values: Mapping[str, float], currents: np.ndarray, h: float) -> np.ndarray:
    """Motor angles (n, 8) [rad] under currents (n, 8) [A], one sample each h [s]."""
    begin = start_from(values, INCA)
    x = np.zeros(36)
    x[:3], x[6:9], x[28:] = begin.pose[:3], begin.pose[3:], begin.no_load_length
    clock = np.arange(len(currents)) * h
    solved = solve_ivp(
        rates, clock[[0, -1]], x, t_eval=clock, args=(currents, h, values, begin.tension),
        rtol=TOLERANCE, atol=1e-3 * TOLERANCE, max_step=h,
    )  # fmt: skip
    return solved.y[12:20].T
