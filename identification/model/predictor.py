"""The predictor: parameter values in, predicted outputs out, for many value sets at once.

    ŷ(t_k, θ) = h(x(t_k)),   x(0) = x₀(θ),   ẋ = f(x, u, θ)          (thesis 3.1, free run)

A `Plant` says how parameter values become numbers of a MuJoCo model and its initial state. All
value sets of a call are simulated in one `Batch.rollout`: a Jacobian of p columns is one call with
2 p simulations.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from identification.model.paths import Slot
from identification.model.rollout import State, rollout

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
        """Initial states (n rows) and model numbers of n value sets.

        Args:
            names: parameters that differ from the plant's own.
            values: their values, shape (n, p).
        """

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """The inputs that reach the model, step by step, computed from the logged inputs.

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
        """What the sensors say, computed from what perfect ones would say.

        Args:
            names: as above.
            values: as above.
            sensors: names of the ny sensors.
            readings: what a perfect sensor would say, and position and rate of its joint, shape
                (3, m, samples, ny); each value set has m/n neighbouring rows.

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
        """The same plant without them, and without the effects that need them."""

    def begun(self, names: Sequence[str], values: np.ndarray, known: State) -> State:
        """States as MuJoCo integrates them.

        Args:
            names: parameters that differ from the plant's own.
            values: their values, shape (n, p).
            known: as windows know them, m rows; each value set has m/n neighbouring ones.
        """

    def shown(
        self, names: Sequence[str], values: np.ndarray, run: Mapping[str, np.ndarray]
    ) -> Mapping[str, np.ndarray]:
        """Positions and rates as sensors see them, of m simulations with qpos, qvel and act."""

    def first_loads(
        self, names: Sequence[str], values: np.ndarray, known: State, inputs: np.ndarray,
        sampling_time: float,
    ) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
        """The states where windows begin, shape (W, na), and how far they may be, shape (na,).

        Args:
            names: as above.
            values: one value set, shape (1, p).
            known: the other states there, W rows.
            inputs: there, shape (W, nu).
            sampling_time: [s].
        """


def with_states(plant: Plant) -> WithStates | None:
    """The plant, where it has states which no model file has."""
    if isinstance(plant, WithStates) and plant.without_states() is not plant:
        return plant
    return None


@dataclass(frozen=True)
class Predictor:
    """Predicts a log's outputs from its inputs.

    Attributes:
        plant: the model.
        log: inputs, outputs and sampling.
        names: parameters that vary.
        fixed: values of parameters that do not vary, where they differ from the plant's own.
    """

    plant: Plant
    log: Log
    names: tuple[str, ...]
    fixed: Mapping[str, float] = field(default_factory=dict)

    def _every(self, values: np.ndarray) -> tuple[tuple[str, ...], np.ndarray]:
        """Names and values of all that differs from the plant's own, the fixed ones included."""
        values = np.atleast_2d(values)
        fixed = {n: v for n, v in self.fixed.items() if n not in self.names}
        rest = np.broadcast_to(list(fixed.values()), (len(values), len(fixed)))
        return (*self.names, *fixed), np.hstack([values, rest])

    def settings(self, values: np.ndarray) -> tuple[State, Numbers]:
        """Initial states and model numbers of n value sets (n, p), the fixed values included."""
        return self.plant.settings(*self._every(values))

    def inputs(self, values: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """The function from held inputs (steps, nu) to those that reach the model, for (n, p)."""
        names, every = self._every(values)
        timestep = self.plant.model.opt.timestep
        return lambda held: self.plant.inputs(names, every, held, timestep, self.log.begun)

    def begun(self, values: np.ndarray, known: State) -> State:
        """States as MuJoCo integrates them, of n value sets (n, p); see `WithStates`."""
        plant = with_states(self.plant)
        return known if plant is None else plant.begun(*self._every(values), known)

    def first_loads(
        self, values: np.ndarray, known: State, inputs: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """States of the plant that no model file has, where windows begin; see `WithStates`.

        Raises:
            InputError: the plant has none.
        """
        plant = with_states(self.plant)
        if plant is None:
            raise InputError("the plant has no states beside those of its model")
        return plant.first_loads(*self._every(values), known, inputs, self.log.sampling_time)

    @property
    def recorded(self) -> tuple[str, ...]:
        """The fields of the state that outputs are made of."""
        return ("qpos", "qvel") if with_states(self.plant) is None else ("qpos", "qvel", "act")

    def predict(self, values: np.ndarray, samples: int | None = None) -> np.ndarray:
        """Outputs of n value sets over the first samples of the log.

        Args:
            values: shape (n, p), in the parameters' units.
            samples: how many samples; all when None.

        Returns:
            Shape (n, samples, ny).

        Raises:
            DivergenceError: a simulation left the finite numbers.
        """
        log = self.log
        start, numbers = self.settings(values)
        states = rollout(
            self.plant.model,
            self.begun(values, start),
            log.inputs[:samples],
            log.sampling_time,
            numbers=numbers,
            record=self.recorded,
            hold_kind=log.hold,
            before=self.inputs(values),
            time=log.begun,
        )
        return self.outputs(values, states)

    def outputs(self, values: np.ndarray, states: Mapping[str, np.ndarray]) -> np.ndarray:
        """What the sensors say of simulated states, for n value sets (n, p).

        Args:
            values: shape (n, p), in the parameters' units.
            states: what `recorded` names, of m simulations, shape (m, samples, size); each value
                set has m/n neighbouring ones.

        Returns:
            Shape (m, samples, ny).
        """
        model, sensors = self.plant.model, self.log.output_names
        plant = with_states(self.plant)
        if plant is not None:
            states = plant.shown(*self._every(values), states)
        columns = output_columns(model, sensors)
        joints = [int(model.sensor(name).objid[0]) for name in sensors]
        y = [states[field][:, :, i] for field, i in columns]
        q = [states["qpos"][:, :, int(model.jnt_qposadr[j])] for j in joints]
        v = [states["qvel"][:, :, int(model.jnt_dofadr[j])] for j in joints]
        readings = np.stack([np.stack(part, axis=-1) for part in (y, q, v)])
        return self.plant.outputs(*self._every(values), sensors, readings)


def output_columns(model: mujoco.MjModel, names: Sequence[str]) -> list[tuple[str, int]]:
    """Where each output stands in the state: its field (qpos or qvel) and index.

    Raises:
        InputError: a name is not a sensor of the model, or its sensor is not a joint position or
            rate.
    """
    fields = {
        int(mujoco.mjtSensor.mjSENS_JOINTPOS): ("qpos", model.jnt_qposadr),
        int(mujoco.mjtSensor.mjSENS_JOINTVEL): ("qvel", model.jnt_dofadr),
    }
    sensors = {model.sensor(i).name: i for i in range(model.nsensor)}
    columns = []
    for name in names:
        if name not in sensors:
            raise unknown_name("sensor", name, filter(None, sensors))
        field, address = fields.get(int(model.sensor_type[sensors[name]]), (None, None))
        if field is None or address is None:
            raise InputError(
                f"sensor {name!r} is no joint position or rate; an output must be a jointpos or"
                " jointvel sensor"
            )
        columns.append((field, int(address[model.sensor_objid[sensors[name]]])))
    return columns
