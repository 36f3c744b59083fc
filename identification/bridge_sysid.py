"""A bridge to `mujoco.sysid`: its users' data, parameters and optimisers on our plants, and back.

    log      →  ModelSequences    inputs held on the model's own steps, outputs as joint states
    values   →  ParameterDict     value, start and bounds of each free parameter
    plant    →  residual          its model numbers and its start, both of every parameter

`mujoco.sysid` compiles a model from an MjSpec for every value set and knows no start that depends
on parameters. A plant writes numbers into a compiled model and computes the start, so the two
functions of `mujoco.sysid` that a user may replace (`build_model`, `custom_rollout`) do that here.
Its residual is (y - ŷ) √2/‖y‖ for each output, without a first sample that the start determines.

`mujoco.sysid` comes with MuJoCo; what it imports comes with `pip install mujoco[sysid]`.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from types import ModuleType
from typing import Any

import mujoco
import numpy as np

from identification.errors import InputError
from identification.logs.log import Log
from identification.model.paths import write
from identification.model.predictor import Plant, output_columns
from identification.model.rollout import State, hold, substeps

Residual = Callable[..., Any]


@dataclass(frozen=True)
class Compiled:
    """Stands where `mujoco.sysid` wants an MjSpec: a model that is compiled already."""

    model: mujoco.MjModel  # the compiled model

    def compile(self) -> mujoco.MjModel:
        """Returns a copy of the model."""
        return copy.copy(self.model)


def to_sysid(plant: Plant, log: Log, names: Sequence[str] = ()) -> Any:
    """Returns a log as the `ModelSequences` of `mujoco.sysid`.

    Args:
        plant: the model, whose start of nominal values is the initial state.
        log: inputs and outputs; every output a joint's position or rate.
        names: free parameters, checked to be the plant's.

    Raises:
        InputError: `mujoco.sysid` cannot be imported, a name is unknown, an output is no joint
            state, or the model's step does not divide the sampling time.
    """
    sysid, model = _sysid(), plant.model
    for name in names:
        plant.parameters[name]
    every = substeps(log.sampling_time, model.opt.timestep)
    held = hold(log.inputs, every, log.hold)
    clock = np.arange(len(held) + 1) * model.opt.timestep
    controls = np.concatenate([held, log.inputs[-1:]])
    kinds = {"qpos": sysid.SignalType.MjStateQPos, "qvel": sysid.SignalType.MjStateQVel}
    signals = {
        f"{_joint(model, field, address)}_{field}": (kinds[field], np.array([k]))
        for k, (field, address) in enumerate(output_columns(model, log.output_names))
    }
    inputs = sysid.TimeSeries.compute_all_control_mapping(model)
    start, _ = plant.settings((), np.empty((1, 0)))
    return sysid.ModelSequences(
        log.name,
        Compiled(model),
        log.name,
        full_state(model, start)[0],
        sysid.TimeSeries(clock, controls, inputs),
        sysid.TimeSeries(log.time - log.time[0], log.outputs, signals),
        allow_missing_sensors=True,
    )


def to_sysid_parameters(
    plant: Plant, names: Sequence[str], start: Mapping[str, float] | None = None
) -> Any:
    """Returns free parameters as the `ParameterDict` of `mujoco.sysid`.

    Args:
        plant: has their values and bounds.
        names: the free parameters.
        start: where a search begins, by name; the plant's own values where not given.

    Raises:
        InputError: `mujoco.sysid` cannot be imported, or a name is unknown.
    """
    sysid = _sysid()
    found = sysid.ParameterDict()
    for record in (plant.parameters[name] for name in names):
        value = (start or {}).get(record.name, record.value)
        found.add(
            sysid.Parameter(record.name, value, min_value=record.lower, max_value=record.upper)
        )
    return found


def from_sysid(result: Any) -> dict[str, float]:
    """Returns values by name from a `ParameterDict`, or from what `mujoco.sysid.optimize` returns.

    Raises:
        InputError: a parameter has more than one number.
    """
    parameters = result[0] if isinstance(result, tuple) else result
    values = {name: parameter.as_vector() for name, parameter in parameters.items()}
    wide = [name for name, value in values.items() if len(value) != 1]
    if wide:
        raise InputError(
            f"parameter {wide[0]!r} of mujoco.sysid has {len(values[wide[0]])} numbers; a parameter"
            " here has one, so give each number a name of its own"
        )
    return {name: float(value[0]) for name, value in values.items()}


def sysid_residual(plant: Plant, log: Log, names: Sequence[str]) -> Residual:
    """Returns the residual function that `mujoco.sysid.optimize` takes, for a plant and a log.

    Raises:
        InputError: as `to_sysid`.
    """
    sysid = _sysid()

    def settings(parameters: Any) -> Any:
        values = from_sysid(parameters)
        return plant.settings(tuple(values), np.array([list(values.values())]))

    def build_model(parameters: Any, spec: Compiled) -> mujoco.MjModel:
        model = spec.compile()
        for slot, values in settings(parameters)[1]:
            write(model, slot, values[0])
        mujoco.mj_setConst(model, mujoco.MjData(model))
        return model

    def rollout(*, models: Any, initial_states: Any, param_dicts: Any, **rest: Any) -> Any:
        begin = [full_state(plant.model, settings(p)[0])[0] for p in param_dicts]
        return sysid.sysid_rollout(
            models=models,
            initial_states=np.array(begin),
            rollout_signal_mapping=rest.pop("rollout_signal_mapping"),
            rollout_state_mapping=rest.pop("rollout_state_mapping"),
            **rest,
        )

    return sysid.build_residual_fn(
        models_sequences=[to_sysid(plant, log, names)],
        build_model=build_model,
        custom_rollout=rollout,
    )


def full_state(model: mujoco.MjModel, start: State) -> np.ndarray:
    """Returns starts as rows of MuJoCo's full physics state (time, qpos, qvel, act): (n, size)."""
    rows = [np.atleast_2d(part) for part in (start.qpos, start.qvel, start.act)]
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.hstack([np.zeros((len(rows[0]), 1)), *rows])
    if state.shape[1] != mujoco.mj_stateSize(model, full):
        raise InputError(
            "the model has states beside time, qpos, qvel and act (a plugin's, or a history);"
            " mujoco.sysid cannot start it here, remove them"
        )
    return state


def _joint(model: mujoco.MjModel, field: str, address: int) -> str:
    """Returns the name of the joint whose state stands at an address."""
    of = {"qpos": model.jnt_qposadr, "qvel": model.jnt_dofadr}[field]
    return model.joint(int(np.flatnonzero(of == address)[0])).name


def _sysid() -> ModuleType:
    """Imports `mujoco.sysid`, whose own import hides that it failed, and returns it."""
    try:
        for part in ("parameter", "optimize", "plotting", "residual"):
            import_module(f"mujoco.sysid._src.{part}")
    except ImportError as error:
        raise InputError(
            f"mujoco.sysid cannot be imported ({error}); install what it needs:"
            " pip install 'mujoco[sysid]'"
        ) from None
    return import_module("mujoco.sysid")
