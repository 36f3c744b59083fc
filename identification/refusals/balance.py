"""The drives' forces that a log cannot explain, whatever may be wrong with the model's numbers.

    τ = Σ_b s_b (M_b(q) q̈ + c_b(q, q̇)) + Σ_p m_p (M_p(q) q̈ + c_p) + Σ_g γ_g g_g(q) + …
        … + d q̇ + f_c sign q̇ + f_0 + κ k (q - q_0)          s, κ in [1/4, 4], m_p, d, f_c ≥ 0
    η_j = Σ (τ_j - right side)² / Σ (τ_j - mean τ_j)²      least over s, m, γ, d, f_c, f_0, κ
    η   = Σ_j Σ (τ_j - right side)²/M_jj / Σ_j Σ (τ_j - mean τ_j)²/M_jj

b are the model's bodies and rotors, p points of the outermost bodies that may carry a payload. Each
γ is the weight of a body along an axis, or of what it carries: gravity may be missing, turned or
too much, but no more than what a mass four times as large and a payload weigh: else it would stand
for a torque in a smaller unit. So η_j is what no payload, gravity, friction or mass explains; only
a wrong unit, sign or order of columns does. The motion is smoothed by ψ
(`identification.refusals.forces`).

A drive that rests while other joints swing its own has a large η_j, because a little that the model
lacks is more than what that drive gives. So η weighs all joints by the inertia M_jj that they move.

    min ‖A x - b‖²,  low ≤ x ≤ high                A = Q R,  Qᵀ b = c:  min ‖R x - c‖², R square
    R_f z + R_b y = c,  z without bounds  ->  min ‖P (R_b y - c)‖² over y,   P = I - R_f R_f⁺

Of a long chain of bodies many columns are nearly sums of others. Unknowns that hardly change what
is left are then huge without their bounds, where a solver of bounds begins, and it does not come
back. So they are held by a weak pull to zero. Unknowns without bounds follow from the others, so
that the solver, whose steps take the square of its columns, is spared them.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from identification.logs.log import Log
from identification.model.predictor import output_columns, output_dofs
from identification.refusals.forces import (
    Smooth,
    inertial_force,
    is_hidden,
    point_force,
    smoothed,
    tendon_forces,
    weights,
    widths,
)
from identification.runtime.engine import quiet
from identification.torques.equations.bodies import follow_bodies

FACTOR = 4.0  # that a mass, an inertia or a stiffness may be off; more is a matter of units
GRAVITY = 9.81  # the most that a robot weighs by its mass [m/s^2]
PAYLOAD = 1.0  # largest, of the mass of all that moves
# Samples that are used; neighbours say the same, because ψ overlaps. Of many joints fewer are, as
# each sample gives an equation a joint, and the unknowns are some twenty a joint.
ROWS, MOST_EQUATIONS = 300, 6000
FAR = (1.0, 1 / 3)  # of the robot's size, that a payload's points are away from its body
SCALAR = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
# Share of the largest diagonal of R below which a column is a sum of the others, to rounding.
DEPENDENT = 1e-10
PULL = 1e-4  # of an unknown, that it adds to what is left; columns are of a size of one, or more


@dataclass(frozen=True)
class Unbalanced:
    """What the balance of forces leaves of the drives' forces."""

    of_outputs: np.ndarray  # η_j of the joint of each output, shape (ny,), without unit
    # η of all joints, without unit; zero where no drive gives a force, so that nothing contradicts
    whole: float


def unbalanced_share(model: mujoco.MjModel, log: Log) -> np.ndarray | None:
    """Returns η_j of the joint of each output, shape (ny,), without unit; see `unbalanced`."""
    found = unbalanced(model, log)
    return None if found is None else found.of_outputs


def unbalanced(
    model: mujoco.MjModel, log: Log, springs: bool = False, wider: int = 1
) -> Unbalanced | None:
    """Returns what the balance of forces leaves of the drives' forces.

    Args:
        model: with the log's actuators and sensors.
        log: as it is read.
        springs: whether each joint may have a spring that the model lacks.
        wider: times as long a ψ, for motion that is rougher than its noise says.

    Returns:
        None where a joint is not measured or is neither hinge nor slide, drives have states, bodies
        are tied, or noise hides the accelerations or the forces that they need.
    """
    columns = output_columns(model, log.output_names)
    at = {i: k for k, (field, i) in enumerate(columns) if field == "qpos"}
    plain = np.isin(model.jnt_type, SCALAR).all() and not (model.neq or model.na)
    if not plain or sorted(at) != [*range(model.nq)]:
        return None
    found = _shortest(model, log, log.outputs[:, [at[i] for i in range(model.nq)]], wider)
    if found is None:
        return None
    motion, force = found
    A, low, high = _columns(model, motion, springs)
    size = given = force.std(axis=0)
    masses = A[:, :, : int(np.sum(low > 0))].sum(axis=2)  # of the model's own masses
    size = np.where(size > 0, size, np.sqrt(np.mean(masses**2, axis=0)))  # joints without a drive
    size = np.where(size > 0, size, 1.0)
    flat = (A / size[None, :, None]).reshape(-1, A.shape[2])
    norm = np.linalg.norm(flat, axis=0)
    used = norm > 1e-9 * norm.max()
    b = (force / size).ravel()
    flat = flat[:, used] / norm[used]
    x = solve_bounded(flat, b, low[used] * norm[used], high[used] * norm[used])
    rest = (b - flat @ x).reshape(force.shape)
    eta = np.mean(rest**2, axis=0)
    weight = 1 / np.maximum(model.dof_M0, np.finfo(float).tiny)
    left, felt = (float(np.sum(x * weight)) for x in (eta * size**2, given**2))
    return Unbalanced(
        np.asarray(eta[output_dofs(model, log.output_names)]), left / felt if felt > 0 else 0.0
    )


def _shortest(
    model: mujoco.MjModel, log: Log, q: np.ndarray, wider: int
) -> tuple[Smooth, np.ndarray] | None:
    """Returns the motion through the shortest ψ that noise does not hide, and the drives' forces.

    Of positions q (n, nv); ψ is then made some times wider.
    """
    rows = min(ROWS, MOST_EQUATIONS // model.nv)
    for w in widths(q, log.sampling_time, wider):
        motion = smoothed(q, log, w, rows)
        force = _drive_forces(model, motion)
        if is_hidden(model, motion, q, w, log.sampling_time, np.ptp(force, axis=0) > 0):
            continue
        if wider > 1:
            motion = smoothed(q, log, w * wider, rows)
            force = _drive_forces(model, motion)
        return motion, force
    return None


@quiet()
def _drive_forces(model: mujoco.MjModel, motion: Smooth) -> np.ndarray:
    """Returns the forces of the drives on the joints (n, nv)."""
    data, force = mujoco.MjData(model), np.empty(motion.v.shape)
    for k in range(len(force)):
        data.qpos, data.qvel, data.ctrl = motion.q[k], motion.v[k], motion.u[k]
        mujoco.mj_forward(model, data)
        force[k] = data.qfrc_actuator
    return force


def _columns(
    model: mujoco.MjModel, motion: Smooth, may_have_springs: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns what may explain the forces, (n, nv, columns), and the bounds of the sizes."""
    moving = [b for b in range(1, model.nbody) if model.body_weldid[b] and model.body_mass[b] > 0]
    outer = [b for b in moving if not any(model.body_parentid[c] == b for c in moving)]
    reach = _size(model, moving)
    nv, n, least = model.nv, len(motion.v), np.finfo(float).tiny
    bodies = follow_bodies(model, motion.q, motion.v, motion.a, moving)
    masses = [inertial_force(body, float(model.body_mass[b]), model.body_inertia[b])
              for b, body in bodies.items()]  # fmt: skip
    rotors = [motion.a * (model.dof_armature * (np.arange(nv) == j))
              for j in range(nv) if model.dof_armature[j]]  # fmt: skip
    stiff = [(motion.q - model.qpos_spring) * (model.jnt_stiffness * (np.arange(nv) == j))
             for j in range(nv) if model.jnt_stiffness[j]]  # fmt: skip
    resisting, springs = tendon_forces(model, motion.q, motion.v)
    stiff += springs
    points = [np.zeros(3)]
    points += [s * far * reach * e for far in FAR for s in (-1, 1) for e in np.eye(3)]
    payload = [point_force(bodies[b], p) for b in outer for p in points]
    near = [np.zeros(3), *(reach * np.eye(3))]
    weight = [w for body in bodies.values() for p in near for w in weights(body, p)]
    each = [np.where(np.arange(nv) == j, x, 0.0)
            for j in range(nv) for x in (motion.v, np.sign(motion.v),
                                         *([motion.q] if may_have_springs else []))]  # fmt: skip
    each += resisting
    most = max(PAYLOAD * float(model.body_mass[moving].sum()), least)
    weights_of = np.repeat([float(model.body_subtreemass[b]) for b in bodies], 3 * len(near))
    # With springs too, it is asked whether the motion is too large, and all else is free.
    heavy = np.inf * weights_of if may_have_springs else GRAVITY * (FACTOR * weights_of + most)
    level = [np.broadcast_to(np.arange(nv) == j, (n, nv)).astype(float) for j in range(nv)]
    low, high = [], []
    for found, (a, b) in (
        (masses + rotors + stiff, (1 / FACTOR, FACTOR)), (payload, (0.0, most)),
        (each, (0.0, np.inf)),
    ):  # fmt: skip
        low += [a] * len(found)
        high += [b] * len(found)
    low += [*-heavy, *[-np.inf] * nv]
    high += [*heavy, *[np.inf] * nv]
    every = [*masses, *rotors, *stiff, *payload, *each, *weight, *level]
    return np.stack(every, axis=2), np.array(low), np.array(high)


def _size(model: mujoco.MjModel, moving: list[int]) -> float:
    """Returns how far the centres of mass are apart, or from the base [m]."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    centres = data.xipos[moving]
    from_axes = np.linalg.norm(centres - data.xpos[moving], axis=1).max(initial=0.0)
    return float(max(np.ptp(centres, axis=0).max(initial=0.0), from_axes)) or 0.1


def solve_bounded(A: np.ndarray, b: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Computes the unknowns (n,) within bounds, infinite for none, that leave least of b (m,)."""
    from scipy.linalg import qr  # slow to import
    from scipy.optimize import lsq_linear

    R, c = _triangle(A, b)
    is_free = np.isinf(low) & np.isinf(high)
    bounded = ~is_free
    Q, T, order = qr(R[:, is_free], pivoting=True)
    size = np.abs(np.diag(T))
    rank = int(np.sum(size > DEPENDENT * size.max(initial=0.0)))
    turned, goal = Q.T @ R[:, bounded], Q.T @ c
    x = np.zeros(A.shape[1])
    if bounded.any():
        n = turned.shape[1]
        pulled = np.vstack([turned[rank:], PULL * np.eye(n)])
        small, rest = _triangle(pulled, np.append(goal[rank:], np.zeros(n)))
        x[bounded] = lsq_linear(small, rest, (low[bounded], high[bounded])).x
    z = np.zeros(int(is_free.sum()))
    if rank:
        from scipy.linalg import solve_triangular

        z[order[:rank]] = solve_triangular(
            T[:rank, :rank], goal[:rank] - turned[:rank] @ x[bounded]
        )
    x[is_free] = z
    return x


def _triangle(A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns R and Qᵀ b of A = Q R, or A and b where they have no more rows than columns."""
    if len(A) <= A.shape[1]:
        return A, b
    both: np.ndarray = np.linalg.qr(np.column_stack([A, b]), mode="r")  # type: ignore[assignment]
    return both[:, :-1], both[:, -1]
