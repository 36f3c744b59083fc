"""Inputs that a model clips: what a log says beyond the range that an actuator takes.

    u' = min(max(u, ctrlrange_0), ctrlrange_1)

A fit takes what is cut off for something that the robot lacks.
"""

from __future__ import annotations

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.quantities import quantity

LEAST = 0.01  # of an input's rms: less is cut off by the noise of a measured input at its limit


def clipped_sentence(model: mujoco.MjModel, log: Log) -> str | None:
    """Returns one sentence on the input of which most is cut off; None where none is."""
    worst, share = "", LEAST
    for name, u in zip(log.input_names, log.inputs.T, strict=True):
        actuator = model.actuator(name)
        if not actuator.ctrllimited[0]:
            continue
        low, high = map(float, actuator.ctrlrange)
        off = u - np.clip(u, low, high)
        if np.linalg.norm(off) > share * np.linalg.norm(u):
            share = float(np.linalg.norm(off) / np.linalg.norm(u))
            unit = log.units.get(name, "")
            farthest = float(u[np.argmax(np.abs(off))])
            part = f"{100 * np.mean(off != 0):.0f} %"
            worst = (
                f"Of the samples of {name!r} in log {log.name!r}, {part} lie beyond the"
                f" actuator's ctrlrange {low:g} to {high:g}, such as"
                f" {quantity(farthest, unit=unit)}, and MuJoCo clips them; widen ctrlrange in the"
                " model if they reached the robot as they were logged."
            )  # fmt: skip
    return worst or None
