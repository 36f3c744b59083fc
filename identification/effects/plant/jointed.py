"""A model with candidate effects on its joints, bodies, inputs and sensors.

joint j gets    size(all joints) + size@j          inputs and sensors likewise; body b gets size@b

Its own parameters are paths into the model (see `ModelPlant`). An effect's are called
`effect.size` + suffix and are zero; one that is already known, such as a Coulomb level, may be
given among the own ones by that name, with its value, and is then no candidate.

Effects with states of their own act where the plant has these states (`with_states`): one with
states is simulated a little slower, and without them every window has fewer numbers to find.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from identification.effects import values as effect_values
from identification.effects.axes import Axis
from identification.effects.effect import Effect, effect_parameters
from identification.effects.laws.rotors import rotor_numbers
from identification.effects.moving_bodies import MovingBody, moving_bodies
from identification.effects.plant.body_numbers import body_numbers
from identification.effects.plant.gears import Gears
from identification.effects.plant.joint_states import (
    JointState,
    first_loads,
    fitting,
    needed_states,
    with_actuators,
)
from identification.effects.plant.rows import JointLayout, changed_rows, with_rows
from identification.logs.log import Log
from identification.model.parameter import ParameterSet
from identification.model.paths import write
from identification.model.plant import ModelPlant
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native.joints.joint_callback import GENTLE, STOP
from identification.runtime.engine import derive


@dataclass(frozen=True)
class JointPlant:
    """A model with effects, as `Predictor` and `discover` take it; `joint_plant` makes one.

    Attributes:
        bare: the model with its own parameters; every joint has a row for its effects.
        parameters: its own and the effects', with nominal values.
        effects: the effects.
        joints: names of the joints that may have them.
        spec: of the model, without rows.
        axes: the joints that may have effects, in the order of `joints`.
        states: states of joints that some effects need.
        leaves_out: whether effects whose states it lacks are left out, and not refused.
        steps: the steps of the user's model that one step of a simulation takes, or the share of
            one; states of joints take no longer steps than the user's own.
        slope_steps: likewise in simulations for slopes, a multiple of `steps`.
    """

    bare: ModelPlant
    parameters: ParameterSet
    effects: tuple[Effect, ...]
    joints: tuple[str, ...]
    spec: mujoco.MjSpec
    axes: tuple[Axis, ...]
    states: tuple[JointState, ...] = ()
    leaves_out: bool = False
    steps: float = 1
    slope_steps: float = 1

    def __post_init__(self) -> None:
        known = {p.name for p in self.bare.parameters}
        own = self.bare.parameters.with_values(
            {p.name: p.value for p in self.parameters if p.name in known}
        )
        start = fitting(self.bare.start, self.bare.model)
        bare = replace(self.bare, parameters=own, start=start)
        object.__setattr__(self, "bare", bare)
        every = tuple(p.name for p in self.parameters if p.name not in known)
        for slot, values in self._rows(
            every, np.array([[self.parameters[n].value for n in every]])
        ):
            bare.model.jnt_user[slot.index()] = values[0]

    @cached_property
    def layout(self) -> JointLayout:
        """The places of its effects' parameters in the model."""
        return JointLayout(self.effects, bool(self.states))

    @cached_property
    def bodies(self) -> tuple[MovingBody, ...]:
        """The bodies that may have effects."""
        return moving_bodies(self.bare.model)

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled model at its nominal values."""
        numbers = self._inertias((), np.empty((1, 0)), [])
        steps = self._taken(self.steps)
        if not numbers and steps == 1:
            return self.bare.model
        model = self._stopping(copy.copy(self.bare.model), min(1, steps))
        model.opt.timestep *= steps
        for slot, values in numbers:
            write(model, slot, float(values[0]))
        derive(model)
        return model

    @cached_property
    def smooth(self) -> mujoco.MjModel:
        """The model for slopes: its friction stops joints more gently, its steps may be longer."""
        steps = self._taken(max(self.steps, self.slope_steps))
        model = copy.copy(self.model)
        model.opt.timestep = steps * self.bare.model.opt.timestep
        return self._stopping(model, max(GENTLE, steps) / min(1, self.steps))

    def _taken(self, steps: float) -> float:
        """Returns the steps of the user's model that are taken at once, where states allow it."""
        return min(1, steps) if self.states else steps

    def with_step(self, factor: float) -> JointPlant:
        """Returns the same plant with another step of the model; joints stop in as many steps.

        Args:
            factor: new step over the old one, the model's or a finer one that is taken.
        """
        factor *= min(1, self.steps)
        model = copy.copy(self.bare.model)
        model.opt.timestep *= factor
        bare = replace(self.bare, model=self._stopping(model, factor))
        return replace(self, bare=bare, steps=1, slope_steps=1)

    def _stopping(self, model: mujoco.MjModel, factor: float) -> mujoco.MjModel:
        """Returns the model itself, changed: its joints take so many times as long to stop."""
        if factor == 1:
            return model
        column = int(model.nuser_jnt) - self.layout.entries + STOP
        for joint in self.joints:
            model.jnt_user[int(model.joint(joint).id), column] *= factor
        return model

    def with_values(self, values: Mapping[str, float]) -> JointPlant:
        """Returns the same plant with other nominal values.

        Raises:
            InputError: a name is unknown, or a value is outside its parameter's bounds.
        """
        with_them = self.with_states_of(n for n, v in values.items() if v != 0)
        return replace(with_them, parameters=self.parameters.with_values(values))

    def with_effects(self, more: Sequence[Effect]) -> JointPlant:
        """Returns the same plant with further effects, all of which are absent.

        Args:
            more: effects of joints, of which it has none.
        """
        effects = (*self.effects, *more)
        records = [p for e in more for p in effect_parameters(e)]
        every = ParameterSet(self.parameters.name, (*self.parameters, *records))
        return replace(
            self, bare=self._bare(self.states, effects), effects=effects, parameters=every
        )

    def with_states_of(self, names: Iterable[str]) -> JointPlant:
        """Returns the same plant with the states that some sizes of effects need."""
        return self.with_states([state for n in names for state in self.needed_states.get(n, ())])

    def with_states(self, states: Sequence[JointState]) -> JointPlant:
        """Returns the same plant with further states of joints, behind those that it has."""
        states = tuple(dict.fromkeys((*self.states, *states)))
        if states not in self._others:
            self._others[states] = replace(self, bare=self._bare(states), states=states)
        return self._others[states]

    def without_states(self) -> JointPlant:
        """Returns the same plant without states of joints, and without effects that need them."""
        return self if not self.states else self._plain

    @cached_property
    def _plain(self) -> JointPlant:
        zeros = self.parameters.with_values(dict.fromkeys(self.needed_states, 0.0))
        return replace(self, bare=self._bare(()), states=(), parameters=zeros, leaves_out=True)

    @cached_property
    def _others(self) -> dict[tuple[JointState, ...], JointPlant]:
        """Plants with other states, by these."""
        return {self.states: self}

    def _bare(
        self, states: tuple[JointState, ...], effects: tuple[Effect, ...] | None = None
    ) -> ModelPlant:
        layout = JointLayout(effects or self.effects, bool(states))
        model = with_rows(with_actuators(self.spec, states), self.axes, layout)
        return ModelPlant(model, self.bare.parameters, fitting(self.bare.start, model))

    @cached_property
    def needed_states(self) -> dict[str, tuple[JointState, ...]]:
        """The states that each size of an effect needs, by its name; most need none."""
        return needed_states(self.effects)

    @cached_property
    def gears(self) -> Gears:
        """Its joints' states, and what effects make of them."""
        return Gears(self.effects, self.axes, self.states, self.bare.model, self.spec)

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Returns initial states (n rows) and model numbers of n value sets; see `Plant`.

        Args:
            names: parameters that differ from the plant's own, p of them.
            values: their values, shape (n, p), in their units.

        Raises:
            InputError: a name is unknown, or another library holds MuJoCo's callback.
        """
        self.layout.install()
        for name in names:
            self.parameters[name]
        if not self.leaves_out:
            self.gears.refuse_stateless(self.needed_states, names, values)
        known = {p.name for p in self.bare.parameters}
        shared = [k for k, name in enumerate(names) if name in known]
        start, numbers = self.bare.settings([names[k] for k in shared], values[:, shared])
        others = [k for k, name in enumerate(names) if name not in known]
        inertias = self._inertias(names, values, numbers)
        rows = self._rows([names[k] for k in others], values[:, others])
        numbers = [*numbers, *inertias, *rows]
        every = self._every(names, values)
        return start, [*numbers, *self.gears.armatures(every, len(values), numbers)]

    def _every(self, names: Sequence[str], values: np.ndarray) -> effect_values.Values:
        return effect_values.merged(self.parameters.values(), names, values)

    def _inertias(self, names: Sequence[str], values: np.ndarray, own: Numbers) -> Numbers:
        """Returns the entries of bodies and rotors that effects change."""
        every, n = self._every(names, values), len(values)
        bodies = self.bodies if self.layout.has_bodies else ()
        about = (names, every, own, n)
        return [
            *body_numbers(self.bare.model, self.effects, bodies, *about),
            *rotor_numbers(self.bare.model, self.effects, self.joints, *about),
        ]

    def _rows(self, names: Sequence[str], values: np.ndarray) -> Numbers:
        """Returns the entries of the joints' rows that some parameters of effects change."""
        every, model = self._every(names, values), self.bare.model
        changed = changed_rows(model, self.layout, self.joints, names, every, len(values))
        return [*changed, *self.gears.rows(names, every, len(values))]

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """Returns the inputs after the effects that act on them; see `Plant`."""
        every = self._every(names, values)
        model = self.bare.model
        actuators = [model.actuator(i).name for i in range(model.nu)]
        return effect_values.changed_inputs(
            self.effects, actuators, every, held, timestep, len(values), begun
        )

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str], readings: np.ndarray
    ) -> np.ndarray:
        """Returns the readings of the sensors after the effects on them; see `Plant`."""
        every = self._every(names, values)
        return effect_values.changed_outputs(self.effects, sensors, every, readings, len(values))

    def begun(self, names: Sequence[str], values: np.ndarray, known: State) -> State:
        """Returns states as MuJoCo integrates them, from those of windows; see `WithStates`."""
        return self.gears.begun(self._every(names, values), len(values), known)

    def shown(
        self, names: Sequence[str], values: np.ndarray, run: Mapping[str, np.ndarray]
    ) -> Mapping[str, np.ndarray]:
        """Returns positions and rates as encoders see them; see `WithStates`."""
        return self.gears.shown(self._every(names, values), len(values), run)

    def first_loads(
        self, names: Sequence[str], values: np.ndarray, known: State, log: Log, starts: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
        """Returns states where windows begin, and how far off they may be; see `WithStates`."""
        plain = self.without_states()
        inputs = log.inputs[np.maximum(starts - (log.hold == "zoh"), 0)]  # has acted until then
        felt = [k for k, name in enumerate(names) if name not in self._of_states]
        loads = plain._loads([names[k] for k in felt], values[:, felt], known, inputs)
        return self.gears.first_states(self._every(names, values), loads, log, starts)

    def _loads(
        self, names: Sequence[str], values: np.ndarray, known: State, inputs: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Returns the loads of `first_loads`; a search asks for the same ones again and again."""
        arrays = (values, known.qpos, known.qvel, known.act, inputs)
        key = (*names, *(np.asarray(x).tobytes() for x in arrays))
        found = self._last_loads.get(key)
        if found is None:
            numbers = self.settings(names, values)[1]
            found = first_loads(self.bare.model, self.layout, numbers, known, inputs)
            self._last_loads.clear()  # another thread may read it meanwhile
            self._last_loads[key] = found
        return found

    @cached_property
    def _last_loads(self) -> dict[object, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        return {}

    @cached_property
    def _of_states(self) -> frozenset[str]:
        """The parameters of effects that need states, which the plant without states leaves out."""
        some = (e for e in self.effects if e.state)
        return frozenset(p.name for e in some for p in effect_parameters(e))
