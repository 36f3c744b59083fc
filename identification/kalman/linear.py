"""The plant linearised along a predicted trajectory: how small errors of state and input grow.

    ẋ = f(x, u, θ),    F = ∂f/∂x,  G = ∂f/∂u           differences of accelerations, at the points
    δẋ = F(t) δx + G(t) δu,    δx_{k+1} = A_k δx_k + B_k δu_k,    δy_k = C δx_k
    A = exp(F Δt),    Γ = ∫ exp(F τ) E dτ over Δt             (`identification.kalman.response`)

E are the columns of the identity of velocities and activations: nothing else is forced. x is
MuJoCo's state in tangent space: position (nv), velocity (nv), activation (na). F and G are means
over an interval, of which a sample has a few. The points of a trajectory are many and its means are
coarse, so forward differences are enough for all but velocities, which take secants
(`identification.linear.derivatives`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np

from identification.kalman.response import transitions
from identification.kalman.trajectory import COARSE_POINTS, Trajectory, follow_records
from identification.linear.derivatives import FORWARD, differences, position_rows
from identification.linear.points import Change, Points
from identification.model.predictor import Predictor, output_columns
from identification.native.forward import Intervals
from identification.runtime.engine import quiet
from identification.runtime.pool import one_blas_thread


@dataclass(frozen=True, eq=False)
class LinearPlant:
    """The linearisation at the N samples of a log."""

    # transition from each sample to the next, shape (N-1, nx, nx); zeros where another record of a
    # joined log begins
    A: np.ndarray
    B: np.ndarray  # effect of an input held over the sample, shape (N-1, nx, nu)
    C: np.ndarray  # outputs from the state, shape (ny, nx)
    # which entries of the state are x, shape (2 nv + na,); None where nobody knows
    felt: np.ndarray | None = None


@dataclass(frozen=True)
class Linearisation:
    """The linearisation of one record over the L intervals of its trajectory."""

    along: Trajectory  # the trajectory
    A: np.ndarray  # transition over each interval, shape (L, nx, nx)
    # effect of a constant rate of change of each velocity and activation, shape (L, nx, nf)
    Γ: np.ndarray
    B: np.ndarray  # effect of a constant input, shape (L, nx, nu)
    C: np.ndarray  # outputs from the state, shape (ny, nx)
    # which entries of the state are x: those that outputs feel, shape (2 nv + na,)
    felt: np.ndarray

    @cached_property
    def of_inputs(self) -> tuple[np.ndarray, np.ndarray]:
        """Change of the rates per unit of each input, upwards and downwards, (M, nf, nu) each."""
        upwards, downwards = input_derivatives(self.along)
        felt = self.felt[self.along.model.nv :]
        return upwards[:, felt], downwards[:, felt]

    def at_samples(self) -> LinearPlant:
        """Returns the transitions from sample to sample."""
        parts = self.along.intervals
        A, B = self.A[::parts], self.B[::parts]
        for i in range(1, parts):
            A, B = self.A[i::parts] @ A, self.A[i::parts] @ B + self.B[i::parts]
        return LinearPlant(A, B, self.C, self.felt)


def linearise(predictor: Predictor, values: np.ndarray, forces: Sequence[int] = ()) -> LinearPlant:
    """Linearise a plant along the trajectory of one value set (p,), in the parameters' units.

    Args:
        predictor: plant and log.
        values: shape (p,).
        forces: degrees of freedom; where given, B is the effect of generalised forces on them
            instead of the effect of the inputs. All of them where the log has no inputs.

    Raises:
        DivergenceError: the simulation left the finite numbers.
    """
    return join(linearise_records(predictor, values, forces))


def linearise_records(
    predictor: Predictor,
    values: np.ndarray,
    forces: Sequence[int] = (),
    points: int = COARSE_POINTS,
) -> tuple[Linearisation, ...]:
    """Returns the linearisation of each record of a log; see `linearise`.

    What acts is known at `points` for each sample. Slopes need few: what a change adds may turn
    with the angle of a motor within an interval, and slopes do not.
    """
    coarse, fine = follow_records(predictor, values, COARSE_POINTS, points)
    return tuple(
        replace(linearise_along(record, each, forces), along=along)
        for (record, _), each, along in zip(predictor.records(), coarse, fine, strict=True)
    )


def join(records: Sequence[Linearisation]) -> LinearPlant:
    """Returns one plant for several records, one after the other; nothing passes between them."""
    return join_plants([record.at_samples() for record in records])


def join_plants(each: Sequence[LinearPlant]) -> LinearPlant:
    """Returns one plant for several plants at samples, one after the other."""
    if len(each) == 1:
        return each[0]
    gap = LinearPlant(np.zeros_like(each[0].A[:1]), np.zeros_like(each[0].B[:1]), each[0].C)
    parts = [part for plant in each for part in (gap, plant)][1:]
    return LinearPlant(
        np.concatenate([p.A for p in parts]), np.concatenate([p.B for p in parts]),
        each[0].C, each[0].felt,
    )  # fmt: skip


def linearise_along(
    predictor: Predictor, along: Trajectory, forces: Sequence[int] = ()
) -> Linearisation:
    """Returns the linearisation of a predictor's outputs along one trajectory."""
    F, G = _derivatives(predictor, along, forces)
    C = _outputs(predictor, along)
    return _linearisation(along, F, G, C, _felt(F, C))


def extend(known: LinearPlant, predictor: Predictor, along: Trajectory) -> LinearPlant:
    """Returns the plant along a record of which it knows the first samples already."""
    rest = along.after(len(known.A))
    if known.felt is None:
        return linearise_along(predictor, along).at_samples()
    if not len(rest.begins):
        return known
    F, G = _derivatives(predictor, rest)
    if F[:, known.felt][:, :, ~known.felt].any():  # it feels more states
        return linearise_along(predictor, along).at_samples()
    new = _linearisation(rest, F, G, _outputs(predictor, along), known.felt).at_samples()
    A, B = np.concatenate([known.A, new.A]), np.concatenate([known.B, new.B])
    return LinearPlant(A, B, known.C, known.felt)


def _derivatives(
    predictor: Predictor, along: Trajectory, forces: Sequence[int] = ()
) -> tuple[np.ndarray, np.ndarray]:
    """Returns F and G of the whole state; G is that of forces where they are asked for."""
    F, G = state_derivatives(along)
    if not forces and not predictor.log.inputs.shape[1]:
        forces = range(along.model.nv)  # what disturbs a free swing, for it has no inputs
    if forces:
        G = along.average(force_derivatives(along, list(forces)))
    return F, G


def state_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Returns means of F (L, nx, nx) and G (L, nx, nu) over the intervals of a trajectory."""
    nv = along.model.nv
    of_state, of_inputs = differences(along, Points(along), FORWARD, along.weighted, along.moved)
    rows = along.average(position_rows(along.model, along.qvel))
    return (
        np.concatenate([rows, of_state], axis=1),
        np.concatenate([np.zeros((len(rows), nv, of_inputs.shape[2])), of_inputs], axis=1),
    )


def input_derivatives(along: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Returns changes of all rates per unit of each input, upwards and downwards, at the points.

    Each has the shape (M, nf, nu), nf = nv + na. They differ where an input is at its limit.
    """
    h, alone = FORWARD.step, Intervals(np.arange(len(along.time)), np.ones(len(along.time)))
    nu = along.inputs.shape[1]
    shifted = (Change({"ctrl": along.inputs + by}) for by in (*h * np.eye(nu), *-h * np.eye(nu)))
    each = [change / h for change in Points(along).each(shifted, alone)]
    if not each:
        nothing = np.zeros((len(along.time), along.model.nv + along.model.na, 0))
        return nothing, nothing
    return np.stack(each[:nu], axis=-1), -np.stack(each[nu:], axis=-1)


@quiet()
def force_derivatives(along: Trajectory, dofs: list[int]) -> np.ndarray:
    """Returns the effect of generalised forces on the rate of the state, shape (M, nx, n)."""
    model = along.model
    nv = model.nv
    data, unit = mujoco.MjData(model), np.eye(nv)[dofs]
    pushed = np.empty_like(unit)
    G = np.zeros((len(along.time), 2 * nv + model.na, len(dofs)))
    for k, (qpos, qvel) in enumerate(zip(along.qpos, along.qvel, strict=True)):
        data.qpos, data.qvel = qpos, qvel
        mujoco.mj_forward(model, data)
        mujoco.mj_solveM(model, data, pushed, unit)
        G[k, nv : 2 * nv] = pushed.T
    return G


def _outputs(predictor: Predictor, along: Trajectory) -> np.ndarray:
    """Returns C of the whole state, shape (ny, 2 nv + na)."""
    model, names = along.model, predictor.log.output_names
    C = np.zeros((len(names), 2 * model.nv + model.na))
    for row, (field, i) in enumerate(output_columns(predictor.plant.model, names)):
        C[row, tangent_index(model, field, i)] = 1
    return C


def _linearisation(
    along: Trajectory, F: np.ndarray, G: np.ndarray, C: np.ndarray, felt: np.ndarray
) -> Linearisation:
    """Returns the linearisation by derivatives of the whole state, for the states that are felt."""
    if not felt.all():
        entries, nx = np.flatnonzero(np.outer(felt, felt)), int(felt.sum())
        F = F.reshape(len(F), -1).take(entries, axis=1).reshape(-1, nx, nx)  # faster than by masks
        G, C = G[:, felt], C[:, felt]
    positions = int(felt[: along.model.nv].sum())
    with one_blas_thread():
        A, Γ = transitions(F, along.duration, positions)
    return Linearisation(along, A, Γ, Γ @ G[:, positions:], C, felt)


def _felt(F: np.ndarray, C: np.ndarray) -> np.ndarray:
    """Returns which states affect an output, directly or through others, shape (nx,)."""
    links = (F != 0).any(axis=0)
    felt = np.any(C != 0, axis=0)
    while (more := felt | links[felt].any(axis=0)).sum() > felt.sum():
        felt = more
    return felt


def tangent_index(model: mujoco.MjModel, field: str, i: int) -> int:
    """Returns the index in the tangent state of an entry of qpos (of a hinge or slide) or qvel."""
    if field == "qvel":
        return int(model.nv) + i
    joint = int(np.flatnonzero(model.jnt_qposadr == i)[0])
    return int(model.jnt_dofadr[joint])
