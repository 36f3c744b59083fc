"""The numbers of one value set, written into a copy of a model."""

from __future__ import annotations

import copy

import mujoco

from identification.model.protocol import Numbers
from identification.model.rollout import UNDERIVED


def with_numbers(
    model: mujoco.MjModel, numbers: Numbers, row: int, like: int | None = None
) -> mujoco.MjModel:
    """A copy of a model with the numbers of one value set.

    Args:
        model: the model.
        numbers: slots and their values, one for each value set.
        row: which value set.
        like: a value set that the model has already; only what differs from it is written.
    """
    new = [(slot, v[row]) for slot, v in numbers if like is None or v[row] != v[like]]
    out = copy.copy(model)
    for slot, value in new:
        getattr(out, slot.field)[slot.index()] = value
    if not all(slot.field in UNDERIVED for slot, _ in new):
        mujoco.mj_setConst(out, mujoco.MjData(out))
    return out
