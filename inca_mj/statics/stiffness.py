"""Stiffness with which the cables hold the platform, and modes in which it would swing.

With x = (δp, δθ) a small displacement and turn in O, and f the wrench on the platform, δf = −K x.
J = [s_iᵀ, (r_i × s_i)ᵀ], A_i = [1, −[r_i]×] the displacement of a connector, P_i = 1 − s_i s_iᵀ:

    K = Jᵀ diag(k) J                                          cables that stretch
        + Σ T_i A_iᵀ (P_i/d_i) A_i + Σ T_i [0, 0; 0, [s_i]× [r_i]×]        cables that turn

    k_i = λ/d₀                          drums locked
    k_i = 1/(d₀/λ + R/κ)                drums free, against their springs (see `robot.pull`)

K is symmetric at an equilibrium without external torque (Behzadipour, Khajepour 2006, Stiffness of
cable-based parallel manipulators). Forces and torques cannot be compared, so K as a whole has no
eigenvectors that mean anything. What has a meaning: the stiffness against a force while the
platform may turn, against a torque while it may move, and, with the mass matrix M, its modes,

    K_pp − K_pθ K_θθ⁻¹ K_θp [N/m],   K_θθ − K_θp K_pp⁻¹ K_pθ [N m/rad],   K x = ω² M x.

Modes with free drums need the inertia of the drums too (`with_drums`): J/R² = 0.26 kg is more than
the platform has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from identification.errors import InputError
from inca_mj.kinematics.cables import Cables
from inca_mj.kinematics.rotations import cross_matrix, pose_rotation
from inca_mj.robot.elastic import Robot

AXES = ("x", "y", "z")
SMALL = 0.15  # a part of an eigenvector that is smaller than this is not told


def stiffness(at: Cables, tension: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Returns K (..., 6, 6) [N/m, N, N m/rad] of cables with stiffness k along themselves [N/m]."""
    elastic = np.einsum("...ka,...k,...kb->...ab", at.L, k, at.L)
    return elastic + geometric_stiffness(at, tension)


def geometric_stiffness(at: Cables, tension: np.ndarray) -> np.ndarray:
    """Returns the part of K that tensions (..., 8) [N] make by turning the cables, (..., 6, 6)."""
    s, r, eye = at.directions, cross_matrix(at.arms), np.eye(3)
    A = np.concatenate([np.broadcast_to(eye, r.shape), -r], axis=-1)  # (..., 8, 3, 6)
    P = eye - s[..., :, None] * s[..., None, :]
    K = np.einsum("...k,...kia,...kij,...kjb->...ab", tension / at.lengths, A, P, A)
    K[..., 3:, 3:] += np.einsum(
        "...k,...kij,...kjl->...il", tension, cross_matrix(at.directions), r
    )
    return K


def mass_matrix(robot: Robot, pose: np.ndarray) -> np.ndarray:
    """Returns M of the platform in O about its centre of mass, shape (6, 6) [kg, kg m^2]."""
    M, R = robot.m * np.eye(6), pose_rotation(pose)
    M[3:, 3:] = R @ np.diag(robot.I) @ R.T
    return M


def with_drums(robot: Robot, at: Cables, tension: np.ndarray, no_load: np.ndarray) -> np.ndarray:
    """Returns the stiffness (14, 14) of platform and drums in (δp, δθ, φ_1 … φ_8), in SI units.

    A turn φ of a drum stretches its cable by R φ, and its spring by R_s φ. With k = λ/d₀ and K_T
    the geometric part: K = [Jᵀ k J + K_T, Jᵀ k R; R k J, R² k + κ R].
    """
    k = robot.lambda_ / no_load
    upper = at.L.T * (k * robot.R)
    drums = np.diag(robot.R**2 * k + robot.drum * robot.R)
    return np.block([[stiffness(at, tension, k), upper], [upper.T, drums]])


@dataclass(frozen=True)
class Axes:
    """Principal values of a 3 x 3 stiffness, the softest first."""

    values: np.ndarray  # shape (3,) [N/m] or [N m/rad]
    vectors: np.ndarray  # in the rows, in O, shape (3, 3), without unit
    words: tuple[str, ...]  # each in words


def principal(K: np.ndarray) -> tuple[Axes, Axes]:
    """Returns stiffness against forces (the platform may turn) and against torques (it may move).

    K (6, 6) is that of an equilibrium. Raises InputError if the platform is not held along some
    direction.
    """
    K = (K + K.T) / 2
    pp, pt, tt = K[:3, :3], K[:3, 3:], K[3:, 3:]
    if min(np.linalg.svd(part, compute_uv=False)[-1] for part in (pp, tt)) <= 0:
        raise InputError("the cables do not hold the platform along some direction here; move it")
    push, twist = pp - pt @ np.linalg.solve(tt, pt.T), tt - pt.T @ np.linalg.solve(pp, pt)
    found = []
    for part, begin in ((push, "along"), (twist, "about")):
        values, vectors = np.linalg.eigh(part)
        rows = vectors.T
        words = tuple(f"{begin} {axis_words(v)}" for v in rows)
        found.append(Axes(values, rows, words))
    return found[0], found[1]


@dataclass(frozen=True)
class Modes:
    """Modes in which the platform swings without damping, the slowest first."""

    frequency: np.ndarray  # shape (6,) [Hz]; NaN where the equilibrium is not stable
    shape: np.ndarray  # in the rows, displacement and turn, M-normalised, shape (6, n)
    words: tuple[str, ...]  # each mode in words


def modes(K: np.ndarray, M: np.ndarray, count: int = 6) -> Modes:
    """Returns the slowest modes of K x = ω² M x; the platform has the first six coordinates."""
    ω2, x = eigh((K + K.T) / 2, M)
    rows = x.T[:count]
    return Modes(hertz(ω2[:count]), rows, tuple(mode_words(row[:6], M[:6, :6]) for row in rows))


def hertz(ω2: np.ndarray) -> np.ndarray:
    """Returns frequencies [Hz] of ω² [rad²/s²]; NaN where that is not positive."""
    return np.sqrt(np.where(ω2 > 0, ω2, np.nan)) / (2 * np.pi)


def mode_words(x: np.ndarray, M: np.ndarray) -> str:
    """Returns a mode x (6,) of the platform in words, by its share in the kinetic energy."""
    moving, turning = x[:3] @ M[:3, :3] @ x[:3], x[3:] @ M[3:, 3:] @ x[3:]
    share = moving / (moving + turning)
    if share > 1 - SMALL**2:
        return f"moves along {axis_words(x[:3])}"
    if share < SMALL**2:
        return f"turns about {axis_words(x[3:])}"
    move, swing = f"moves along {axis_words(x[:3])}", f"turns about {axis_words(x[3:])}"
    return f"{move} and {swing}" if share > 0.5 else f"{swing} and {move}"


def axis_words(v: np.ndarray) -> str:
    """Returns a direction (3,) in words: "z", or "x (0.8) and y (0.6)"."""
    v = v / np.linalg.norm(v)
    order = [i for i in np.argsort(-np.abs(v), kind="stable") if abs(v[i]) > SMALL]
    if len(order) == 1:
        return AXES[order[0]]
    v = v * np.sign(v[order[0]])
    return " and ".join(f"{AXES[i]} ({v[i]:.2f})" for i in order)
