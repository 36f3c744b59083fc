"""The range in which the massless straight line is good enough: its errors over ρ, T and pose.

What a line without mass gets wrong, for a cable that has the tension T at its connector:

    length      d₀ of the straight line − d₀ of the catenary, as an angle of the drum: Δd₀/R force
    of the catenary on the connector, against −T s of the line, and against −T s with half of the
                cable's weight (`cable_weight` of the twin)
    stiffness   λ_eq/λ by Ernst

A log of angles with white noise σ shows an error of length where it exceeds σ, here 0.5 mrad on a
roller of 17.5 mm, which are 8.8 µm of cable. An error of force moves the platform: with free drums
it moves where the springs of the drums take the force, δx = K⁻¹ δw, and the drums turn by s_i·δx/R.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inca_mj.kinematics.cables import inverse
from inca_mj.robot.elastic import Robot
from inca_mj.robot.parameters import GRAVITY
from inca_mj.statics.catenary import ernst_modulus, pulled, sag
from inca_mj.statics.robot import pull
from inca_mj.statics.stiffness import stiffness

NOISE = 5e-4  # std of the noise on a motor angle [rad]
RHO = (3e-4, 1e-3, 3e-3)  # a polymer braid, a thin and a thick steel rope [kg/m]
TENSION = (1.0, 4.0, 16.0)  # [N]


@dataclass(frozen=True, kw_only=True)
class LineError:
    """Errors of the massless straight line at one pose, the worst of the eight cables."""

    pose: np.ndarray  # x, y, z [m], roll, pitch, yaw [rad], shape (6,)
    rho: float  # mass per length [kg/m]
    tension: float  # of every cable at its connector [N]
    length: float  # difference of the unstrained lengths [m]
    angle: float  # the same as an angle of the drum [rad]
    force: float  # difference of the forces on the connector, without any weight of the cable [N]
    force_half: float  # the same where half of the cable's weight hangs on the connector [N]
    sag: float  # of the cable below the middle of its chord, by Irvine's parabola [m]
    stiffness_lost: float  # 1 − λ_eq/λ by Ernst
    moved: float  # how far the weight of all cables moves the platform against free drums [m]
    moved_angle: float  # the largest turn of a drum by that [rad]

    @property
    def line_is_enough(self) -> bool:
        """Tells whether the lengths of the line are right to the noise: weight may be missing."""
        return self.angle < NOISE

    @property
    def massless_is_enough(self) -> bool:
        """Tells whether neither sag nor weight of the cables shows in the angles at rest."""
        return self.line_is_enough and self.moved_angle < NOISE


def line_errors(
    robot: Robot,
    poses: np.ndarray,
    rho: Sequence[float] = RHO,
    tension: Sequence[float] = TENSION,
) -> tuple[LineError, ...]:
    """Returns the errors over masses `rho` [kg/m], tensions at the connectors [N] and poses (N, 6).

    Raises InputError if a cable has no length at a pose, or cannot hang with so little tension.
    """
    return tuple(
        _line_error(robot, pose, mass, T)
        for mass in rho
        for T in tension
        for pose in np.atleast_2d(poses)
    )


def _line_error(robot: Robot, pose: np.ndarray, rho: float, T: float) -> LineError:
    at = inverse(pose, robot.geometry)
    B = pose[:3] + at.arms
    length, force, half, lost = (np.empty(len(at.lengths)) for _ in range(4))
    weight = np.zeros(6)
    for k, (A, d, λ) in enumerate(zip(robot.geometry.A, at.lengths, robot.lambda_, strict=True)):
        cable = pulled(A, B[k], T, rho, λ)
        straight, F = λ * d / (λ + T), cable.force_on_connector()
        hanging = np.array([0, 0, -rho * GRAVITY * d / 2])
        along = -T * at.directions[k]
        length[k], force[k] = cable.no_load - straight, np.linalg.norm(F - along)
        # with the half weight the tension of the line is that of the middle of the cable
        middle = float(cable.tension(cable.no_load / 2))
        half[k] = np.linalg.norm(F - (-middle * at.directions[k] + hanging))
        span = float(np.linalg.norm((B[k] - A)[:2]))
        lost[k] = 1 - ernst_modulus(span, T, rho, λ) / λ
        weight += np.concatenate([hanging, np.cross(at.arms[k], hanging)])
    free = pull(robot, at.lengths)
    δ = np.linalg.solve(stiffness(at, free.tension, free.stiffness), weight)
    turned = np.abs(-at.W.T @ δ) / robot.R
    worst = int(np.abs(length).argmax())
    return LineError(
        pose=pose,
        rho=rho,
        tension=T,
        length=float(abs(length[worst])),
        angle=float((np.abs(length) / robot.R).max()),
        force=float(force.max()),
        force_half=float(half.max()),
        sag=sag(float(at.lengths.max()), T, rho),
        stiffness_lost=float(lost.max()),
        moved=float(np.linalg.norm(δ[:3])),
        moved_angle=float(turned.max()),
    )
