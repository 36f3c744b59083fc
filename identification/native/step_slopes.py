"""The steps of a model, linearised at many states, and what joints and their frictions see there.

    x_{k+1} = F(x_k, τ),    x = (q, v, a)        a step of MuJoCo's integrator, with our laws in it
    A_k = ∂F/∂x,    B_k = ∂F/∂τ                  τ: a generalised force that is held over the step
    w = v/T + M⁻¹ (f_u - c + qfrc_passive),      g_i = w_i/R_ii,    R = M⁻¹

A is that of forward differences, each of which does again only what follows from what it moves:
all for a position, forces for a rate, actuators for an activation. B needs accelerations alone,
and without constraints it is exact. g is what is left of the force that would have to be resisted
to stop a joint when its friction has resisted (`identification.native.joints.holding`): zero where
friction holds it, of the direction of its motion where it slips. It has no forces of constraints,
because MuJoCo finds these when our laws have acted.

Forces of MuJoCo's own dry friction and of equality constraints are continuous functions of state
and force, and the differences have them. Limits and contacts act at times that depend on the
state, so that no slope of a step tells what another force does to them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import mujoco
import numpy as np
from numba import types

from identification.native import library, structs
from identification.native.cache import compile_once
from identification.native.forward_loop import NONE, POSITION, VELOCITY, clear, load_state
from identification.native.joints import joint_callback
from identification.native.joints.joint_callback import (
    HINGE,
    SLIDE,
    STOP,
    Joint,
    drive_force,
    joint,
)
from identification.native.library import (
    mj_Euler,
    mj_forwardSkip,
    mj_implicit,
    mj_rne,
    mobility,
    solve,
    unit,
)
from identification.native.memory import (
    integer,
    internal,
    load_constant,
    load_double,
    load_int,
    load_word,
    offsets,
    store_double,
    word,
)
from identification.runtime.engine import quiet, untimed
from identification.runtime.pool import run_parts, threads

STEP = 1e-6  # of the differences, in the units of the states
TIED_STEP = 1e-8  # where joints are tied: MuJoCo's equalities are softer the less they are violated
# Acceleration of a joint by the force that is moved where constraints answer it [rad/s² or m/s²].
PUSHED = 1e-3
FIELDS = len(Joint._fields)
M = offsets("mjModel", "njnt nq nv na nu nuser_jnt jnt_user jnt_type jnt_qposadr jnt_dofadr")
D = offsets("mjData", "qpos qvel act qfrc_applied qfrc_bias qfrc_passive efc_force")
# Rows of constraints: equalities stand first, dry frictions behind them, then limits and contacts.
COUNTS = ("ne", "nf", "nefc")
EQUALITIES, FRICTIONS, ROWS = (structs.byte("mjData", name) for name in COUNTS)
_EULER = int(mujoco.mjtIntegrator.mjINT_EULER)
# model, data, number of states, states, number of joints, joints, entries of their rows, whether
# the integrator is Euler's, room for 3 nx numbers, A, B, joints' states, g, R, forces of limits
_SIGNATURE = types.void(*[types.int64] * 15)


@dataclass(frozen=True)
class StepSlopes:
    """Steps linearised at P points, nx = 2 nv + na; J joints carry effects."""

    A: np.ndarray  # ∂F/∂x, shape (P, nx, nx)
    B: np.ndarray  # ∂F/∂τ, shape (P, nx, nv)
    joints: np.ndarray  # fields of `Joint`, as a force sees them, shape (P, J, FIELDS)
    g: np.ndarray  # shape (P, J) [N m or N]
    R: np.ndarray  # of these joints, shape (P, J, J)
    limited: np.ndarray  # largest force of a limit or contact, 0 where none acts, shape (P,)


def linearise_steps(
    model: mujoco.MjModel, states: np.ndarray, joints: np.ndarray, entries: int
) -> StepSlopes:
    """Linearises the steps from some states.

    Args:
        model: of one evaluation of the dynamics a step, with as many positions as rates.
        states: time, qpos, qvel, act and ctrl, shape (P, 1 + nq + nv + na + nu).
        joints: indices of the J joints that carry effects, shape (J,).
        entries: of the row of effects of each.
    """
    run, P, J = _loop(), len(states), len(joints)
    nv = int(model.nv)
    nx, at = 2 * nv + int(model.na), np.asarray(joints, np.int64)
    out = StepSlopes(
        np.empty((P, nx, nx)), np.empty((P, nx, nv)), np.empty((P, J, FIELDS)), np.empty((P, J)),
        np.empty((P, J, J)), np.empty(P),
    )  # fmt: skip
    x = np.ascontiguousarray(states, float)
    cuts = np.linspace(0, P, max(1, min(threads(), P)) + 1).astype(int)

    def part(k: int) -> None:
        some, data, room = slice(cuts[k], cuts[k + 1]), mujoco.MjData(model), np.empty(3 * nx)
        results = (out.A, out.B, out.joints, out.g, out.R, out.limited)
        run(
            model._address, data._address, int(cuts[k + 1] - cuts[k]), x[some].ctypes.data,
            J, at.ctypes.data, entries, int(model.opt.integrator == _EULER), room.ctypes.data,
            *(result[some].ctypes.data for result in results),
        )  # fmt: skip

    with quiet(), untimed():
        run_parts(part, range(len(cuts) - 1))
    return out


@cache
def _loop() -> Any:
    """Returns the loop over points, compiled; its arguments are those of `_SIGNATURE`."""
    structs.require((*M._fields, *D._fields, *COUNTS, *joint_callback.FIELDS, *library.FIELDS))
    return compile_once(_slopes, _SIGNATURE)


@internal
def _integrate(m, d, is_euler, to):
    """Take the step, and write the state after it."""
    if is_euler:
        mj_Euler((m, d))
    else:
        mj_implicit((m, d))
    nv, na = word(m, M.nv), word(m, M.na)
    for i in range(nv):
        store_double(to + 8 * i, load_double(word(d, D.qpos) + 8 * i))
        store_double(to + 8 * (nv + i), load_double(word(d, D.qvel) + 8 * i))
    for i in range(na):
        store_double(to + 8 * (2 * nv + i), load_double(word(d, D.act) + 8 * i))


@internal
def _step_from(m, d, x, at, step, skipped, is_euler, to):
    """Take the step from a state of which one number is moved, and write the state after it."""
    load_state(m, d, x)
    store_double(at, load_double(at) + step)
    mj_forwardSkip((m, d, skipped, 1))
    _integrate(m, d, is_euler, to)


@internal
def _differ(to, columns, column, here, there, step, n):
    """Write a column of differences into a matrix of n rows."""
    for i in range(n):
        x = (load_double(there + 8 * i) - load_double(here + 8 * i)) / step
        store_double(to + 8 * (columns * i + column), x)


@internal
def _resisted(m, d, n, joints, entries, w, g, R):
    """Write what is left of the force to stop each joint, and R; w: room for nv numbers."""
    nv, columns = word(m, M.nv), word(m, M.nuser_jnt)
    mj_rne((m, d, 0, word(d, D.qfrc_bias)))
    for i in range(nv):
        c = load_double(word(d, D.qfrc_bias) + 8 * i)
        store_double(w + 8 * i, load_double(word(d, D.qfrc_passive) + 8 * i) - c)
    for j in range(word(m, M.njnt)):
        kind, dof = integer(m, M.jnt_type, j), integer(m, M.jnt_dofadr, j)
        if kind in (HINGE, SLIDE):
            q = load_double(word(d, D.qpos) + 8 * integer(m, M.jnt_qposadr, j))
            f_u = drive_force(m, d, j, q, load_double(word(d, D.qvel) + 8 * dof))
            if f_u == f_u:
                store_double(w + 8 * dof, load_double(w + 8 * dof) + f_u)
    solve(m, d, w)
    for k in range(n):
        j = load_word(joints + 8 * k)
        dof = integer(m, M.jnt_dofadr, j)
        stop = load_constant(word(m, M.jnt_user) + 8 * (columns * (j + 1) - entries + STOP))
        v = load_double(word(d, D.qvel) + 8 * dof)
        store_double(g + 8 * k, load_double(w + 8 * dof) + v / stop)
    for k in range(n):
        unit(w, integer(m, M.jnt_dofadr, load_word(joints + 8 * k)), nv)
        solve(m, d, w)
        for i in range(n):
            dof = integer(m, M.jnt_dofadr, load_word(joints + 8 * i))
            store_double(R + 8 * (n * k + i), load_double(w + 8 * dof))
        store_double(g + 8 * k, load_double(g + 8 * k) / load_double(R + 8 * (n * k + k)))


@internal
def _largest_limit(d, rows):
    """Returns the largest force of a limit or a contact, 0 where none acts."""
    most = 0.0
    for i in range(load_int(d + EQUALITIES) + load_int(d + FRICTIONS), rows):
        most = max(most, abs(load_double(word(d, D.efc_force) + 8 * i)))
    return most


def _slopes(m, d, points, states, n, joints, entries, is_euler, room, A, B, seen, g, R, limited):
    nv, na, columns = word(m, M.nv), word(m, M.na), word(m, M.nuser_jnt)
    nx = 2 * nv + na
    row = 8 * (1 + word(m, M.nq) + nv + na + word(m, M.nu))
    here, there, w = room, room + 8 * nx, room + 16 * nx
    for p in range(points):
        x, to = states + row * p, A + 8 * nx * nx * p
        load_state(m, d, x)
        clear(word(d, D.qfrc_applied), nv)
        mj_forwardSkip((m, d, NONE, 1))
        rows = np.int64(load_int(d + ROWS))
        step = TIED_STEP if load_int(d + EQUALITIES) > 0 else STEP
        store_double(limited + 8 * p, _largest_limit(d, rows))
        for k in range(n):
            j = load_word(joints + 8 * k)
            at = word(m, M.jnt_user) + 8 * (columns * (j + 1) - entries)
            s = joint(m, d, j, at)
            to_s = seen + 8 * FIELDS * (n * p + k)
            for i, value in enumerate(s):
                store_double(to_s + 8 * i, value)
        _resisted(m, d, n, joints, entries, w, g + 8 * n * p, R + 8 * n * n * p)
        _integrate(m, d, is_euler, here)
        for i in range(nv):
            at, push = word(d, D.qfrc_applied) + 8 * i, 1.0
            if rows > 0:  # friction answers a large force otherwise than a small one
                push = PUSHED / mobility(m, d, i, w)
            _step_from(m, d, x, at, push, VELOCITY, is_euler, there)
            _differ(B + 8 * nx * nv * p, nv, i, here, there, push, nx)
            store_double(at, 0.0)
        for i in range(na):
            at = word(d, D.act) + 8 * i
            _step_from(m, d, x, at, step, VELOCITY, is_euler, there)
            _differ(to, nx, 2 * nv + i, here, there, step, nx)
        for i in range(nv):
            at = word(d, D.qvel) + 8 * i
            _step_from(m, d, x, at, step, POSITION, is_euler, there)
            _differ(to, nx, nv + i, here, there, step, nx)
        for i in range(nv):
            at = word(d, D.qpos) + 8 * i
            _step_from(m, d, x, at, step, NONE, is_euler, there)
            _differ(to, nx, i, here, there, step, nx)
