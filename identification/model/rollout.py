"""Simulate a MuJoCo model under a log's inputs, many value sets at once.

    u(t) = u_k on [t_k, t_{k+1})          zero-order hold ("zoh")
    u(t) linear from u_k to u_{k+1}       first-order hold ("foh"), sampled at mid-step

Every simulation has its own initial state and, if given, its own model numbers. All of them run in
one `Batch.rollout`, on native threads. Memory, threads and numbers that MuJoCo derives cost as much
as some hundred steps: `Simulations` are prepared once, and may be run many times.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco.batch import Batch, SimulationError

from identification.errors import DivergenceError, InputError
from identification.model.lean import lean
from identification.model.paths import Slot
from identification.runtime.engine import quiet, untimed
from identification.runtime.pool import end_if_given_up, threads

# MuJoCo derives no other number from these entries: after writing them, no mj_setConst is needed.
# Nor does anything depend on them that follows from positions alone.
UNDERIVED = {
    "actuator_user",
    "tendon_user",
    "body_user",
    "numeric_data",
    "dof_damping",
    "jnt_stiffness",
    "jnt_user",
}
UNLOGGED = "state of "  # actuators called so carry states alone: they have no input


@dataclass(frozen=True)
class State:
    """Initial states of simulations: one row for each, or one row for all."""

    qpos: np.ndarray  # positions, shape (n, nq) or (nq,) [m, rad, quaternions]
    qvel: np.ndarray  # velocities, shape (n, nv) or (nv,) [m/s, rad/s]
    act: np.ndarray  # activations, shape (n, na) or (na,), in the units of their actuators

    def rows(self, keep: np.ndarray | int) -> State:
        """Returns some of the rows, by mask or by index; one row by its number."""
        return State(self.qpos[keep], self.qvel[keep], self.act[keep])

    @classmethod
    def stacked(cls, each: Sequence[State]) -> State:
        """Returns the rows of several, one after the other."""
        return cls(
            *(np.concatenate(x) for x in zip(*((s.qpos, s.qvel, s.act) for s in each), strict=True))
        )


def substeps(sampling_time: float, timestep: float) -> int:
    """Returns how many simulation steps a sample has."""
    n = round(sampling_time / timestep)
    if n < 1 or abs(n * timestep - sampling_time) > 1e-6 * sampling_time:
        raise InputError(
            f"the step {timestep:g} s does not divide the sampling time {sampling_time:g} s;"
            f" try {sampling_time / max(1, round(sampling_time / timestep)):g} s"
        )
    return n


def logged_inputs(model: mujoco.MjModel) -> int:
    """Returns how many inputs a log of a model has: actuators that only carry states have none."""
    carriers = (
        model.actuator(i).name.startswith(UNLOGGED) for i in range(len(model.actuator_trntype))
    )
    return int(model.nu) - sum(carriers)


def hold(inputs: np.ndarray, n: int, kind: str = "zoh") -> np.ndarray:
    """Returns controls of the steps between the samples: (..., N, nu) -> (..., (N-1) n, nu)."""
    if kind == "zoh":
        return np.repeat(inputs[..., :-1, :], n, axis=-2)
    weight = ((np.arange(n) + 0.5) / n)[:, None]
    before, after = inputs[..., :-1, None, :], inputs[..., 1:, None, :]
    held = (1 - weight) * before + weight * after
    steps = n * (inputs.shape[-2] - 1)  # said, because a log without inputs has nothing to count
    return np.asarray(held.reshape(*inputs.shape[:-2], steps, inputs.shape[-1]))


def without_sensors(model: mujoco.MjModel) -> mujoco.MjModel:
    """Returns the model with sensors disabled in its steps; itself where they are so already."""
    out = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
    if model.opt.disableflags & out:
        return model
    model = copy.copy(model)
    model.opt.disableflags |= out
    return model


def rollout(
    model: mujoco.MjModel,
    start: State,
    inputs: np.ndarray,
    sampling_time: float,
    *,
    numbers: Sequence[tuple[Slot, np.ndarray]] = (),
    record: Sequence[str] = ("qpos",),
    hold_kind: str = "zoh",
    nthread: int | None = None,
    before: Callable[[np.ndarray], np.ndarray] | None = None,
    time: float | np.ndarray = 0.0,
    keeps_diverged: bool = False,
) -> Mapping[str, np.ndarray]:
    """Simulate n copies of a model under one input sequence.

    Args:
        model: the model; its timestep divides `sampling_time`.
        start: initial states; n is the number of their rows, or of the values in `numbers`.
        inputs: shape (N, nu), the same for all, or (n, N, nu), one for each, in the units of the
            model's controls, but for those of actuators that have none (see `UNLOGGED`).
        sampling_time: time between samples [s].
        numbers: model entries that differ between simulations: slot and its values, shape (n,).
        record: MjData fields of the state to return (qpos, qvel, act).
        hold_kind: "zoh" or "foh".
        nthread: native threads; all processors when None.
        before: changes the held inputs before they reach the model:
            (steps, nu) -> (steps, nu) for all or (n, steps, nu).
        time: at the start, one for all or one for each, shape (n,) [s]; laws may depend on it.
        keeps_diverged: whether simulations that leave the finite numbers are NaN, and no error.

    Returns:
        For each recorded field an array (n, N, size); sample 0 is the start.
    """
    inputs = np.asarray(inputs, float)
    nu = logged_inputs(model)
    if inputs.ndim not in (2, 3) or inputs.shape[-1] != nu:
        raise InputError(f"inputs have shape {inputs.shape}; the model takes (N, {nu})")
    rows = [np.atleast_2d(x) for x in (start.qpos, start.qvel, start.act)]
    n = max([len(r) for r in rows] + [len(values) for _, values in numbers])
    every = substeps(sampling_time, model.opt.timestep)
    each = inputs[None] if inputs.ndim == 2 else inputs
    controls = hold(each, every, hold_kind)
    if before is not None and len(each) == 1:
        controls = before(controls[0])
        controls = controls if controls.ndim == 3 else controls[None]
    if len(each) not in (1, n):
        raise InputError(f"{len(each)} input sequences for {n} simulations; give one, or one each")

    return simulations(model, n, numbers, nthread).run(
        State(*rows), controls, every, record, time, keeps_diverged=keeps_diverged
    )


@dataclass(frozen=True)
class Simulations:
    """Simulations of one model, each with numbers of its own; see `simulations`."""

    model: mujoco.MjModel  # the model
    batch: Batch  # runs them; one call at a time
    fresh: np.ndarray  # what each simulation begins with, beside what `run` is told

    def run(
        self, start: State, controls: np.ndarray, every: int, record: Sequence[str],
        time: float | np.ndarray = 0.0, at: np.ndarray | None = None, keeps_diverged: bool = False,
    ) -> Mapping[str, np.ndarray]:  # fmt: skip
        """Runs k of the simulations; see `rollout`.

        Args:
            start: initial states, one row for all or k.
            controls: at each step, shape (1, steps, nu) for all or (k, steps, nu), without those of
                actuators that have none.
            every: steps of a sample.
            record: MjData fields of the state to return (qpos, qvel, act), each (k, N, size).
            time: at the start, one for all or one for each [s].
            at: which simulations, shape (k,); all when None.
            keeps_diverged: whether simulations that leave the finite numbers are NaN, and no error.
        """
        end_if_given_up()
        batch, model = self.batch, self.model
        which = np.arange(len(self.fresh)) if at is None else at
        k, steps = len(which), controls.shape[1]
        batch.state[which] = self.fresh[which]
        batch.warning[which] = 0  # the first warning of a simulation stops it, and no later one
        for field, row in zip(("qpos", "qvel", "act"), (start.qpos, start.qvel, start.act),
                              strict=True):  # fmt: skip
            if np.shape(row)[-1]:
                batch.bind(field)[which] = row
        begun = np.broadcast_to(np.asarray(time, float), k)
        batch.bind("time")[which] = begun
        first = {field: batch.bind(field)[which] for field in record}
        held = np.broadcast_to(controls, (k, *controls.shape[1:]))
        if held.shape[2] < model.nu:
            rest = np.zeros((k, steps, model.nu - held.shape[2]))
            held = np.concatenate([held, rest], axis=2)
        with quiet(), untimed():
            try:
                run = batch.rollout(steps, held, record=tuple(record), ids=at)
            except SimulationError as error:  # of the engine, which no other value may meet
                text = " ".join(str(error).rpartition("simulation ")[2].split())
                raise InputError(
                    f"MuJoCo refuses to simulate the model with these values ({text}); correct the"
                    " model or the values"
                ) from error
        reached = np.array(batch.bind("time")[which])
        # a non-finite state stops a simulation and its clock
        late = ~(reached > begun + (steps - 0.5) * model.opt.timestep)
        if late.any() and not keeps_diverged:
            raise _diverged(reached, late)
        for states in run.values() if late.any() else ():
            states[late] = np.nan
        return {
            f: np.concatenate([first[f][:, None], run[f][:, every - 1 :: every]], axis=1)
            for f in record
        }


def simulations(
    model: mujoco.MjModel, n: int, numbers: Sequence[tuple[Slot, np.ndarray]] = (),
    nthread: int | None = None,
) -> Simulations:  # fmt: skip
    """Prepares n simulations of a model, which may not change, to be run as often as one likes.

    Entries of the model that differ between them are given as `rollout` takes them. All processors
    serve them if `nthread` is None.
    """
    model = lean(model, numbers)
    batch = Batch(model, n, nthread or min(threads(), n))
    _expand(batch, numbers)
    return Simulations(model, batch, np.array(batch.state))


def _expand(batch: Batch, numbers: Sequence[tuple[Slot, np.ndarray]]) -> None:
    for slot, values in numbers:
        entries = batch.expand(slot.field)
        column = () if slot.column is None else (slot.column,)
        entries[(slice(None), list(slot.rows), *column)] = np.asarray(values)[:, None]
    if not all(slot.field in UNDERIVED for slot, _ in numbers):
        batch.set_const()


def _diverged(reached: np.ndarray, late: np.ndarray) -> DivergenceError:
    first = int(np.flatnonzero(late)[0])
    return DivergenceError(
        f"the simulation diverged at t = {reached[first]:.4g} s"
        + (f" (value set {first + 1} of {len(reached)})" if len(reached) > 1 else "")
        + "; use a smaller step, or values nearer to the nominal ones"
    )
