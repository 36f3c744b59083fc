"""The twin: a compiled MuJoCo model of the robot together with the values that made it."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import mujoco
import numpy as np

from identification.effects.effect import Effect
from identification.effects.values import changed_inputs, changed_outputs, merged
from identification.model.export import write_xml
from identification.model.parameter import ParameterSet
from identification.model.paths import Slot, write
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.runtime.engine import derive
from inca_mj.effects.hooks import THINGS, Layout
from inca_mj.effects.values import with_effects
from inca_mj.robot import law
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import TIMESTEP, parameter_set
from inca_mj.twin import native
from inca_mj.twin.mjcf import build, check_inertia
from inca_mj.twin.numbers import model_numbers
from inca_mj.twin.statics import Start, start, start_state, starts_from


@dataclass(frozen=True)
class Twin:
    """A robot that can be simulated; `build_twin()` makes one.

    Attributes:
        parameters: every number of the robot, with unit and source.
        geometry: where its cables begin and end.
        model: the compiled model; treat it as read-only.
        effects: candidate effects that are compiled into its law; absent while their sizes are 0.
        settled: see `Layout`.
    """

    parameters: ParameterSet
    geometry: Geometry
    model: mujoco.MjModel
    effects: tuple[Effect, ...] = ()
    settled: bool = False

    @cached_property
    def layout(self) -> Layout:
        """The places of the parameters of its effects in the model."""
        return Layout(self.effects, self.settled)

    @property
    def start(self) -> Start:
        """The pretensioned start that the parameters imply."""
        return start(self.parameters, self.geometry, self.layout)

    def state(self) -> State:
        """Returns the start as a MuJoCo state."""
        native.install(self.layout)
        return start_state(self.start)

    def with_values(self, values: Mapping[str, float]) -> Twin:
        """Returns the twin with other values, without compiling again.

        Raises:
            InputError: a name is unknown, a value out of bounds, or the start has no pretension.
        """
        parameters = self.parameters.with_values(values)
        check_inertia(parameters.values())
        model = copy.copy(self.model)
        write_values(model, parameters, self.geometry, self.layout)
        begin = start(parameters, self.geometry, self.layout)
        model.actuator_user[:, law.T_0] = begin.balance
        state = start_state(begin)
        model.qpos0[:] = model.key("start").qpos[:] = state.qpos
        model.key("start").act[:] = state.act
        derive(model)
        return replace(self, parameters=parameters, model=model)

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Returns initial states and model numbers of n value sets, for `identification.Predictor`.

        The start follows from the parameters, which the thesis could not achieve: T(0) follows from
        pose and m, and d₀(0) follows from T(0), pose and λ.

        Args:
            names: parameters that differ from the twin's own.
            values: their values, shape (n, p), in their units.

        Raises:
            InputError: a start has no pretension.
        """
        native.install(self.layout)
        nominal = self.parameters.values()
        starts = starts_from(nominal, names, values, self.geometry, self.layout)
        balance = np.array([begin.balance for begin in starts])
        for name in names:
            self.parameters[name]
        numbers = [
            *model_numbers(
                self.model, self.parameters, self.geometry, self.layout, names,
                merged(nominal, names, values), len(values),
            ),
            *((Slot("actuator_user", (i,), law.T_0), T) for i, T in enumerate(balance.T)),
        ]  # fmt: skip
        states = [start_state(begin) for begin in starts]
        rows = (np.array([getattr(s, field) for s in states]) for field in ("qpos", "qvel", "act"))
        return State(*rows), numbers

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """Returns the currents that reach the motors, after effects that act on them; see `Plant`.

        Args:
            names: parameters that differ from the twin's own.
            values: their values, shape (n, p).
            held: logged currents at the steps of the simulation, shape (steps, 8) [A].
            timestep: of the simulation [s].
            begun: time of the first step in the record, of which no input effect asks here [s].
        """
        every = merged(self.parameters.values(), names, values)
        return changed_inputs(self.effects, THINGS, every, held, timestep, len(values))

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str], readings: np.ndarray
    ) -> np.ndarray:
        """Returns what the encoders say, after effects that act on them; see `Plant`."""
        every = merged(self.parameters.values(), names, values)
        things = [sensor.rpartition("_")[2] for sensor in sensors]
        return changed_outputs(self.effects, things, every, readings, len(values))

    def save(self, path: str | Path) -> Path:
        """Write the model as MJCF, exact to the last bit; returns the path."""
        spec = build(self.parameters, self.geometry, self.layout)
        spec.option.timestep = self.model.opt.timestep
        return write_xml(spec, path)


def build_twin(
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    timestep: float = TIMESTEP,
    effects: Sequence[Effect] = (),
    settled: bool = False,
    visual: bool = True,
) -> Twin:
    """Build and compile the robot, and install the law of its cables in this process.

    Args:
        parameters: the values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables; assumed ones by default.
        timestep: of the RK4 integrator [s].
        effects: candidate effects to compile into the law; their sizes become parameters.
        settled: see `Layout`.
        visual: whether it can be drawn; without its shapes the motion is the same, and faster to
            compute.

    Raises:
        InputError: the start has no pretension, two effects have one name, a function of an effect
            is not what its hook takes, or another library holds MuJoCo's callbacks.
    """
    layout = Layout(tuple(effects), settled)
    parameters = with_effects(parameters or parameter_set(), layout.effects)
    native.install(layout)
    spec = build(parameters, geometry, layout)
    spec.option.timestep = timestep
    spec.compiler.discardvisual = not visual
    model = spec.compile()
    write_values(model, parameters, geometry, layout)
    return Twin(parameters, geometry, model, layout.effects, settled)


def rebuild(
    robot: Twin, *, timestep: float | None = None, effects: Sequence[Effect] | None = None
) -> Twin:
    """Returns a twin with another step [s] or other effects; its values stay.

    Raises InputError if two effects have one name or the start has no pretension.
    """
    return build_twin(
        robot.parameters,
        robot.geometry,
        timestep=timestep or robot.model.opt.timestep,
        effects=robot.effects if effects is None else effects,
        settled=robot.settled,
    )


def write_values(
    model: mujoco.MjModel, parameters: ParameterSet, geometry: Geometry, layout: Layout
) -> None:
    """Write all model parameters into mjModel, in place; `Twin` writes those of the start."""
    values = parameters.values()
    every = merged(values, tuple(values), np.array([[*values.values()]]))
    for slot, column in model_numbers(model, parameters, geometry, layout, tuple(values), every, 1):
        write(model, slot, float(column[0]))
