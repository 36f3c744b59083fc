"""The numbers of value sets, written into copies of a model."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from identification.model.protocol import Numbers
from identification.model.rollout import UNDERIVED


def with_numbers(model: mujoco.MjModel, numbers: Numbers, row: int) -> mujoco.MjModel:
    """A copy of a model with the numbers of one value set.

    Args:
        model: the model.
        numbers: slots and their values, one for each value set.
        row: which value set.
    """
    return _written(model, numbers, range(len(numbers)), row)[0]


def each_with_numbers(
    model: mujoco.MjModel, numbers: Numbers, like: int, rows: Sequence[int]
) -> Iterator[tuple[mujoco.MjModel, bool]]:
    """Copies of a model that has the numbers of one value set, each with those of another.

    Args:
        model: the model.
        numbers: slots and their values, one for each value set.
        like: the value set that the model has already; only what differs from it is written.
        rows: the value sets.

    Yields:
        A copy, and whether a number differs from which MuJoCo derives others (see `UNDERIVED`).
    """
    every = np.array([values for _, values in numbers]).reshape(len(numbers), -1)
    for row in rows:
        yield _written(model, numbers, np.flatnonzero(every[:, row] != every[:, like]), row)


def _written(
    model: mujoco.MjModel, numbers: Numbers, places: Sequence[int] | np.ndarray, row: int
) -> tuple[mujoco.MjModel, bool]:
    out, is_derived = copy.copy(model), False
    for place in places:
        slot, values = numbers[place]
        getattr(out, slot.field)[slot.index()] = values[row]
        is_derived |= slot.field not in UNDERIVED
    if is_derived:
        mujoco.mj_setConst(out, mujoco.MjData(out))
    return out, is_derived
