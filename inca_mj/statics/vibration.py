"""Cables with mass swing sideways: at which frequencies, and what that does to its modes.

A taut string between two points that stand still, c = √(T/ρ), swings at

    f_n = n c/(2 d)

out of its vertical plane, and in it where n is even. In the plane, sag stretches the cable in the
modes of odd n (Irvine, Caughey 1974, The linear theory of free vibrations of a suspended cable):

    tan(ω̄/2) = ω̄/2 − (4/Λ²)(ω̄/2)³,   ω = ω̄ c/d,   Λ² = (ρ g ℓ/T)² λ/T   (short for d ≈ d_e)

The connector of a real cable moves with the platform. The sideways motion of the string is a
straight line to the moving end and N sines (Craig, Bampton 1968),

    u(s, t) = (s/d) u_B + Σ q_n sin(n π s/d)
    kinetic:  ρ d/3 of u_B,   ρ d/2 of each q_n,   −(−1)ⁿ ρ d/(n π) between u_B and q_n
    elastic:  T/d of u_B (the geometric part of K),   T n² π²/(2 d) of each q_n

in two directions of each cable; along itself the cable moves like a rod, and only ρ d/3 counts,
because its waves are far faster. So M and K of platform and cables together are finite, and
converge with N.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, eigh
from scipy.optimize import brentq

from inca_mj.kinematics.cables import Cables
from inca_mj.kinematics.rotations import cross_matrix
from inca_mj.robot.elastic import Robot
from inca_mj.robot.parameters import GRAVITY
from inca_mj.statics.stiffness import hertz, mass_matrix, stiffness

SINES = 12
STRAIGHT = 1e-9  # Λ² below which sag changes no digit that counts


def string_frequencies(d: float, tension: float, rho: float, count: int = 3) -> np.ndarray:
    """Returns f_n of a taut string of length d [m] with ends at rest, shape (count,) [Hz]."""
    return np.arange(1, count + 1) * np.sqrt(tension / rho) / (2 * d)


def irvine_parameter(span: float, tension: float, rho: float, lambda_: float) -> float:
    """Returns Irvine's Λ² = (ρ g ℓ/T)² λ/T: what sag stretches against what tension straightens."""
    return (rho * GRAVITY * span / tension) ** 2 * lambda_ / tension


def in_plane_frequency(d: float, span: float, tension: float, rho: float, lambda_: float) -> float:
    """Returns the frequency of the first symmetric mode in the vertical plane [Hz].

    Without sag it is that of the string, c/(2 d), and 2.86 times as much for a cable that sags and
    cannot stretch.
    """
    Λ2 = irvine_parameter(span, tension, rho, lambda_)
    if Λ2 < STRAIGHT:
        return float(string_frequencies(d, tension, rho, 1)[0])

    def equation(x: float) -> float:  # x = ω̄/2, tan as sin/cos: no pole between π/2 and 3π/2
        return float(Λ2 * (np.sin(x) - x * np.cos(x)) + 4 * x**3 * np.cos(x))

    x = brentq(equation, np.pi / 2, 3 * np.pi / 2, xtol=1e-13)
    return float(2 * x * np.sqrt(tension / rho) / d / (2 * np.pi))


@dataclass(frozen=True)
class Coupled:
    """The platform's modes with massless cables, and with swinging ones; drums locked."""

    massless: np.ndarray  # frequencies of the platform alone, shape (6,) [Hz]
    # frequencies where a third of each cable's mass moves with its connector, shape (6,) [Hz]:
    # right for cables that are much faster than the platform
    added: np.ndarray
    # frequencies of the modes in which the platform moves most, shape (6,) [Hz]
    coupled: np.ndarray
    share: np.ndarray  # part of the kinetic energy of each that the platform has, shape (6,)
    cables: np.ndarray  # lowest frequency of each cable between ends at rest, shape (8,) [Hz]
    # the same in the vertical plane, where sag stretches the cable, shape (8,) [Hz]
    in_plane: np.ndarray


def coupled_modes(
    robot: Robot, pose: np.ndarray, at: Cables, tension: np.ndarray, rho: float, sines: int = SINES
) -> Coupled:
    """Returns modes of platform and cables of mass rho [kg/m], with as many sines each way."""
    d_0 = robot.lambda_ * at.lengths / (robot.lambda_ + tension)
    K, M = stiffness(at, tension, robot.lambda_ / d_0), mass_matrix(robot, pose)
    K = (K + K.T) / 2
    connector = np.concatenate(
        [np.broadcast_to(np.eye(3), (len(at.lengths), 3, 3)), -cross_matrix(at.arms)], 2
    )
    heavier = M + np.einsum("k,kia,kib->ab", rho * at.lengths / 3, connector, connector)
    n = np.arange(1, sines + 1)
    masses, springs, between = [heavier], [K], []
    for d, T, s, C in zip(at.lengths, tension, at.directions, connector, strict=True):
        for across in _across(s):
            masses.append(np.diag(np.full(sines, rho * d / 2)))
            springs.append(np.diag(T * (n * np.pi) ** 2 / (2 * d)))
            between.append(np.outer(across @ C, -((-1.0) ** n) * rho * d / (n * np.pi)))
    whole, stiff = block_diag(*masses), block_diag(*springs)
    whole[:6, 6:] = np.hstack(between)
    whole[6:, :6] = whole[:6, 6:].T
    ω2, x = eigh(stiff, whole)
    share = np.clip(np.einsum("ai,ab,bi->i", x[:6], M, x[:6]), 0.0, 1.0)
    most = np.sort(np.argsort(-share)[:6])
    span = np.hypot(at.directions[:, 0], at.directions[:, 1]) * at.lengths
    each = list(zip(at.lengths, span, tension, robot.lambda_, strict=True))
    return Coupled(
        massless=hertz(eigh(K, M, eigvals_only=True)),
        added=hertz(eigh(K, heavier, eigvals_only=True)),
        coupled=hertz(ω2[most]),
        share=share[most],
        cables=np.array([string_frequencies(d, T, rho, 1)[0] for d, _, T, _ in each]),
        in_plane=np.array([in_plane_frequency(d, x, T, rho, λ) for d, x, T, λ in each]),
    )


def _across(s: np.ndarray) -> np.ndarray:
    """Returns two unit vectors that are perpendicular to s and to each other, shape (2, 3)."""
    return np.linalg.svd(s[None])[2][1:]
