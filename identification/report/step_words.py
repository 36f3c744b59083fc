"""What the steps of a simulation do to estimates, in a sentence that says what to do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.prediction.model import WindowModel
from identification.prediction.step_shift import FINER
from identification.quantities import held
from identification.windows.coarse import own_step

MOVED = 1.0  # std: a value that moves by less is within what its std tells
LOWER = 0.9  # of the error of the fitted windows: a fall below it with finer steps is told
SHOWN = 3  # values that are told, those that move most first


def step_sentences(model: WindowModel, words: Mapping[str, str] | None = None) -> list[str]:
    """A sentence on what finer steps would change beyond what is told; none without such.

    Args:
        model: fitted.
        words: what to call the values by name; their names when None.
    """
    words, std = words or {}, model.told_std
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = {n: abs(shift) / np.float64(std[n]) for n, shift in model.step_shift.items()}
    far = sorted((n for n, m in moved.items() if m > MOVED), key=lambda n: -moved[n])
    said, error = [], model.finer.error
    if far:
        told = ", ".join(f"{words.get(n, n)} by {held(moved[n])} std" for n in far[:SHOWN])
        more = f" and {len(far) - SHOWN} more" if len(far) > SHOWN else ""
        said.append(f"move {told}{more}, of which the std tell nothing")
    if error < LOWER:
        said.append(
            f"lower the error of the fitted windows to {held(error)} of what it is: that part is of"
            " the steps, and nothing that is missing"
        )
    if not said:
        return []
    finer = f"{own_step(model.plant) / FINER:.6g}"
    return [
        f"Simulations with steps of {finer} s would {', and would '.join(said)}. Where this"
        f' matters, write timestep="{finer}" into the <option> of the model, and do this once more.'
    ]
