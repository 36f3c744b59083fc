"""The thesis' 36 states, from MuJoCo's tangent space.

    MuJoCo   δx = (δp, δθ, δφ_m, δv, δω, δω_m, δd₀)   v along O, δθ a turn about the body's axes
    thesis   δz = (δp, δv_B, δe, δω, δφ_m, δω_m, δd₀)   v_B = Rᵀ v, e = (roll, pitch, yaw)

    δz = T δx:   δv_B = Rᵀ δv + v_B × δθ,   δe = J(e) δθ                             (2.1, 2.5)
    ∂ż/∂z = (T ∂ẋ/∂x + Ṫ) T⁻¹,   ∂ż/∂u = T ∂ẋ/∂u,   ∂y/∂z = ∂y/∂x T⁻¹
    Ṫ:   d(Rᵀ)/dt = -ω × Rᵀ,   v̇_B = Rᵀ v̇ - ω × v_B,   J̇ = ∂J/∂e ė

The order is that of the reference (`inca_mj.reference.layout`), whose equations the tests compare.
States of effects follow behind.

In these states the pull of a cable is the small difference of two large effects, those of d and of
d₀: where their entries are interpolated one by one, the differences are wrong, and with them the
slow modes. With the tension of each cable in the place of its no-load length,

    τ = λ (d - d₀)/d₀                                               the elastic part of T (2.31)
    δτ = (λ/d₀) ∂d/∂z δz - (λ d/d₀²) δd₀

the entries are of moderate size and what belongs together stays so: φ̇ = ω_m and ṗ = R v make the
eight zero eigenvalues exact at every point. So grids use these states.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from identification.errors import InputError
from identification.linear.operating_points import OperatingPoints
from identification.linear.system import LinearSystem
from inca_mj.kinematics.rotations import cross_matrix, euler, rotation
from inca_mj.robot.geometry import DRIVES, each_drive
from inca_mj.robot.spread import at_drives
from inca_mj.twin.twin import Twin

STATES = (
    "x", "y", "z", "vx_body", "vy_body", "vz_body", "roll", "pitch", "yaw", "wx", "wy", "wz",
    *each_drive("angle"), *each_drive("rate"), *each_drive("no_load_length"),
)  # fmt: skip
TENSIONS = each_drive("tension")
LEAST_COSINE = 1e-3  # of pitch, below which Euler angles turn too fast

# Where each quantity is in δx and in δz.
POSITION, _TURN, _ANGLE = slice(0, 3), slice(3, 6), slice(6, 14)
_V, _OMEGA, _SPEED, _ACT = slice(14, 17), slice(17, 20), slice(20, 28), 28
_V_BODY, EULER, _RATES, PLATFORM = slice(3, 6), slice(6, 9), slice(9, 12), slice(0, 12)
_ANGLES, _SPEEDS, NO_LOAD = slice(12, 20), slice(20, 28), slice(28, 36)


def to_thesis(
    systems: tuple[LinearSystem, ...], points: OperatingPoints, own: int = 0
) -> tuple[LinearSystem, ...]:
    """Returns the linear systems in the thesis' states."""
    names = (*STATES, *(f"effect_{i}_{k}" for k in range(1, DRIVES + 1) for i in range(1, own + 1)))
    return tuple(
        _one(system, points.qpos[k], own, names) for k, system in enumerate(systems)
    )  # fmt: skip


def to_tension(system: LinearSystem, lengths: LinearSystem, robot: Twin) -> LinearSystem:
    """Returns a system at rest with tensions for no-load lengths."""
    λ = at_drives("lambda", robot.parameters.values())
    d, d_0 = lengths.y, system.x[NO_LOAD]
    S = np.eye(len(system.x))
    S[NO_LOAD] = (λ / d_0)[:, None] * lengths.C
    S[NO_LOAD, NO_LOAD] -= np.diag(λ * d / d_0**2)
    back = np.linalg.inv(S)
    x = system.x.copy()
    x[NO_LOAD] = λ * (d - d_0) / d_0
    names = (*STATES[: NO_LOAD.start], *TENSIONS, *system.states[NO_LOAD.stop :])
    return replace(
        system, A=S @ system.A @ back, B=S @ system.B, C=system.C @ back, states=names, x=x,
        rate=S @ system.rate,
    )  # fmt: skip


def euler_rates(e: np.ndarray) -> np.ndarray:
    """Returns J of (2.5), [φ̇ θ̇ ψ̇]ᵀ = J ω, shape (3, 3) [-]; e = (φ, θ, ψ), shape (3,) [rad]."""
    (s, c), (cp, tp) = (np.sin(e[0]), np.cos(e[0])), (np.cos(e[1]), np.tan(e[1]))
    return np.array([[1, s * tp, c * tp], [0, c, -s], [0, s / cp, c / cp]])


def _euler_rates_change(e: np.ndarray, ė: np.ndarray) -> np.ndarray:
    """Returns J̇ = ∂J/∂φ φ̇ + ∂J/∂θ θ̇."""
    (s, c), (sp, cp) = (np.sin(e[0]), np.cos(e[0])), (np.sin(e[1]), np.cos(e[1]))
    by_roll = np.array([[0, c * sp / cp, -s * sp / cp], [0, -s, -c], [0, c / cp, -s / cp]])
    by_pitch = np.array([[0, s, c], [0, 0, 0], [0, s * sp, c * sp]]) / cp**2
    return np.asarray(by_roll * ė[0] + by_pitch * ė[1])


def _one(system: LinearSystem, qpos: np.ndarray, own: int, names: tuple[str, ...]) -> LinearSystem:
    e = euler(qpos[3:7])
    if np.cos(e[1]) < LEAST_COSINE:
        raise InputError(
            f"the platform is pitched by {np.degrees(e[1]):.4g}°, where Euler angles are singular;"
            " take another time or pose"
        )
    Rᵀ, J = rotation(*e).T, euler_rates(e)
    v, ω, v̇ = system.x[_V], system.x[_OMEGA], system.rate[_V]
    v_B = Rᵀ @ v
    v̇_B = Rᵀ @ v̇ - np.cross(ω, v_B)
    n = len(system.x)
    T, Ṫ = np.zeros((n, n)), np.zeros((n, n))
    T[POSITION, POSITION] = np.eye(3)
    T[_V_BODY, _V], T[_V_BODY, _TURN] = Rᵀ, cross_matrix(v_B)
    T[EULER, _TURN], T[_RATES, _OMEGA] = J, np.eye(3)
    T[_ANGLES, _ANGLE] = T[_SPEEDS, _SPEED] = np.eye(DRIVES)
    T[np.arange(_ACT, n), _ACT + _activations(own)] = 1
    Ṫ[_V_BODY, _V], Ṫ[_V_BODY, _TURN] = -cross_matrix(ω) @ Rᵀ, cross_matrix(v̇_B)
    Ṫ[EULER, _TURN] = _euler_rates_change(e, J @ ω)
    back = np.linalg.inv(T)
    x, rate = T @ system.x, T @ system.rate
    x[_V_BODY], x[EULER] = v_B, e
    rate[_V_BODY], rate[EULER] = v̇_B, J @ ω
    return replace(
        system, A=(T @ system.A + Ṫ) @ back, B=T @ system.B, C=system.C @ back,
        states=names, x=x, rate=rate,
    )  # fmt: skip


def _activations(own: int) -> np.ndarray:
    """Returns activations in the thesis' order: d₀ of all drives, then effects' states by drive."""
    each = np.arange(DRIVES * (1 + own)).reshape(DRIVES, 1 + own)
    return np.concatenate([each[:, 0], each[:, 1:].ravel()])
