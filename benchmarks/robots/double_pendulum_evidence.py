"""What the double pendulum's records show by inverse dynamics: does the torque explain the motion?

    τ = M(q) q̈ + C q̇ + G(q) + b q̇ + c_f atan(100 q̇)         their equations, their numbers

Torques are compared joint by joint below each frequency of `BANDS`. In two records nothing is asked
of motor 1, and joint 1 moves because link 2 does: what its motion needs there, friction must give.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from robots.double_pendulum import CONFIRM, FIT, UNPOWERED, changed, published_model, read_table
from robots.inverse_dynamics import rms, smoothed, torques

BANDS = (3.0, 5.0, 8.0)  # [Hz]
STEP = 0.002  # [s]
STEEP = 100.0  # of their atan [s/rad]


def evidence(data: Path) -> dict[str, Any]:
    """Rms by frequency, record and joint [N m].

    Returns:
        `bands`: by frequency and record: `torque` as measured, `needed` by the motion without
        friction under model 2.0, and `left` of the torque by model, with the authors' friction.
    """
    models = {v: published_model(data, v) for v in ("1.0", "2.0")}
    bands: dict[str, Any] = {f"{band:g} Hz": {} for band in BANDS}
    for name in (*FIT, *CONFIRM, *UNPOWERED):
        column = read_table(data / "double_pendulum" / f"sys_id_{name}.csv")
        angles, drive = (
            np.column_stack([column[f"{what}{k}"] for k in (1, 2)])
            for what in ("pos_meas", "tau_meas")
        )
        motion = smoothed(column["time"], angles, drive, STEP)
        without = {v: torques(changed(p), motion) for v, p in models.items()}
        needed = {v: without[v] + friction(p, motion.v) for v, p in models.items()}
        for band in BANDS:
            measured = motion.low(motion.drive, band)
            bands[f"{band:g} Hz"][f"sys_id_{name}"] = {
                "torque": rms(measured), "needed": rms(motion.low(without["2.0"], band)),
                "left": {v: rms(measured - motion.low(n, band)) for v, n in needed.items()},
            }  # fmt: skip
    return {"bands": bands, "unpowered": [f"sys_id_{name}" for name in UNPOWERED]}


def friction(p: Mapping[str, float], speed: np.ndarray) -> np.ndarray:
    """The authors' friction at both joints, shape (n, 2) [N m]."""
    viscous, dry = (np.array([p[f"{what}1"], p[f"{what}2"]]) for what in ("b", "cf"))
    return viscous * speed + dry * np.arctan(STEEP * speed)
