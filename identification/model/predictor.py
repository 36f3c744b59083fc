"""The predictor: parameter values in, predicted outputs out, for many value sets at once.

    ŷ(t_k, θ) = h(x(t_k)),   x(0) = x₀(θ),   ẋ = f(x, u, θ)          (thesis 3.1, free run)

A `Plant` says how parameter values become numbers of a MuJoCo model and its initial state. All
value sets of a call are simulated in one `Batch.rollout`: a Jacobian of p columns is one call with
2 p simulations.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import mujoco
import numpy as np

from identification.errors import InputError, unknown_name
from identification.logs.joined import JoinedLog, records_of
from identification.logs.log import Log
from identification.model.parameter import of_record
from identification.model.protocol import Numbers as Numbers
from identification.model.protocol import Plant as Plant
from identification.model.protocol import with_states as with_states
from identification.model.rollout import State, rollout


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
        """Returns names and values of all that differs from the plant, also the fixed ones."""
        values = np.atleast_2d(values)
        fixed = {n: v for n, v in self.fixed.items() if n not in self.names}
        rest = np.broadcast_to(list(fixed.values()), (len(values), len(fixed)))
        return (*self.names, *fixed), np.hstack([values, rest])

    def settings(self, values: np.ndarray) -> tuple[State, Numbers]:
        """Returns initial states and model numbers of n value sets (n, p), with fixed values."""
        return self.plant.settings(*self._every(values))

    def inputs(self, values: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """Returns the function from held inputs (steps, nu) to the model's inputs, for (n, p)."""
        names, every = self._every(values)
        timestep = self.plant.model.opt.timestep
        return lambda held: self.plant.inputs(names, every, held, timestep, self.log.begun)

    def begun(self, values: np.ndarray, known: State) -> State:
        """Returns states as MuJoCo integrates them, of n value sets (n, p); see `WithStates`."""
        plant = with_states(self.plant)
        return known if plant is None else plant.begun(*self._every(values), known)

    def first_loads(
        self, values: np.ndarray, known: State, starts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns the plant's states that no model file has, where windows begin; see `WithStates`.

        Raises:
            InputError: the plant has none.
        """
        plant = with_states(self.plant)
        if plant is None:
            raise InputError("the plant has no states beside those of its model")
        return plant.first_loads(*self._every(values), known, self.log, starts)

    @property
    def recorded(self) -> tuple[str, ...]:
        """The fields of the state that outputs are made of."""
        return ("qpos", "qvel") if with_states(self.plant) is None else ("qpos", "qvel", "act")

    def records(self) -> tuple[tuple[Predictor, list[int]], ...]:
        """Returns a predictor of each record of the log, and the columns of its values."""
        if not isinstance(self.log, JoinedLog):
            return ((self, [*range(len(self.names))]),)
        given = {n: v for n, v in self.fixed.items() if n not in self.names}
        out = []
        for number, log in records_of(self.log):
            columns = of_record((*self.names, *given), number)
            seen = {name: k for name, k in columns.items() if k < len(self.names)}
            known = [*given.values()]
            fixed = {n: known[k - len(self.names)] for n, k in columns.items() if n not in seen}
            out.append((replace(self, log=log, names=tuple(seen), fixed=fixed), [*seen.values()]))
        return tuple(out)

    def predict(self, values: np.ndarray, samples: int | None = None) -> np.ndarray:
        """Predicts the outputs of n value sets over the first samples of the log.

        Args:
            values: shape (n, p), in the parameters' units.
            samples: how many samples; all when None.

        Returns:
            Shape (n, samples, ny).

        Raises:
            DivergenceError: a simulation left the finite numbers.
        """
        if isinstance(self.log, JoinedLog):
            return self._predict_records(np.atleast_2d(values), samples)
        return self.outputs(values, self.simulated(values, self.recorded, samples))

    def simulated(
        self, values: np.ndarray, record: Sequence[str], samples: int | None = None
    ) -> Mapping[str, np.ndarray]:
        """Returns fields of the state along simulations of n value sets, (n, samples, size) each.

        Raises:
            DivergenceError: a simulation left the finite numbers.
        """
        log, (start, numbers) = self.log, self.settings(values)
        return rollout(
            self.plant.model, self.begun(values, start), log.inputs[:samples], log.sampling_time,
            numbers=numbers, record=record, hold_kind=log.hold, before=self.inputs(values),
            time=log.begun,
        )  # fmt: skip

    def _predict_records(self, values: np.ndarray, samples: int | None) -> np.ndarray:
        """Predicts the outputs of all records in turn, each simulated from its own start.

        Value sets that differ in values of other records only are simulated once.
        """
        out, rest = [], len(self.log) if samples is None else samples
        for predictor, columns in self.records():
            here = min(rest, len(predictor.log))
            if here > 0:
                different, which = np.unique(values[:, columns], axis=0, return_inverse=True)
                out.append(predictor.predict(different, here)[which.ravel()])
            rest -= here
        return np.concatenate(out, axis=1)

    def outputs(
        self, values: np.ndarray, states: Mapping[str, np.ndarray], begun: np.ndarray | None = None
    ) -> np.ndarray:
        """Returns what sensors say, (m, samples, ny), of simulated states, for n value sets (n, p).

        The states are what `recorded` names of m simulations, (m, samples, size); each value set
        has m/n neighbouring ones. They begin at times of the record (m,) [s], or where the log
        begins.
        """
        plant = with_states(self.plant)
        if plant is not None:
            states = plant.shown(*self._every(values), states)
        return self.said(values, self.readings(states, begun))

    def readings(
        self, states: Mapping[str, np.ndarray], begun: np.ndarray | None = None
    ) -> np.ndarray:
        """Returns what perfect sensors would say of simulated states, shape (4, m, samples, ny).

        See `Plant.outputs`, and `outputs` for the arguments.
        """
        model, sensors = self.plant.model, self.log.output_names
        joints = [int(model.sensor(name).objid[0]) for name in sensors]
        y = [states[field][:, :, i] for field, i in output_columns(model, sensors)]
        q = [states["qpos"][:, :, int(model.jnt_qposadr[j])] for j in joints]
        v = [states["qvel"][:, :, int(model.jnt_dofadr[j])] for j in joints]
        first = np.atleast_1d(self.log.begun if begun is None else begun)[:, None]
        time = first + self.log.sampling_time * np.arange(y[0].shape[1])
        times = [np.broadcast_to(time, y[0].shape)] * len(y)
        return np.stack([np.stack(part, axis=-1) for part in (y, q, v, times)])

    def said(self, values: np.ndarray, readings: np.ndarray) -> np.ndarray:
        """Returns what the plant's sensors say, for n value sets (n, p); see `Plant.outputs`."""
        return self.plant.outputs(*self._every(values), self.log.output_names, readings)


def settings_of(
    predictors: Sequence[Predictor], values: Sequence[np.ndarray]
) -> list[tuple[State, Numbers]]:
    """Returns the settings of some predictors at values of each; those that are alike at once.

    Args:
        predictors: of records, most of which share their plant and its values.
        values: shape (n, p) each.
    """
    known, out = dict[object, tuple[State, Numbers]](), []
    for predictor, here in zip(predictors, values, strict=True):
        names, every = predictor._every(here)
        key = (id(predictor.plant), names, every.shape, every.tobytes())
        if key not in known:
            known[key] = predictor.plant.settings(names, every)
        out.append(known[key])
    return out


def sensor_word(model: mujoco.MjModel, i: int) -> str:
    """Returns what MJCF calls the kind of a sensor, with its article, such as "a framequat"."""
    word = mujoco.mjtSensor(int(model.sensor_type[i])).name.removeprefix("mjSENS_").lower()
    return f"a{'n' * (word[0] in 'aeiou')} {word}"


def output_columns(model: mujoco.MjModel, names: Sequence[str]) -> list[tuple[str, int]]:
    """Returns the place of each output in the state: its field (qpos or qvel) and index."""
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
                f"sensor {name!r} is {sensor_word(model, sensors[name])}; outputs are jointpos or"
                " jointvel sensors"
            )
        columns.append((field, int(address[model.sensor_objid[sensors[name]]])))
    return columns


def measured_joints(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    """Returns the numbers of the joints whose positions are outputs, in their order."""
    return [int(np.flatnonzero(model.jnt_qposadr == i)[0])
            for field, i in output_columns(model, names) if field == "qpos"]  # fmt: skip


def output_dofs(model: mujoco.MjModel, names: Sequence[str]) -> list[int]:
    """Returns the degree of freedom whose position or rate each output is."""
    return [i if field == "qvel" else int(model.jnt_dofadr[model.jnt_qposadr == i][0])
            for field, i in output_columns(model, names)]  # fmt: skip
