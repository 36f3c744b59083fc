"""Any MJCF as a plant with candidate effects on its joints, bodies, inputs and sensors.

joint j gets    size(all joints) + size@j          inputs and sensors likewise; body b gets size@b

Its own parameters are paths into the model (see `ModelPlant`). An effect's are called
`effect.size` + suffix and are zero; one that is already known, such as a Coulomb level, may be
given among the own ones by that name, with its value, and is then no candidate (see `candidates`).
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import mujoco
import numpy as np

from identification.effects import values as effect_values
from identification.effects.axes import Axis, axes
from identification.effects.body_numbers import body_numbers
from identification.effects.catalogue import all_effects
from identification.effects.effect import Effect
from identification.effects.effect_parameters import effect_parameters
from identification.effects.joint_layout import JointLayout
from identification.effects.moving_bodies import MovingBody, moving_bodies
from identification.effects.own_effects import refuse_unfit_own
from identification.effects.rows import read_model, with_rows
from identification.logs.log import Log
from identification.model.parameter import Parameter, ParameterSet
from identification.model.paths import Slot, write
from identification.model.plant import ModelPlant
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native.joint_callback import FIRST, GENTLE, STOP


@dataclass(frozen=True)
class JointPlant:
    """A model with effects, as `Predictor` and `discover` take it; `joint_plant` makes one.

    Attributes:
        bare: the model with its own parameters; every joint has a row for its effects.
        parameters: its own and the effects', with nominal values.
        effects: the effects.
        joints: names of the joints that may have them.
    """

    bare: ModelPlant
    parameters: ParameterSet
    effects: tuple[Effect, ...]
    joints: tuple[str, ...]

    def __post_init__(self) -> None:
        known = {p.name for p in self.bare.parameters}
        own = self.bare.parameters.with_values(
            {p.name: p.value for p in self.parameters if p.name in known}
        )
        bare = replace(self.bare, parameters=own)
        object.__setattr__(self, "bare", bare)
        every = tuple(p.name for p in self.parameters if p.name not in known)
        for slot, values in self._rows(
            every, np.array([[self.parameters[n].value for n in every]])
        ):
            bare.model.jnt_user[slot.index()] = values[0]

    @cached_property
    def layout(self) -> JointLayout:
        """Where the parameters of its effects are in the model."""
        return JointLayout(self.effects)

    @cached_property
    def bodies(self) -> tuple[MovingBody, ...]:
        """The bodies that may have effects."""
        return moving_bodies(self.bare.model)

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled model at its nominal values."""
        numbers = self._bodies((), np.empty((1, 0)), [])
        if not numbers:
            return self.bare.model
        model = copy.copy(self.bare.model)
        for slot, values in numbers:
            write(model, slot, float(values[0]))
        mujoco.mj_setConst(model, mujoco.MjData(model))
        return model

    @cached_property
    def smooth(self) -> mujoco.MjModel:
        """The model whose friction stops its joints more gently: its outputs have slopes."""
        model = copy.copy(self.model)
        column = int(model.nuser_jnt) - self.layout.entries + STOP
        for joint in self.joints:
            model.jnt_user[int(model.joint(joint).id), column] *= GENTLE
        return model

    def with_values(self, values: Mapping[str, float]) -> JointPlant:
        """The same plant with other nominal values.

        Raises:
            InputError: a name is unknown, or a value is outside its parameter's bounds.
        """
        return replace(self, parameters=self.parameters.with_values(values))

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Initial states (n rows) and model numbers of n value sets; see `Plant`.

        Args:
            names: parameters that differ from the plant's own, p of them.
            values: their values, shape (n, p), in their units.

        Raises:
            InputError: a name is unknown, or another library holds MuJoCo's callback.
        """
        self.layout.install()
        for name in names:
            self.parameters[name]
        known = {p.name for p in self.bare.parameters}
        own = [k for k, name in enumerate(names) if name in known]
        start, numbers = self.bare.settings([names[k] for k in own], values[:, own])
        others = [k for k, name in enumerate(names) if name not in known]
        bodies = self._bodies(names, values, numbers)
        rows = self._rows([names[k] for k in others], values[:, others])
        return start, [*numbers, *bodies, *rows]

    def _bodies(self, names: Sequence[str], values: np.ndarray, own: Numbers) -> Numbers:
        """Entries of the bodies that effects change."""
        if not self.layout.has_bodies:
            return []
        every = effect_values.merged(self.parameters.values(), names, values)
        return body_numbers(
            self.bare.model, self.effects, self.bodies, names, every, own, len(values)
        )

    def _rows(self, names: Sequence[str], values: np.ndarray) -> Numbers:
        """Entries of the joints' rows that some parameters of effects change."""
        every = effect_values.merged(self.parameters.values(), names, values)
        model = self.bare.model
        first = int(model.nuser_jnt) - self.layout.entries + FIRST
        return [
            (Slot("jnt_user", (int(model.joint(joint).id),), first + column),
             np.broadcast_to(numbers, len(values)))
            for joint in self.joints
            for column, numbers in effect_values.changed_columns(
                self.effects, self.layout.on_joints, joint, names, every
            )
        ]  # fmt: skip

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """The inputs after the effects that act on them; see `Plant`."""
        every = effect_values.merged(self.parameters.values(), names, values)
        model = self.bare.model
        actuators = [model.actuator(i).name for i in range(model.nu)]
        return effect_values.changed_inputs(
            self.effects, actuators, every, held, timestep, len(values), begun
        )

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str], readings: np.ndarray
    ) -> np.ndarray:
        """What the sensors say after the effects that act on them; see `Plant`."""
        every = effect_values.merged(self.parameters.values(), names, values)
        return effect_values.changed_outputs(self.effects, sensors, every, readings, len(values))


def joint_plant(
    source: str | Path | mujoco.MjSpec,
    parameters: Iterable[Parameter],
    log: Log,
    *,
    joints: Sequence[Axis] | None = None,
    effects: Sequence[Effect] | None = None,
    own_effects: Sequence[Effect] = (),
    start: State | None = None,
) -> JointPlant:
    """Compile an MJCF whose joints and inputs may have effects.

    Args:
        source: path of an MJCF file, or its text, or the result of `read_model`.
        parameters: its own, with paths; those called as an effect's are that effect's.
        log: shows how far joints and inputs move, which says what sizes are plausible.
        joints: the joints that may have effects; those that the log measures when None.
        effects: the candidates; all of the catalogue when None.
        own_effects: candidates beside them, of the caller's own.
        start: the initial state; the model's own when None.

    Raises:
        InputError: the model or a path is unusable, a joint does not move in the log, or an effect
            has a hook that is none of a joint, an input, a body or a sensor; or an own effect has a
            place that is not there, or a function that fails when it is tried.
    """
    spec = read_model(source)
    known = tuple(joints) if joints is not None else axes(spec.copy().compile(), log)
    if effects is None:
        effects = all_effects(spec, known, log)
    effects = (*effects, *own_effects)
    records = {p.name: p for e in effects for p in effect_parameters(e)}
    given = {p.name: p for p in parameters}
    paths = ParameterSet("own", tuple(p for p in given.values() if p.name not in records))
    every = (*paths, *(given.get(name, record) for name, record in records.items()))
    layout = JointLayout(effects)
    if own_effects:
        inputs = [actuator.name for actuator in spec.actuators]
        refuse_unfit_own(own_effects, [a.joint for a in known], inputs)
    bare = ModelPlant(with_rows(spec, known, layout), paths, start)
    name = spec.modelname or "robot"
    return JointPlant(bare, ParameterSet(name, every), effects, tuple(a.joint for a in known))


def candidates(plant: JointPlant, names: Iterable[str]) -> tuple[Effect, ...]:
    """The effects of a plant that may be missing: those of which no parameter is free already.

    Args:
        plant: of `joint_plant`.
        names: its free parameters.
    """
    free = {name.partition(".")[0] for name in names}
    return tuple(e for e in plant.effects if e.name not in free)
