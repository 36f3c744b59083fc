"""Multiple shooting: windows of a log whose initial states are nuisances.

    ε_w(q, x_w) = C (y_w - ŷ_w(q, x_w)),   w = 1..W        each window begins at a state of its own
    X_w = -∂ε_w/∂x_w = U_w Σ_w V_wᵀ                         felt directions of that state only
    x_w ← x_w + X_w⁺ ε_w                                    Gauss-Newton, for every trial q
    S_w ← (I - U_w U_wᵀ) S_w                                what the state cannot make up for

This is variable projection (Golub and Pereyra 1973, in Kaufman's form). A free run adds up all that
disturbs the robot, and an unstable one loses it; a window forgets after its length. The states
begin at the measured outputs and their rates, and where none is measured on a free run. They move
in the tangent of qpos (as `mj_integratePos`), in qvel and in act, all in one `Batch.rollout`.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.coordinates import Coordinates
from identification.errors import DivergenceError, InputError
from identification.log import Log
from identification.predictor import Predictor, output_columns
from identification.rollout import State, rollout
from identification.sensitivity import STEP

FELT = 1e-6  # of the strongest direction of a state, each entry scaled to its own effect


@dataclass(frozen=True)
class Windows:
    """A log in W windows of L samples; a rest shorter than a window is left out.

    Attributes:
        inputs: shape (W, L, nu).
        outputs: shape (W, L, ny).
        starts: first sample of each window, shape (W,).
    """

    inputs: np.ndarray
    outputs: np.ndarray
    starts: np.ndarray


def windows(log: Log, length: float) -> Windows:
    """Split a log into windows of a length [s].

    Raises:
        InputError: a window has fewer than 3 samples, or the log is shorter than one.
    """
    samples = round(length / log.sampling_time)
    if samples < 3 or samples > len(log):
        raise InputError(
            f"windows of {length:g} s do not fit a log of {log.duration:g} s sampled every"
            f" {log.sampling_time:g} s; take 3 samples or more, and no more than the log has"
        )
    starts = samples * np.arange(len(log) // samples)
    rows = starts[:, None] + np.arange(samples)
    return Windows(log.inputs[rows], log.outputs[rows], starts)


@dataclass(frozen=True)
class Windowed:
    """Windows explained as well as their initial states can.

    Attributes:
        residual: C ε at these states, shape (W, L, ny).
        J: ∂(C ε)/∂q with the states projected out, shape (W, L, ny, p).
        states: initial states, W rows.
        freedom: directions of all states that the outputs feel.
    """

    residual: np.ndarray
    J: np.ndarray
    states: State
    freedom: int


def first_states(predictor: Predictor, values: np.ndarray, cut: Windows) -> State:
    """States at the windows' starts: measured where an output tells, else on a free run."""
    plant, log = predictor.plant, predictor.log
    start, numbers = plant.settings(predictor.names, np.atleast_2d(values))
    fields = ("qpos", "qvel", "act")
    try:
        run = rollout(
            plant.model, start, log.inputs, log.sampling_time, numbers=numbers, record=fields,
            hold_kind=log.hold,
        )  # fmt: skip
        rows = {f: np.array(run[f][0, cut.starts]) for f in fields}
    except DivergenceError:
        rows = {f: np.repeat(np.atleast_2d(getattr(start, f)), len(cut.starts), 0) for f in fields}
    rate = np.gradient(log.outputs, log.sampling_time, axis=0)[cut.starts]
    columns = list(enumerate(output_columns(plant.model, log.output_names)))
    for k, (field, i) in sorted(columns, key=lambda item: item[1][0]):  # a measured rate is last
        rows[field][:, i] = log.outputs[cut.starts, k]
        if field == "qpos":
            joint = int(np.flatnonzero(plant.model.jnt_qposadr == i)[0])
            rows["qvel"][:, plant.model.jnt_dofadr[joint]] = rate[:, k]
    return State(**rows)


def windowed_residual(
    predictor: Predictor,
    space: Coordinates,
    q: np.ndarray,
    cut: Windows,
    states: State,
    whitener: np.ndarray,
    iterations: int = 3,
) -> Windowed:
    """Residual of all windows at q, their states fitted from the given ones.

    Raises:
        DivergenceError: a window left the finite numbers.
    """
    model, W = predictor.plant.model, len(cut.starts)
    p, nx = len(q), 2 * model.nv + model.na
    felt = 0
    for i in range(iterations + 1):
        last = i == iterations
        moves = STEP * np.eye(p) if last else np.empty((0, p))
        sets = space.decode(np.concatenate([q[None], q + moves, q - moves]))
        shifts = np.concatenate([np.zeros((1, nx)), STEP * np.eye(nx), -STEP * np.eye(nx)])
        pick = np.concatenate([np.zeros(len(shifts), int), np.arange(1, len(sets))])
        along = np.concatenate([shifts, np.zeros((len(sets) - 1, nx))])
        y = _outputs(predictor, sets[pick], [moved(model, states, d) for d in along], cut)
        y = (y @ whitener.T).reshape(len(pick), W, -1)
        error = (cut.outputs @ whitener.T).reshape(W, -1) - y[0]
        ahead, behind, rest = y[1 : nx + 1], y[nx + 1 : 2 * nx + 1], y[2 * nx + 1 :]
        X = np.moveaxis(ahead - behind, 0, -1) / (2 * STEP)  # (W, L ny, nx)
        size = np.linalg.norm(X, axis=1, keepdims=True)
        size = np.where(size > 0, size, 1.0)
        U, s, Vt = np.linalg.svd(X / size, full_matrices=False)
        keep = s > FELT * np.maximum(s[:, :1], np.finfo(float).tiny)
        U, felt = U * keep[:, None], int(keep.sum())
        if last:
            S = np.moveaxis(rest[:p] - rest[p:], 0, -1) / (2 * STEP)
            S = S - U @ (np.swapaxes(U, 1, 2) @ S)
            shape = cut.outputs.shape
            return Windowed(error.reshape(shape), -S.reshape(*shape, p), states, felt)
        part = np.einsum("wnk,wn->wk", U, error) / np.where(keep, s, 1.0)
        step = np.einsum("wkx,wk->wx", Vt, part) / size[:, 0]
        states = moved(model, states, step)
    raise InputError(f"{iterations} iterations of the states; give none or more")


def moved(model: mujoco.MjModel, states: State, step: np.ndarray) -> State:
    """States moved along their tangent (qpos, qvel, act): by one step for all, or one each."""
    W, nv = len(states.qpos), model.nv
    steps = np.broadcast_to(step, (W, 2 * nv + model.na))
    qpos = np.array(states.qpos)
    for row, d in zip(qpos, steps, strict=True):
        mujoco.mj_integratePos(model, row, np.ascontiguousarray(d[:nv]), 1.0)
    return State(qpos, states.qvel + steps[:, nv : 2 * nv], states.act + steps[:, 2 * nv :])


def _outputs(
    predictor: Predictor, sets: np.ndarray, starts: list[State], cut: Windows
) -> np.ndarray:
    """Outputs of k value sets, each over all windows from its own states: (k, W, L, ny)."""
    plant, log, W = predictor.plant, predictor.log, len(cut.starts)
    fixed = {n: v for n, v in predictor.fixed.items() if n not in predictor.names}
    rest = np.broadcast_to(list(fixed.values()), (len(sets), len(fixed)))
    _, numbers = plant.settings((*predictor.names, *fixed), np.hstack([sets, rest]))
    rows = (np.concatenate([getattr(s, f) for s in starts]) for f in ("qpos", "qvel", "act"))
    states = rollout(
        plant.model, State(*rows), np.tile(cut.inputs, (len(sets), 1, 1)), log.sampling_time,
        numbers=[(slot, np.repeat(column, W)) for slot, column in numbers],
        record=("qpos", "qvel"), hold_kind=log.hold,
    )  # fmt: skip
    columns = output_columns(plant.model, log.output_names)
    y = np.stack([states[field][:, :, i] for field, i in columns], axis=-1)
    return y.reshape(len(sets), W, *y.shape[1:])
