"""Windows of several records, each at some points, whose outputs are simulated in one batch.

Preparing a batch costs as much as some hundred steps, and a window has few: a linearisation of
eight records of a servo took most of its time to prepare eight batches. Simulations for slopes may
be those of a smooth model (`JointPlant.smooth`) with longer steps; where these diverge, a record is
simulated again with the steps of the model.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from identification.model.lean import slope_integrator
from identification.model.predictor import Numbers, Plant, Predictor
from identification.model.rollout import State, rollout


@dataclass(frozen=True, kw_only=True)
class Points:
    """The W windows of a record at k points: the windows at the first point, then at the next."""

    predictor: Predictor  # of the record
    values: np.ndarray  # of its parameters, in their units, shape (k, p)
    start: State  # k W rows
    inputs: np.ndarray  # shape (k W, steps + 1, nu)
    every: int  # inputs per sample
    hold_kind: str  # of the inputs
    numbers: Numbers  # of the model, shape (k,) each
    times: np.ndarray  # when each window begins in its record, shape (W,) [s]

    def is_alike(self, other: Points) -> bool:
        """Returns whether both can be simulated in one batch."""
        return (
            self.predictor.plant is other.predictor.plant
            and self.predictor.log.sampling_time == other.predictor.log.sampling_time
            and (self.every, self.hold_kind) == (other.every, other.hold_kind)
            and self.inputs.shape[1:] == other.inputs.shape[1:]
            and [slot for slot, _ in self.numbers] == [slot for slot, _ in other.numbers]
        )

    def outputs(self, run: Mapping[str, np.ndarray]) -> np.ndarray:
        """Returns what sensors say of simulated states, shape (k, W, L, ny)."""
        k, W = len(self.values), len(self.times)
        y = self.predictor.outputs(self.values, run, np.tile(self.times, k))
        return y.reshape(k, W, *y.shape[1:])


def simulated(each: Sequence[Points], is_rough: bool = False) -> list[np.ndarray]:
    """Returns the outputs of the windows of some records at their points, (k, W, L, ny) a record.

    Args:
        each: the windows at their points.
        is_rough: whether the outputs are for slopes, where only differences matter.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    out, rest = dict[int, np.ndarray](), list(range(len(each)))
    while rest:
        alike = [k for k in rest if each[rest[0]].is_alike(each[k])]
        rest = [k for k in rest if k not in alike]
        out |= zip(alike, _together([each[k] for k in alike], is_rough), strict=True)
    return [out[k] for k in range(len(each))]


def _together(each: Sequence[Points], is_rough: bool) -> list[np.ndarray]:
    """Returns the outputs of records that are alike."""
    plant = each[0].predictor.plant
    if not is_rough:
        runs = _run(plant.model, each)
        return [points.outputs(run) for points, run in zip(each, runs, strict=True)]
    model, out = rough(plant), []
    for points, run in zip(each, _run(model, each, keeps_diverged=True), strict=True):
        if not all(np.isfinite(x).all() for x in run.values()):
            # longer steps may diverge where the model's own do not
            (run,) = _run(at_own_steps(model, plant.model), [points])
        out.append(points.outputs(run))
    return out


def _run(
    model: mujoco.MjModel, each: Sequence[Points], keeps_diverged: bool = False
) -> list[Mapping[str, np.ndarray]]:
    """Returns the states of records that are alike at their samples, by field."""
    first = each[0]
    whole = np.concatenate([p.inputs for p in each])
    inputs, every = slower(whole, first.every, first.predictor.plant.model, model)
    columns = zip(
        *([np.repeat(column, len(p.times)) for _, column in p.numbers] for p in each), strict=True
    )
    slots = [slot for slot, _ in first.numbers]
    run = rollout(
        model, State.stacked([p.start for p in each]), inputs,
        first.predictor.log.sampling_time / every,
        numbers=[(s, np.concatenate(c)) for s, c in zip(slots, columns, strict=True)],
        record=first.predictor.recorded, hold_kind=first.hold_kind,
        time=np.concatenate([np.tile(p.times, len(p.values)) for p in each]),
        keeps_diverged=keeps_diverged,
    )  # fmt: skip
    ends = np.cumsum([len(p.inputs) for p in each])[:-1]
    split = {field: np.split(states[:, ::every], ends) for field, states in run.items()}
    return [{field: states[k] for field, states in split.items()} for k in range(len(each))]


def rough(plant: Plant) -> mujoco.MjModel:
    """Returns the model for slopes: smooth where the plant has one, with one evaluation a step."""
    model: mujoco.MjModel = getattr(plant, "smooth", plant.model)
    integrator = slope_integrator(model)
    if model.opt.integrator == integrator:
        return model
    model = copy.copy(model)
    model.opt.integrator = integrator
    return model


def at_own_steps(model: mujoco.MjModel, own: mujoco.MjModel) -> mujoco.MjModel:
    """Returns a model whose steps may be longer, with the steps of another one."""
    model = copy.copy(model)
    model.opt.timestep = own.opt.timestep
    return model


def slower(
    inputs: np.ndarray, every: int, model: mujoco.MjModel, other: mujoco.MjModel
) -> tuple[np.ndarray, int]:
    """Returns inputs (k, steps + 1, nu), `every` a sample, for another model with longer steps.

    The last input stands behind the last step; a step of the other model takes a whole number of
    steps of the model.
    """
    n = round(other.opt.timestep / model.opt.timestep)
    if n == 1 or every == 1:
        return inputs, every
    steps = inputs[:, :-1].reshape(len(inputs), (inputs.shape[1] - 1) // n, n, inputs.shape[2])
    return np.concatenate([steps.mean(axis=2), inputs[:, -1:]], axis=1), every // n
