"""The twin: a compiled MuJoCo model of the robot together with the values that made it."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np

from identification.export import write_xml
from identification.parameter import ParameterSet
from identification.paths import Slot, resolve, write
from identification.predictor import Numbers
from identification.rollout import State
from inca_mj import law, native
from inca_mj.geometry import INCA, Geometry
from inca_mj.kinematics import quaternion
from inca_mj.mjcf import TIMESTEP, build, check_inertia
from inca_mj.parameters import parameter_set
from inca_mj.statics import Start, start, start_from


@dataclass(frozen=True)
class Twin:
    """A robot that can be simulated; `build_twin()` makes one.

    Attributes:
        parameters: every number of the robot, with unit and source.
        geometry: where its cables begin and end.
        model: the compiled model; treat it as read-only.
    """

    parameters: ParameterSet
    geometry: Geometry
    model: mujoco.MjModel

    @property
    def start(self) -> Start:
        """The pretensioned start that the parameters imply."""
        return start(self.parameters, self.geometry)

    def state(self) -> State:
        """The start as a MuJoCo state."""
        return start_state(self.start)

    def with_values(self, values: Mapping[str, float]) -> Twin:
        """The twin with other values, without compiling again.

        Raises:
            InputError: a name is unknown, a value out of bounds, or the start has no pretension.
        """
        parameters = self.parameters.with_values(values)
        check_inertia(parameters.values())
        model = copy.copy(self.model)
        write_values(model, parameters)
        begin = start(parameters, self.geometry)
        model.actuator_user[:, law.T_0] = begin.tension
        state = start_state(begin)
        model.qpos0[:] = model.key("start").qpos[:] = state.qpos
        model.key("start").act[:] = state.act
        mujoco.mj_setConst(model, mujoco.MjData(model))
        return replace(self, parameters=parameters, model=model)

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Initial states and model numbers of n value sets, for `identification.Predictor`.

        The start closes the loop that the thesis could not: T(0) follows from pose and m, d₀(0)
        from T(0), pose and λ.

        Args:
            names: parameters that differ from the twin's own.
            values: their values, shape (n, p), in their units.

        Raises:
            InputError: a start has no pretension.
        """
        own = self.parameters.values()
        starts = [
            start_from({**own, **dict(zip(names, row, strict=True))}, self.geometry)
            for row in values
        ]
        tensions = np.array([begin.tension for begin in starts])
        numbers = [
            (resolve(self.model, self.parameters[name].where), column)
            for name, column in zip(names, values.T, strict=True)
            if self.parameters[name].where != "start"
        ]
        numbers += [
            (Slot("actuator_user", (i,), law.T_0), column) for i, column in enumerate(tensions.T)
        ]
        states = [start_state(begin) for begin in starts]
        rows = (np.array([getattr(s, field) for s in states]) for field in ("qpos", "qvel", "act"))
        return State(*rows), numbers

    def save(self, path: str | Path) -> Path:
        """Write the model as MJCF, exact to the last bit; returns the path."""
        spec = build(self.parameters, self.geometry)
        spec.option.timestep = self.model.opt.timestep
        return write_xml(spec, path)


def build_twin(
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    timestep: float = TIMESTEP,
) -> Twin:
    """Build and compile the robot, and install the law of its cables in this process.

    Args:
        parameters: the values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables; assumed ones by default.
        timestep: of the RK4 integrator [s].

    Raises:
        InputError: the start has no pretension, or another library holds MuJoCo's callbacks.
    """
    parameters = parameters or parameter_set()
    native.install()
    spec = build(parameters, geometry)
    spec.option.timestep = timestep
    return Twin(parameters, geometry, spec.compile())


def write_values(model: mujoco.MjModel, parameters: ParameterSet) -> None:
    """Write all model parameters into mjModel, in place; the start's follow in `Twin`."""
    for parameter in parameters:
        if parameter.where != "start":
            write(model, resolve(model, parameter.where), parameter.value)


def start_state(begin: Start) -> State:
    """A start as a MuJoCo state: qpos (15,), qvel (14,), act (8,)."""
    drives = len(begin.tension)
    qpos = np.concatenate([begin.pose[:3], quaternion(*begin.pose[3:]), np.zeros(drives)])
    return State(qpos, np.zeros(6 + drives), begin.no_load_length)
