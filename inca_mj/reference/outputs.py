"""What a state of the equations tells: cables and accelerations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inca_mj.reference import layout as at
from inca_mj.reference.equations import cables, derivative
from inca_mj.reference.kinematics import rotation


@dataclass(frozen=True, kw_only=True)
class Outputs:
    """Cables and accelerations at one state."""

    tension: np.ndarray  # T, shape (8,) [N]
    length: np.ndarray  # d, shape (8,) [m]
    length_rate: np.ndarray  # ḋ, shape (8,) [m/s]
    no_load_rate: np.ndarray  # ḋ₀, shape (8,) [m/s]
    acceleration: np.ndarray  # p̈ = R_AB (v̇ + ω × v) of the platform, along O, shape (3,) [m/s^2]
    # ω̇ of the platform, along its body axes, shape (3,) [rad/s^2]
    angular_acceleration: np.ndarray
    motor_acceleration: np.ndarray  # ω̇_m, shape (8,) [rad/s^2]


def outputs(x: np.ndarray, i: np.ndarray, q: np.ndarray) -> Outputs:
    """Returns the outputs at a state.

    Args:
        x: state, shape (36,).
        i: currents, shape (8,) [A].
        q: packed numbers, from `pack`.
    """
    T, d, d_rate, d_0_rate, _ = cables(x, q)
    rate = derivative(x, i, q)
    R_AB = rotation(x[at.EULER])
    return Outputs(
        tension=T,
        length=d,
        length_rate=d_rate,
        no_load_rate=d_0_rate,
        acceleration=R_AB @ (rate[at.VELOCITY] + np.cross(x[at.RATES], x[at.VELOCITY])),
        angular_acceleration=rate[at.RATES],
        motor_acceleration=rate[at.SPEEDS],
    )
