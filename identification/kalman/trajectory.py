"""The trajectory that a plant predicts, at points between the samples, and means over intervals.

    t_m = t_k + (i + 1/2) T_s/P,  i = 0 … P - 1      x(t_m), and the mean of u about t_m

What varies along a trajectory is averaged over intervals, of which a sample has a few. Their
midpoints are enough for what varies as the state does. A torque that turns with the angle of a
motor varies faster, and takes more points.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import mujoco
import numpy as np

from identification.linear.points import AtPoints
from identification.model.predictor import Predictor
from identification.model.protocol import with_numbers, with_states
from identification.model.rollout import hold, rollout, substeps, without_sensors
from identification.native.forward import Intervals
from identification.runtime.pool import run_parts

# Intervals of a sample, where the step of the simulation allows as many: a state of the rate
# 100 1/s that is sampled at 100 Hz changes by half over one of them.
INTERVALS = 2
COARSE_POINTS, FINE_POINTS = INTERVALS, 3 * INTERVALS  # P, likewise
POINTS = ("qpos", "qvel", "moved", "act", "inputs", "time")  # fields with a row for each point


@dataclass(frozen=True, kw_only=True)
class Trajectory(AtPoints):
    """One record's trajectory at M points, P of them for each of its N samples but the last.

    Its model has the numbers of the value set, and no sensors; its times are those in the record.
    """

    # how far the velocities move in the time that a point stands for, shape (M, nv)
    moved: np.ndarray
    steps: np.ndarray  # of the simulation, between which the points lie, shape (M + 1,)
    timestep: float  # of the simulation [s]
    begins: np.ndarray  # first point of each interval, shape (L,)
    states: dict[str, np.ndarray]  # fields of the state at the samples, each (N, size)

    @property
    def intervals(self) -> int:
        """Intervals of a sample."""
        return len(self.begins) // (len(self.states["qpos"]) - 1)

    @property
    def duration(self) -> np.ndarray:
        """The duration of each interval [s], shape (L,)."""
        return self.timestep * np.add.reduceat(np.diff(self.steps), self.begins)

    def average(self, values: np.ndarray) -> np.ndarray:
        """Returns means over the intervals of values at the points, shape (M, …)."""
        each = (-1, *[1] * (values.ndim - 1))
        length = self.timestep * np.diff(self.steps)
        total = np.add.reduceat(values * length.reshape(each), self.begins)
        return np.asarray(total / self.duration.reshape(each))

    @property
    def weighted(self) -> Intervals:
        """The intervals, with the share of each point in its own."""
        length = self.timestep * np.diff(self.steps)
        places = np.searchsorted(self.begins, np.arange(len(length)), side="right") - 1
        return Intervals(self.begins, length / self.duration[places])

    def after(self, sample: int) -> Trajectory:
        """Returns the trajectory from one of its samples on."""
        begins = self.begins[self.intervals * sample :]
        first = int(begins[0]) if len(begins) else len(self.time)
        points = {f: getattr(self, f)[first:] for f in (*POINTS, "steps")}
        states = {field: x[sample:] for field, x in self.states.items()}
        return replace(self, begins=begins - first, states=states, **points)

    def some(self, most: int) -> Trajectory:
        """Returns the trajectory at up to `most` of its points, which stand for no intervals."""
        every = slice(None, None, -(-len(self.time) // most))
        few = {f: getattr(self, f)[every] for f in POINTS}
        return replace(self, begins=self.begins[:0], **few)


@dataclass(frozen=True, eq=False)
class Run:
    """A simulation of all records of a log, made when something of it is first asked for.

    A search simulates a step to see whether it is a good one, and then linearises along the same
    trajectory. What is asked raises a DivergenceError where the simulation diverges, and an
    InputError where the robot cannot rest at its start.

    Attributes:
        predictor: plant and log, with p parameters.
        values: shape (p,), in the parameters' units.
    """

    predictor: Predictor
    values: np.ndarray

    @cached_property
    def along(self) -> tuple[Trajectory, ...]:
        """The trajectory of each record."""
        (each,) = follow_records(self.predictor, self.values, COARSE_POINTS)
        return tuple(each)

    @cached_property
    def outputs(self) -> np.ndarray:
        """The outputs of all records, shape (N, ny)."""
        if with_states(self.predictor.plant) is not None:
            return self.predictor.predict(self.values)[0]
        each = zip(self.predictor.records(), self.along, strict=True)
        return np.concatenate([
            record.outputs(
                self.values[None, columns], {field: x[None] for field, x in along.states.items()}
            )[0]
            for (record, columns), along in each
        ])  # fmt: skip


def follow_records(
    predictor: Predictor, values: np.ndarray, *points: int
) -> list[list[Trajectory]]:
    """Returns trajectories of the records for each wanted P, simulated once side by side."""
    records = [*predictor.records()]
    runs = run_parts(lambda each: _simulated(each[0], values[..., each[1]]), records)
    return [[run(P) for run in runs] for P in points]


def follow(predictor: Predictor, values: np.ndarray, points: int) -> Trajectory:
    """Returns the trajectory of one value set (p,) over one record."""
    return _simulated(predictor, values)(points)


def _simulated(predictor: Predictor, values: np.ndarray) -> Callable[[int], Trajectory]:
    """Returns the trajectory of one simulation as a function of P."""
    model, log = predictor.plant.model, predictor.log
    step = model.opt.timestep
    every = substeps(log.sampling_time, step)
    held = hold(log.inputs, every, log.hold)
    start, numbers = predictor.settings(values)
    run = rollout(
        model, start, np.vstack([held, held[-1:]]), step, numbers=numbers,
        record=("qpos", "qvel", "act") if model.na else ("qpos", "qvel"),
        before=predictor.inputs(values), time=log.begun,
    )  # fmt: skip
    return partial(
        divided,
        with_numbers(without_sensors(model), numbers, 0),
        {field: each[0] for field, each in run.items()},
        predictor.inputs(values)(held), every, log.begun,
    )  # fmt: skip


def divided(
    model: mujoco.MjModel, states: dict[str, np.ndarray], held: np.ndarray, every: int,
    begun: float, points: int,
) -> Trajectory:  # fmt: skip
    """Returns the trajectory of what was simulated step by step.

    Args:
        model: with the numbers of the value set, without its sensors.
        states: fields of the state before each step and after the last, each (steps + 1, size).
        held: inputs that reach the model, shape (steps, inputs).
        every: steps of a sample.
        begun: time in the record at which it begins [s].
        points: P, if there are as many steps in a sample.
    """
    step, samples = model.opt.timestep, (len(states["qpos"]) - 1) // every + 1
    steps = _divide(every, points, samples)
    middle = (steps[1:] + steps[:-1]) / 2
    at = {field: _between(x, middle) for field, x in states.items()}
    return Trajectory(
        model=model,
        qpos=at["qpos"],
        qvel=at["qvel"],
        moved=np.diff(states["qvel"][steps], axis=0),
        act=at.get("act", np.empty((len(middle), 0))),
        inputs=average_inputs(held, steps, model.nu)[0],
        time=begun + middle * step,
        steps=steps,
        timestep=step,
        begins=np.searchsorted(steps, _divide(every, INTERVALS, samples)[:-1]),
        states={field: x[::every] for field, x in states.items()},
    )


def _divide(every: int, parts: int, samples: int) -> np.ndarray:
    """Returns the steps at which the parts of all samples begin, and at which the last one ends."""
    cuts = np.round(np.linspace(0, every, min(every, parts) + 1)).astype(int)
    begins = every * np.arange(samples - 1)[:, None] + cuts[:-1]
    return np.append(begins.ravel(), every * (samples - 1))


def _between(x: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Returns rows of x (n, size) at places between them, shape (M, size)."""
    below = np.floor(at).astype(int)
    share = (at - below)[:, None]
    return x[below] * (1 - share) + x[np.ceil(at).astype(int)] * share


def average_inputs(held: np.ndarray, steps: np.ndarray, nu: int) -> np.ndarray:
    """Returns means of held inputs (steps, inputs) or (n, steps, inputs) about points: (n, M, nu).

    The points lie between `steps`; inputs of the model beyond the log's are zero.
    """
    each = held if held.ndim == 3 else held[None]
    mean = np.add.reduceat(each, steps[:-1], axis=1) / np.diff(steps)[:, None]
    rest = np.zeros((*mean.shape[:2], nu - mean.shape[2]))
    return np.concatenate([mean, rest], axis=2)
