"""The forces that the gears of all joints pass on at once; unresolved ones feel each other.

    a = M⁻¹ (F + τ)                                         F: all forces but those of geared drives
    T_j = m_j (f_mj/J_j - (a_j - A_jj τ_j))                 A = M⁻¹
    τ_j ← τ(T_j, δ_j, dδ_j/dt),   a ← a + A_j Δτ_j          Gauss-Seidel over the joints j

τ(T, δ, dδ/dt) and m are those of `identification.native.gear`. For one joint it is exact at once,
and where all gears are resolved τ needs no load.
"""

from __future__ import annotations

import numpy as np

from identification.native.access import double, integer, word
from identification.native.decorators import inlined, internal
from identification.native.gear import (
    GAP,
    GEARS,
    INERTIA,
    SLIP,
    TIMESTEP,
    D,
    M,
    gears_of,
    is_geared,
    motor_force,
    spring,
    transmitted,
)
from identification.native.joint_callback import LAST, TAG, drive_force
from identification.native.joint_callback import D as JOINT_D
from identification.native.joint_callback import M as JOINT_M
from identification.native.mass import mobility, solve, unit
from identification.native.memory import load_constant, load_double, store_double

SWEEPS = 200  # at most; arms take some five
ENOUGH = 1e-13  # change of a τ in a sweep that ends them, of the largest one
# columns of a geared joint: its degree of freedom, f_m, δ, dδ/dt, ε, m, κ, r, D, A_jj, J and τ
DOF, FORCE, DELTA, RATE, HALF, MASS, KAPPA, SHARE, DAMPING, MOBILITY, OWN, TAU = range(12)
COLUMNS = 12


@inlined
def is_ours(m, j, key):  # type: ignore[no-untyped-def]
    """Returns whether joint j has a row of a set of effects."""
    end = gears_of(m, j) + 8 * (GEARS + LAST)
    return load_constant(end - 8) == TAG and load_constant(end - 16) == key


@inlined
def _load(g, k, a):  # type: ignore[no-untyped-def]
    """Returns T of geared joint k, which accelerates by a."""
    return g[k, MASS] * (g[k, FORCE] / g[k, OWN] - (a - g[k, MOBILITY] * g[k, TAU]))


@inlined
def _passed_on(g, k, load, h):  # type: ignore[no-untyped-def]
    """Returns τ of geared joint k under a load."""
    return transmitted(
        load, g[k, DELTA], g[k, RATE], g[k, HALF], g[k, KAPPA], g[k, SHARE], g[k, DAMPING], h
    )


@internal
def _gather(m, d, key, g):  # type: ignore[no-untyped-def]
    """Puts geared joints into the rows of g, and F into qacc_smooth.

    Returns:
        How many have a gear, how many of these are not resolved, whether a friction gives.
    """
    h, a, room = load_constant(m + TIMESTEP), word(d, D.qacc_smooth), word(d, D.qfrc_smooth)
    for i in range(word(m, M.nv)):
        f = load_double(word(d, JOINT_D.qfrc_passive) + 8 * i) - double(d, D.qfrc_bias, i)
        store_double(a + 8 * i, f)
    count, loose, gives = 0, 0, False
    for j in range(word(m, JOINT_M.njnt)):
        gears, dof = gears_of(m, j), integer(m, JOINT_M.jnt_dofadr, j)
        ours = is_ours(m, j, key)
        gives = gives or (ours and load_constant(gears + 8 * SLIP) != 0.0)
        if ours and is_geared(gears):
            f_m, delta, rate = motor_force(m, d, j, gears)
            A = mobility(m, d, dof, room)
            g[count, DOF], g[count, FORCE], g[count, DELTA], g[count, RATE] = dof, f_m, delta, rate
            g[count, MASS], g[count, KAPPA], g[count, SHARE], g[count, DAMPING] = spring(
                gears, A, h
            )
            g[count, MOBILITY], g[count, OWN] = A, load_constant(gears + 8 * INERTIA)
            g[count, HALF] = load_constant(gears + 8 * GAP)
            g[count, TAU] = _passed_on(g, count, f_m, h)
            loose += g[count, SHARE] < 1.0
            count += 1
            continue
        q = double(d, JOINT_D.qpos, integer(m, JOINT_M.jnt_qposadr, j))
        f = drive_force(m, d, j, q, double(d, JOINT_D.qvel, dof))
        if f == f and f != 0.0:  # where it is known
            store_double(a + 8 * dof, load_double(a + 8 * dof) + f)
    return count, loose, gives


@internal
def _settle(m, d, g, count, loose, h):  # type: ignore[no-untyped-def]
    """Computes τ of the gears that are not resolved into g, and what they change of a, in place."""
    n, room, a = word(m, M.nv), word(d, D.qfrc_smooth), word(d, D.qacc_smooth)
    columns, at, largest = np.empty((loose, n)), 0, 0.0
    for k in range(count):
        largest = max(largest, abs(g[k, TAU]), abs(g[k, FORCE]))
        if g[k, SHARE] < 1.0:
            unit(room, np.int64(g[k, DOF]), n)
            solve(m, d, room)
            for i in range(n):
                columns[at, i] = load_double(room + 8 * i)
            at += 1
    for _ in range(SWEEPS):
        change, at = 0.0, 0
        for k in range(count):
            if g[k, SHARE] >= 1.0:
                continue
            load = _load(g, k, load_double(a + 8 * np.int64(g[k, DOF])))
            tau = _passed_on(g, k, load, h)
            more = tau - g[k, TAU]
            g[k, TAU] = tau
            change = max(change, abs(more))
            for i in range(n):
                store_double(a + 8 * i, load_double(a + 8 * i) + columns[at, i] * more)
            at += 1
        if loose == 1 or change <= ENOUGH * largest:
            break


@internal
def transmit(m, d, key, is_implicit):  # type: ignore[no-untyped-def]
    """Writes τ of all geared joints into qfrc_actuator, behind MuJoCo's velocity stage.

    MuJoCo writes there, and into the room of qfrc_smooth and qacc_smooth, when it has asked all
    actuators. Where a step moves friction that gives by the new rate, qacc_smooth holds a.
    """
    h, a, out = load_constant(m + TIMESTEP), word(d, D.qacc_smooth), word(d, D.qfrc_actuator)
    g = np.empty((word(m, JOINT_M.njnt), COLUMNS))
    count, loose, gives = _gather(m, d, key, g)
    if loose > 0 or (gives and is_implicit):
        for k in range(count):
            at = a + 8 * np.int64(g[k, DOF])
            store_double(at, load_double(at) + g[k, TAU])
        solve(m, d, a)
    if loose > 0:
        _settle(m, d, g, count, loose, h)
    for k in range(count):
        store_double(out + 8 * np.int64(g[k, DOF]), g[k, TAU])
