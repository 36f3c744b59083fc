"""Record the two logs of the elbow, from equations that share nothing with MuJoCo.

    J q'' = K i - m g r sin q - d q' - f,     J = I + m r²,     |f| ≤ f_c against the motion

The robot is heavier than its drawing, has less damping, and has dry friction, which the drawing
does not have. Run it: python examples/elbow/record.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np

MASS, ARM, INERTIA = 1.35, 0.2, 0.012  # [kg], [m], [kg m^2]; the drawing says 1.2 kg
DAMPING = 0.24  # [N m s/rad]; the drawing says 0.3
FRICTION = 0.15  # f_c [N m]; the drawing says nothing
TORQUE = 0.5  # K [N m/A]
COUNTS, NOISE = 4096, 1e-3  # of the encoder in a turn; std of its other noise [rad]
SAMPLING, STEP = 0.01, 1e-4  # [s]


def swing(current):
    """Angles [rad] of the elbow, shape (N,), under currents [A] that are held, shape (N,).

    A step of dry friction takes away at most the speed that is there (implicit Euler), so that
    the joint rests where the other torques are smaller than f_c.
    """
    inertia = INERTIA + MASS * ARM**2
    angle = speed = 0.0
    angles = []
    for i in current:
        angles.append(angle)
        for _ in range(round(SAMPLING / STEP)):
            torque = TORQUE * i - MASS * 9.81 * ARM * np.sin(angle) - DAMPING * speed
            wanted = speed + STEP * torque / inertia
            slowed = max(0.0, abs(wanted) - STEP * FRICTION / inertia)
            speed = slowed if wanted > 0 else -slowed
            angle += STEP * speed
    return np.array(angles)


def record(seed, seconds=12.0):
    """One log: times [s], currents [A] and angles as the encoder tells them [rad], shape (N, 3)."""
    chance = np.random.default_rng(seed)
    time = np.arange(round(seconds / SAMPLING)) * SAMPLING
    frequency, phase = chance.uniform(0.1, 2.0, 6), chance.uniform(0, 2 * np.pi, 6)
    current = np.cos(2 * np.pi * frequency * time[:, None] + phase).sum(1) * 1.2
    current = np.round(current, 3)
    count = 2 * np.pi / COUNTS
    angle = swing(current) + NOISE * chance.standard_normal(len(time))
    return np.column_stack([time, current, np.round(angle / count) * count])


def write(folder):
    """Write both logs into a folder."""
    for name, seed in (("first", 1), ("second", 3)):
        np.savetxt(
            Path(folder) / f"{name}.csv", record(seed), "%.6g", ",", header="time,current,angle",
            comments="",
        )  # fmt: skip


if __name__ == "__main__":
    write(sys.argv[1])
