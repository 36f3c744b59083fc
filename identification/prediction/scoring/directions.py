"""The steps of all windows of a record, linearised along what a fit predicts.

    δx_{k+1} = A_k δx_k + B_k δτ_k,    δx_0 = 0,    δy = C δx

The steps are those of the model for slopes (`identification.windows.shooting`). A force on joints
enters them as a generalised force δτ, so that a linearisation, which costs as much as some ten
simulations, gives the response to any number of forces.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.effects.plant.jointed import JointPlant
from identification.errors import DivergenceError
from identification.kalman.response import respond
from identification.model.lean import RK4
from identification.model.predictor import Predictor, output_columns
from identification.model.protocol import with_numbers
from identification.model.rollout import State, without_sensors
from identification.native.joints.holding import MOST
from identification.native.step_slopes import StepSlopes, linearise_steps
from identification.windows.batches import at_own_steps, rough
from identification.windows.held import NO_VALUES, HeldWindows, at_values, held_windows
from identification.windows.shooting import Shooting

MOST_SLOPES = 2e7  # entries of all A at most: 160 MB


@dataclass(frozen=True, kw_only=True)
class Directions:
    """W windows of K steps each, linearised; P = W K points, one window after the other."""

    predictor: Predictor  # all parameters held
    plant: JointPlant  # the plant
    slopes: StepSlopes  # of the steps
    run: dict[str, np.ndarray]  # fields of the state at the samples, each (W, L, size)
    times: np.ndarray  # when each window begins in its record, shape (W,) [s]
    every: int  # steps of a sample

    @property
    def is_smooth(self) -> np.ndarray:
        """Whether no limit or contact acts in a window, shape (W,)."""
        largest = self.slopes.limited.reshape(len(self.times), -1).max(axis=1)
        return np.asarray(largest == 0)

    def dofs(self) -> list[int]:
        """Returns the degree of freedom of each joint that carries effects."""
        return [int(self.plant.model.joint(j).dofadr[0]) for j in self.plant.joints]

    def outputs(self, τ: np.ndarray, scale: np.ndarray) -> np.ndarray:
        """Returns how outputs change with m forces, shape (W, L, ny, m), over `scale`.

        Args:
            τ: the generalised forces at the points, shape (m, P, J), at the plant's joints.
            scale: by which each is divided, shape (m,), where sensors are linear.
        """
        model, W, m = self.plant.model, len(self.times), len(τ)
        sensors = self.predictor.log.output_names
        read, q, v = _indices(model, sensors)
        A, B = (x.reshape(W, -1, *x.shape[1:]) for x in (self.slopes.A, self.slopes.B))
        B = np.ascontiguousarray(B[..., self.dofs()])
        forces, first = τ.reshape(m, W, -1, τ.shape[2]), np.zeros((m, A.shape[2]))
        rows = np.array([*read, *q, *v])
        here = self.predictor.readings(self.run, self.times)
        is_perfect = np.may_share_memory(self.predictor.said(NO_VALUES, here), here)
        rows = rows[: len(read)] if is_perfect else rows
        δ = np.stack([
            respond(A[w], B[w], first, forces[:, w], self.every, rows) for w in range(W)
        ], axis=1)  # fmt: skip
        if not is_perfect:
            moved = np.repeat(here[:, None], m, axis=1)
            moved[:3] += np.moveaxis(δ.reshape(*δ.shape[:3], 3, len(read)), 3, 0)
            both = np.concatenate([here[:, None], moved], axis=1)
            y = self.predictor.said(NO_VALUES, both.reshape(4, -1, *here.shape[2:]))
            y = y.reshape(1 + m, *here.shape[1:])
            δ = y[1:] - y[:1]
        return np.moveaxis(δ / scale[:, None, None, None], 0, -1)


def directions(part: Shooting, q: np.ndarray, d: np.ndarray) -> Directions | None:
    """Returns the windows of a record linearised at q (p,) and d (W, nx); None where none hold.

    They do not where joints have states of their own, where positions are quaternions, where steps
    have to be those of Runge and Kutta (`identification.model.lean`), and of robots with so many
    degrees of freedom that their slopes would take much memory.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    plant = part.predictor.plant
    if not isinstance(plant, JointPlant) or plant.states:
        return None
    if plant.model.nq != plant.model.nv or plant.model.nv > MOST:
        return None
    part = at_values(part, q)
    held, start = held_windows(part), part.states(d)
    model = rough(plant)
    if model.opt.integrator == RK4:
        return None
    try:
        return _along(plant, held, start, model)
    except DivergenceError:  # longer steps may diverge where the model's own do not
        return _along(plant, held, start, at_own_steps(model, plant.model))


def _along(
    plant: JointPlant, held: HeldWindows, start: State, model: mujoco.MjModel
) -> Directions | None:
    """Returns the windows of a record, linearised along the steps of a model."""
    prepared = held.prepared(model, 1)
    W, K, _ = prepared.controls.shape
    if W * K * (2 * model.nv + model.na) ** 2 > MOST_SLOPES:
        return None
    fields = ("qpos", "qvel", "act") if model.na else ("qpos", "qvel")
    run = prepared.simulations.run(start, prepared.controls, 1, fields, held.times)
    time = held.times[:, None] + model.opt.timestep * np.arange(K)
    states = [time[..., None], *(run[f][:, :-1] for f in fields), prepared.controls]
    x = np.concatenate(states, axis=2).reshape(W * K, -1)
    numbers = [(slot, column[:1]) for slot, column in held.numbers]
    at = without_sensors(with_numbers(model, numbers, 0))
    joints = np.array([int(at.joint(j).id) for j in plant.joints])
    return Directions(
        predictor=held.predictors[0], plant=plant,
        slopes=linearise_steps(at, x, joints, plant.layout.entries),
        run={f: np.asarray(y[:, :: prepared.every]) for f, y in run.items()},
        times=held.times, every=prepared.every,
    )  # fmt: skip


def _indices(model: mujoco.MjModel, sensors: tuple[str, ...]) -> list[list[int]]:
    """Returns indices in x of each sensor's reading, and of its joint's position and rate."""
    read = [i + model.nv * (field == "qvel") for field, i in output_columns(model, sensors)]
    dofs = [int(model.jnt_dofadr[model.sensor(name).objid[0]]) for name in sensors]
    return [read, dofs, [model.nv + dof for dof in dofs]]
