"""Any MuJoCo model as a plant: every parameter is a path into the model or into its start.

    θ_j -> mjModel entry              where = "joint/slide.damping", "body/cart.mass", …
    θ_j -> spread of a body's mass     where = "body/link.spread[0]" (identification.model.tied)
    θ_j -> gain of a servo             where = "actuator/servo.kp" (identification.model.tied)
    θ_j -> entry of x₀                where = "qpos[0]", "qvel[3]", "act[1]"
    c θ_j -> any of these             ties = (("joint/other.damping", c), …)
    (1 + θ_k) times any of these      where = "deviation", ties = (("joint/other.damping", 1),)

The values change nothing else. A plant whose start depends on its masses, or whose inertia depends
on its shape, implements `identification.model.predictor.Plant` itself.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from identification.errors import InputError
from identification.model.parameter import DEVIATION, ParameterSet
from identification.model.paths import Slot, resolve, write
from identification.model.predictor import Numbers
from identification.model.rollout import State
from identification.model.tied import (
    parts,
    refuse_both,
    refuse_half,
    refuse_unread,
    spread_place,
    with_spreads,
)
from identification.runtime.engine import derive

_START = re.compile(r"(?P<field>qpos|qvel|act)\[(?P<index>\d+)\]")


@dataclass(frozen=True)
class ModelPlant:
    """A compiled model whose parameters are paths.

    The model is copied and the parameters' values are written into the copy.

    Attributes:
        model: the compiled model.
        parameters: what can be moved, with nominal values.
        start: the initial state; the model's own (qpos0, at rest) when None.

    Raises:
        InputError: a path names nothing in the model, or what the model does not read, or one of
            two numbers that are one gain of a servo, or two parameters name the same path.
    """

    model: mujoco.MjModel
    parameters: ParameterSet
    start: State | None = None

    def with_step(self, factor: float) -> ModelPlant:
        """Returns the same plant with another step of its model.

        Args:
            factor: new step over the old one.
        """
        model = copy.copy(self.model)
        model.opt.timestep *= factor
        return replace(self, model=model)

    def __post_init__(self) -> None:
        model, every = copy.copy(self.model), self.parameters.values()
        written = [(p.name, part) for p in self.parameters for path, _ in p.places
                   for part, _ in parts(model, path)]  # fmt: skip
        paths = [path for _, path in written]
        twice = next((path for path in paths if paths.count(path) > 1), None)
        if twice is not None:
            names = [name for name, path in written if path == twice]
            raise InputError(
                f"{' and '.join(names)} all go to {twice!r}; give each parameter a place of its own"
            )
        refuse_both(paths, model)
        refuse_half(model, written)
        for name, path in written:
            if start_place(path, model) is None and spread_place(path, model) is None:
                refuse_unread(model, name, resolve(model, path), path)
        start, numbers = self.settings(tuple(every), np.array([[*every.values()]]))
        for slot, values in numbers:
            write(model, slot, float(values[0]))
        derive(model)
        object.__setattr__(self, "model", model)
        object.__setattr__(self, "start", start.rows(0))

    def settings(self, names: Sequence[str], values: np.ndarray) -> tuple[State, Numbers]:
        """Returns initial states (n rows) and model numbers of n value sets; see `Plant`.

        Args:
            names: parameters that differ from the plant's own, p of them.
            values: their values, shape (n, p), in their units.

        Raises:
            InputError: a name is unknown.
        """
        start = self.start or own_start(self.model)
        rows = {f: np.tile(getattr(start, f), (len(values), 1)) for f in ("qpos", "qvel", "act")}
        numbers: list[tuple[Slot, np.ndarray]] = []
        spread: dict[tuple[int, int], np.ndarray] = {}
        every = dict(zip(names, values.T, strict=True))
        for name, path, factor in self._written(names):
            place, of_body = start_place(path, self.model), spread_place(path, self.model)
            column = factor * every.get(name, np.full(len(values), self.parameters[name].value))
            if path in self._deviations:
                deviation = every.get(self._deviations[path])
                column = column * (1 + (self._deviation(path) if deviation is None else deviation))
            if of_body is not None:
                spread[of_body] = column
            elif place is None:
                each = parts(self.model, path)
                numbers += [(resolve(self.model, part), sign * column) for part, sign in each]
            else:
                rows[place[0]][:, place[1]] = column
        return State(**rows), [*numbers, *with_spreads(self.model, spread, len(values))]

    @cached_property
    def _deviations(self) -> dict[str, str]:
        """The deviation at each path that has one, by the path."""
        return {p.ties[0][0]: p.name for p in self.parameters if p.where == DEVIATION}

    @cached_property
    def _owners(self) -> dict[str, tuple[str, str, float]]:
        """The parameter, the path and its factor that are written to the path of each deviation."""
        return {
            self._deviations[path]: (p.name, path, factor)
            for p in self.parameters
            for path, factor in p.places
            if path in self._deviations
        }

    def _written(self, names: Sequence[str]) -> list[tuple[str, str, float]]:
        """Returns what some parameters write, once each: the parameter, the path and its factor."""
        out = []
        for name in names:
            each = [(name, *place) for place in self.parameters[name].places]
            out += [self._owners[name]] if name in self._owners else each
        return list(dict.fromkeys(out))

    def _deviation(self, path: str) -> float:
        """Returns the relative deviation at a path in the plant's values, zero if it has none."""
        name = self._deviations.get(path)
        return 0.0 if name is None else self.parameters[name].value

    def inputs(
        self, names: Sequence[str], values: np.ndarray, held: np.ndarray, timestep: float,
        begun: float = 0.0,
    ) -> np.ndarray:  # fmt: skip
        """Returns the logged inputs, as they are; see `Plant`."""
        return held

    def outputs(
        self, names: Sequence[str], values: np.ndarray, sensors: Sequence[str], readings: np.ndarray
    ) -> np.ndarray:
        """Returns what perfect sensors say; see `Plant`."""
        return np.asarray(readings[0])


def own_start(model: mujoco.MjModel) -> State:
    """Returns the state in which a model is reset: qpos0, at rest."""
    return State(np.array(model.qpos0), np.zeros(model.nv), np.zeros(model.na))


def start_place(where: str, model: mujoco.MjModel) -> tuple[str, int] | None:
    """Returns field and index of a path such as `qpos[2]`; None for a path into the model."""
    match = _START.fullmatch(where)
    if match is None:
        return None
    field, index = match["field"], int(match["index"])
    size = {"qpos": model.nq, "qvel": model.nv, "act": model.na}[field]
    if index >= size:
        raise InputError(f"{where!r}: the model's {field} has {size} entries, counted from 0")
    return field, index
