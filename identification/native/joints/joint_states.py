"""The effects of joints with states of their own, inside MuJoCo's callbacks.

    mjcb_passive     friction and forces, as in `identification.native.joints.joint_friction`; where
                     gears swing, of the joint behind its gear
    mjcb_act_dyn     rates of θ, ω, p and z
    mjcb_act_bias    τ in place of the drives' force, by the actuator that carries θ and ω; f_i of a
                     servo's integral part, by the actuator that carries z

`identification.native.joints.gear` has the laws of one gear. Gears that are not resolved feel each
other:

    a = M⁻¹ (F + τ)                                         F: all forces but those of geared drives
    T_j = m_j (f_mj/J_j - (a_j - A_jj τ_j))                 A = M⁻¹
    τ_j ← τ(T_j, δ_j, dδ_j/dt),   a ← a + A_j Δτ_j          Gauss-Seidel over the joints j

For one joint it is exact at once, and where all gears are resolved τ needs no load. MuJoCo asks all
actuators for rates before it asks any for its force: the first one with states finds τ for all
joints. A semi-implicit step moves q by the new rate, so that the rates of θ and p are those at the
end of such a step too; without the damping that such steps take implicitly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from identification.native.compose import total
from identification.native.element import Function, Term
from identification.native.joints.gear import (
    GAP,
    GEARS,
    GRIP,
    INERTIA,
    INTEGRATOR,
    IS_JOINT,
    MOTOR,
    RK4,
    SIDE,
    SLIP,
    SUM,
    felt,
    gears_of,
    integral_force,
    is_geared,
    motor_force,
    spring,
    transmitted,
    whole_drive,
)
from identification.native.joints.joint_callback import (
    FIRST,
    JOINT,
    LAST,
    TAG,
    TIMESTEP,
    D,
    M,
    drive,
    drive_force,
    with_sign,
)
from identification.native.joints.joint_friction import passive_force
from identification.native.library import mobility, solve, unit
from identification.native.memory import (
    double,
    inlined,
    integer,
    internal,
    load_constant,
    load_double,
    load_int,
    store_double,
    word,
)

SWEEPS = 200  # at most; arms take some five
ENOUGH = 1e-13  # change of a τ in a sweep that ends them, of the largest one
# columns of a geared joint: its degree of freedom, f_m, δ, dδ/dt, ε, m, κ, r, D, A_jj, J and τ
DOF, FORCE, DELTA, RATE, HALF, MASS, KAPPA, SHARE, DAMPING, MOBILITY, OWN, TAU = range(12)
COLUMNS = 12


@inlined
def is_ours(m, j, key):
    """Returns whether joint j has a row of a set of effects."""
    end = gears_of(m, j) + 8 * (GEARS + LAST)
    return load_constant(end - 8) == TAG and load_constant(end - 16) == key


@inlined
def _load(g, k, a):
    """Returns T of geared joint k, which accelerates by a."""
    return g[k, MASS] * (g[k, FORCE] / g[k, OWN] - (a - g[k, MOBILITY] * g[k, TAU]))


@inlined
def _passed_on(g, k, load, h):
    """Returns τ of geared joint k under a load."""
    return transmitted(
        load, g[k, DELTA], g[k, RATE], g[k, HALF], g[k, KAPPA], g[k, SHARE], g[k, DAMPING], h
    )


@internal
def _gather(m, d, key, g):
    """Puts geared joints into the rows of g, and F into qacc_smooth.

    Returns:
        How many have a gear, how many of these are not resolved, whether a friction gives.
    """
    h, a, room = load_constant(m + TIMESTEP), word(d, D.qacc_smooth), word(d, D.qfrc_smooth)
    for i in range(word(m, M.nv)):
        f = load_double(word(d, D.qfrc_passive) + 8 * i) - double(d, D.qfrc_bias, i)
        store_double(a + 8 * i, f)
    count, loose, gives = 0, 0, False
    for j in range(word(m, M.njnt)):
        gears, dof = gears_of(m, j), integer(m, M.jnt_dofadr, j)
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
        q, v = double(d, D.qpos, integer(m, M.jnt_qposadr, j)), double(d, D.qvel, dof)
        f = whole_drive(m, d, j, q, v, gears) if ours else drive_force(m, d, j, q, v)
        if f == f and f != 0.0:  # where it is known
            store_double(a + 8 * dof, load_double(a + 8 * dof) + f)
    return count, loose, gives


@internal
def _settle(m, d, g, count, loose, h):
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
def _has_gears(m, key):
    """Returns whether a joint of a set of effects has a gear."""
    for j in range(word(m, M.njnt)):  # noqa: SIM110
        if is_ours(m, j, key) and is_geared(gears_of(m, j)):
            return True
    return False


@internal
def transmit(m, d, key, is_implicit):
    """Writes τ of all geared joints into qfrc_actuator, behind MuJoCo's velocity stage.

    MuJoCo writes there, and into the room of qfrc_smooth and qacc_smooth, when it has asked all
    actuators. Where a step moves friction that gives by the new rate, qacc_smooth holds a. Without
    gears nothing else is made of what is computed here.
    """
    if not is_implicit and not _has_gears(m, key):
        return
    h, a, out = load_constant(m + TIMESTEP), word(d, D.qacc_smooth), word(d, D.qfrc_actuator)
    g = np.empty((word(m, M.njnt), COLUMNS))
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


def width(terms: Sequence[Term]) -> int:
    """Returns how many entries a joint's row has with some effects and its states' numbers."""
    return FIRST + sum(len(term.names) for term in terms) + GEARS + LAST


def callbacks(terms: Sequence[Term], key: float) -> dict[str, Function]:
    """Returns the callbacks of a set of joint effects in a plant with states, to be compiled."""
    friction, entries = total(JOINT, terms, "friction"), width(terms)

    @inlined
    def felt_of(m, d, j, row, end):
        gears, p = end - 8 * (GEARS + LAST), 0.0
        s, more = felt(m, d, j, row, gears)
        c = load_constant(gears + 8 * SLIP)
        if c != 0.0:
            p = double(d, D.act, np.int64(load_constant(gears + 8 * GRIP)))
        return s, more, c, p

    @inlined
    def mine(m, i):
        """Returns the joint of an actuator that carries states of this law; -1 if it does not."""
        if (
            i < 0
            or word(m, M.nuser_jnt) < entries
            or integer(m, M.actuator_trntype, i) != IS_JOINT
            or integer(m, M.actuator_actadr, i) < 0
        ):
            return -1
        j, place = integer(m, M.actuator_trnid, 2 * i), integer(m, M.actuator_actadr, i)
        if not is_ours(m, j, key):
            return -1
        gears = gears_of(m, j)
        for which in (MOTOR, GRIP, SUM):
            if np.int64(load_constant(gears + 8 * which)) == place:
                return j
        return -1

    @inlined
    def servo(m, d, j, gears):
        """Returns `drive` of a joint, as the encoder of its servo sees it."""
        q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
        v = double(d, D.qvel, integer(m, M.jnt_dofadr, j))
        if load_constant(gears + 8 * SIDE) != 0.0 and is_geared(gears):
            at = word(d, D.act) + 8 * np.int64(load_constant(gears + 8 * MOTOR))
            q, v = load_constant(at), load_constant(at + 8)
        return drive(m, d, j, q, v)

    def act_dyn(m, d, i):
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears, place = gears_of(m, j), integer(m, M.actuator_actadr, i)
        dof = integer(m, M.jnt_dofadr, j)
        out, h = word(d, D.act_dot) + 8 * place, load_constant(m + TIMESTEP)
        semi = 0.0 if load_int(m + INTEGRATOR) == RK4 else h  # such a step moves q by the new v
        if mine(m, i - 1) < 0:  # these actuators stand in a row
            transmit(m, d, key, semi != 0.0)
        if np.int64(load_constant(gears + 8 * MOTOR)) == place:
            store_double(out, 0.0)
            store_double(out + 8, 0.0)
            if is_geared(gears):
                f_m, _, _ = motor_force(m, d, j, gears)
                tau = load_double(word(d, D.qfrc_actuator) + 8 * dof)
                rate = (f_m - tau) / load_constant(gears + 8 * INERTIA)
                store_double(out, double(d, D.act, place + 1) + semi * rate)
                store_double(out + 8, rate)
            return 0.0
        if np.int64(load_constant(gears + 8 * SUM)) == place:
            return servo(m, d, j, gears)[1]
        c = load_constant(gears + 8 * SLIP)
        if np.int64(load_constant(gears + 8 * GRIP)) != place or c == 0.0:
            return 0.0
        row = gears + 8 * (GEARS + LAST - entries)
        s, _ = felt(m, d, j, row, gears)
        v, p = s.v, double(d, D.act, place)
        if semi != 0.0:
            v += semi * load_double(word(d, D.qacc_smooth) + 8 * dof)
        b = max(0.0, friction(with_sign(s, (1.0 if v > 0.0 else -1.0,)), row + 8 * FIRST, 0))
        if b == 0.0:
            return -p / h
        return (v - abs(v) * p / b) / max(c, abs(v) * h / b)

    def act_bias(m, d, i):
        j = mine(m, i)
        if j < 0:
            return 0.0
        gears, place = gears_of(m, j), integer(m, M.actuator_actadr, i)
        if np.int64(load_constant(gears + 8 * SUM)) == place and not is_geared(gears):
            _, _, _, f_s, f_low, f_high = servo(m, d, j, gears)
            return integral_force(d, gears, f_s, f_low, f_high)
        if np.int64(load_constant(gears + 8 * MOTOR)) != place or not is_geared(gears):
            return 0.0
        dof = integer(m, M.jnt_dofadr, j)
        q = double(d, D.qpos, integer(m, M.jnt_qposadr, j))
        v = double(d, D.qvel, dof)
        return load_double(word(d, D.qfrc_actuator) + 8 * dof) - drive_force(m, d, j, q, v)

    passive = passive_force(terms, key, entries, felt_of)
    return {"passive": passive, "act_dyn": act_dyn, "act_bias": act_bias}
