"""The plant linearised along a predicted trajectory: how small errors of state and input grow.

    δẋ = F(t) δx + G(t) δu,    δx_{k+1} = A_k δx_k + B_k δu_k,    δy_k = C δx_k

    [A_k B_k; 0 I] = exp([F G; 0 0] T_s)                               (Van Loan 1978)

x is MuJoCo's state in tangent space: position (nv), velocity (nv), activation (na). The columns of
F that belong to position and velocity come from MuJoCo's finite differences of one short Euler
step; the others are finite differences of accelerations.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.linalg import expm
from threadpoolctl import threadpool_limits

from identification.model.predictor import Predictor, output_columns
from identification.model.rollout import rollout

SHORT = 1e-6  # Euler step whose difference from the identity is F [s]
EPS = 1e-6  # of the finite differences


@dataclass(frozen=True)
class LinearPlant:
    """Linearisation at the N samples of a log.

    Attributes:
        A: transition from each sample to the next, shape (N-1, nx, nx); zeros where another
            record of a joined log begins.
        B: effect of an input held over the sample, shape (N-1, nx, nu).
        C: outputs from the state, shape (ny, nx).
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray


def linearise(predictor: Predictor, values: np.ndarray, forces: Sequence[int] = ()) -> LinearPlant:
    """Linearise a plant along the trajectory that it predicts for one value set.

    Args:
        predictor: plant and log.
        values: shape (p,), in the parameters' units.
        forces: degrees of freedom; where given, B is the effect of generalised forces on them
            instead of the effect of the inputs.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    each = [
        _of_record(record, values[..., columns], forces) for record, columns in predictor.records()
    ]
    return each[0] if len(each) == 1 else _joined(each)


def _joined(each: Sequence[LinearPlant]) -> LinearPlant:
    """The plants of several records, one after the other; nothing passes from one to the next."""
    gap = LinearPlant(np.zeros_like(each[0].A[:1]), np.zeros_like(each[0].B[:1]), each[0].C)
    parts = [part for plant in each for part in (gap, plant)][1:]
    return LinearPlant(
        np.concatenate([p.A for p in parts]), np.concatenate([p.B for p in parts]), each[0].C
    )


def _of_record(predictor: Predictor, values: np.ndarray, forces: Sequence[int]) -> LinearPlant:
    """The linearisation along one record."""
    plant, log = predictor.plant, predictor.log
    start, numbers = predictor.settings(values)
    states = rollout(
        plant.model, start, log.inputs, log.sampling_time, numbers=numbers,
        record=("qpos", "qvel", "act") if plant.model.na else ("qpos", "qvel"),
        hold_kind=log.hold, before=predictor.inputs(values), time=log.begun,
    )  # fmt: skip
    model = copy.copy(plant.model)
    for slot, column in numbers:
        getattr(model, slot.field)[slot.index()] = column[0]
    mujoco.mj_setConst(model, mujoco.MjData(model))
    along = {field: values[0] for field, values in states.items()}
    F, G = _derivatives(model, along, log.inputs, log.sampling_time, log.begun, forces)
    C = np.zeros((log.outputs.shape[1], F.shape[1]))
    for row, (field, i) in enumerate(output_columns(model, log.output_names)):
        C[row, _tangent(model, field, i)] = 1
    F, G = (F[:-1] + F[1:]) / 2, (G[:-1] + G[1:]) / 2
    felt = _felt(F, C)
    F, G, C = F[:, felt][:, :, felt], G[:, felt], C[:, felt]
    nx, nu = F.shape[1], G.shape[2]
    block = np.zeros((len(F), nx + nu, nx + nu))
    block[:, :nx] = np.concatenate([F, G], axis=2) * log.sampling_time
    with threadpool_limits(1, "blas"):  # the matrices are small, so threads would only wait
        block = expm(block)
    return LinearPlant(block[:, :nx, :nx], block[:, :nx, nx:], C)


def _felt(F: np.ndarray, C: np.ndarray) -> np.ndarray:
    """Which states have an effect on an output, directly or through others, shape (nx,)."""
    links = np.abs(F).max(axis=0) > 0
    felt = np.any(C != 0, axis=0)
    while (more := felt | links[felt].any(axis=0)).sum() > felt.sum():
        felt = more
    return felt


def _derivatives(
    model: mujoco.MjModel,
    states: dict[str, np.ndarray],
    inputs: np.ndarray,
    sampling_time: float,
    begun: float,
    forces: Sequence[int],
) -> tuple[np.ndarray, np.ndarray]:
    """F (N, nx, nx) and G (N, nx, nu) at all samples."""
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    model.opt.timestep = SHORT
    data = mujoco.MjData(model)
    moved, nx, n = 2 * model.nv, 2 * model.nv + model.na, len(inputs)
    F, G = np.empty((n, nx, nx)), np.zeros((n, nx, len(forces) or model.nu))
    unit, pushed = np.eye(model.nv)[list(forces)], np.empty((len(forces), model.nv))
    for k in range(n):
        data.time = begun + k * sampling_time
        data.qpos, data.qvel, data.ctrl = states["qpos"][k], states["qvel"][k], inputs[k]
        if model.na:
            data.act = states["act"][k]
        mujoco.mjd_transitionFD(model, data, EPS, 1, F[k], None, None, None)
        F[k] = (F[k] - np.eye(nx)) / SHORT
        F[k, :, moved:] = _differences(model, data, "act", model.na)
        if forces:
            mujoco.mj_forward(model, data)
            mujoco.mj_solveM(model, data, pushed, unit)
            G[k, model.nv : moved] = pushed.T
        else:
            G[k] = _differences(model, data, "ctrl", model.nu)
    return F, G


def _differences(model: mujoco.MjModel, data: mujoco.MjData, field: str, n: int) -> np.ndarray:
    """Columns of F or G for activations or inputs, shape (nx, n).

    MuJoCo's own differences keep the passive forces constant while activations and inputs change.
    The passive forces of a callback may depend on them: the tension of a cable depends on an
    activation, the length that its drum has paid out.
    """
    out = np.zeros((1 + n, 2 * model.nv + model.na))
    at = getattr(data, field)
    for i in range(-1, n):  # -1: nothing is changed
        if i >= 0:
            was = at[i]
            at[i] = was + EPS
        mujoco.mj_forward(model, data)
        out[1 + i, model.nv : 2 * model.nv] = data.qacc
        out[1 + i, 2 * model.nv :] = data.act_dot
        if i >= 0:
            at[i] = was
    return ((out[1:] - out[0]) / EPS).T


def _tangent(model: mujoco.MjModel, field: str, i: int) -> int:
    """Index in the tangent state of an entry of qpos (of a hinge or slide) or qvel."""
    if field == "qvel":
        return model.nv + i
    joint = int(np.flatnonzero(model.jnt_qposadr == i)[0])
    return int(model.jnt_dofadr[joint])
