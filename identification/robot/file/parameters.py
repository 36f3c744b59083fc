"""The free parameters of a robot's TOML, each with its prior.

Values that the file leaves out come from the model. A start that is not given comes from the log:
it is the first measured sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np

from identification.effects.effect import Effect, effect_parameters
from identification.effects.moving_bodies import Felt
from identification.effects.named import means_effect, unknown_number
from identification.errors import InputError, told_of
from identification.logs.log import Log
from identification.logs.units import refuse_other_unit
from identification.model.parameter import Parameter
from identification.model.paths import Slot, resolve
from identification.model.plant import own_start, start_place
from identification.model.predictor import output_columns
from identification.model.tied import spread_place, spreads, value_of
from identification.robot.file.alike import Alike
from identification.robot.file.file import RobotFile
from identification.robot.file.model_file import refuse_unit, unit_of
from identification.robot.file.start import CLEAR, measured_begin

KNOWN = 0.3  # std of the prior unless given: relative if positive, else of the plausible size
SURE = 0.01  # of a joint's motion in the log: std of the prior of a start that was measured
POSITIVE = (
    "mass", "inertia", "spread", "damping", "armature", "stiffness", "frictionloss", "kp", "kv",
    "timeconst", "resistance", "motorconst",
)  # fmt: skip


@dataclass(frozen=True)
class Free:
    """A free parameter, and what is known of it before the log speaks."""

    parameter: Parameter  # its value is where the search begins
    mean: float  # of the prior, in the parameter's unit
    std: float  # of the prior in the coordinates of the search, without unit

    @property
    def known(self) -> float:
        """The std as a robot's file says it: relative where positive, else in the unit."""
        return self.std if self.is_relative else self.std * self.parameter.scale

    @property
    def is_relative(self) -> bool:
        """Returns whether it stays positive, so that its prior is one of its logarithm."""
        return _is_positive(self.parameter, self.mean)


def _is_positive(record: Parameter, mean: float) -> bool:
    return record.lower >= 0 and record.value > 0 and mean > 0


def effect_sizes(effects: Sequence[Effect]) -> dict[str, tuple[Parameter, float]]:
    """Returns the sizes of effects by name, each with the largest plausible one, in its unit."""
    return {p.name: (p, s.largest) for e in effects for s in e.sizes
            for p in effect_parameters(e) if p.symbol == s.name}  # fmt: skip


def free_parameter(
    file: RobotFile, name: str, model: mujoco.MjModel, effects: Sequence[Effect], log: Log
) -> Free:
    """Returns a free parameter of a robot's file."""
    for alike in file.spread:
        if name in alike.names:
            return _alike(file, alike, name, model)
    # What only a log's TOML names is told of by who reads that.
    key = f"parameters.{name}" if name in file.records else "free"
    with told_of(f"{key} in {file.path}") if name in file.free else nullcontext():
        return _free(file, name, model, effects, log)


def _free(
    file: RobotFile, name: str, model: mujoco.MjModel, effects: Sequence[Effect], log: Log
) -> Free:
    """Returns a parameter that is free by itself, or that a log gives a value."""
    said = file.records.get(name, {})
    given: dict[str, Any] = {k: said[k] for k in ("unit", "about") if k in said}
    given |= {k: float(said[k]) for k in ("value", "lower", "upper", "scale") if k in said}
    sizes = effect_sizes([e for e in effects if name.startswith(f"{e.name}.")])
    if name in sizes:
        size, largest = sizes[name]
        refuse_other_unit(said.get("unit", size.unit), size.unit, "it")
        if "value" not in given:
            raise InputError(
                f"{name} is zero in the model: give it a value under"
                f' [parameters."{name}"], or leave it to the candidates'
            )
        record, guess = replace(size, **given), KNOWN * largest
    else:
        path = said.get("path", name)
        if any(path == f"{e.name}.{s.name}" for e in effects for s in e.shapes):
            raise InputError(
                f"{path} says how an effect looks and not how large it is: give its value under"
                " [fixed]"
            )
        if means_effect(path, effects):
            raise unknown_number(path, effects)
        body = path.partition(".inertia")[0]
        names = dict.fromkeys([*file.free, *log.values])
        every = (str(file.records.get(n, {}).get("path", n)) for n in names)
        alone = sum(p.startswith(f"{body}.inertia") for p in every) == 1
        refuse_unit(said, unit_of(model, path), "it")
        record, guess = _in_model(path, name, model, log, given, alone)
    if "std" in said:  # of a fit of other logs
        positive = _is_positive(record, record.value)
        std = float(said["std"]) / (record.value if positive else record.scale)
        return Free(record, record.value, std)
    mean = float(said.get("prior", record.value))
    if not record.lower <= mean <= record.upper:
        raise InputError(
            f"its prior is {mean:g}, outside its range [{record.lower:g}, {record.upper:g}];"
            " correct it, or leave it out"
        )
    if _is_positive(record, mean):
        return Free(record, mean, float(said.get("known", KNOWN)))
    return Free(record, mean, float(said.get("known", guess)) / record.scale)


def _alike(file: RobotFile, alike: Alike, name: str, model: mujoco.MjModel) -> Free:
    """Returns the common value of a spread, or a deviation from it."""
    with told_of(alike.where):
        unit = unit_of(model, alike.of[0])
    record, std = alike.parameters(model, unit)[name]
    said = file.records.get(name, {})
    refuse_unit(said, record.unit, f"parameters.{name} in {file.path}")
    value = float(said.get("value", record.value))
    mean = float(said.get("prior", record.value))
    std = float(said.get("known", std))
    if "std" in said:  # of a fit of other logs
        mean, std = value, float(said["std"]) / (value if name == alike.name else 1.0)
    return Free(replace(record, value=value), mean, std)


def measured_start(model: mujoco.MjModel, path: str, log: Log, own: float) -> float:
    """Returns the first measured sample of an entry of the start; `own` where it is not measured.

    A rate that is not measured itself is that of the measured position, where it is beyond noise.
    """
    place = start_place(path, model)
    columns = output_columns(model, log.output_names)
    if place in columns:
        return float(log.outputs[0, columns.index(place)])
    begin = None if place is None else measured_begin(model, log).get(place)
    return own if begin is None or abs(begin.value) <= CLEAR * begin.std else begin.value


def _in_model(
    path: str, name: str, model: mujoco.MjModel, log: Log, given: dict[str, Any], alone: bool
) -> tuple[Parameter, float]:
    """Returns a parameter that is a path into the model or into its start."""
    fields: dict[str, Any] = {"where": path, "unit": unit_of(model, path)}
    place = start_place(path, model)
    if place is not None:
        reset = float(getattr(own_start(model), place[0])[place[1]])
        moved = motion_of_start(model, place, log)
        fields |= {"value": measured_start(model, path, log, reset), "scale": moved}
        return Parameter(name=name, **{**fields, **given}), moved
    of_body = spread_place(path, model)
    value = (
        value_of(model, path) if of_body is None else float(spreads(model, of_body[0])[of_body[1]])
    )
    attribute = path.rpartition(".")[2].partition("[")[0]
    scale = abs(value) or 1.0
    positive = attribute in POSITIVE or path.endswith(".forcerange")  # and not one of its ends
    fields |= {"value": value, "scale": scale, "lower": 0.0 if positive else -np.inf}
    if attribute == "inertia":
        fields |= _possible(model, resolve(model, path), alone)
    if {"lower", "upper"} & {*given}:
        fields.pop("bounded_by", None)
    return Parameter(name=name, **{**fields, **given}), KNOWN * scale


def _possible(model: mujoco.MjModel, slot: Slot, alone: bool) -> dict[str, Any]:
    """Returns what keeps a principal inertia I_k that is free alone one of a body.

    It has bounds, |I_i - I_j| <= I_k <= I_i + I_j. Where no motion of the model feels the other two
    (a link that turns in a plane), they go along with it in proportion instead: a body that is
    possible stays so, and two numbers that nothing feels bind none that is felt.
    """
    if slot.column is None or len(slot.rows) != 1 or not alone:
        return {}
    body, k = slot.rows[0], slot.column
    others, inertia = [i for i in range(3) if i != k], model.body_inertia[body]
    a, b = (float(inertia[i]) for i in others)
    value, label = float(inertia[k]), model.body(body).name
    felt = Felt(model).inertias(body)
    in_fluid = bool(model.opt.density or model.opt.viscosity)  # its drag is made of all three
    if felt[k] and not felt[others].any() and not in_fluid and min(a, b, value) > 0:
        return {"ties": tuple((f"body/{label}.inertia[{i}]", inertia[i] / value) for i in others)}
    # A bound must not be the value itself, as that of a flat body is.
    low, high = min(abs(a - b), value * (1 - 1e-6)), max(a + b, value * (1 + 1e-6))
    return {
        "lower": low, "upper": high,
        "bounded_by": f"the other two inertias of {label} allow {low:.4g} to {high:.4g} kg m^2:"
        f" change these in the model, or free body/{label}.spread[0] to [2] in its place",
    }  # fmt: skip


def motion_of_start(model: mujoco.MjModel, place: tuple[str, int], log: Log) -> float:
    """Returns a magnitude that matters for an entry of the start: a small share of its motion."""
    columns = output_columns(model, log.output_names)
    if place in columns:
        return SURE * float(np.ptp(log.outputs[:, columns.index(place)])) or 1.0
    return 0.1
