"""An experiment as it is simulated: its inputs are played as they are, or a motion is followed.

    inputs      u(t) is the series; the model answers
    reference   q_d(t) is the series; u = (τ/gear - bias)/gain,
                τ = M(q)(q̈_d + 2 w (q̇_d - q̇) + w² (q_d - q)) + c(q, q̇) + g(q) - springs and dampers

The inputs of servos are positions. Inputs of motors are played as they are only where a free run of
the robot's own log stays within its limits; else small errors add up, and the robot needs a
controller, here computed torque (Craig 2005, chapter 10). Friction is left to its feedback.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import mujoco
import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError, InputError
from identification.experiment.drives import Drive, drives_of, torque_for
from identification.experiment.limits import Limit, Limits, Margin, keeps, margins
from identification.experiment.series import Series
from identification.logs.log import Log
from identification.model.plant import own_start
from identification.model.predictor import Predictor
from identification.model.protocol import with_numbers
from identification.model.rollout import State, substeps
from identification.runtime.engine import quiet

Form = Literal["inputs", "reference"]
FORMS = ("auto", "inputs", "reference")
SMALLER = (1.0, 0.8, 0.6, 0.4, 0.2, 0.1)  # tried on deviations that break a limit
INSIDE = 0.98  # of the room to a limit that a series may take
BANDWIDTH, SLOW = 20.0, 0.15  # of the controller [rad/s], and at most this over the sampling time
FASTEST = 4.0  # a tone's rate at full room, over the fastest speed
SHORTEST = 20.0  # samples in a period
DRIFT = 0.1  # of the room, by which a free run of the log may leave it
NONE = np.empty((1, 0))
STATE = ("qpos", "qvel", "act")


@dataclass(frozen=True)
class Played:
    """A simulated experiment."""

    log: Log  # inputs, and the outputs that the model expects
    qpos: np.ndarray  # at the samples, shape (N, nq)
    qvel: np.ndarray  # shape (N, nv)
    margins: tuple[Margin, ...]  # the nearest limit first
    # positions, rates and accelerations of the drives' joints to follow, shape (3, N, n)
    aim: np.ndarray | None = None


@dataclass(frozen=True)
class Stage:
    """A robot that begins at rest, its limits, and the way in which an experiment is played."""

    plant: JointPlant  # at the values that are believed, with the start of the experiment
    like: Log  # a log of the robot: its columns, units, hold and sampling time
    limits: Limits
    samples: int
    form: Form

    @cached_property
    def time(self) -> np.ndarray:
        """Times of the samples from zero [s], shape (N,)."""
        return np.arange(self.samples) * self.like.sampling_time

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The model at the plant's values."""
        _, numbers = self._predictor(self.blank).settings(NONE)
        return with_numbers(self.plant.model, numbers, 0)

    @cached_property
    def drives(self) -> tuple[Drive | None, ...]:
        """The drive of each input."""
        return drives_of(self.model, self.like.inputs.shape[1])

    @cached_property
    def center(self) -> np.ndarray:
        """Where the series begin and end, shape (n,): the start pose, or inputs that hold it."""
        start = self.plant.bare.start or own_start(self.model)
        qpos = np.ravel(start.qpos)
        if self.form == "reference":
            return np.array([qpos[d.qpos] for d in self.drives if d is not None])
        data = mujoco.MjData(self.model)
        data.qpos[:] = qpos
        torque, u = torque_for(self.model, data, np.zeros(self.model.nv)), []
        for drive, limit in zip(self.drives, self.limits.inputs, strict=True):
            held = 0.0 if drive is None else drive.input(torque[drive.dof], qpos[drive.qpos], 0.0)
            u.append(float(np.clip(held, limit.low, limit.high)))
        return np.array(u)

    @cached_property
    def bounds(self) -> tuple[Limit | None, ...]:
        """The limit of each series."""
        if self.form == "inputs":
            return self.limits.inputs
        at = {int(self.model.jnt_qposadr[j]): k for k, j in enumerate(self.limits.joints)}
        return tuple(self.limits.positions[at[d.qpos]] for d in self.drives if d is not None)

    @cached_property
    def room(self) -> np.ndarray:
        """Half the width of each series' limit; zero where it has none, shape (n,)."""
        return np.array([0.0 if b is None else 0.5 * (b.high - b.low) for b in self.bounds])

    @cached_property
    def most_waves(self) -> int:
        """The most periods of a tone in the experiment."""
        rates = [
            v.high / (0.5 * (p.high - p.low))
            for p, v in zip(self.limits.positions, self.limits.speeds, strict=True)
            if p is not None and v is not None and p.high > p.low
        ]
        seconds = float(self.time[-1])
        fast = FASTEST * max(rates, default=np.inf) * seconds / (2 * np.pi)
        return max(2, int(min(fast, self.samples / SHORTEST)))

    @cached_property
    def blank(self) -> Log:
        """An empty log of the experiment."""
        like, samples = self.like, self.samples
        return Log(
            time=self.time,
            inputs=np.zeros((samples, like.inputs.shape[1])),
            outputs=np.zeros((samples, like.outputs.shape[1])),
            input_names=like.input_names, output_names=like.output_names, units=like.units,
            hold=like.hold, name="next_experiment", values=like.values,
        )  # fmt: skip

    def largest(self, series: Series) -> Series:
        """Returns the series with the largest deviations up to its own that keep their limits."""
        x, v, _ = series.at(self.time, self.center, self.room)
        most = 1.0
        away = x - self.center
        for k, bound in enumerate(self.bounds):
            if bound is None or not self.room[k]:
                continue
            up, down = bound.high - self.center[k], self.center[k] - bound.low
            most = min(most, *(INSIDE * max(room, 0.0) / far
                               for room, far in ((up, away[:, k].max()), (down, -away[:, k].min()))
                               if far > 0))  # fmt: skip
        if self.form == "reference":
            dofs = [int(self.model.jnt_dofadr[j]) for j in self.limits.joints]
            fastest = {d: s for d, s in zip(dofs, self.limits.speeds, strict=True) if s is not None}
            moved = [d.dof for d in self.drives if d is not None]
            for k, dof in enumerate(moved):
                if dof in fastest and (top := float(np.abs(v[:, k]).max())) > 0:
                    most = min(most, INSIDE * fastest[dof].high / top)
        return series.scaled(most)

    def attempt(self, series: Series) -> tuple[Series, Played] | None:
        """Returns the series, made smaller until its simulation keeps the limits, or None."""
        largest = self.largest(series)
        for factor in SMALLER:
            smaller = largest.scaled(factor)
            if not smaller.scale > 0:
                return None
            try:
                played, touch = self.play(smaller)
            except (DivergenceError, InputError):
                continue
            if not touch and keeps(played.margins):
                return smaller, played
        return None

    def play(self, series: Series) -> tuple[Played, str]:
        """Returns the simulated experiment, and two bodies that touch; "" where none do.

        Raises:
            DivergenceError: the simulation left the finite numbers.
        """
        x, v, a = series.at(self.time, self.center, self.room)
        log = self.blank
        if self.form == "inputs":
            log = replace(log, inputs=x)
            run = self._predictor(log).simulated(NONE, STATE)
            aim = None
        else:
            u, run = self._follow(x, v, a)
            log, aim = replace(log, inputs=u), np.stack([x, v, a])
        y = self._predictor(log).outputs(NONE, run)[0]
        log = replace(log, outputs=y)
        qpos, qvel = run["qpos"][0], run["qvel"][0]
        found, touch = margins(self.model, self.limits, log.inputs, qpos, qvel)
        return Played(log, qpos, qvel, found, aim), touch

    def _predictor(self, log: Log) -> Predictor:
        return Predictor(self.plant, log, ())

    @quiet()
    def _follow(
        self, q: np.ndarray, v: np.ndarray, a: np.ndarray
    ) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Returns inputs (N, nu) and states of a motion under control."""
        model, data, h = self.model, mujoco.MjData(self.model), self.like.sampling_time
        every, w = substeps(h, self.model.opt.timestep), min(BANDWIDTH, SLOW / h)
        predictor = self._predictor(self.blank)
        begun = predictor.begun(NONE, predictor.settings(NONE)[0])
        data.qpos[:], data.act[:] = np.ravel(begun.qpos), np.ravel(begun.act)
        drives = [d for d in self.drives if d is not None]
        dofs, places = [d.dof for d in drives], [d.qpos for d in drives]
        u = np.zeros((len(q), len(drives)))
        run = {"qpos": np.zeros((1, len(q), model.nq)), "qvel": np.zeros((1, len(q), model.nv)),
               "act": np.zeros((1, len(q), model.na))}  # fmt: skip
        wanted = np.zeros(model.nv)
        for k in range(len(q)):
            run["qpos"][0, k], run["qvel"][0, k] = data.qpos, data.qvel
            wanted[dofs] = a[k] + 2 * w * (v[k] - data.qvel[dofs])
            wanted[dofs] += w * w * (q[k] - data.qpos[places])
            torque = torque_for(model, data, wanted)
            for i, d in enumerate(drives):
                u[k, i] = d.input(torque[d.dof], data.qpos[d.qpos], data.qvel[d.dof])
            data.ctrl[: len(drives)] = u[k]
            mujoco.mj_step(model, data, every)
        if not all(np.isfinite(x).all() for x in (u, *run.values())) or data.time < h:
            raise DivergenceError("the simulation under control diverged; use a smaller step")
        return u, run


def stage_of(
    plant: JointPlant, log: Log, limits: Callable[[np.ndarray], Limits], seconds: float,
    form: str = "auto",
) -> Stage:  # fmt: skip
    """Returns the stage of an experiment of a robot.

    Args:
        plant: at the values that are believed, with the start of the log.
        log: of the robot.
        limits: returns the limits of an experiment that begins at some positions (nq,).
        seconds: how long the experiment lasts.
        form: "inputs", "reference", or "auto" for what the robot needs.

    Raises:
        InputError: the form is unknown or impossible, or the duration is no experiment.
    """
    h = log.sampling_time
    if not 50 * h <= seconds <= 600:
        raise InputError(f"an experiment of {seconds:g} s cannot be designed; give"
                         f" {50 * h:g} s to 600 s")  # fmt: skip
    if form not in FORMS:
        raise InputError(f"no form {form!r} of an experiment; give one of {', '.join(FORMS)}")
    begun = plant.bare.start or own_start(plant.bare.model)
    rest = State(np.array(begun.qpos), np.zeros_like(begun.qvel), np.array(begun.act))
    still = replace(plant, bare=replace(plant.bare, start=rest))
    found = limits(np.ravel(rest.qpos))
    stage = Stage(still, log, found, round(seconds / h) + 1, "inputs")
    drives = [d for d in stage.drives if d is not None]
    can_follow = len({d.dof for d in drives}) == len(stage.drives) == stage.model.nv
    can_follow = can_follow and not any(d.is_servo for d in drives)
    if form == "reference" and not can_follow:
        raise InputError(
            "a motion can be followed where each joint has one motor and no servo, and this robot"
            " is another one; let its inputs be played (inputs)"
        )
    drifts = form == "auto" and can_follow and _drifts(plant, log, found)
    return replace(stage, form="reference") if form == "reference" or drifts else stage


def _drifts(plant: JointPlant, log: Log, limits: Limits) -> bool:
    """Returns whether a free run of a log leaves the positions' limits."""
    try:
        qpos = Predictor(plant, log, ()).simulated(NONE, STATE)["qpos"][0]
    except DivergenceError:
        return True
    model = plant.model
    for j, limit in zip(limits.joints, limits.positions, strict=True):
        if limit is not None:
            q, more = qpos[:, model.jnt_qposadr[j]], DRIFT * (limit.high - limit.low)
            if q.min() < limit.low - more or q.max() > limit.high + more:
                return True
    return False
