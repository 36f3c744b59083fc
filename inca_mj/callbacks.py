"""The cable law as MuJoCo callbacks: numba cfuncs that run without Python and without the GIL.

    mjcb_passive    -T ∂d/∂q on the platform, -R T + R_s F_s - τ_c on the motor joint
    mjcb_act_dyn    activation of a drive is d₀, its rate ḋ₀; RK4 integrates it with the rest
    mjcb_act_bias   force of a drive is its current [A]; the gear K_t makes it a torque
    mjcb_sensor     user sensors on a drive: tension [N], no-load length [m] of its cable

A drive is an actuator whose `actuator_user` row starts with `law.TAG`: every other actuator,
sensor and model passes through untouched. A compiled callback must not raise: a vanished length
gives NaN, which MuJoCo reports as a divergence.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import mujoco
import numpy as np
from numba import njit, types

from inca_mj import law, structs
from inca_mj.memory import (
    load_byte,
    load_constant,
    load_double,
    load_int,
    load_word,
    store_double,
)


def _offsets(struct: str, names: str) -> Any:
    """Word offsets of fields, frozen into the compiled code as constants."""
    fields = names.split()
    kind: Any = namedtuple(struct, fields)  # type: ignore[misc]
    return kind(*(structs.word(struct, n) for n in fields))


_M = _offsets(
    "mjModel",
    "nactuator nsensor nuser_actuator nuser_tendon nuser_sensor"
    " actuator_user actuator_actadr actuator_trnid actuator_ctrladr actuator_ctrllimited"
    " actuator_ctrlrange tendon_user ten_J_rownnz ten_J_rowadr ten_J_colind"
    " jnt_qposadr jnt_dofadr sensor_type sensor_objtype sensor_objid sensor_adr sensor_user",
)
_D = _offsets("mjData", "qpos qvel act ctrl ten_length ten_velocity ten_J qfrc_passive sensordata")
_USER = int(mujoco.mjtSensor.mjSENS_USER)
_ACTUATOR = int(mujoco.mjtObj.mjOBJ_ACTUATOR)
_STAGE_VEL = int(mujoco.mjtStage.mjSTAGE_VEL)


@njit
def _word(struct, at):  # type: ignore[no-untyped-def]
    """A size, or the address of an array."""
    return load_word(struct + 8 * at)


@njit
def _double(struct, at, i):  # type: ignore[no-untyped-def]
    return load_constant(load_word(struct + 8 * at) + 8 * i)


@njit
def _int(struct, at, i):  # type: ignore[no-untyped-def]
    return np.int64(load_int(load_word(struct + 8 * at) + 4 * i))


@njit
def _is_ours(m):  # type: ignore[no-untyped-def]
    return (
        _word(m, _M.nuser_actuator) >= law.ACTUATOR_COLUMNS
        and _word(m, _M.nuser_tendon) >= law.TENDON_COLUMNS
    )


@njit
def _drive(m, i, column):  # type: ignore[no-untyped-def]
    """A number of drive i: row i of `actuator_user`."""
    return _double(m, _M.actuator_user, _word(m, _M.nuser_actuator) * i + column)


@njit
def _cable(m, k, column):  # type: ignore[no-untyped-def]
    """A number of cable k: row k of `tendon_user`."""
    return _double(m, _M.tendon_user, _word(m, _M.nuser_tendon) * k + column)


@njit
def _no_load(m, d, i):  # type: ignore[no-untyped-def]
    """No-load length of the cable of drive i and its rate: d₀ [m], ḋ₀ [m/s]."""
    joint = _int(m, _M.actuator_trnid, 2 * i)
    omega = _double(d, _D.qvel, _int(m, _M.jnt_dofadr, joint))
    d_0 = _double(d, _D.act, _int(m, _M.actuator_actadr, i))
    length = _double(d, _D.ten_length, np.int64(_drive(m, i, law.CABLE)))
    return d_0, law.no_load_rate(length, d_0, omega, _drive(m, i, law.R))


@njit
def _tension(m, d, i):  # type: ignore[no-untyped-def]
    """Tension of the cable of drive i: T [N]."""
    k = np.int64(_drive(m, i, law.CABLE))
    length, rate = _double(d, _D.ten_length, k), _double(d, _D.ten_velocity, k)
    d_0, d_0_dot = _no_load(m, d, i)
    return law.tension(length, rate, d_0, d_0_dot, _cable(m, k, law.LAMBDA), _cable(m, k, law.B))


def _passive(m, d):  # type: ignore[no-untyped-def]
    if not _is_ours(m):
        return
    force = _word(d, _D.qfrc_passive)
    for i in range(_word(m, _M.nactuator)):
        if _drive(m, i, law.ACTUATOR_TAG) != law.TAG:
            continue
        T = _tension(m, d, i)
        k = np.int64(_drive(m, i, law.CABLE))
        start = _int(m, _M.ten_J_rowadr, k)
        for a in range(start, start + _int(m, _M.ten_J_rownnz, k)):
            at = force + 8 * _int(m, _M.ten_J_colind, a)
            store_double(at, load_double(at) - T * _double(d, _D.ten_J, a))
        joint = _int(m, _M.actuator_trnid, 2 * i)
        dof = _int(m, _M.jnt_dofadr, joint)
        phi, omega = _double(d, _D.qpos, _int(m, _M.jnt_qposadr, joint)), _double(d, _D.qvel, dof)
        R, R_s = _drive(m, i, law.R), _drive(m, i, law.R_S)
        F_s = law.spring_force(phi, R, R_s, _drive(m, i, law.K_S), _drive(m, i, law.T_0))
        tau_c = law.coulomb_friction(omega, _drive(m, i, law.B_C), _drive(m, i, law.BETA))
        at = force + 8 * dof
        store_double(at, load_double(at) - R * T + R_s * F_s - tau_c)


def _act_dyn(m, d, i):  # type: ignore[no-untyped-def]
    if not _is_ours(m) or _drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return 0.0
    return _no_load(m, d, i)[1]


def _act_bias(m, d, i):  # type: ignore[no-untyped-def]
    if not _is_ours(m) or _drive(m, i, law.ACTUATOR_TAG) != law.TAG:
        return 0.0
    u = _int(m, _M.actuator_ctrladr, i)
    current = _double(d, _D.ctrl, u)
    if load_byte(_word(m, _M.actuator_ctrllimited) + u):
        current = max(current, _double(m, _M.actuator_ctrlrange, 2 * u))
        current = min(current, _double(m, _M.actuator_ctrlrange, 2 * u + 1))
    return current


def _sensor(m, d, stage):  # type: ignore[no-untyped-def]
    if stage != _STAGE_VEL or not _is_ours(m) or _word(m, _M.nuser_sensor) < 1:
        return
    for s in range(_word(m, _M.nsensor)):
        if _int(m, _M.sensor_type, s) != _USER or _int(m, _M.sensor_objtype, s) != _ACTUATOR:
            continue
        i = _int(m, _M.sensor_objid, s)
        if _drive(m, i, law.ACTUATOR_TAG) != law.TAG:
            continue
        shown = _double(m, _M.sensor_user, _word(m, _M.nuser_sensor) * s)
        at = _word(d, _D.sensordata) + 8 * _int(m, _M.sensor_adr, s)
        if shown == law.TENSION:
            store_double(at, _tension(m, d, i))
        elif shown == law.NO_LOAD_LENGTH:
            store_double(at, _no_load(m, d, i)[0])


SIGNATURES: dict[str, tuple[Any, Any]] = {
    "passive": (types.void(types.int64, types.int64), _passive),
    "act_dyn": (types.double(types.int64, types.int64, types.intc), _act_dyn),
    "act_bias": (types.double(types.int64, types.int64, types.intc), _act_bias),
    "sensor": (types.void(types.int64, types.int64, types.intc), _sensor),
}
FIELDS = {*_M._fields, *_D._fields}  # everything the callbacks touch
