"""The cable law as MuJoCo callbacks: numba cfuncs that run without Python and without the GIL.

    mjcb_passive    -T ∂d/∂q on the platform, -R T + R_s F_s - τ_c on the motor joint
    mjcb_act_dyn    activation of a drive is d₀, its rate ḋ₀; RK4 integrates it with the rest
    mjcb_act_bias   force of a drive is its current [A]; the gear K_t makes it a torque
    mjcb_sensor     user sensors on a drive: tension [N], no-load length [m] of its cable

A drive is an actuator whose `actuator_user` row starts with `law.TAG`: every other actuator,
sensor and model passes through untouched. A compiled callback must not raise: a vanished length
gives NaN, which MuJoCo reports as a divergence, and so does a model with other effects than those
compiled.

Candidate effects are terms of the same law (see `inca_mj.effects.hooks`), added where their
letters stand: i + Δi, R + ΔR, d + Δd, T + ΔT, τ + Δτ. A set without effects costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from numba import njit, types

from identification.native.joint_callback import add_joint_forces
from identification.native.memory import load_byte, load_constant, load_double, store_double
from inca_mj.effects.compose import rates, total
from inca_mj.effects.hooks import Drive
from inca_mj.effects.layout import KEY, Layout
from inca_mj.robot import law
from inca_mj.twin.fields import D, M, cable, double, drive, integer, word
from inca_mj.twin.platform import connector, dof, platform, push, span, velocity, wrench

_USER = int(mujoco.mjtSensor.mjSENS_USER)
_ACTUATOR = int(mujoco.mjtObj.mjOBJ_ACTUATOR)
_STAGE_VEL = int(mujoco.mjtStage.mjSTAGE_VEL)

SIGNATURES: dict[str, Any] = {
    "passive": types.void(types.int64, types.int64),
    "act_dyn": types.double(types.int64, types.int64, types.intc),
    "act_bias": types.double(types.int64, types.int64, types.intc),
    "sensor": types.void(types.int64, types.int64, types.intc),
}


@njit
def _is_ours(m):  # type: ignore[no-untyped-def]
    return (
        word(m, M.nuser_actuator) >= law.ACTUATOR_COLUMNS
        and word(m, M.nuser_tendon) >= law.TENDON_COLUMNS
    )


@njit
def _current(m, d, i):  # type: ignore[no-untyped-def]
    """Current of drive i, within its limits [A]."""
    u = integer(m, M.actuator_ctrladr, i)
    current = double(d, D.ctrl, u)
    if load_byte(word(m, M.actuator_ctrllimited) + u):
        current = max(current, double(m, M.actuator_ctrlrange, 2 * u))
        current = min(current, double(m, M.actuator_ctrlrange, 2 * u + 1))
    return current


@njit
def _row(m, i):  # type: ignore[no-untyped-def]
    """Address of the row of drive i in `actuator_user`."""
    return word(m, M.actuator_user) + 8 * word(m, M.nuser_actuator) * i


@njit
def _act(m, d, i):  # type: ignore[no-untyped-def]
    """Address of the activations of drive i: d₀, then the states of its effects."""
    return word(d, D.act) + 8 * integer(m, M.actuator_actadr, i)


def callbacks(layout: Layout) -> dict[str, Callable[..., Any]]:
    """The four callbacks of the law with a set of candidate effects, to be compiled."""
    added_current, added_radius = total(layout, "current", 1), total(layout, "radius", 1)
    added_path, added_tension = total(layout, "path", 4), total(layout, "tension", 1)
    added_torque, added_force = total(layout, "torque", 1), total(layout, "force", 3)
    added_wrench, advance = total(layout, "wrench", 6), rates(layout)
    key, some = layout.key, bool(layout.effects)

    @njit
    def state(m, d, i):  # type: ignore[no-untyped-def]
        """Drive i with all that follows from its state; NaN is what is not known yet."""
        joint = integer(m, M.actuator_trnid, 2 * i)
        phi = double(d, D.qpos, integer(m, M.jnt_qposadr, joint))
        omega = double(d, D.qvel, integer(m, M.jnt_dofadr, joint))
        k = np.int64(drive(m, i, law.CABLE))
        length, rate = double(d, D.ten_length, k), double(d, D.ten_velocity, k)
        d_0 = load_constant(_act(m, d, i))
        R, lambda_, b = drive(m, i, law.R), cable(m, k, law.LAMBDA), cable(m, k, law.B)
        gx, gy, gz = 0.0, 0.0, 0.0
        x, y, z, current, more = np.nan, np.nan, np.nan, np.nan, 0.0
        if some and word(m, M.nuser_actuator) > KEY:
            row, act, s = _row(m, i), _act(m, d, i), _begun(m, d, i)
            x, y, z, current = s.rx, s.ry, s.rz, s.i
            R += added_radius(s, row, act)
            longer, gx, gy, gz = added_path(s, row, act)
            length += longer
            if gx != 0.0 or gy != 0.0 or gz != 0.0:
                v = velocity(m, d, connector(m, k))
                rate += gx * v[0] + gy * v[1] + gz * v[2]
            d_0_dot = law.no_load_rate(length, d_0, omega, R)
            strain, strain_rate = (length - d_0) / d_0, (rate - d_0_dot) / d_0
            more = added_tension(_strained(s, length, strain, strain_rate), row, act)
            if drive(m, i, KEY) != key:
                more = np.nan
        d_0_dot = law.no_load_rate(length, d_0, omega, R)
        T = law.tension(length, rate, d_0, d_0_dot, lambda_, b, more)
        F_s = law.spring_force(
            phi, drive(m, i, law.R), drive(m, i, law.R_S), drive(m, i, law.K_S),
            drive(m, i, law.T_0),
        )  # fmt: skip
        return phi, omega, length, d_0, d_0_dot, T, F_s, R, (gx, gy, gz), (x, y, z), current

    @njit
    def seen(m, d, i, now):  # type: ignore[no-untyped-def]
        """Drive i as the hooks behind the tension see it."""
        phi, omega, length, d_0, _, T, F_s, _, _, r, current = now
        k = np.int64(drive(m, i, law.CABLE))
        return Drive(
            load_constant(d + 8 * D.time), phi, omega, current, 0.0, r[0], r[1], r[2], length, d_0,
            (length - d_0) / d_0, np.nan, T, F_s, drive(m, i, law.R), drive(m, i, law.R_S),
            drive(m, i, law.K_S), drive(m, i, law.B_C), drive(m, i, law.BETA),
            double(m, M.actuator_gear, 6 * i), cable(m, k, law.LAMBDA),
        )  # fmt: skip

    def passive(m, d):  # type: ignore[no-untyped-def]
        add_joint_forces(m, d)  # of other models in this process
        if not _is_ours(m):
            return
        qfrc = word(d, D.qfrc_passive)
        body = -1
        for i in range(word(m, M.nactuator)):
            if drive(m, i, law.ACTUATOR_TAG) != law.TAG:
                continue
            now = state(m, d, i)
            _, omega, _, _, _, T, F_s, R, g, _, _ = now
            k = np.int64(drive(m, i, law.CABLE))
            start = integer(m, M.ten_J_rowadr, k)
            for a in range(start, start + integer(m, M.ten_J_rownnz, k)):
                at = qfrc + 8 * integer(m, M.ten_J_colind, a)
                store_double(at, load_double(at) - T * double(d, D.ten_J, a))
            tau = -law.coulomb_friction(omega, drive(m, i, law.B_C), drive(m, i, law.BETA))
            if some and word(m, M.nuser_actuator) > KEY:
                s, row, act = seen(m, d, i, now), _row(m, i), _act(m, d, i)
                tau += added_torque(s, row, act)
                f = added_force(s, row, act)
                end = connector(m, k)
                body = integer(m, M.site_bodyid, end)
                push(m, d, end, (f[0] - T * g[0], f[1] - T * g[1], f[2] - T * g[2]))
            at = qfrc + 8 * integer(m, M.jnt_dofadr, integer(m, M.actuator_trnid, 2 * i))
            store_double(at, load_double(at) - R * T + drive(m, i, law.R_S) * F_s + tau)
        if some and body >= 0 and word(m, M.nuser_body) > 0:
            row = word(m, M.body_user) + 8 * word(m, M.nuser_body) * body
            wrench(m, d, body, added_wrench(platform(d, dof(m, body), body), row, 0))

    def act_dyn(m, d, i):  # type: ignore[no-untyped-def]
        if not _is_ours(m) or drive(m, i, law.ACTUATOR_TAG) != law.TAG:
            return 0.0
        now = state(m, d, i)
        if some and word(m, M.nuser_actuator) > KEY:
            out = word(d, D.act_dot) + 8 * integer(m, M.actuator_actadr, i)
            advance(seen(m, d, i, now), _row(m, i), _act(m, d, i), out)
            store_double(out, now[4])  # MuJoCo keeps what is returned only of a single activation
        return now[4]

    def act_bias(m, d, i):  # type: ignore[no-untyped-def]
        if not _is_ours(m) or drive(m, i, law.ACTUATOR_TAG) != law.TAG:
            return 0.0
        current = _current(m, d, i)
        if some and word(m, M.nuser_actuator) > KEY:
            current += added_current(_begun(m, d, i), _row(m, i), _act(m, d, i))
        return current

    def sensor(m, d, stage):  # type: ignore[no-untyped-def]
        if stage != _STAGE_VEL or not _is_ours(m) or word(m, M.nuser_sensor) < 1:
            return
        for s in range(word(m, M.nsensor)):
            if (
                integer(m, M.sensor_type, s) != _USER
                or integer(m, M.sensor_objtype, s) != _ACTUATOR
            ):
                continue
            i = integer(m, M.sensor_objid, s)
            if drive(m, i, law.ACTUATOR_TAG) != law.TAG:
                continue
            shown = double(m, M.sensor_user, word(m, M.nuser_sensor) * s)
            at = word(d, D.sensordata) + 8 * integer(m, M.sensor_adr, s)
            if shown == law.TENSION:
                store_double(at, state(m, d, i)[5])
            elif shown == law.NO_LOAD_LENGTH:
                store_double(at, load_constant(_act(m, d, i)))

    return {"passive": passive, "act_dyn": act_dyn, "act_bias": act_bias, "sensor": sensor}


@njit
def _begun(m, d, i):  # type: ignore[no-untyped-def]
    """Drive i as the hooks before the tension see it."""
    joint, k = integer(m, M.actuator_trnid, 2 * i), np.int64(drive(m, i, law.CABLE))
    x, y, z = span(m, d, k)
    return Drive(
        load_constant(d + 8 * D.time), double(d, D.qpos, integer(m, M.jnt_qposadr, joint)),
        double(d, D.qvel, integer(m, M.jnt_dofadr, joint)), _current(m, d, i), 0.0, x, y, z,
        double(d, D.ten_length, k), load_constant(_act(m, d, i)), np.nan, np.nan, np.nan, np.nan,
        drive(m, i, law.R), drive(m, i, law.R_S), drive(m, i, law.K_S), drive(m, i, law.B_C),
        drive(m, i, law.BETA), double(m, M.actuator_gear, 6 * i), cable(m, k, law.LAMBDA),
    )  # fmt: skip


@njit
def _strained(s, d, strain, strain_rate):  # type: ignore[no-untyped-def]
    """A drive whose cable is known but for its tension."""
    return Drive(
        s.time, s.phi, s.omega, s.i, 0.0, s.rx, s.ry, s.rz, d, s.d_0, strain, strain_rate, s.T,
        s.F_s, s.R, s.R_s, s.k_s, s.b_c, s.beta, s.K_t, s.lambda_,
    )  # fmt: skip
