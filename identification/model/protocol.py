"""The protocol of a plant: a model whose parameters can be moved, and copies with moved numbers."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Protocol, cast, runtime_checkable

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from identification.model.paths import Slot
from identification.model.rollout import UNDERIVED, State
from identification.runtime.engine import derive

FINER = 4  # an error that is proportional to the step falls by three quarters
Entries = Sequence[tuple[Slot, float]]
Numbers = Sequence[tuple[Slot, np.ndarray]]


class Plant(Protocol):
    """A model whose parameters can be moved."""

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model."""

    @property
    def parameters(self) -> ParameterSet:
        """Every parameter, with its nominal value."""

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Returns initial states (n rows) and model numbers of n value sets.

        Args:
            names: parameters that differ from the plant's own.
            values: their values, shape (n, p).
        """

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """Returns the inputs that reach the model at each step, computed from the logged inputs.

        Args:
            names: as above.
            values: as above.
            held: logged inputs at the steps of the simulation, shape (steps, nu).
            timestep: of the simulation [s].
            begun: time of the first step in the record [s].

        Returns:
            Shape (steps, nu) for all, or (n, steps, nu).
        """

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str],
        readings: np.ndarray,
    ) -> np.ndarray:  # fmt: skip
        """Returns what the sensors say, computed from what perfect ones would say.

        Args:
            names: as above.
            values: as above.
            sensors: names of the ny sensors.
            readings: what a perfect sensor would say, position and rate of its joint, and the time
                of the record, shape (4, m, samples, ny); each value set has m/n neighbouring rows.

        Returns:
            Shape (m, samples, ny).
        """


@runtime_checkable
class WithStates(Protocol):
    """A plant that may have states which no model file has, such as a motor behind a gear.

    Windows know these states, the last activations, as deviations that stay small; MuJoCo
    integrates them as they are. A plant without such states gives back what it is given.
    """

    def without_states(self) -> Plant:
        """Returns the same plant without its extra states and the effects that need them."""

    def begun(self, names: Sequence[str], values: np.ndarray, known: State) -> State:
        """Returns states as MuJoCo integrates them.

        Args:
            names: parameters that differ from the plant's own.
            values: their values, shape (n, p).
            known: as windows know them, m rows; each value set has m/n neighbouring ones.
        """

    def shown(
        self, names: Sequence[str], values: np.ndarray, run: Mapping[str, np.ndarray]
    ) -> Mapping[str, np.ndarray]:
        """Returns positions and rates as sensors see them, of m simulations (qpos, qvel, act)."""

    def first_loads(
        self, names: Sequence[str], values: np.ndarray, known: State, log: Log, starts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns the states where windows begin (W, na), and how far they may be off (na,).

        Args:
            names: as above.
            values: one value set, shape (1, p).
            known: the other states there, W rows.
            log: the record.
            starts: first sample of each window, shape (W,).
        """


def with_states(plant: Plant) -> WithStates | None:
    """Returns the plant where it has states which no model file has, else None."""
    if not _may_have_states(type(plant)):
        return None
    known = cast(WithStates, plant)
    return None if known.without_states() is plant else known


@cache
def _may_have_states(kind: type) -> bool:
    """Returns whether plants of a kind are `WithStates`; it takes as long as some steps do."""
    return issubclass(kind, WithStates)


@runtime_checkable
class Stepped(Protocol):
    """A plant whose model can be simulated with another step."""

    def with_step(self, factor: float) -> Plant:
        """Returns the same plant with another step; `factor` is the new step over the old one."""


def finer(plant: Plant) -> Plant | None:
    """Returns the plant with a quarter of its model's own step; None for one that has no other."""
    return plant.with_step(1 / FINER) if isinstance(plant, Stepped) else None


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
