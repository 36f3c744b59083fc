"""What the pendulum's records show by inverse dynamics, before any model is believed.

    τ(t - δ) = J q̈ + F_v q̇ + F_c tanh(q̇/v₀) + g m l sin q - f_0       J = m l² + J_a

Both sides are compared below a frequency of `BANDS`: above the first of them arm and drive vibrate
against each other, and a shift is that vibration's. δ > 0 where the motion is stamped later than
the torque that made it.

Physics comes from two records whose torques are trajectories, with a shift for each. Under energy
shaping and sequential action control the torque is ±0.9 N m by the sign of the speed; a regression
of that torque on Coulomb friction finds the controller, so those records give no physics.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from robots.inverse_dynamics import smoothed
from robots.pendulum import CONFIRM, FIT, HEAVY, LENGTH, UNTOUCHED, read_columns

BANDS = (3.0, 8.0)  # [Hz]; physics is that of the first
STEP = 0.005  # of the grid [s]
G = 9.81  # [m/s^2]
SLOW = 0.1  # v₀ [rad/s]
SHIFTS = np.arange(-0.06, 0.0801, 0.002)  # δ [s]
TRAJECTORIES = ("ddp", "direct_collocation")
NAMES = ("J", "m l", "F_v", "F_c", "f_0")


def balance(path: Path, band: float) -> tuple[np.ndarray, np.ndarray]:
    """Filtered columns of J, m l, F_v, F_c, f_0, shape (n, 5), and torques by shift, (S, n)."""
    time, angle, _, torque = read_columns(path).T
    row = time <= UNTOUCHED.get(path.stem, np.inf)
    motion = smoothed(time[row], angle[row, None], torque[row, None], STEP)
    q, v, a = motion.q[:, 0], motion.v[:, 0], motion.a[:, 0]
    columns = (a, G * np.sin(q), v, np.tanh(v / SLOW), -np.ones_like(q))
    t = time[0] + STEP * np.arange(len(q))
    shifted = np.column_stack([np.interp(t - d, time, torque) for d in SHIFTS])
    return motion.low(np.column_stack(columns), band), motion.low(shifted, band).T


def physics(folder: Path, band: float) -> np.ndarray:
    """J, m l, F_v, F_c, f_0 of the records with trajectories, each record with its best shift."""
    each = [balance(folder / f"{name}.csv", band) for name in TRAJECTORIES]
    shift = [int(np.argmin(np.abs(SHIFTS)))] * len(each)
    x = np.zeros(len(NAMES))
    for _ in range(5):
        A = np.concatenate([a for a, _ in each])
        b = np.concatenate([t[k] for (_, t), k in zip(each, shift, strict=True)])
        x = np.linalg.lstsq(A, b, rcond=None)[0]
        shift = [int(np.argmin(np.mean((t - a @ x) ** 2, axis=1))) for a, t in each]
    return x


def evidence(folder: Path) -> dict[str, Any]:
    """Shifts and torque residuals by record, and what the mass at the end of the arm does.

    Returns:
        `physics`: J, m l and frictions; `records`: by frequency and name the rms torque, what is
        left at a shift of zero and at the best one [N m], and that shift [ms]; `heavy`: J and m l
        of the record with 1 kg, the frictions being those of the others.
    """
    x = physics(folder, BANDS[0])
    rows: dict[str, Any] = {f"{band:g} Hz": {} for band in BANDS}
    heavy: dict[str, float] = {}
    for band in BANDS:
        for name in (*FIT, *CONFIRM, HEAVY):
            A, torques = balance(folder / f"{name}.csv", band)
            own = x
            if name == HEAVY:
                own = _inertia(A, torques, x)
                heavy = heavy or dict(zip(NAMES[:2], own[:2].tolist(), strict=True))
            left = np.sqrt(np.mean((torques - A @ own) ** 2, axis=1))
            k, zero = int(np.argmin(left)), int(np.argmin(np.abs(SHIFTS)))
            rows[f"{band:g} Hz"][name] = {
                "torque": float(np.sqrt(np.mean(torques[zero] ** 2))), "left": float(left[zero]),
                "left_shifted": float(left[k]), "shift_ms": round(1e3 * float(SHIFTS[k])),
            }  # fmt: skip
    return {
        "physics": dict(zip(NAMES, x.tolist(), strict=True)), "records": rows, "heavy": heavy,
        "nominal": {"J": 0.5 * LENGTH**2, "m l": 0.5 * LENGTH},
    }  # fmt: skip


def _inertia(A: np.ndarray, torques: np.ndarray, x: np.ndarray) -> np.ndarray:
    """J and m l of a record whose friction is known, by its best shift; and that friction."""
    found = []
    for torque in torques:
        own = np.linalg.lstsq(A[:, :2], torque - A[:, 2:] @ x[2:], rcond=None)[0]
        every = np.concatenate([own, x[2:]])
        found.append((float(np.mean((torque - A @ every) ** 2)), every))
    return min(found, key=lambda pair: pair[0])[1]
