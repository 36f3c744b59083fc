"""What the steps of a simulation do to estimates, in a sentence that says what to do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from identification.prediction.model import WindowModel
from identification.prediction.step_shift import FINER
from identification.quantities import held, quantity
from identification.windows.coarse import own_step

MOVED = 1.0  # std: a value that moves by less is within what its std tells
SHOWN = 3  # values that are told, those that move most first


def step_sentences(model: WindowModel, words: Mapping[str, str] | None = None) -> list[str]:
    """A sentence on the values that finer steps would move beyond their std; none without such.

    Args:
        model: fitted.
        words: what to call the values by name; their names when None.
    """
    words, std = words or {}, model.told_std
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = {n: abs(shift) / np.float64(std[n]) for n, shift in model.step_shift.items()}
    far = sorted((n for n, m in moved.items() if m > MOVED), key=lambda n: -moved[n])
    if not far:
        return []
    told = ", ".join(f"{words.get(n, n)} by {held(moved[n])} std" for n in far[:SHOWN])
    more = f" and {len(far) - SHOWN} more" if len(far) > SHOWN else ""
    step = own_step(model.plant)
    return [
        f"The steps of the simulation move {told}{more}, which the std do not know: where such"
        f" digits matter, search at the end once more with a timestep of"
        f" {quantity(step / FINER, unit='s')} or less in the model's <option> (it has"
        f" {quantity(step, unit='s')})."
    ]
