"""The numbers of value sets, written into copies of a model."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from identification.engine import derive
from identification.model.paths import Slot
from identification.model.protocol import Numbers
from identification.model.rollout import UNDERIVED

Entries = Sequence[tuple[Slot, float]]


def with_numbers(model: mujoco.MjModel, numbers: Numbers, row: int) -> mujoco.MjModel:
    """Returns a copy of a model with the numbers of one value set."""
    return with_entries(model, [(slot, float(values[row])) for slot, values in numbers])


def with_entries(model: mujoco.MjModel, entries: Entries) -> mujoco.MjModel:
    """Returns a copy of a model with other numbers, and with what MuJoCo derives from them."""
    out = copy.copy(model)
    for slot, value in entries:
        getattr(out, slot.field)[slot.index()] = value
    if any(slot.field not in UNDERIVED for slot, _ in entries):
        derive(out)
    return out


def list_differences(numbers: Numbers, like: int, rows: Sequence[int]) -> Iterator[Entries]:
    """Yields the entries in which value sets differ from one of them.

    Yields:
        Of each value set the entries that differ; a slot of several rows gives one entry each.
    """
    every = np.array([values for _, values in numbers]).reshape(len(numbers), -1)
    for row in rows:
        yield [
            (Slot(numbers[k][0].field, (i,), numbers[k][0].column), float(every[k, row]))
            for k in np.flatnonzero(every[:, row] != every[:, like]).tolist()
            for i in numbers[k][0].rows
        ]
