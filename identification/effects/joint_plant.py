"""Any MJCF as a plant with candidate effects on its joints and inputs.

joint j gets    size(all joints) + size@j          input i likewise

Its own parameters are paths into the model (see `ModelPlant`). An effect's are called
`effect.size` + suffix and are zero; one that is already known, such as a Coulomb level, may be
given among the own ones by that name, with its value, and is then no candidate (see `candidates`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import mujoco
import numpy as np

from identification.effects.axes import Axis, axes
from identification.effects.effect import Effect
from identification.effects.effect_parameters import effect_parameters
from identification.effects.input_effects import drives, input_effects
from identification.effects.joint_catalogue import joint_effects
from identification.effects.joint_effect import JointEffect
from identification.effects.rows import column, read_model, with_rows
from identification.logs.log import Log
from identification.model.parameter import Parameter, ParameterSet
from identification.model.paths import Slot
from identification.model.plant import ModelPlant
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.native import installer as native


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
    effects: tuple[JointEffect, ...]
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

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model at its nominal values."""
        return self.bare.model

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
        native.install()
        for name in names:
            self.parameters[name]
        known = {p.name for p in self.bare.parameters}
        own = [k for k, name in enumerate(names) if name in known]
        start, numbers = self.bare.settings([names[k] for k in own], values[:, own])
        others = [k for k, name in enumerate(names) if name not in known]
        return start, [*numbers, *self._rows([names[k] for k in others], values[:, others])]

    def _rows(self, names: Sequence[str], values: np.ndarray) -> Numbers:
        """Entries of the joints' rows that some parameters of effects change."""
        at = {name: values[:, k] for k, name in enumerate(names)}
        out = []
        for effect in self.effects:
            for joint in self.joints if effect.columns else ():
                sums = effect.parameters_at(joint)
                for name, parts in zip(effect.columns, sums, strict=False):
                    if any(part in at for part in parts):
                        row = (int(self.model.joint(joint).id),)
                        slot = Slot("jnt_user", row, column(self.model, name))
                        out.append((slot, self._sum(parts, at, len(values))))
        return out

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float
    ) -> np.ndarray:
        """The inputs after the effects that act on them; see `Plant`."""
        at = {name: values[:, k] for k, name in enumerate(names)}
        out = held
        for effect in self.effects:
            for i in range(self.model.nu if effect.inputs else 0):
                parts = effect.parameters_at(self.model.actuator(i).name)
                each = np.array([self._sum(p, at, len(values)) for p in parts])
                if effect.inputs is None or not each[: len(effect.effect.sizes)].any():
                    continue
                if out.ndim == 2:
                    out = np.repeat(held[None], len(values), axis=0)
                for u, numbers in zip(out, each.T, strict=True):
                    u[:, i] = effect.inputs(u[:, i], timestep, *numbers)
        return out

    def _sum(self, parts: Sequence[str], at: Mapping[str, np.ndarray], n: int) -> np.ndarray:
        """What some parameters add up to in n value sets, shape (n,)."""
        zero = np.zeros(n)
        return np.sum([zero + at.get(p, self.parameters[p].value) for p in parts], axis=0)


def joint_plant(
    source: str | Path,
    parameters: Iterable[Parameter],
    log: Log,
    *,
    joints: Sequence[Axis] | None = None,
    effects: Sequence[JointEffect] | None = None,
    start: State | None = None,
) -> JointPlant:
    """Compile an MJCF whose joints and inputs may have effects.

    Args:
        source: path of an MJCF file, or its text.
        parameters: its own, with paths; those called as an effect's are that effect's.
        log: shows how far joints and inputs move, which says what sizes are plausible.
        joints: the joints that may have effects; those that the log measures when None.
        effects: the candidates; all of the catalogue when None.
        start: the initial state; the model's own when None.

    Raises:
        InputError: the model or a path is unusable, or a joint does not move in the log.
    """
    spec = read_model(source)
    known = tuple(joints) if joints is not None else axes(spec.copy().compile(), log)
    if effects is None:
        effects = (*joint_effects(known), *input_effects(drives(log)))
    records = {p.name: p for e in effects for p in effect_parameters(e.effect)}
    given = {p.name: p for p in parameters}
    own = ParameterSet("own", tuple(p for p in given.values() if p.name not in records))
    every = (*own, *(given.get(name, record) for name, record in records.items()))
    bare = ModelPlant(with_rows(spec, known), own, start)
    name = spec.modelname or "robot"
    return JointPlant(
        bare, ParameterSet(name, every), tuple(effects), tuple(a.joint for a in known)
    )


def candidates(plant: JointPlant, names: Iterable[str]) -> tuple[Effect, ...]:
    """The effects of a plant that may be missing: those of which no parameter is free already.

    Args:
        plant: of `joint_plant`.
        names: its free parameters.
    """
    free = {name.partition(".")[0] for name in names}
    return tuple(e.effect for e in plant.effects if e.name not in free)
